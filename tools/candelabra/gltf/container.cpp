// SPDX-License-Identifier: Apache-2.0
// Opens a glTF file: splits .glb chunks, resolves URIs, loads buffers and calls tinygltf.
#include "gltf/document.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>

#include "scene/scene_file.h"

namespace candelabra::app
{

namespace
{

uint32_t readLittleEndian32(const uint8_t* p)
{
    return uint32_t{p[0]} | uint32_t{p[1]} << 8 | uint32_t{p[2]} << 16 | uint32_t{p[3]} << 24;
}

// Splits a binary glTF file into chunks. Chunks of { length, type, data } follow a header of 12
// bytes (glTF 2.0, section 4.4).
GltfContainer splitBinary(const std::string& path, const std::vector<uint8_t>& bytes)
{
    constexpr uint32_t jsonChunk = 0x4E4F534A, binaryChunk = 0x004E4942;
    if (bytes.size() < 20)
        failScene(path, "", "is cut off inside the header of binary glTF");
    const uint32_t version = readLittleEndian32(&bytes[4]);
    if (version != 2)
        failScene(path, "",
                  "is binary glTF of version " + std::to_string(version) +
                      ", and only version 2 can be read" +
                      (version == 1 ? "; gltf-pipeline converts the file" : ""));
    const uint64_t length = readLittleEndian32(&bytes[8]);
    if (length > bytes.size())
        failScene(path, "",
                  "has " + std::to_string(bytes.size()) + " bytes, its header says " +
                      std::to_string(length));
    GltfContainer container;
    container.isBinary = true;
    size_t index = 0;
    for (uint64_t at = 12; at < length; ++index) {
        const std::string element = gltfElement("chunk", index);
        if (length - at < 8)
            failScene(path, element, "is cut off inside its header");
        const uint64_t size = readLittleEndian32(&bytes[at]);
        const uint32_t type = readLittleEndian32(&bytes[at + 4]);
        at += 8;
        if (size > length - at)
            failScene(path, element,
                      "claims " + std::to_string(size) + " bytes, " + std::to_string(length - at) +
                          " are left");
        if ((index == 0) != (type == jsonChunk))
            failScene(path, element, index ? "is a second JSON chunk" : "is not the JSON chunk");
        const auto begin = bytes.begin() + ptrdiff_t(at);
        const auto end = begin + ptrdiff_t(size);
        if (index == 0)
            container.json.assign(begin, end);
        else if (index == 1 && type == binaryChunk)
            container.binary.assign(begin, end);
        at += size; // further chunks belong to extensions and are skipped
    }
    if (index == 0)
        failScene(path, "", "has no JSON chunk");
    return container;
}

// Decodes base64 (RFC 4648, section 4). Returns false for any other character; the padding may be
// missing.
bool decodeBase64(std::string_view text, std::vector<uint8_t>& out)
{
    static const std::array<int8_t, 256> values = [] {
        std::array<int8_t, 256> table;
        table.fill(-1);
        const std::string_view digits =
            "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        for (size_t i = 0; i < digits.size(); ++i)
            table[uint8_t(digits[i])] = int8_t(i);
        return table;
    }();
    for (int i = 0; i < 2 && !text.empty() && text.back() == '='; ++i)
        text.remove_suffix(1);
    out.clear();
    out.reserve(text.size() / 4 * 3 + 2);
    uint32_t bits = 0;
    int bitCount = 0;
    for (const char c : text) {
        const int8_t value = values[uint8_t(c)];
        if (value < 0)
            return false;
        bits = (bits << 6 | uint32_t(value)) & 0xFFFFFF;
        bitCount += 6;
        if (bitCount >= 8) {
            bitCount -= 8;
            out.push_back(uint8_t(bits >> bitCount));
        }
    }
    return bitCount < 6; // a single digit at the end would be no byte
}

int hexDigit(char c)
{
    if (c >= '0' && c <= '9')
        return c - '0';
    if (c >= 'a' && c <= 'f')
        return c - 'a' + 10;
    if (c >= 'A' && c <= 'F')
        return c - 'A' + 10;
    return -1;
}

bool decodePercent(const std::string& uri, std::string& out)
{
    for (size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] != '%') {
            out += uri[i];
            continue;
        }
        if (i + 2 >= uri.size())
            return false;
        const int high = hexDigit(uri[i + 1]), low = hexDigit(uri[i + 2]);
        if (high < 0 || low < 0)
            return false;
        out += char(high * 16 + low);
        i += 2;
    }
    return true;
}

