// SPDX-License-Identifier: Apache-2.0
// Decompresses the geometry of an opened glTF file, so that all that follows finds it in plain
// buffers. Internal to the glTF loader. Both functions throw SceneError if data is broken, or if it
// claims to be larger than what its compressed size allows: memory is allocated only after that has
// been checked.
#pragma once

#include "gltf/document.h"

namespace candelabra::app
{

// Decompresses the buffer views that have EXT_meshopt_compression, or KHR_meshopt_compression with
// data of the same version. The views then lie in buffers of their own.
void decompressMeshopt(GltfDocument& document);

// Decompresses the primitives that have KHR_draco_mesh_compression, and gives them accessors of
// their own.
void decompressDraco(GltfDocument& document);

} // namespace candelabra::app
