// SPDX-License-Identifier: Apache-2.0
// The walk through the trees of occluders (shaders/shading/occluder_walk.glsl) must find the points
// that a test of every triangle finds, bit for bit.
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "candelabra_probes.h"
#include "gpu/probe.h"
#include "harness/full_tests.h"
#include "harness/occluder_host.h"
#include "occluders/prepared_occluders.h"
#include "shared/walk_probe.h"
#include "tables/point_table.h"

namespace candelabra::test
{
namespace
{

using lighting::OccluderId;
using lighting::OccluderInstance;
using lighting::OccluderMesh;
using lighting::OccluderMeshId;

class VisibilityWalk : public ProbeTest
{
protected:
    void SetUp() override
    {
        ProbeTest::SetUp();
        if (!IsSkipped() && !HasFatalFailure())
            host_ = std::make_unique<OccluderHost>(device());
    }
    void TearDown() override
    {
        host_.reset();
        ProbeTest::TearDown();
    }
    glm::dvec3 anyDirection() { return direction(uniform(-1, 1)); }
    glm::dvec3 pointWithin(double size)
    {
        return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
    }
    OccluderMeshId addMesh(uint32_t triangles);
    void addInstance(OccluderMeshId mesh);
    void addScene(uint32_t meshes, uint32_t instances, uint32_t triangles);
    gpu::WalkProbeInput anyPair(uint32_t type);
    std::vector<gpu::WalkProbeOutput> evaluate(const std::vector<gpu::WalkProbeInput>& inputs,
                                               uint32_t points);

    // The camera looks along some direction at the scene, which is far from the world's origin.
    const glm::dvec3 centre_{4000, -300, 20};
    const glm::dmat4 view_ = glm::lookAt(centre_ + glm::dvec3(9, 4, 2), centre_, {0.1, 1, 0});
    std::unique_ptr<OccluderHost> host_;
    uint32_t ignored_ = 0;
};

// A mesh of about 1 m: triangles of many sizes and slivers. Some share vertices.
OccluderMeshId VisibilityWalk::addMesh(uint32_t triangles)
{
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    for (uint32_t i = 0; i < triangles; ++i) {
        const glm::dvec3 at = pointWithin(0.5);
        const double size = std::exp2(uniform(-6, 0)), other = random_() % 8 ? size : 1e-6;
        for (int k = 0; k < 3; ++k) {
            const bool shared = !positions.empty() && random_() % 4 == 0;
            indices.push_back(uint32_t(shared ? random_() % positions.size() : positions.size()));
            if (!shared)
                positions.push_back(glm::vec3(at + pointWithin(k == 0 ? size : other)));
        }
    }
    const OccluderMesh mesh{.positions = &positions[0].x,
                            .vertexCount = uint32_t(positions.size()),
                            .indices = indices.data(),
                            .triangleCount = triangles};
    OccluderMeshId id = 0;
    host_->set.addMeshes({&mesh, 1}, &id);
    return id;
}

// Within 6 m of the centre; rotated, stretched, sheared and, in half of the cases, mirrored.
void VisibilityWalk::addInstance(OccluderMeshId mesh)
{
    OccluderInstance instance{.mesh = mesh, .occluderLayer = uint32_t(random_() % 3), .layers = 1};
    const glm::dvec3 position = centre_ + pointWithin(6);
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            instance.worldFromMesh[4 * row + column] =
                uniform(-0.4, 0.4) + (row == column) * uniform(0.8, 2);
        instance.worldFromMesh[4 * row] *= random_() % 2 ? 1 : -1;
        instance.worldFromMesh[4 * row + 3] = position[row];
    }
    OccluderId id = 0;
    host_->set.add({&instance, 1}, &id);
}

void VisibilityWalk::addScene(uint32_t meshes, uint32_t instances, uint32_t triangles)
{
    std::vector<OccluderMeshId> ids;
    for (uint32_t i = 0; i < meshes; ++i)
        ids.push_back(addMesh(uint32_t(1 + random_() % triangles)));
    for (uint32_t i = 0; i < instances; ++i)
        addInstance(ids[random_() % ids.size()]);
}

// A receiver and a light of up to 3 m within 8 m of the centre. A quarter of the flat lights is
// seen from the edge.
gpu::WalkProbeInput VisibilityWalk::anyPair(uint32_t type)
{
    const glm::dvec3 position = glm::dvec3(view_ * glm::dvec4(centre_ + pointWithin(8), 1));
    const glm::dvec3 light = glm::dvec3(view_ * glm::dvec4(centre_ + pointWithin(8), 1));
    const bool distant = (gpu::TYPES_WITH_POSITION >> type & 1u) == 0;
    const double size = std::exp2(uniform(-7, 1.5));
    glm::dvec3 normal = anyDirection();
    if (random_() % 4 == 0) {
        const glm::dvec3 a = glm::normalize(light - position);
        normal -= (glm::dot(normal, a) - std::exp2(uniform(-17, -4))) * a;
    }
    const glm::dvec3 n = glm::normalize(normal);
    const glm::dvec3 u = glm::normalize(glm::cross(n, anyDirection())), v = glm::cross(n, u);
    gpu::WalkProbeInput in{};
    in.position = glm::vec3(position);
    in.type = type;
    in.toLight = glm::vec3(distant ? anyDirection() : light - position);
    in.boundingRadius = float(distant ? std::exp2(uniform(-8, -0.5)) : size);
    in.shape.radius = float(type == CND_LIGHT_TUBE ? 0.1 * size : size);
    in.shape.axisU = glm::vec3(type == CND_LIGHT_DISC ? n : 0.7 * size * u);
    in.shape.axisV = glm::vec3(0.4 * size * v);
    return in;
}

std::vector<gpu::WalkProbeOutput>
VisibilityWalk::evaluate(const std::vector<gpu::WalkProbeInput>& inputs, uint32_t points)
{
    const uint32_t count = uint32_t(inputs.size());
    const gpu::Buffer in = upload("pairs", inputs);
    const gpu::Buffer table = upload("points", tables::pointTable(points));
    const gpu::Buffer out = readback("points", count * sizeof(gpu::WalkProbeOutput));
    const gpu::Kernel<gpu::WalkProbeParams> kernel(device(), spirv::occluder_walk_comp,
                                                   {{gpu::SPEC_VISIBILITY_POINTS, points}});
    double viewFromWorld[16];
    std::memcpy(viewFromWorld, glm::value_ptr(view_), sizeof viewFromWorld);
    context().submitAndWait([&](VkCommandBuffer cmd) { host_->record(cmd, viewFromWorld); });

    const lighting::InstanceTable& instances = host_->set.instances();
    const gpu::Bindings bindings = kernel.createBindings(1);
    bindings.write(0, {gpu::Binding::of(gpu::PROBE_INPUT, in),
                       gpu::Binding::of(gpu::PROBE_OUTPUT, out),
                       gpu::Binding::of(gpu::WALK_PROBE_INSTANCES, host_->prepared.buffer()),
                       gpu::Binding::of(gpu::WALK_PROBE_NODES, host_->set.meshes().nodes()),
                       gpu::Binding::of(gpu::WALK_PROBE_TRIANGLES, host_->set.meshes().triangles()),
                       gpu::Binding::of(gpu::WALK_PROBE_TABLE, table)});
    const glm::dmat3 rotation(view_);
    const glm::dvec3 camera = glm::transpose(rotation) * -glm::dvec3(view_[3]);
    const gpu::WalkProbeParams params{.viewFromTree = glm::mat3(rotation),
                                      .viewInTree = glm::vec3(camera - instances.origin()),
                                      .count = count,
                                      .layers = 1,
                                      .ignored = ignored_ << gpu::OCCLUDER_LAYERS_SHIFT,
                                      .firstNode = host_->set.meshes().firstInstanceNode()};
    gpu::Timer timer(device(), "walk", 1, false);
    context().submitAndWait([&](VkCommandBuffer cmd) {
        timer.begin(cmd, 0);
        kernel.dispatch(gpu::Frame{device(), cmd, timer, 0}, bindings.set(0), params,
                        gpu::divideUp(count, gpu::PROBE_GROUP));
        fullBarrier(cmd);
    });
    const auto values = out.as<gpu::WalkProbeOutput>();
    return {values.begin(), values.begin() + long(count)};
}

} // namespace

