// SPDX-License-Identifier: Apache-2.0
// An opened glTF 2.0 file: its container is split, its JSON is checked and parsed by
// tinygltf, and its buffers are in memory. Internal to the glTF loader. All functions throw
// SceneError.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <tiny_gltf.h>

#include "scene/warnings.h"

namespace candelabra::app
{

// The two chunks of a .glb file, or the text of a .gltf file, which has no binary chunk.
struct GltfContainer {
    std::string json;
    std::vector<uint8_t> binary;
    bool isBinary = false; // true for a .glb file
};

// The elements of arrays that the drawn scene uses: indices by JSON pointer, such as "/buffers".
using GltfUse = std::map<std::string, std::set<size_t>, std::less<>>;

struct GltfDocument {
    std::string file; // the path as the user gave it; messages name it
    // The repaired JSON: every property that the loader reads has the right type, range and index.
    nlohmann::json json;
    GltfUse used;
    // The result of tinygltf, without buffers and images, which the loader reads itself. Extensions
    // and extras are read from `json`, because tinygltf::Value cuts integers to 32 bits.
    // Decompression changes the buffer views and accessors of `model`, and not those of `json`.
    tinygltf::Model model;
    // The buffers of the file, each with the byteLength that was declared for it, and after them
    // what was decompressed.
    std::vector<std::vector<uint8_t>> buffers;
    std::string missingExtensions; // those that the file requires and the loader does not read
    mutable LoadWarnings warnings;
    // The first fault of the JSON for which a mesh, or a part of one, may be left out.
    std::optional<SceneError> lostMesh;

    // The message of a failure of this document without the name of the file at its beginning.
    std::string withoutFile(const std::string& message) const;
    [[noreturn]] void fail(const std::string& element, const std::string& reason) const;
    // Throws SceneTooLarge.
    [[noreturn]] void failTooLarge(const std::string& element, const std::string& reason) const;
    void warn(const std::string& element, const std::string& reason) const
    {
        warnings.add(element, reason);
    }
    // Warns with the message of an error of this document, and says what is used instead.
    void warnInstead(const SceneError& error, const std::string& instead) const
    {
        warnings.addInstead(file, error, instead);
    }
    bool isUsed(std::string_view array, size_t index) const
    {
        const auto indices = used.find(array);
        return indices != used.end() && indices->second.contains(index);
    }
    // The bytes of a buffer view, or those of them that its buffer has, with a warning. Fails if it
    // has none.
    std::span<const uint8_t> bufferView(int index, const std::string& element) const;
    // Returns object["extensions"][name], or nullptr if there is none. `object` may be any JSON
    // object of the document.
    static const nlohmann::json* extension(const nlohmann::json& object, const char* name);
};

// The name of an element in messages, such as "meshes[3]".
std::string gltfElement(const char* array, size_t index);

GltfContainer readGltfContainer(const std::string& path);

// Checks types, ranges, array lengths and indices of every property that the loader or tinygltf
// reads, and the glTF version. Replaces or removes what is wrong and not needed, with warnings
// (check.cpp), and warns of content that is not used. Sets document.used and document.lostMesh.
void repairGltfJson(GltfDocument& document);

// Warns of the extensions that the file uses and of which the loader reads nothing or only a part,
// with a hint where one helps. Returns the extensions that the file calls required and of which the
// loader reads nothing, as one phrase for a message, or "" if there are none. Throws SceneError if
// the lists of extensions are no lists of names.
std::string checkGltfExtensions(const std::string& file, const nlohmann::json& json,
                                LoadWarnings& warnings);

// The functions below decompress geometry into plain buffers. They throw SceneError if data is
// broken, or claims to be larger than its compressed size allows, which they check before they
// allocate memory.
//
// Decompresses the buffer views that have EXT_meshopt_compression, or KHR_meshopt_compression with
// data of the same version. The views then lie in buffers of their own.
void decompressMeshopt(GltfDocument& document);

// Decompresses the primitives that have KHR_draco_mesh_compression, and gives them accessors of
// their own.
void decompressDraco(GltfDocument& document);

// Reads what a "uri" stands for: base64 data, or a file in the folder of document.file or below
// that folder. Absolute paths, "..", and schemes other than data: are errors.
std::vector<uint8_t> readGltfUri(const GltfDocument& document, const std::string& uri,
                                 const std::string& element);

GltfDocument openGltf(const std::string& path);

} // namespace candelabra::app
