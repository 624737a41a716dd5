// SPDX-License-Identifier: Apache-2.0
// The pipelines that shade: one set per light type and specular method that are in use.
#pragma once

#include <span>

#include "candelabra/candelabra.h"
#include "gpu/kernel.h"
#include "shared/influence.h"
#include "shared/lighting.h"
#include "surfaces/host_kernels.h"

namespace candelabra::lighting
{

// Mask of 1 << CLASS_*: the classes of tiles that are told apart, CLASS_ANY among them. Only those
// that the layout of the G-buffer can store.
uint32_t tileClassesOf(const CndLightingDesc& desc);

// Kernels that know light types and specular methods, one pipeline for each pair that lights and
// frames may ask for: what is absent costs nothing.
class ShadeKernels
{
public:
    // `methods`: mask of 1 << CndSpecularMethod.
    // `gbuffer`: value of SPEC_GBUFFER. `tileClasses`: as of tileClassesOf. `host` must outlive it.
    // `measures`: CndLightingDesc::influenceByError.
    ShadeKernels(const gpu::Device& device, const surfaces::HostKernels& host, uint32_t gbuffer,
                 uint32_t methods, uint32_t tileClasses, bool measures);
    // Makes the pipelines of a light type unless they exist; whether it did.
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
        gpu::Kernel<gpu::MeasureInfluenceParams> measure; // where it is asked for, without a budget
    };
    const Variant& variant(uint32_t type, CndSpecularMethod method, bool withBudget) const;
    bool tellsApart(uint32_t tileClass) const { return tileClasses_ >> tileClass & 1; }
    // For a class that is told apart.
    const Tiles& tiles(uint32_t type, CndSpecularMethod method, bool withBudget,
                       uint32_t tileClass) const;
    // One of them: binding layouts are the same for all.
    const Variant& anyVariant() const;

private:
    struct OfType {
        bool made = false;
        Variant variants[CND_SPECULAR_METHOD_COUNT][2]; // [1]: with an error budget
        Tiles diffuse;                                  // CLASS_DIFFUSE: one for all methods
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
    uint32_t methods_, tileClasses_;
    bool measures_;
    OfType types_[CND_LIGHT_TYPE_COUNT];
};

} // namespace candelabra::lighting
