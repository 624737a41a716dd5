// SPDX-License-Identifier: Apache-2.0
// The walk through the trees of occluders (shaders/shading/occluder_walk.glsl) must find the points
// that a test of every triangle finds, bit for bit. Meshes must not shadow the surface that they
// are themselves.
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <iostream>
#include <memory>
#include <random>

#include <fmt/format.h>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "candelabra_probes.h"
#include "formula/visibility.h"
#include "generate/generators.h"
#include "generate/shapes.h"
#include "gpu/probe.h"
#include "harness/full_tests.h"
#include "harness/occluder_host.h"
#include "occluders/prepared_occluders.h"
#include "reference/occluders.h"
#include "shading/light_batches.h"
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
    gpu::WalkProbeInput pair(uint32_t type, const glm::dvec3& receiver, const glm::dvec3& lamp,
                             double size);
    std::vector<gpu::WalkProbeOutput> evaluate(const std::vector<gpu::WalkProbeInput>& inputs,
                                               uint32_t points, bool tests = true);

    // The camera looks along some direction at the scene, which is far from the world's origin.
    glm::dvec3 centre_{4000, -300, 20};
    glm::dmat4 view_ = glm::lookAt(centre_ + glm::dvec3(9, 4, 2), centre_, {0.1, 1, 0});
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

// A receiver and a light of up to 3 m within 8 m of the centre.
gpu::WalkProbeInput VisibilityWalk::anyPair(uint32_t type)
{
    const glm::dvec3 receiver = centre_ + pointWithin(8), lamp = centre_ + pointWithin(8);
    return pair(type, receiver, lamp, std::exp2(uniform(-7, 1.5)));
}

