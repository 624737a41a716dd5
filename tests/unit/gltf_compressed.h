// SPDX-License-Identifier: Apache-2.0
// Small glTF files whose data is compressed, made with the encoders of the libraries that the
// loader decompresses with.
#pragma once

#include "unit/gltf_builder.h"

namespace candelabra::test
{

// The wavy grid that all of these files hold: (n + 1)^2 vertices with positions, normals +z and
// uvs.
struct GridData {
    std::vector<float> positions, normals, uvs;
    std::vector<uint32_t> indices;
};
GridData wavyGrid(uint32_t n);

// The grid without compression.
GltfBuilder plainGrid(uint32_t n);

// The grid compressed by Draco, without quantisation.
enum class DracoMethod { Sequential, Edgebreaker };
GltfBuilder dracoGrid(uint32_t n, DracoMethod method);

// Adds a view that is compressed by meshoptimizer to `stride * count` bytes, and returns its index.
int addMeshoptView(GltfBuilder& b, const Bytes& compressed, size_t stride, size_t count,
                   const char* mode, const char* filter = "NONE");
// The grid compressed by meshoptimizer.
GltfBuilder meshoptGrid(uint32_t n);

// An image of 2 x 1 pixels, (10, 20, 30, 128) and white, as WebP.
Bytes smallWebP();

} // namespace candelabra::test
