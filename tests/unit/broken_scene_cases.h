// SPDX-License-Identifier: Apache-2.0
// Scenes that loaders must refuse, and the valid ones they are made from.
#pragma once

#include <string>
#include <vector>

#include "unit/gltf_builder.h"

namespace candelabra::test
{

struct BrokenCase {
    std::string name;
    std::string file; // name of the file to write
    Bytes bytes;
    std::string element; // must occur in the message
};

// Valid: nodes, a textured material with a normal map, sparse and quantised accessors, a camera,
// lights of every kind, some with a radius.
GltfBuilder completeGltf();
// Valid: plane and ball, lights, every key.
std::string completeSceneJson();

std::vector<BrokenCase> brokenGltfCases();      // as .gltf and, where it applies, as .glb
std::vector<BrokenCase> brokenContainerCases(); // chunks, truncation, text encoding
std::vector<BrokenCase> brokenSceneJsonCases();

} // namespace candelabra::test
