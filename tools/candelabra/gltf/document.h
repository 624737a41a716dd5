// SPDX-License-Identifier: Apache-2.0
// An opened glTF 2.0 file: container taken apart, JSON checked, parsed by tinygltf, buffers in
// memory. Internal to the glTF loader. Everything throws SceneError.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <tiny_gltf.h>

namespace candelabra::app
{

// The two chunks of a .glb, or the text of a .gltf and no binary chunk.
struct GltfContainer {
    std::string json;
    std::vector<uint8_t> binary;
    bool isBinary = false; // .glb
};

struct GltfDocument {
    std::string file;    // as given, for messages
    nlohmann::json json; // every property we read has the right type, range and index
    // Everything but buffers and images, which are ours: see openGltf. Extensions and extras are
    // read from `json`, since tinygltf::Value cuts integers to 32 bits.
    tinygltf::Model model;
    std::vector<std::vector<uint8_t>> buffers; // each at least the byteLength declared for it
    mutable std::vector<std::string> warnings;

    [[noreturn]] void fail(const std::string& element, const std::string& reason) const;
    void warn(const std::string& element, const std::string& reason) const;
    // The bytes of a buffer view; fails when it leaves its buffer.
    std::span<const uint8_t> bufferView(int index, const std::string& element) const;
    // json[element]["extensions"][name], or NULL. `object` is any JSON object of the document.
    static const nlohmann::json* extension(const nlohmann::json& object, const char* name);
};

// "meshes", 3 -> "meshes[3]".
std::string gltfElement(const char* array, size_t index);

GltfContainer readGltfContainer(const std::string& path);

// Types, ranges, array lengths and indices of every property that the loader or tinygltf reads,
// glTF version and required extensions. Unknown optional extensions and things left out become
// warnings.
void checkGltfJson(const std::string& file, const nlohmann::json& json,
                   std::vector<std::string>& warnings);

// The bytes that a "uri" stands for: base64 data, or a file in the folder of document.file or below
// it. Absolute paths, "..", and schemes other than data: are errors.
std::vector<uint8_t> readGltfUri(const GltfDocument& document, const std::string& uri,
                                 const std::string& element);

GltfDocument openGltf(const std::string& path);

} // namespace candelabra::app
