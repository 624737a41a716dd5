// SPDX-License-Identifier: Apache-2.0
// The pipelines that shade: one set for each light type and specular method in use.
#pragma once

#include <span>

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

// The kernels that are specialised for a light type and a specular method. Pipelines are created
// only for light types that have been present and for methods that frames may ask for.
class ShadeKernels
{
public:
    // `gbuffer`: value of SPEC_GBUFFER. `radianceFormat`: of the images that kernels add light to.
    // `methods`: mask of 1 << CndSpecularMethod. `tileClasses`:
    // what tileClassesOf returns. `measures`: CndLightingDesc::influenceByError. `device` and
    // `host` must outlive this object.
    ShadeKernels(const gpu::Device& device, const surfaces::HostKernels& host, uint32_t gbuffer,
                 VkFormat radianceFormat, uint32_t methods, uint32_t tileClasses, bool measures);
    // Creates the pipelines of the light type that are missing. Returns true if any was created.
    bool require(uint32_t lightType);

    bool allows(CndSpecularMethod method) const { return methods_ >> method & 1; }
    // The kernels for tiles of one material class.
    struct Tiles {
        gpu::Kernel<gpu::ShadeTilesParams> shade;
        gpu::Kernel<gpu::ShadeUnlistedParams> unlisted;
        gpu::Kernel<gpu::CountPairsParams> countPairs;
    };
    struct Variant {
        Tiles any, specular; // CLASS_ANY, CLASS_SPECULAR
        gpu::Kernel<gpu::ShadeBruteParams> brute;
        // Only if `measures` is set, and only in variants without an error budget.
        gpu::Kernel<gpu::MeasureInfluenceParams> measure;
    };
    const Variant& variant(uint32_t type, CndSpecularMethod method, bool withBudget) const;
    // Tells whether tiles of this class have a work list and kernels of their own.
    bool tellsApart(uint32_t tileClass) const { return tileClasses_ >> tileClass & 1; }
    // Returns the kernels for tiles of a class, for which tellsApart is true.
    const Tiles& tiles(uint32_t type, CndSpecularMethod method, bool withBudget,
                       uint32_t tileClass) const;
    // Returns some variant that exists: all have the same binding layouts.
    const Variant& anyVariant() const;

private:
    struct OfType {
        bool made = false;
        Variant variants[CND_SPECULAR_METHOD_COUNT][2]; // [1]: with an error budget
        Tiles diffuse; // CLASS_DIFFUSE: without a specular lobe, so the same for all methods
    };
    OfType make(uint32_t lightType) const;
    Variant makeVariant(uint32_t lightType, CndSpecularMethod method, bool withBudget) const;
    Tiles makeTiles(uint32_t lightType, CndSpecularMethod method, bool withBudget,
                    uint32_t tileClass) const;
    template <typename Params>
    gpu::Kernel<Params> makeKernel(std::span<const gpu::Spirv* const> families, uint32_t lightType,
                                   CndSpecularMethod method, bool withBudget,
                                   uint32_t tileClass) const;

    const gpu::Device* device_;
    const surfaces::HostKernels* host_;
    uint32_t gbuffer_;
    VkFormat radianceFormat_;
    uint32_t methods_, tileClasses_;
    bool measures_;
    OfType types_[CND_LIGHT_TYPE_COUNT];
};

} // namespace candelabra::lighting
