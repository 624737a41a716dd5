// SPDX-License-Identifier: Apache-2.0
// The pipelines that shade: one set for each light type and specular method in use.
#pragma once

#include <atomic>
#include <mutex>
#include <span>
#include <vector>

#include "candelabra/candelabra.h"
#include "gpu/kernel.h"
#include "shared/influence.h"
#include "shared/lighting.h"
#include "surfaces/host_kernels.h"

namespace candelabra::lighting
{

// Returns the material classes that tiles are divided into, as a mask of 1 << CLASS_*. CLASS_ANY is
// always one of them. The others are those that the host asks for
// (CndLightingDesc::materialClasses) and the layout of the G-buffer can store.
uint32_t tileClassesOf(const CndLightingDesc& desc);

// Returns what a frame asks of pipelines, as a mask of CndShadingBits.
uint32_t shadingOf(const CndLightingFrame& frame);

// The kernels that are specialised for a light type and a specular method. Pipelines are created
// only for light types that have been present and for what frames may ask for. They are never
// destroyed before this object, and a thread may create some while another one records frames.
class ShadeKernels
{
public:
    // Creates the pipelines that `desc` names. `gbuffer`: value of SPEC_GBUFFER. `device` and
    // `host` must outlive this object.
    ShadeKernels(const gpu::Device& device, const surfaces::HostKernels& host, uint32_t gbuffer,
                 const CndLightingDesc& desc);
    // These two may be called on several threads at the same time, and beside all other functions.
    // What is missing after a gpu::Failure is created by the next call that needs it.
    //
    // Creates the pipelines of a light type that are missing. Returns true if any was created.
    bool require(uint32_t lightType) { return add(1u << lightType, 0, 0); }
    // Creates the pipelines that are missing for these light types (a mask of 1 << CndLightType)
    // and for frames that ask for these methods (1 << CndSpecularMethod) and this shading
    // (CndShadingBits). Returns true if any was created.
    bool add(uint32_t lightTypes, uint32_t methods, uint32_t shading);

    // Tells whether frames may ask for a method, and for a method with this shading.
    bool allows(CndSpecularMethod method) const { return allowed_[method].load() != 0; }
    bool allows(CndSpecularMethod method, uint32_t shading) const
    {
        return (allowed_[method].load() & shading) == shading;
    }
    // The kernels for tiles of one material class.
    struct Tiles {
        gpu::Kernel<gpu::ShadeTilesParams> shade;
        gpu::Kernel<gpu::ShadeUnlistedParams> unlisted;
        gpu::Kernel<gpu::CountPairsParams> countPairs;
    };
    struct Variant {
        Tiles tiles[gpu::TILE_CLASSES];
        gpu::Kernel<gpu::ShadeBruteParams> brute;
        // Only with CndLightingDesc::influenceByError, and only in variants without a budget.
        gpu::Kernel<gpu::MeasureInfluenceParams> measure;
    };
    // These return kernels of a type that is present, for a frame that is allowed.
    const Variant& variant(uint32_t type, CndSpecularMethod method, bool withBudget) const;
    // `tileClass`: one for which tellsApart is true.
    const Tiles& tiles(uint32_t type, CndSpecularMethod method, bool withBudget,
                       uint32_t tileClass) const;
    // Tells whether tiles of this class have a work list and kernels of their own.
    bool tellsApart(uint32_t tileClass) const { return tileClasses_ >> tileClass & 1; }

private:
    // Pipelines that are created together, and the bits that say that they are there.
    enum Part : uint32_t {
        Lists = 1,                           // shade and unlisted, of CLASS_ANY
        Counts = Lists << gpu::TILE_CLASSES, // countPairs, of CLASS_ANY
        Brute = Counts << gpu::TILE_CLASSES, // Lists and Counts of other classes: << the class
        Measure = Brute << 1,
    };
    struct Job {
        uint32_t lightType;
        CndSpecularMethod method; // one of canonicalMethod
        bool withBudget;
        Part part;
        uint32_t tileClass = gpu::CLASS_ANY;
        uint32_t bit() const { return uint32_t(part) << tileClass; }
    };
    struct Slot {
        Variant kernels;               // does not change where `made` says that it is there
        std::atomic<uint32_t> made{0}; // mask of Part
    };
    void addJobs(std::vector<Job>& jobs, uint32_t lightType, CndSpecularMethod method,
                 uint32_t shading) const;
    std::vector<Job> jobsOf(uint32_t lightTypes, uint32_t methods, uint32_t shading);
    bool run(const Job& job);
    Variant make(const Job& job) const;
    template <typename Params>
    gpu::Kernel<Params> makeKernel(std::span<const gpu::Spirv* const> families,
                                   const Job& job) const;

    const gpu::Device* device_;
    const surfaces::HostKernels* host_;
    uint32_t gbuffer_;
    VkFormat radianceFormat_;
    uint32_t tileClasses_;
    bool measures_;
    std::mutex mutex_; // guards the next two, and changes of slots
    uint32_t wantedTypes_ = 0;
    uint32_t wanted_[CND_SPECULAR_METHOD_COUNT] = {}; // CndShadingBits by method
    // The same, with all pipelines created.
    std::atomic<uint32_t> allowed_[CND_SPECULAR_METHOD_COUNT] = {};
    Slot slots_[CND_LIGHT_TYPE_COUNT][CND_SPECULAR_METHOD_COUNT][2]; // [1]: with an error budget
};

} // namespace candelabra::lighting
