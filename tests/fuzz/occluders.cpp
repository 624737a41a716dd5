// SPDX-License-Identifier: Apache-2.0
// Fuzzes the calls about occluders and lights on the mock driver: an input is a sequence of edits
// and recordings, with raw bytes as positions, indices, transforms, ids and formats, and with
// memory that runs out. Each call must accept what the headers allow, refuse everything else with a
// sentence, and change nothing when it fails.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "fuzz/fuzz_target.h"
#include "harness/occluder_walk.h"
#include "lighting/lighting_module.h"
#include "mock/host_steps.h"
#include "mock/mock_vulkan.h"

namespace candelabra::test
{
namespace
{

// Reads values from the input; zeros after its end.
class Input
{
public:
    Input(const uint8_t* data, size_t size) : data_(data), left_(size) {}
    bool ended() const { return left_ == 0; }
    template <typename T>
    T read()
    {
        T out{};
        const size_t count = std::min(sizeof out, left_);
        std::memcpy(&out, data_, count);
        data_ += count;
        left_ -= count;
        return out;
    }
    uint32_t below(uint32_t end) { return read<uint8_t>() % end; }

private:
    const uint8_t* data_;
    size_t left_;
};

// What the headers say about a description. Unknown: too near a limit for another calculation.
enum class Allowed { No, Yes, Unknown };

Allowed both(Allowed a, Allowed b)
{
    if (a == Allowed::No || b == Allowed::No)
        return Allowed::No;
    return a == Allowed::Yes && b == Allowed::Yes ? Allowed::Yes : Allowed::Unknown;
}

Allowed allowedIf(bool condition)
{
    return condition ? Allowed::Yes : Allowed::No;
}

// Whether x >= limit.
Allowed isAtLeast(double x, double limit)
{
    return std::abs(x - limit) <= 1e-9 * limit ? Allowed::Unknown : allowedIf(x >= limit);
}

bool strideIsAllowed(uint32_t stride)
{
    return stride == 0 || (stride >= 12 && stride % 4 == 0);
}

// `positions` holds what `stride` reaches.
bool positionsAreAllowed(const std::vector<float>& positions, uint32_t stride, uint32_t count)
{
    for (size_t i = 0; i < count; ++i)
        for (size_t axis = 0; axis < 3; ++axis)
            if (!(std::abs(positions[i * (stride ? stride / 4 : 3) + axis]) <= 1e15f))
                return false;
    return true;
}

Allowed transformIsAllowed(const double (&m)[12])
{
    for (const double x : m)
        if (!std::isfinite(x))
            return Allowed::No;
    Allowed out = Allowed::Yes;
    glm::dmat3 columns;
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row)
            columns[column][row] = m[4 * row + column];
        out = both(out, allowedIf(std::abs(m[4 * column + 3]) <= 1e15));
        const double length = std::hypot(columns[column].x, columns[column].y, columns[column].z);
        out = both(out, both(isAtLeast(length, 1e-15), isAtLeast(1e15, length)));
        columns[column] /= length;
    }
    if (out == Allowed::No)
        return out;
    return both(out, isAtLeast(std::abs(glm::determinant(columns)), 1e-4));
}

// A module with shadows and a view, for all inputs: creation takes longer than an input. Each input
// leaves it empty.
struct Host {
    MockVulkan vulkan;
    CndLighting lighting = nullptr;
    CndLightingView view = nullptr;

    Host()
    {
        const CndLightingDesc desc{.structSize = sizeof desc,
                                   .framesInFlight = 1,
                                   .shading = CND_SHADING_CLUSTERED_BIT,
                                   .forwardStages = VK_SHADER_STAGE_FRAGMENT_BIT,
                                   .shadows = {.points = 32}};
        const CndDeviceDesc device = vulkan.desc();
        require(cndCreateLighting(&device, &desc, &lighting, nullptr) == CND_SUCCESS, "a module");
        const CndLightingViewDesc viewDesc{.structSize = sizeof viewDesc,
                                           .maxWidth = 64,
                                           .maxHeight = 48,
                                           .listBudget = 1 << 16,
                                           .shadowBudget = 1 << 16};
        require(cndCreateLightingView(lighting, &viewDesc, &view, nullptr) == CND_SUCCESS,
                "a view");
    }
    ~Host()
    {
        cndDestroyLightingView(view);
        cndDestroyLighting(lighting);
        require(vulkan.alive.empty(), "a leak");
    }
};