// True if a URI begins with a scheme, which is what stands before a ':' in the first segment
// (RFC 3986).
bool hasScheme(const std::string& uri)
{
    const size_t end = uri.find_first_of(":/?#");
    return end != std::string::npos && uri[end] == ':';
}

// The path of a relative URI. Fails if it could lead out of the scene's folder.
std::string relativePath(const GltfDocument& document, const std::string& uri,
                         const std::string& element)
{
    const std::string quoted = "\"" + printable(uri, 80) + "\"";
    std::string path;
    if (hasScheme(uri))
        document.fail(element, quoted + " is neither a data URI nor a relative path");
    if (!decodePercent(uri, path) || path.empty() || path.find('\0') != std::string::npos)
        document.fail(element, quoted + " is not a valid URI");
    if (path.find('\\') != std::string::npos || path[0] == '/' || hasScheme(path))
        document.fail(element, quoted + " is not a relative path");
    for (const std::filesystem::path& part : std::filesystem::path(path))
        if (part == "..")
            document.fail(element, quoted + " leads out of the scene's folder");
    return path;
}

// Returns true for a buffer without data, into which compressed buffer views are decompressed.
bool isFallback(const nlohmann::json& buffer)
{
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
        if (const auto* extension = GltfDocument::extension(buffer, name))
            if (extension->value("fallback", false))
                return true;
    return false;
}

std::vector<uint8_t> loadBuffer(const GltfDocument& document, GltfContainer& container,
                                size_t index)
{
    const nlohmann::json& json = document.json["buffers"][index];
    const std::string element = gltfElement("buffers", index);
    std::vector<uint8_t> bytes;
    if (json.contains("uri"))
        bytes = readGltfUri(document, json["uri"].get<std::string>(), element + ".uri");
    else if (index == 0 && container.isBinary && !container.binary.empty())
        bytes = std::move(container.binary);
    else if (isFallback(json))
        return bytes;
    else
        document.fail(element, "has no uri");
    const uint64_t declared = json["byteLength"].get<uint64_t>();
    if (bytes.size() < declared)
        document.warn(element, "declares " + std::to_string(declared) + " bytes, has " +
                                   std::to_string(bytes.size()) + "; these are used");
    bytes.resize(std::min<uint64_t>(declared, bytes.size()));
    return bytes;
}

void loadBuffers(GltfDocument& document, GltfContainer& container)
{
    const auto buffers = document.json.find("buffers");
    for (size_t i = 0; buffers != document.json.end() && i < buffers->size(); ++i)
        try {
            document.buffers.push_back(loadBuffer(document, container, i));
        } catch (const SceneError& error) {
            if (document.isUsed("/buffers", i))
                throw;
            document.warnInstead(error, "nothing uses it, so it is left out");
            document.buffers.emplace_back();
        }
}

// Gives tinygltf the checked JSON without buffers and images. It would read them from anywhere,
// also relative to the working directory, require that files have exactly the declared size, and
// decode images that nothing uses.
void parseWithTinyGltf(GltfDocument& document)
{
    nlohmann::json reduced;
    for (const char* key : {"asset", "scene", "scenes", "nodes", "meshes", "materials", "textures",
                            "samplers", "accessors", "bufferViews", "cameras", "skins"})
        if (document.json.contains(key))
            reduced[key] = document.json[key];
    // It refuses indices without a buffer view, which are those that Draco replaces.
    if (reduced.contains("meshes"))
        for (nlohmann::json& mesh : reduced["meshes"])
            for (nlohmann::json& primitive : mesh["primitives"])
                if (GltfDocument::extension(primitive, "KHR_draco_mesh_compression"))
                    primitive.erase("indices");
    if (const auto* lights = GltfDocument::extension(document.json, "KHR_lights_punctual"))
        reduced["extensions"]["KHR_lights_punctual"] = *lights;
    const std::string text = reduced.dump();

    tinygltf::TinyGLTF loader;
    std::string error, warning;
    bool loaded = false;
    try {
        loaded = loader.LoadASCIIFromString(&document.model, &error, &warning, text.data(),
                                            unsigned(text.size()), "");
    } catch (const std::exception& e) {
        error = e.what();
    }
    if (!loaded)
        document.fail("", "cannot be read; the parser says \"" +
                              printable(error.substr(0, error.find('\n'))) + "\"");
}

} // namespace

