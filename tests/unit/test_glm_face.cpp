// SPDX-License-Identifier: Apache-2.0
// Tests candelabra/glm.hpp: values survive conversion there and back, with columns in the right
// place.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "candelabra/glm.hpp"

namespace candelabra::test
{

TEST(GlmFace, VectorsGoIntoLightsAndOut)
{
    CndLight light{};
    assign(light.position, glm::vec3(1, 2, 3));
    EXPECT_EQ(light.position[2], 3);
    EXPECT_EQ(toGlm(light.position), glm::vec3(1, 2, 3));
    CndLightSet set{};
    assign(set.origin, glm::dvec3(1e9 + 1, 0, -1));
    EXPECT_EQ(set.origin[0], 1e9 + 1);
}

TEST(GlmFace, MatricesKeepTheirColumns)
{
    const glm::dmat4 view = glm::translate(glm::dmat4(1), glm::dvec3(4, 5, 6));
    glm::mat4 clip(1);
    clip[2][3] = -1;
    const CndCamera c = camera(view, clip);
    EXPECT_EQ(c.viewFromWorld[12], 4);
    EXPECT_EQ(c.viewFromWorld[14], 6);
    EXPECT_EQ(c.clipFromView[11], -1);
    CndEnvironmentFrame frame{};
    assign(frame.worldFromEnvironment, glm::mat3(1, 2, 3, 4, 5, 6, 7, 8, 9));
    EXPECT_EQ(frame.worldFromEnvironment[1], 2);
    EXPECT_EQ(frame.worldFromEnvironment[8], 9);
    CndOccluderInstance instance{};
    assign(instance.worldFromMesh,
           view * glm::rotate(glm::dmat4(1), glm::radians(90.0), {0, 0, 1}));
    EXPECT_EQ(instance.worldFromMesh[3], 4);
    EXPECT_EQ(instance.worldFromMesh[11], 6);
    EXPECT_EQ(instance.worldFromMesh[4], 1) << "x of the mesh is y of the world";
}

} // namespace candelabra::test