// In scenes of one instance up to some hundred triangles: every type, 64 and 32 points, layers that
// do not count.
TEST_F(VisibilityWalk, FindsThePointsThatATestOfEveryTriangleFinds)
{
    const int rounds = fullTests() ? 16 : 1, pairs = fullTests() ? 2000 : 160;
    uint32_t hidden = 0, partial = 0, different = 0;
    // A test of more triangles would take more turns of loops than llvmpipe makes (DECISIONS 12).
    for (int scene = 0; scene < 4 * rounds; ++scene) {
        const uint32_t instances = std::array{1u, 7u, 30u, 80u}[scene % 4];
        host_ = std::make_unique<OccluderHost>(device());
        addScene(3, instances, instances < 30 ? 60 : instances < 80 ? 20 : 8);
        ignored_ = instances == 7 ? 2u : 0u;
        std::vector<gpu::WalkProbeInput> inputs;
        for (int i = 0; i < pairs; ++i)
            for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
                if (type != CND_LIGHT_POLYGON) // the facet of a polygon is that of a rectangle
                    inputs.push_back(anyPair(type));
        for (const gpu::WalkProbeOutput& o : evaluate(inputs, instances == 30 ? 32 : 64)) {
            different += o.walked != o.tested;
            hidden += o.walked != o.members;
            partial += o.walked != o.members && o.walked != glm::uvec2(0);
        }
    }
    EXPECT_EQ(different, 0u);
    const uint32_t all = uint32_t(4 * rounds * pairs) * (CND_LIGHT_TYPE_COUNT - 1);
    EXPECT_GT(hidden, all / 16); // the scenes do cast shadows
    EXPECT_GT(partial, all / 40);
}

} // namespace candelabra::test