Host& host()
{
    static Host out;
    return out;
}

class Edits
{
public:
    explicit Edits(Input input) : input_(input) {}
    void run()
    {
        vulkan_.failableCalls.clear();
        while (!input_.ended())
            edit(input_.below(11));
        record();
        removeAll();
        require(vulkan_.misuse.empty(), "misuse of Vulkan");
    }

private:
    void edit(uint32_t what)
    {
        if (what == 0)
            addMesh();
        else if (what == 1)
            replacePositions();
        else if (what == 2)
            removeMeshes();
        else if (what == 3)
            addInstances();
        else if (what == 4)
            updateInstances();
        else if (what == 5)
            removeInstances();
        else if (what == 6)
            editLights();
        else if (what == 7)
            replacePositionsOnDevice();
        else if (what == 8 || input_.below(2))
            record();
        else if (!input_.below(8)) // takes longer than all the others
            createAnother();
    }
    // Runs a call, in which sometimes a function of Vulkan or the heap has no memory left. Tells
    // whether it succeeded.
    bool call(Allowed allowed, const std::function<CndResult(CndError*)>& make)
    {
        const uint32_t how = input_.below(16);
        CndError error{};
        if (how == 1)
            vulkan_.failingCall = vulkan_.failableCalls.size() + input_.below(4);
        const uint32_t allocation = how == 2 ? input_.below(32) : UINT32_MAX;
        CndResult result = CND_SUCCESS;
        {
            const HostAllocations heap(allocation);
            result = make(&error);
        }
        vulkan_.failingCall = UINT64_MAX;
        const std::string message = error.message;
        if (result == CND_SUCCESS) {
            require(allowed != Allowed::No, "what is wrong was accepted");
            return true;
        }
        require(result == error.code, "two codes");
        require(message.find(' ') != std::string::npos && message.back() != '\n', "no sentence");
        require(message.find('\n') == std::string::npos, "two lines");
        if (result == CND_ERROR_OUT_OF_MEMORY)
            require(how == 1 || how == 2, "memory ran out: " + message);
        else
            require(allowed != Allowed::Yes, "what is right was refused: " + message);
        return false;
    }
    // Mostly one of the keys, otherwise any number.
    template <typename Map>
    uint64_t id(const Map& known)
    {
        const uint32_t which = input_.below(16);
        if (which >= known.size())
            return input_.read<uint64_t>();
        return std::prev(known.end(), long(which) + 1)->first;
    }
    // One or two of them, and whether each is known and none is given twice.
    template <typename Map>
    Allowed someIds(const Map& known, std::vector<uint64_t>& out)
    {
        out.resize(1 + input_.below(2));
        bool right = true;
        for (uint64_t& i : out) {
            i = id(known);
            right = right && known.contains(i);
        }
        return allowedIf(right && std::set(out.begin(), out.end()).size() == out.size());
    }
    std::vector<float> positions(uint32_t count)
    {
        const bool raw = input_.below(4) == 0;
        std::vector<float> out(size_t(count) * 8);
        for (float& p : out)
            p = raw ? input_.read<float>() : float(input_.read<int8_t>()) / 8;
        return out;
    }
    uint32_t stride() { return input_.below(4) == 0 ? input_.below(33) : 0; }
    void addMesh()
    {
        CndOccluderMesh mesh{
            .stride = stride(), .vertexCount = input_.below(64), .triangleCount = input_.below(32)};
        const std::vector<float> points = positions(mesh.vertexCount);
        std::vector<uint32_t> indices(size_t(3) * mesh.triangleCount);
        for (uint32_t& index : indices)
            index = input_.below(64);
        if (input_.below(32))
            mesh.positions = points.data();
        if (input_.below(4))
            mesh.indices = indices.data();
        else if (input_.below(4))
            mesh.triangleCount = mesh.vertexCount / 3;
        else
            mesh.triangleCount = input_.read<uint32_t>() | 1u << 29; // too many
        bool right = mesh.positions && mesh.vertexCount && strideIsAllowed(mesh.stride) &&
                     mesh.triangleCount && mesh.triangleCount <= 1u << 28;
        if (mesh.indices)
            for (const uint32_t index : indices)
                right = right && index < mesh.vertexCount;
        else
            right = right && mesh.vertexCount == 3 * mesh.triangleCount;
        right = right && positionsAreAllowed(points, mesh.stride, mesh.vertexCount);
        uint64_t added = 0;
        if (call(allowedIf(right), [&](CndError* error) {
                return cndAddOccluderMeshes(lighting_, 1, &mesh, &added, error);
            }))
            meshes_[added] = {mesh.vertexCount, 0};
        else
            require(added == 0, "a failed call has written an id");
    }
    void replacePositions()
    {
        const uint64_t mesh = id(meshes_);
        const std::vector<float> points = positions(64);
        const uint32_t bytes = stride();
        const auto known = meshes_.find(mesh);
        call(allowedIf(known != meshes_.end() && strideIsAllowed(bytes) &&
                       positionsAreAllowed(points, bytes, known->second.vertexCount)),
             [&](CndError* error) {
                 return cndReplaceOccluderPositions(lighting_, mesh, points.data(), bytes, error);
             });
    }
    void replacePositionsOnDevice()
    {
        std::vector<uint64_t> ids;
        Allowed allowed = someIds(meshes_, ids);
        std::vector<CndDevicePositions> some(ids.size());
        for (size_t i = 0; i < ids.size(); ++i) {
            some[i] = {.mesh = ids[i],
                       .buffer = input_.below(16) ? MockVulkan::hostBuffer() : VK_NULL_HANDLE,
                       .offset = input_.below(8) ? 4 * input_.below(200) : input_.read<uint64_t>(),
                       .stride = stride()};
            allowed = both(allowed, allowedIf(some[i].buffer && some[i].offset % 4 == 0 &&
                                              strideIsAllowed(some[i].stride)));
        }
        call(allowed, [&](CndError* error) {
            return cndReplaceOccluderPositionsOnDevice(lighting_, uint32_t(some.size()),
                                                       some.data(), error);
        });
    }
    void removeMeshes()
    {
        std::vector<uint64_t> ids;
        Allowed allowed = someIds(meshes_, ids);
        for (const uint64_t i : ids)
            allowed = both(allowed, allowedIf(!meshes_.contains(i) || !meshes_[i].users));
        if (call(allowed, [&](CndError* error) {
                return cndRemoveOccluderMeshes(lighting_, uint32_t(ids.size()), ids.data(), error);
            }))
            for (const uint64_t i : ids)
                meshes_.erase(i);
    }
    CndOccluderInstance instance()
    {
        CndOccluderInstance out{.mesh = id(meshes_)};
        const bool raw = input_.below(4) == 0;
        for (double& m : out.worldFromMesh)
            m = raw ? input_.read<double>() : double(input_.read<int8_t>()) / 16;
        for (int axis = 0; axis < 3; ++axis)
            out.worldFromMesh[5 * axis] += raw ? 0 : input_.below(4) * 7;
        out.surfaceError = raw ? input_.read<float>() : 0;
        out.occluderLayer = input_.below(7);
        out.layers = raw ? input_.read<uint32_t>() : input_.read<uint16_t>();
        return out;
    }
    Allowed isAllowed(const CndOccluderInstance& i) const
    {
        return both(transformIsAllowed(i.worldFromMesh),
                    allowedIf(meshes_.contains(i.mesh) && std::isfinite(i.surfaceError) &&
                              i.surfaceError >= 0 && i.occluderLayer < CND_OCCLUDER_LAYER_COUNT &&
                              i.layers < 1u << CND_LAYER_COUNT));
    }
    void addInstances()
    {
        std::vector<CndOccluderInstance> some(input_.below(4));
        Allowed allowed = Allowed::Yes;
        for (CndOccluderInstance& i : some) {
            i = instance();
            allowed = both(allowed, isAllowed(i));
        }
        uint64_t ids[3] = {};
        if (call(allowed, [&](CndError* error) {
                return cndAddOccluders(lighting_, uint32_t(some.size()), some.data(), ids, error);
            }))
            for (size_t i = 0; i < some.size(); ++i) {
                instances_[ids[i]] = some[i].mesh;
                ++meshes_[some[i].mesh].users;
            }
        else
            require(!ids[0] && !ids[1] && !ids[2], "a failed call has written an id");
    }
    void updateInstances()
    {
        std::vector<uint64_t> ids;
        Allowed allowed = someIds(instances_, ids);
        std::vector<CndOccluderInstance> with(ids.size());
        for (CndOccluderInstance& i : with) {
            i = instance();
            allowed = both(allowed, isAllowed(i));
        }
        if (!call(allowed, [&](CndError* error) {
                return cndUpdateOccluders(lighting_, uint32_t(ids.size()), ids.data(), with.data(),
                                          error);
            }))
            return;
        for (size_t i = 0; i < ids.size(); ++i) {
            --meshes_[instances_[ids[i]]].users;
            instances_[ids[i]] = with[i].mesh;
            ++meshes_[with[i].mesh].users;
        }
    }
    void removeInstances()
    {
        std::vector<uint64_t> ids;
        const Allowed allowed = someIds(instances_, ids);
        if (call(allowed, [&](CndError* error) {
                return cndRemoveOccluders(lighting_, uint32_t(ids.size()), ids.data(), error);
            }))
            forget(ids);
    }
    void forget(const std::vector<uint64_t>& ids)
    {
        for (const uint64_t i : ids) {
            --meshes_[instances_[i]].users;
            instances_.erase(i);
        }
    }
    CndLight light()
    {
        CndLight out{
            .type = input_.below(CND_LIGHT_TYPE_COUNT + 1), .radius = 0.1f, .influenceRadius = 5};
        out.direction[input_.below(3)] = 1;
        out.axisU[0] = out.axisV[1] = 0.5f;
        for (float& p : out.position)
            p = input_.below(8) ? float(input_.read<int8_t>()) : input_.read<float>();
        if (input_.below(4) == 0)
            out.radius = input_.read<float>();
        out.unshadowed = input_.below(4) == 0;
        out.unshadowedBy = input_.below(4) ? input_.below(64) : input_.read<uint32_t>();
        return out;
    }
    // Other tests know which lights are valid. Here a call that adds or changes them may fail.
    void editLights()
    {
        std::vector<uint64_t> ids;
        const uint32_t what = input_.below(3);
        const Allowed known = someIds(lights_, ids);
        const CndLight with[] = {light(), light()};
        const uint32_t count = uint32_t(ids.size());
        if (what == 0) {
            uint64_t added[2] = {};
            if (call(Allowed::Unknown, [&](CndError* error) {
                    return cndAddLights(lighting_, count, with, added, error);
                }))
                for (uint32_t i = 0; i < count; ++i)
                    lights_[added[i]] = true;
        } else if (what == 1) {
            call(both(known, Allowed::Unknown), [&](CndError* error) {
                return cndUpdateLights(lighting_, count, ids.data(), with, error);
            });
        } else if (call(known, [&](CndError* error) {
                       return cndRemoveLights(lighting_, count, ids.data(), error);
                   })) {
            for (const uint64_t i : ids)
                lights_.erase(i);
        }
    }
    // Another module, whose shadows are mostly refused.
    void createAnother()
    {
        constexpr std::pair<VkFormat, bool> formats[] = {
            {VK_FORMAT_UNDEFINED, true},          {VK_FORMAT_D16_UNORM, false},
            {VK_FORMAT_D16_UNORM_S8_UINT, false}, {VK_FORMAT_X8_D24_UNORM_PACK32, true},
            {VK_FORMAT_D24_UNORM_S8_UINT, true},  {VK_FORMAT_D32_SFLOAT, true}};
        const auto [format, precise] = formats[input_.below(uint32_t(std::size(formats)))];
        const uint32_t points = input_.below(3) * 32 + (input_.below(4) ? 0 : input_.below(99));
        const CndLightingDesc desc{
            .structSize = sizeof desc,
            .framesInFlight = 1,
            .shading = CND_SHADING_CLUSTERED_BIT,
            .gbuffer = {.depthFormat = format},
            .shadows = {points, input_.read<uint16_t>(), input_.read<uint16_t>()}};
        const bool right = points == 0 || ((points == 32 || points == 64) && precise);
        const CndDeviceDesc device = vulkan_.desc();
        const size_t alive = vulkan_.alive.size();
        CndLighting made = nullptr;
        if (call(allowedIf(right),
                 [&](CndError* error) { return cndCreateLighting(&device, &desc, &made, error); }))
            cndDestroyLighting(made);
        require(vulkan_.alive.size() == alive, "a leak");
    }
    void record()
    {
        auto frame = surfacesOf<CndLightingFrame>();
        frame.shadowsOff = input_.below(8) == 0;
        frame.layers = input_.read<uint16_t>();
        require(call(Allowed::Yes,
                     [&](CndError* error) {
                         return cndRecordLighting(view_, MockVulkan::commandBuffer(), &frame,
                                                  error);
                     }),
                "a recording has no memory");
        vulkan_.finish(vulkan_.submit());
        const lighting::OccluderSet& set = lighting_->impl.occluders("");
        require(set.instances().count() == instances_.size(), "the number of occluders");
        const Segment segment{glm::dvec3(-30, 1, 2), glm::dvec3(30, 2, 1)};
        for (const gpu::OccluderNode& node : set.instances().nodes())
            require(std::isfinite(lighting::halfSurface(lighting::boxOf(node))), "a box");
        walkTree(set.instances().nodes(), segment, [&](uint32_t place) {
            const gpu::OccluderRecord& r = set.instances().records()[place];
            if (r.flags)
                walkTree(set.meshes().allNodes().subspan(r.firstNode), segment, [](uint32_t) {});
        });
    }
    // Fails if the module lacks something, or has more.
    void removeAll()
    {
        const auto keys = [](const auto& map) {
            std::vector<uint64_t> out;
            for (const auto& [key, value] : map)
                out.push_back(key);
            return out;
        };
        const std::vector<uint64_t> instances = keys(instances_), meshes = keys(meshes_);
        const std::vector<uint64_t> lights = keys(lights_);
        require(cndRemoveOccluders(lighting_, uint32_t(instances.size()), instances.data(),
                                   nullptr) == CND_SUCCESS,
                "an occluder is lost");
        require(cndRemoveOccluderMeshes(lighting_, uint32_t(meshes.size()), meshes.data(),
                                        nullptr) == CND_SUCCESS,
                "a mesh is lost");
        require(cndRemoveLights(lighting_, uint32_t(lights.size()), lights.data(), nullptr) ==
                    CND_SUCCESS,
                "a light is lost");
    }

    struct Mesh {
        uint32_t vertexCount = 0, users = 0;
    };
    Input input_;
    MockVulkan& vulkan_ = host().vulkan;
    const CndLighting lighting_ = host().lighting;
    const CndLightingView view_ = host().view;
    std::map<uint64_t, Mesh> meshes_;
    std::map<uint64_t, uint64_t> instances_; // the mesh of each
    std::map<uint64_t, bool> lights_;
};

} // namespace

Seeds fuzzSeeds()
{
    Seeds seeds(3);
    uint32_t state = 1;
    for (std::string& seed : seeds)
        for (int i = 0; i < 2000; ++i) {
            state = state * 1664525 + 1013904223;
            seed.push_back(char(state >> 24));
        }
    return seeds;
}

} // namespace candelabra::test

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    candelabra::test::Edits(candelabra::test::Input(data, size)).run();
    return 0;
}