// A receiver and a light of this size, at places in the world. A quarter of the flat lights is seen
// from the edge.
gpu::WalkProbeInput VisibilityWalk::pair(uint32_t type, const glm::dvec3& receiver,
                                         const glm::dvec3& lamp, double size)
{
    const glm::dvec3 position = glm::dvec3(view_ * glm::dvec4(receiver, 1));
    const glm::dvec3 light = glm::dvec3(view_ * glm::dvec4(lamp, 1));
    const bool distant = (gpu::TYPES_WITH_POSITION >> type & 1u) == 0;
    glm::dvec3 normal = anyDirection();
    if (random_() % 4 == 0) {
        const glm::dvec3 a = glm::normalize(light - position);
        const double sine = random_() % 8 ? std::exp2(uniform(-17, -4)) : 0;
        normal -= (glm::dot(normal, a) - (random_() % 2 ? sine : -sine)) * a;
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

// Nodes of the tree over instances whose triangles one dispatch tests.
struct NodeRange {
    uint32_t first = 0, end = 0;
};

// Divides the tree into ranges of at most some thousand triangles: a test of more would take more
// turns of loops than llvmpipe makes (DECISIONS 12).
std::vector<NodeRange> testedAtOnce(const lighting::OccluderSet& set)
{
    constexpr uint32_t mostTriangles = 2000;
    const auto nodes = set.instances().nodes();
    const auto trianglesIn = [&](uint32_t node) {
        uint32_t count = 0;
        for (uint32_t i = lighting::leafFirst(nodes[node]); i < lighting::leafEnd(nodes[node]);
             ++i) {
            const auto mesh =
                set.meshes().allNodes().subspan(set.instances().records()[i].firstNode);
            for (uint32_t k = 0; k < mesh[0].skip; ++k)
                count += lighting::leafEnd(mesh[k]) - lighting::leafFirst(mesh[k]);
        }
        return count;
    };
    std::vector<NodeRange> out{{}};
    uint32_t triangles = 0;
    for (uint32_t node = 0; node < nodes[0].skip; ++node) {
        const uint32_t more = nodes[node].leaf ? trianglesIn(node) : 0;
        if (triangles + more > mostTriangles && triangles > 0) {
            out.push_back({node, node});
            triangles = 0;
        }
        triangles += more;
        out.back().end = node + 1;
    }
    return out;
}

// `tests`: false: only the walk is made.
std::vector<gpu::WalkProbeOutput>
VisibilityWalk::evaluate(const std::vector<gpu::WalkProbeInput>& inputs, uint32_t points,
                         bool tests)
{
    const uint32_t count = uint32_t(inputs.size());
    const gpu::Buffer in = upload("pairs", inputs);
    const gpu::Buffer table = upload("points", tables::pointTable(points));
    const gpu::Buffer out = readback("points", count * sizeof(gpu::WalkProbeOutput));
    const gpu::Kernel<gpu::WalkProbeParams> kernel(
        device(), spirv::occluder_walk_comp,
        {{gpu::SPEC_VISIBILITY_POINTS, points},
         {gpu::SPEC_WALK_TURNS, lighting::walkTurns(device())}});
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
    gpu::WalkProbeParams params{.viewFromTree = glm::mat3(rotation),
                                .viewInTree = glm::vec3(camera - instances.origin()),
                                .count = count,
                                .layers = 1,
                                .ignored = ignored_ << gpu::OCCLUDER_LAYERS_SHIFT,
                                .firstNode = host_->set.meshes().firstInstanceNode(),
                                .walks = 1};
    gpu::Timer timer(device(), "walk", 1, false);
    const auto dispatch = [&] {
        context().submitAndWait([&](VkCommandBuffer cmd) {
            timer.begin(cmd, 0);
            kernel.dispatch(gpu::Frame{device(), cmd, timer, 0}, bindings.set(0), params,
                            gpu::divideUp(count, gpu::PROBE_GROUP));
            fullBarrier(cmd);
        });
        return out.as<gpu::WalkProbeOutput>();
    };
    const auto walked = dispatch();
    std::vector<gpu::WalkProbeOutput> joined(walked.begin(), walked.begin() + long(count));
    params.walks = 0;
    for (uint32_t i = 0; i < count; ++i)
        joined[i].tested = joined[i].members;
    for (const NodeRange& range : tests ? testedAtOnce(host_->set) : std::vector<NodeRange>()) {
        params.firstTested = range.first;
        params.endTested = range.end;
        const auto tested = dispatch();
        for (uint32_t i = 0; i < count; ++i)
            joined[i].tested &= tested[i].tested;
    }
    return joined;
}

// Scenes that the program generates, as occluders.
class VisibilityScenes : public VisibilityWalk
{
protected:
    void give(const app::Scene& scene, bool halved);
    void expectEqualMasks(const char* name);
};

// Gives the meshes to a new set of occluders. halved: each one as two meshes with every other
// triangle, so that all trees are others.
void VisibilityScenes::give(const app::Scene& scene, bool halved)
{
    host_ = std::make_unique<OccluderHost>(device());
    const uint32_t parts = halved ? 2 : 1;
    std::vector<std::vector<OccluderMeshId>> meshes;
    for (const app::Mesh& mesh : scene.meshes) {
        meshes.emplace_back();
        for (uint32_t part = 0; part < parts; ++part) {
            std::vector<uint32_t> indices;
            for (size_t i = 0; i < mesh.indices.size(); ++i)
                if (i / 3 % parts == part)
                    indices.push_back(mesh.indices[i]);
            const OccluderMesh given{.positions = &mesh.vertices[0].position.x,
                                     .stride = sizeof(app::Vertex),
                                     .vertexCount = uint32_t(mesh.vertices.size()),
                                     .indices = indices.data(),
                                     .triangleCount = uint32_t(indices.size() / 3)};
            if (!indices.empty())
                host_->set.addMeshes({&given, 1}, &meshes.back().emplace_back());
        }
    }
    for (const app::Instance& instance : scene.instances)
        for (const OccluderMeshId mesh : meshes[instance.mesh]) {
            OccluderInstance given{.mesh = mesh, .layers = 1};
            for (int row = 0; row < 3; ++row)
                for (int column = 0; column < 4; ++column)
                    given.worldFromMesh[4 * row + column] = instance.worldFromObject[column][row];
            OccluderId id = 0;
            host_->set.add({&given, 1}, &id);
        }
}

// Compares what two different trees find and what tests of every triangle find. Lights, of every
// type, are where the scene has one, and receivers between them and vertices nearby.
void VisibilityScenes::expectEqualMasks(const char* name)
{
    const app::Scene scene = app::generateScene(name, {.lights = 500});
    const auto anyVertex = [&] {
        const app::Instance& instance = scene.instances[random_() % scene.instances.size()];
        const auto& vertices = scene.meshes[instance.mesh].vertices;
        const glm::dvec4 at(vertices[random_() % vertices.size()].position, 1);
        return glm::dvec3(instance.worldFromObject * at);
    };
    view_ = glm::lookAt(scene.cameras[0].position,
                        scene.cameras[0].position + scene.cameras[0].forward, {0, 1, 0});
    const uint32_t count = fullTests() ? 2400 : 256;
    std::vector<gpu::WalkProbeInput> inputs;
    while (inputs.size() < count) {
        const CndLight& light = scene.lights[random_() % scene.lights.size()];
        const glm::dvec3 lamp = scene.lightOrigin + glm::dvec3(glm::make_vec3(light.position));
        const glm::dvec3 surface = anyVertex() + pointWithin(0.05);
        const glm::dvec3 receiver = glm::mix(surface, lamp, uniform(0, 0.6));
        // The facet of a polygon is that of a rectangle.
        uint32_t type = uint32_t(inputs.size() / 8) % CND_LIGHT_TYPE_COUNT;
        if (type == CND_LIGHT_POLYGON)
            type = CND_LIGHT_RECTANGLE;
        if (glm::distance(surface, lamp) >= 5)
            continue;
        // Eight receivers that walk together are close to each other, as pixels of a tile are.
        // llvmpipe would end many walks of distant receivers too early (DECISIONS 12).
        const double size = std::exp2(uniform(-5, 0));
        for (int i = 0; i < 8; ++i)
            inputs.push_back(pair(type, receiver + pointWithin(0.02), lamp, size));
    }
    give(scene, true);
    const auto halved = evaluate(inputs, 64, false);
    give(scene, false);
    const auto whole = evaluate(inputs, 64);
    uint32_t finished = 0, partial = 0, dark = 0;
    for (uint32_t i = 0; i < count; ++i) {
        if (!whole[i].finished || !halved[i].finished)
            continue;
        ++finished;
        dark += whole[i].walked == glm::uvec2(0);
        partial += whole[i].walked != whole[i].members && whole[i].walked != glm::uvec2(0);
        EXPECT_EQ(whole[i].walked, whole[i].tested) << name << ", pair " << i;
        EXPECT_EQ(whole[i].walked, halved[i].walked) << name << ", pair " << i;
    }
    std::cout << fmt::format("{}: {} of {} walks finished, {} partial, {} dark\n", name, finished,
                             count, partial, dark);
    EXPECT_GE(finished, count - count / 20);
    EXPECT_GE(partial, count / 20);
    EXPECT_GE(dark, count / 20);
}

} // namespace

// In scenes of one instance up to some hundred triangles: every type, 64 and 32 points, layers that
// do not count.
TEST_F(VisibilityWalk, FindsThePointsThatATestOfEveryTriangleFinds)
{
    const int rounds = fullTests() ? 16 : 1, pairs = fullTests() ? 2000 : 160;
    uint32_t hidden = 0, partial = 0, different = 0;
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

TEST_F(VisibilityScenes, TreesAndTestsAgreeInRooms)
{
    expectEqualMasks("rooms");
}

TEST_F(VisibilityScenes, TreesAndTestsAgreeInTheHall)
{
    expectEqualMasks("hall");
}

namespace
{

// Receivers on a mesh and lights beyond it, as frames see them: positions come from depths.
class VisibilityOwnMesh : public VisibilityWalk
{
protected:
    struct Pair {
        gpu::WalkProbeInput input;
        uint64_t truth; // the points that the reference sees from the exact position
    };
    void placeBall(uint32_t segments, bool bowl);
    std::vector<Pair> somePairs(uint32_t count, bool inside, double lowest, double stepOfDepth);

    std::vector<reference::Triangle> triangles_; // in the world
    glm::dvec3 middle_{0};
};

// Places a ball, stretched and in half of the cases mirrored, or only its lower half.
void VisibilityOwnMesh::placeBall(uint32_t segments, bool bowl)
{
    app::Mesh mesh = app::makeSphere(segments, segments / 2);
    if (bowl) {
        std::vector<uint32_t> lower;
        for (size_t i = 0; i < mesh.indices.size(); i += 3)
            if (mesh.vertices[mesh.indices[i]].position.y +
                    mesh.vertices[mesh.indices[i + 1]].position.y +
                    mesh.vertices[mesh.indices[i + 2]].position.y <
                0)
                lower.insert(lower.end(),
                             {mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]});
        mesh.indices = lower;
    }
    glm::dmat4 world = glm::translate(glm::dmat4(1), centre_ + pointWithin(4));
    world = glm::rotate(world, uniform(0, 6), anyDirection());
    world = glm::scale(world, {uniform(0.5, 2), uniform(0.5, 2),
                               random_() % 2 ? uniform(0.5, 2) : -uniform(0.5, 2)});
    const OccluderMesh given{.positions = &mesh.vertices[0].position.x,
                             .stride = sizeof(app::Vertex),
                             .vertexCount = uint32_t(mesh.vertices.size()),
                             .indices = mesh.indices.data(),
                             .triangleCount = uint32_t(mesh.indices.size() / 3)};
    OccluderMeshId id = 0;
    host_ = std::make_unique<OccluderHost>(device());
    host_->set.addMeshes({&given, 1}, &id);
    OccluderInstance instance{.mesh = id, .layers = 1};
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            instance.worldFromMesh[4 * row + column] = world[column][row];
    OccluderId occluder = 0;
    host_->set.add({&instance, 1}, &occluder);
    middle_ = glm::dvec3(world[3]);
    triangles_.clear();
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        reference::Triangle triangle{};
        for (size_t k = 0; k < 3; ++k)
            triangle.corners[k] =
                glm::dvec3(world * glm::dvec4(mesh.vertices[mesh.indices[i + k]].position, 1));
        const auto& [a, b, c] = triangle.corners;
        if (glm::length(glm::cross(b - a, c - a)) > 1e-12) // poles have triangles without area
            triangles_.push_back(triangle);
    }
}

// The lights are spheres above the plane of the receiver's triangle, by this sine at least.
// `inside`: on that side of it which faces the middle of the ball. stepOfDepth: at 1 m; it grows
// with the square of the distance for depths that are integers, and with the distance for floats.
std::vector<VisibilityOwnMesh::Pair> VisibilityOwnMesh::somePairs(uint32_t count, bool inside,
                                                                  double lowest, double stepOfDepth)
{
    const reference::Occluders occluders({}, triangles_);
    const auto table = tables::pointTable(64);
    std::vector<Pair> out;
    while (out.size() < count) {
        const auto& [a, b, c] = triangles_[random_() % triangles_.size()].corners;
        const double u = uniform(0, 1), v = uniform(0, 1 - u);
        const glm::dvec3 at = a + u * (b - a) + v * (c - a);
        glm::dvec3 n = glm::normalize(glm::cross(b - a, c - a));
        n *= (glm::dot(n, middle_ - at) > 0) == inside ? 1 : -1;
        const double radius = std::exp2(uniform(-6, -1));
        const glm::dvec3 toLight = uniform(0.7, 8) * anyDirection();
        if (glm::dot(n, toLight) <= radius + lowest * glm::length(toLight))
            continue;
        const glm::dvec3 position = glm::dvec3(view_ * glm::dvec4(at, 1));
        const double distance = glm::length(position);
        const double step = stepOfDepth * (stepOfDepth < 1e-6 ? distance : distance * distance);
        const glm::dvec3 drawn = position * (1 + uniform(-0.5, 0.5) * step / distance);
        Pair p{};
        p.input.position = glm::vec3(drawn);
        p.input.type = CND_LIGHT_SPHERE;
        p.input.toLight = glm::vec3(glm::dmat3(view_) * toLight + position - drawn);
        p.input.boundingRadius = float(radius);
        p.input.shape.radius = float(radius);
        p.input.depthError = float(step / 2);
        const auto facet = formula::lightFacet(
            64, {}, {.type = CND_LIGHT_SPHERE, .centre = toLight, .boundingRadius = radius});
        for (uint32_t i = 0; i < 64; ++i) {
            const double x = std::bit_cast<float>(table[i].x), y = std::bit_cast<float>(table[i].y);
            const double g = std::sqrt(1 - x * x - y * y);
            const reference::LightRay ray{.origin = at,
                                          .direction =
                                              (facet.centre + x * facet.halfU + y * facet.halfV) /
                                              facet.inverseDistance,
                                          .end = 1 / (1 + 0x1p-12 + facet.kappa * g)};
            p.truth |= uint64_t(occluders.stop(ray) ? 0 : 1) << i;
        }
        out.push_back(p);
    }
    return out;
}

constexpr double depthSteps[] = {0x1p-23,         // 32-bit floats
                                 0x1p-24 / 0.05}; // 24 bits, nearest depth 0.05 m

} // namespace

