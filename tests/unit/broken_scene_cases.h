// SPDX-License-Identifier: Apache-2.0
// Scenes that loaders must refuse, and the valid scenes from which they are made.
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
    std::string element; // the error message must contain this
    // The scene is loaded, and a warning has the message.
    bool isRepaired = false;
};

// A valid glTF scene with nodes, a textured material with a normal map, sparse and quantised
// accessors, a camera, and lights of every kind, some with a radius.
GltfBuilder completeGltf();
// A valid scene description with plane, ball, lights, and every key.
std::string completeSceneJson();

std::vector<BrokenCase> brokenGltfCases();      // as .gltf and, where possible, as .glb
std::vector<BrokenCase> brokenContainerCases(); // chunks, truncation, text encoding
std::vector<BrokenCase> brokenSceneJsonCases();

} // namespace candelabra::test
