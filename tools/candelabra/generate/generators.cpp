// SPDX-License-Identifier: Apache-2.0
#include "generate/generators.h"

namespace candelabra::app
{

bool isGenerated(const std::string& scene)
{
    return scene == "hall" || scene == "field" || scene == "fence" || scene == "rooms";
}

bool isBuiltIn(const std::string& scene)
{
    return isGenerated(scene) || scene == "showcase";
}

namespace
{

Scene generateByName(const std::string& scene, const SceneOptions& options)
{
    if (scene == "hall")
        return generateHall(options);
    if (scene == "field")
        return generateField(options);
    if (scene == "fence")
        return generateFence(options);
    if (scene == "rooms")
        return generateRooms(options);
    return generateShowcase(options);
}

} // namespace

Scene generateScene(const std::string& scene, const SceneOptions& options)
{
    Scene out = generateByName(scene, options);
    out.exposureCompensation = -1; // all of them are at night
    return out;
}

} // namespace candelabra::app
