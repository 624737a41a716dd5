// SPDX-License-Identifier: Apache-2.0
// An opened glTF 2.0 file: its container is taken apart, its JSON is checked and parsed by
// tinygltf, and its buffers are in memory. Internal to the glTF loader. All functions throw
// SceneError.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <tiny_gltf.h>

#include "gltf/warnings.h"

namespace candelabra::app
{

// The two chunks of a .glb file, or the text of a .gltf file, which has no binary chunk.
struct GltfContainer {
    std::string json;
    std::vector<uint8_t> binary;
    bool isBinary = false; // true for a .glb file
};

struct GltfDocument {
    std::string file; // the path as the user gave it; messages name it
    // The JSON. Every property that the loader reads is known to have the right type, range and
    // index.
    nlohmann::json json;
    // What tinygltf made of it, without buffers and images, which the loader reads itself.
    // Extensions and extras are read from `json`, because tinygltf::Value cuts integers to 32 bits.
    // Decompression changes the buffer views and accessors of `model`, and not those of `json`.
    tinygltf::Model model;
    // The buffers of the file, each with the byteLength that was declared for it, and after them
    // what was decompressed.
    std::vector<std::vector<uint8_t>> buffers;
    std::string missingExtensions; // those that the file requires and the loader does not read
    mutable GltfWarnings warnings;

    // The message of a failure of this document without the name of the file at its beginning.
    std::string withoutFile(const std::string& message) const;
    [[noreturn]] void fail(const std::string& element, const std::string& reason) const;
    void warn(const std::string& element, const std::string& reason) const
    {
        warnings.add(element, reason);
    }
    // The bytes of a buffer view. Fails if it extends beyond its buffer.
    std::span<const uint8_t> bufferView(int index, const std::string& element) const;
    // Returns object["extensions"][name], or nullptr if there is none. `object` may be any JSON
    // object of the document.
    static const nlohmann::json* extension(const nlohmann::json& object, const char* name);
};

// The name of an element in messages, such as "meshes[3]".
std::string gltfElement(const char* array, size_t index);

GltfContainer readGltfContainer(const std::string& path);

// Checks types, ranges, array lengths and indices of every property that the loader or tinygltf
// reads, and the glTF version. Warns of content that is not used.
void checkGltfJson(const std::string& file, const nlohmann::json& json, GltfWarnings& warnings);

// Reads what a "uri" stands for: base64 data, or a file in the folder of document.file or below
// that folder. Absolute paths, "..", and schemes other than data: are errors.
std::vector<uint8_t> readGltfUri(const GltfDocument& document, const std::string& uri,
                                 const std::string& element);

GltfDocument openGltf(const std::string& path);

} // namespace candelabra::app