// A ball shadows none of its points that face a light, however coarse it is. With lower lights, one
// receiver of a thousand, beside an edge, is shadowed by the triangle beyond if depths have 24
// bits.
TEST_F(VisibilityOwnMesh, ConvexMeshesDoNotShadowThemselves)
{
    for (const uint32_t segments : {6u, 16u, 64u})
        for (const double step : depthSteps) {
            placeBall(segments, false);
            std::vector<gpu::WalkProbeInput> inputs;
            for (const Pair& pair : somePairs(fullTests() ? 10000 : 1000, false, 0.1, step)) {
                EXPECT_EQ(pair.truth, ~uint64_t{0});
                inputs.push_back(pair.input);
            }
            uint32_t shadowed = 0;
            for (const gpu::WalkProbeOutput& o : evaluate(inputs, 64, false))
                shadowed += o.walked != o.members;
            EXPECT_EQ(shadowed, 0u) << segments << " segments, step " << step;
        }
}

// A bowl shadows its inside as rays to the points of its lights say.
TEST_F(VisibilityOwnMesh, BowlsAreShadowedByTheirRims)
{
    for (const uint32_t segments : {6u, 16u, 64u})
        for (const double step : depthSteps) {
            placeBall(segments, true);
            const uint32_t count = fullTests() ? 10000 : 1000;
            const std::vector<Pair> pairs = somePairs(count, true, 0, step);
            std::vector<gpu::WalkProbeInput> inputs;
            for (const Pair& pair : pairs)
                inputs.push_back(pair.input);
            uint32_t different = 0, wrong = 0, hidden = 0, lit = 0;
            const auto found = evaluate(inputs, 64, false);
            for (uint32_t i = 0; i < count; ++i) {
                const uint64_t seen = uint64_t(found[i].walked.y) << 32u | found[i].walked.x;
                const uint64_t truth = pairs[i].truth;
                different += std::popcount(seen ^ truth) > 4;
                wrong += ~truth == 0 && seen == 0;
                hidden += truth == 0;
                lit += ~truth == 0;
            }
            std::cout << fmt::format(
                "bowl of {} segments, step {:.1e}: {} of {} pairs differ by "
                "more than 4 points, {} are dark by mistake; {} hidden, {} lit\n",
                segments, step, different, count, wrong, hidden, lit);
            EXPECT_LE(different, count / 100) << segments << " segments, step " << step;
            EXPECT_EQ(wrong, 0u) << segments << " segments, step " << step;
            EXPECT_GE(hidden, count / 20);
            EXPECT_GE(lit, count / 20);
        }
}

} // namespace candelabra::test
