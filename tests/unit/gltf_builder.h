// SPDX-License-Identifier: Apache-2.0
// Builds small glTF files for the loader's tests, as text with base64 data or as binary glTF.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/temporary_folder.h"

namespace candelabra::test
{

using Json = nlohmann::json;
using Bytes = std::vector<uint8_t>;

Bytes readBytes(const std::string& path);
std::string encodeBase64(const Bytes& bytes);

// Returns the bytes of a binary glTF file with these chunks.
Bytes makeGlb(const std::string& json, const Bytes& binary);

constexpr int componentByte = 5120, componentUnsignedByte = 5121, componentShort = 5122,
              componentUnsignedShort = 5123, componentUnsignedInt = 5125, componentFloat = 5126;

// Builds a glTF whose data all lives in buffer 0. `json` may be edited freely before saving.
struct GltfBuilder {
    Json json = {{"asset", {{"version", "2.0"}}}};
    Bytes binary;
    // There is a second buffer without data, in which compressed views have their places.
    bool fallbackBuffer = false;

    // Adds a buffer view of these bytes and returns its index.
    template <typename T>
    int view(const std::vector<T>& values, int byteStride = 0)
    {
        binary.resize((binary.size() + 3) / 4 * 4);
        Json v = {{"buffer", 0},
                  {"byteOffset", binary.size()},
                  {"byteLength", values.size() * sizeof(T)}};
        if (byteStride)
            v["byteStride"] = byteStride;
        const size_t at = binary.size();
        binary.resize(at + values.size() * sizeof(T));
        std::memcpy(binary.data() + at, values.data(), values.size() * sizeof(T));
        json["bufferViews"].push_back(v);
        return static_cast<int>(json["bufferViews"].size()) - 1;
    }

    // Adds an accessor and returns its index; `extra` is merged into it.
    int accessor(int view, int componentType, const char* type, size_t count,
                 const Json& extra = Json::object());

    int floats(const std::vector<float>& values, const char* type);
    int indices(const std::vector<uint16_t>& values);

    // Adds a mesh with one primitive and returns its index.
    int mesh(const Json& primitive);
    // Adds a node that is a root of scene 0, and returns its index.
    int rootNode(const Json& node);

    std::string text() const; // as .gltf
    Bytes glb() const;

private:
    Json withBuffers(const Json& first) const;
};

// A node with one triangle (0,0,0), (1,0,0), (0,1,0) with normals +z; no lights, no camera.
GltfBuilder triangleScene();

} // namespace candelabra::test