std::string gltfElement(const char* array, size_t index)
{
    return std::string(array) + "[" + std::to_string(index) + "]";
}

void GltfDocument::fail(const std::string& element, const std::string& reason) const
{
    failScene(file, element, reason);
}

void GltfDocument::failTooLarge(const std::string& element, const std::string& reason) const
{
    throw SceneTooLarge(sceneMessage(file, element, reason));
}

std::string GltfDocument::withoutFile(const std::string& message) const
{
    const std::string start = printable(file, 4096) + ": ";
    return message.starts_with(start) ? message.substr(start.size()) : message;
}

std::span<const uint8_t> GltfDocument::bufferView(int index, const std::string& element) const
{
    const tinygltf::BufferView& view = model.bufferViews[size_t(index)];
    const std::vector<uint8_t>& buffer = buffers[size_t(view.buffer)];
    const std::string beyond = "bufferViews[" + std::to_string(index) +
                               "] extends beyond its buffer of " + std::to_string(buffer.size()) +
                               " bytes";
    if (view.byteOffset >= buffer.size())
        fail(element, beyond);
    const size_t inside = buffer.size() - view.byteOffset;
    if (view.byteLength > inside)
        warn(element, beyond + "; the part inside is used");
    return std::span(buffer).subspan(view.byteOffset, std::min(view.byteLength, inside));
}

const nlohmann::json* GltfDocument::extension(const nlohmann::json& object, const char* name)
{
    const auto extensions = object.find("extensions");
    if (extensions == object.end())
        return nullptr;
    const auto found = extensions->find(name);
    return found == extensions->end() ? nullptr : &*found;
}

GltfContainer readGltfContainer(const std::string& path)
{
    const std::vector<uint8_t> bytes = readSceneFile(path);
    if (bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0)
        return splitBinary(path, bytes);
    GltfContainer container;
    container.json.assign(bytes.begin(), bytes.end());
    return container;
}

std::vector<uint8_t> readGltfUri(const GltfDocument& document, const std::string& uri,
                                 const std::string& element)
{
    if (uri.substr(0, 5) == "data:") {
        const size_t comma = uri.find(',');
        const std::string_view header = std::string_view(uri).substr(0, comma);
        if (comma == std::string::npos || !header.ends_with(";base64"))
            document.fail(element, "is a data URI without base64 data");
        std::vector<uint8_t> bytes;
        if (!decodeBase64(std::string_view(uri).substr(comma + 1), bytes))
            document.fail(element, "holds broken base64 data");
        return bytes;
    }
    const std::string relative = relativePath(document, uri, element);
    const std::filesystem::path folder = std::filesystem::path(document.file).parent_path();
    return readSceneFile((folder / relative).string(), document.file,
                         element + ": \"" + printable(uri, 80) + "\"");
}

GltfDocument openGltf(const std::string& path)
{
    GltfDocument document;
    document.file = path;
    GltfContainer container = readGltfContainer(path);
    document.json = parseSceneJson(path, container.json);
    container.json.clear();
    repairGltfJson(document);
    document.missingExtensions = checkGltfExtensions(path, document.json, document.warnings);
    loadBuffers(document, container);
    parseWithTinyGltf(document);
    decompressMeshopt(document);
    decompressDraco(document);
    return document;
}

} // namespace candelabra::app
