// SPDX-License-Identifier: Apache-2.0
#include "unit/gltf_builder.h"

#include <fstream>
#include <iterator>
#include <stdexcept>

namespace candelabra::test
{

Bytes readBytes(const std::string& path)
{
    std::ifstream in(path, std::ios::binary);
    if (!in)
        throw std::runtime_error("cannot read " + path);
    return Bytes(std::istreambuf_iterator<char>(in), {});
}

std::string encodeBase64(const Bytes& bytes)
{
    const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t group = 0;
        for (size_t k = 0; k < 3; ++k)
            group = group << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
        for (size_t k = 0; k < 4; ++k)
            out += i + k > bytes.size() ? '=' : digits[group >> (18 - 6 * k) & 63];
    }
    return out;
}

Bytes makeGlb(const std::string& json, const Bytes& binary)
{
    std::string text = json;
    text.resize((text.size() + 3) / 4 * 4, ' ');
    Bytes data = binary;
    data.resize((data.size() + 3) / 4 * 4);
    Bytes out;
    const auto put = [&](uint64_t x) {
        for (int i = 0; i < 4; ++i)
            out.push_back(static_cast<uint8_t>(x >> (8 * i)));
    };
    put(0x46546C67); // "glTF"
    put(2);
    put(12 + 8 + text.size() + (data.empty() ? 0 : 8 + data.size()));
    put(text.size());
    put(0x4E4F534A); // "JSON"
    out.insert(out.end(), text.begin(), text.end());
    if (!data.empty()) {
        put(data.size());
        put(0x004E4942); // "BIN"
        out.insert(out.end(), data.begin(), data.end());
    }
    return out;
}

int GltfBuilder::accessor(int view, int componentType, const char* type, size_t count,
                          const Json& extra)
{
    Json a = {{"componentType", componentType}, {"type", type}, {"count", count}};
    if (view >= 0)
        a["bufferView"] = view;
    a.update(extra);
    json["accessors"].push_back(a);
    return static_cast<int>(json["accessors"].size()) - 1;
}

int GltfBuilder::floats(const std::vector<float>& values, const char* type)
{
    const size_t components =
        type == std::string("SCALAR") ? 1 : static_cast<size_t>(type[3] - '0');
    return accessor(view(values), componentFloat, type, values.size() / components);
}

int GltfBuilder::indices(const std::vector<uint16_t>& values)
{
    return accessor(view(values), componentUnsignedShort, "SCALAR", values.size());
}

int GltfBuilder::mesh(const Json& primitive)
{
    json["meshes"].push_back({{"primitives", Json::array({primitive})}});
    return static_cast<int>(json["meshes"].size()) - 1;
}

int GltfBuilder::rootNode(const Json& node)
{
    json["nodes"].push_back(node);
    const int index = static_cast<int>(json["nodes"].size()) - 1;
    json["scenes"][0]["nodes"].push_back(index);
    return index;
}

// Returns the JSON with `first` as buffer 0, if there is any data.
Json GltfBuilder::withBuffers(const Json& first) const
{
    Json copy = json;
    if (!binary.empty())
        copy["buffers"] = Json::array({first});
    if (fallbackBuffer)
        copy["buffers"].push_back(
            {{"byteLength", 1 << 20},
             {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
    return copy;
}

std::string GltfBuilder::text() const
{
    return withBuffers({{"byteLength", binary.size()},
                        {"uri", "data:application/octet-stream;base64," + encodeBase64(binary)}})
        .dump();
}

Bytes GltfBuilder::glb() const
{
    return makeGlb(withBuffers({{"byteLength", binary.size()}}).dump(), binary);
}

GltfBuilder triangleScene()
{
    GltfBuilder b;
    const int positions = b.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const int normals = b.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const int indices = b.indices({0, 1, 2});
    b.json["scene"] = 0;
    b.rootNode({{"mesh", b.mesh({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}},
                                 {"indices", indices}})}});
    return b;
}

} // namespace candelabra::test
