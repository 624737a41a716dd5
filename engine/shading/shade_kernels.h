// SPDX-License-Identifier: Apache-2.0
// The pipelines that shade: one set for each light type and specular method in use.
#pragma once

#include <array>
#include <atomic>
#include <list>
#include <mutex>
#include <vector>

#include "candelabra/candelabra.h"
#include "gpu/kernel.h"
#include "lights/light_types.h"
#include "shared/influence_data.h"
#include "shared/lighting_data.h"
#include "shared/occluder_data.h"
#include "surfaces/host_kernels.h"

namespace candelabra::lighting
{

// Tells whether tiles without a specular lobe are shaded apart: the host asks for it
// (CndLightingDesc::diffuseOnlyTiles) and the layout of the G-buffer can store such surfaces.
bool findsDiffuseTiles(const CndLightingDesc& desc);

// Returns what a frame asks of pipelines, as a mask of CndShadingBits.
uint32_t shadingOf(const CndLightingFrame& frame);

// The kernels that are specialised for a light type and a specular method. Pipelines are made for
// the light types and frames that CndLightingDesc or add() names, and for light types that light
// sets contain. They live as long as this object, and one thread may make some while another
// records frames.
class ShadeKernels
{
public:
    // Creates the pipelines that `desc` names. `gbuffer`: value of SPEC_GBUFFER. `device` and
    // `host` must outlive this object.
    ShadeKernels(const gpu::Device& device, const surfaces::HostKernels& host, uint32_t gbuffer,
                 const CndLightingDesc& desc);
    // Creates the pipelines that are missing for these light types (a mask of 1 << CndLightType)
    // and for frames that ask for these methods (1 << CndSpecularMethod) and this shading
    // (CndShadingBits). Returns the light types for which it has created any, as such a mask. May
    // be called on several threads at the same time, and beside all other functions. After a
    // gpu::Failure neither frames nor later calls know of what this one asked for, but pipelines
    // that were created stay.
    uint32_t add(uint32_t lightTypes, uint32_t methods, uint32_t shading);

    // Tells whether frames may ask for a method, and for a method with this shading.
    bool allows(CndSpecularMethod method) const { return allowed_[method].load() != 0; }
    bool allows(CndSpecularMethod method, uint32_t shading) const
    {
        return (allowed_[method].load() & shading) == shading;
    }
    // The kernels for tiles of one tile class.
    struct Tiles {
        // One per height of tiles, such as gpu::ANY_HEIGHT. Those below tileHeightsOf() exist.
        gpu::Kernel<gpu::ShadeTilesParams> shade[gpu::TILE_HEIGHTS];
        gpu::Kernel<gpu::ShadeUnlistedParams> unlisted;
        gpu::Kernel<gpu::CountPairsParams> countPairs;
    };
    struct Variant {
        Tiles tiles[gpu::TILE_CLASSES];
        gpu::Kernel<gpu::ShadeBruteParams> brute;
        // Only with CndLightingDesc::influenceByError.
        gpu::Kernel<gpu::MeasureInfluenceParams> measure;
        // Only of CND_SPECULAR_NONE, for all methods, with CndLightingDesc::shadows. One per kind
        // of pairs, such as gpu::PAIRS_WALKED; those below pairKinds() exist.
        gpu::Kernel<gpu::PairVisibilityParams> visibility[gpu::SLOT_KINDS];
    };
    // These return kernels of a type that is present, for a frame that is allowed.
    const Variant& variant(uint32_t type, CndSpecularMethod method) const;
    // The kernel that finds the visibility of lights of a type, with CndLightingDesc::shadows.
    // `kind`: one of pairKinds().
    const gpu::Kernel<gpu::PairVisibilityParams>& visibility(uint32_t type, uint32_t kind) const
    {
        return slots_[type][CND_SPECULAR_NONE].kernels.visibility[kind];
    }
    // Returns the number of kinds of pairs of a type. Distant lights have no lists of occluders,
    // nor does any light if the host finds points.
    uint32_t pairKinds(uint32_t type) const
    {
        return isDistant(type) || host_->findsPoints() ? 1 : gpu::SLOT_KINDS;
    }
    // `tileClass`: one of tileClasses().
    const Tiles& tiles(uint32_t type, CndSpecularMethod method, uint32_t tileClass) const;
    // Returns the number of tile classes that have a work list and kernels: CLASS_ANY has them, and
    // CLASS_DIFFUSE may have them.
    uint32_t tileClasses() const { return findsDiffuse_ ? gpu::TILE_CLASSES : 1; }

private:
    // Pipelines that are made together. The value is their bit in Slot::made for CLASS_ANY; Lists
    // and Counts of another tile class have the bit shifted left by the class.
    enum Part : uint32_t {
        Lists = 1,                           // shade and unlisted, of CLASS_ANY
        Counts = Lists << gpu::TILE_CLASSES, // countPairs, of CLASS_ANY
        Brute = Counts << gpu::TILE_CLASSES,
        Measure = Brute << 1,
        Visibility = Measure << 1,
    };
    struct Job {
        uint32_t lightType;
        CndSpecularMethod method; // one of canonicalMethod
        Part part;
        uint32_t tileClass = gpu::CLASS_ANY;
        uint32_t bit() const { return uint32_t(part) << tileClass; }
    };
    struct Slot {
        // A kernel is written once, before the bit of its part is set in `made`, and is only read
        // afterwards.
        Variant kernels;
        std::atomic<uint32_t> made{0}; // mask of Job::bit
    };
    struct Request { // the arguments of add()
        uint32_t lightTypes, methods, shading;
    };
    class Running;
    void addJobs(std::vector<Job>& jobs, uint32_t lightType, CndSpecularMethod method,
                 uint32_t shading) const;
    std::vector<Job> jobsOf(const Request& request) const;
    void publish(const Request& request, const std::vector<Job>& jobs);
    bool runJob(const Job& job);
    std::array<const gpu::Spirv*, 2> kernelsOf(const Job& job) const;
    Variant make(const Job& job) const;
    template <typename Params>
    gpu::Kernel<Params> makeKernel(const gpu::Spirv& builtIn, const Job& job,
                                   uint32_t height = gpu::ANY_HEIGHT,
                                   uint32_t pairKind = gpu::PAIRS_WALKED) const;

    const gpu::Device* device_;
    const surfaces::HostKernels* host_;
    uint32_t gbuffer_;
    VkFormat radianceFormat_;
    bool findsDiffuse_;
    bool measures_;
    uint32_t shadowPoints_; // CndShadowDesc::points
    std::mutex mutex_;      // guards the list, and changes of the members after it
    std::list<Request> running_;
    // Light types that have pipelines for all that frames may ask for.
    std::atomic<uint32_t> knownTypes_{0};
    // The shading that frames may ask for, as CndShadingBits by method. All its pipelines exist.
    std::atomic<uint32_t> allowed_[CND_SPECULAR_METHOD_COUNT] = {};
    Slot slots_[CND_LIGHT_TYPE_COUNT][CND_SPECULAR_METHOD_COUNT];
};

} // namespace candelabra::lighting
