// SPDX-License-Identifier: Apache-2.0
#include "unit/broken_scene_cases.h"

#include <cmath>
#include <limits>

#include <stb/stb_image_write.h>

#include "unit/broken_scene_edits.h"

namespace candelabra::test
{

namespace
{

Bytes smallPng()
{
    Bytes png;
    const auto append = [](void* context, void* data, int size) {
        auto& out = *static_cast<Bytes*>(context);
        out.insert(out.end(), static_cast<uint8_t*>(data), static_cast<uint8_t*>(data) + size);
    };
    const uint8_t pixels[4 * 3] = {128, 128, 255, 0, 10, 20, 30, 40, 50, 60, 70, 80};
    stbi_write_png_to_func(append, &png, 2, 2, 3, pixels, 6);
    return png;
}

Bytes bytesOf(const std::string& text)
{
    return Bytes(text.begin(), text.end());
}

Json edited(Json json, const Edit& edit)
{
    const Json::json_pointer pointer(edit.pointer);
    if (*edit.value)
        json[pointer] = Json::parse(edit.value);
    else
        json[pointer.parent_pointer()].erase(pointer.back());
    return json;
}

std::string nested(size_t depth)
{
    return std::string(depth, '[') + std::string(depth, ']');
}

// Adds the ways in which the JSON text of one file can be damaged.
void addTextCases(std::vector<BrokenCase>& cases, const std::string& file, const std::string& valid)
{
    const auto add = [&](const std::string& name, const std::string& text,
                         const std::string& element) {
        cases.push_back({file + ": " + name, file, bytesOf(text), element});
    };
    add("empty", "", "is empty");
    add("blanks", "  \n", "is not valid JSON");
    add("not JSON", "hello", "is not valid JSON");
    add("binary", std::string("\x00\x01\x02\xff", 4), "is not valid JSON");
    add("not UTF-8", "{\"name\": \"\xff\xfe\"}", "is not valid JSON");
    add("NaN", "{\"name\": NaN}", "is missing"); // the name is text, so what else is missing counts
    add("number too large", "{\"name\": 1e999}", "is not valid JSON");
    add("two documents", valid + valid, "is not valid JSON");
    add("deep nesting", "{\"extras\": " + nested(100000) + "}", "deeper than 64");
    add("deep nesting left open", std::string(1000000, '['), "deeper than 64");
    add("newline in a string", "{\"a\nb\": 1}", "is not valid JSON");
    for (int tenth = 1; tenth < 10; ++tenth)
        add("cut at " + std::to_string(tenth) + "/10",
            valid.substr(0, valid.size() * static_cast<size_t>(tenth) / 10), "is not valid JSON");
}

void putLittleEndian(Bytes& bytes, size_t at, uint32_t value)
{
    for (size_t i = 0; i < 4; ++i)
        bytes[at + i] = static_cast<uint8_t>(value >> (8 * i));
}

// Adds cases with wrong binary data: floats that are not numbers, indices beyond the vertices.
void addDataCases(std::vector<BrokenCase>& cases)
{
    const auto add = [&](const char* name, int view, const auto& values, const char* element,
                         bool isRepaired = false) {
        GltfBuilder b = completeGltf();
        const size_t at = b.json["bufferViews"][static_cast<size_t>(view)]["byteOffset"];
        std::memcpy(b.binary.data() + at, values.data(), sizeof values[0] * values.size());
        cases.push_back({name, "scene.gltf", bytesOf(b.text()), element, isRepaired});
        cases.push_back({name, "scene.glb", b.glb(), element, isRepaired});
    };
    const float nan = std::numeric_limits<float>::quiet_NaN();
    add("position is not a number", 0, std::vector<float>{0, nan}, "accessors[0]: element 0");
    add("position is infinite", 0, std::vector<float>{0, 0, 0, INFINITY},
        "accessors[0]: element 1");
    add("position is far", 0, std::vector<float>{1e30f}, "accessors[0] element 0");
    add("normal is not a number", 1, std::vector<float>{nan}, "accessors[1]: element 0");
    add("uv is not a number", 2, std::vector<float>{nan}, "accessors[2]: element 0");
    add("index beyond the vertices", 3, std::vector<uint16_t>{0, 4}, "accessors[3] element 1 is 4");
    add("primitive restart", 3, std::vector<uint16_t>{65535}, "accessors[3] element 0 is 65535");
    add("sparse index beyond", 5, std::vector<uint16_t>{4}, "sparse index 4 is beyond");
    add("sparse value is not a number", 6, std::vector<float>{nan}, "accessors[0]: element 3");
    add("image header is garbage", 7, std::vector<uint8_t>{1, 2, 3, 4}, "images[0]", repaired);
    // IHDR width, big-endian at byte 16: 2^24 pixels
    add(
        "image is too wide", 7,
        [&] {
            Bytes png = smallPng();
            png[17] = 1;
            return png;
        }(),
        "images[0]: ", repaired);
    add(
        "image data is garbage", 7,
        [&] {
            Bytes png = smallPng();
            for (size_t i = 41; i < png.size(); ++i)
                png[i] = 0xaa;
            return png;
        }(),
        "images[0]: cannot be decoded", repaired);
}

} // namespace

GltfBuilder completeGltf()
{
    GltfBuilder b;
    const int positions = b.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, "VEC3");
    const int normals = b.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const int uvs = b.floats({0, 1, 1, 1, 0, 0, 1, 0}, "VEC2");
    const int indices = b.indices({0, 1, 2, 2, 1, 3});
    const int colors = b.accessor(b.view(Bytes(16, 200)), componentUnsignedByte, "VEC4", 4,
                                  {{"normalized", true}});
    const int sparseIndices = b.view(std::vector<uint16_t>{3});
    const int sparseValues = b.view(std::vector<float>{2, 2, 0});
    b.json["accessors"][0]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", sparseIndices}, {"componentType", componentUnsignedShort}}},
        {"values", {{"bufferView", sparseValues}}}};
    b.mesh(
        {{"attributes",
          {{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", uvs}, {"COLOR_0", colors}}},
         {"indices", indices},
         {"material", 0}});
    b.json["images"] = {{{"bufferView", b.view(smallPng())}, {"mimeType", "image/png"}}};
    const Json rest = Json::parse(R"({
        "extensionsUsed": ["KHR_lights_punctual", "KHR_lights_area"],
        "textures": [{"source": 0, "sampler": 0}],
        "samplers": [{"wrapS": 10497, "magFilter": 9729}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.25, 1],
                                                "baseColorTexture": {"index": 0}},
                       "normalTexture": {"index": 0}}],
        "cameras": [{"type": "perspective",
                     "perspective": {"yfov": 0.8, "znear": 0.1, "zfar": 100}}],
        "extensions": {
            "KHR_lights_punctual": {"lights": [
                {"type": "point", "intensity": 10, "range": 5, "extras": {"radius": 0.1}},
                {"type": "spot", "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.4}},
                {"type": "directional", "color": [1, 1, 0.5]}]},
            "KHR_lights_area": {"lights": [
                {"shape": "sphere", "intensity": 100, "radius": 0.25}]}},
        "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [
            {"children": [1, 2, 3, 4], "translation": [1, 0, 0]},
            {"mesh": 0, "rotation": [0, 0, 0, 1], "scale": [2, 2, -2]},
            {"extensions": {"KHR_lights_punctual": {"light": 0}}},
            {"camera": 0, "translation": [0, 0, 5]},
            {"extensions": {"KHR_lights_area": {"light": 0}}, "children": [5, 6]},
            {"extensions": {"KHR_lights_punctual": {"light": 1}}},
            {"extensions": {"KHR_lights_punctual": {"light": 2}}}]})");
    b.json.update(rest);
    return b;
}

std::string completeSceneJson()
{
    return R"({
        "name": "complete", "about": "every key", "channels": 3, "rendered_terms": ["D"],
        "camera": {"position": [0, 2, 4], "look_at": [0, 0, 0], "up": [0, 1, 0],
                   "vertical_fov_degrees": 45, "aspect": 1},
        "object": {"type": "plane", "point": [0, 0, 0], "normal": [0, 1, 0]},
        "material": {"albedo": [0.8, 0.8, 0.8], "diffuse": true, "specular": true,
                     "F0": [0.04, 0.04, 0.04], "alpha": 0.25, "perceptual_roughness": 0.5,
                     "metalness": 0},
        "lights": [{"position": [0, 3, 0], "radius": 0.5, "radiance": [10, 10, 10]},
                   {"position": [1, 3, 0], "radius": 0.5, "radiance": [10, 10, 10],
                    "influence_radius": 7},
                   {"type": "tube", "start": [0, 1, 0], "end": [1, 1, 0], "radius": 0.1,
                    "luminous_power": [10, 10, 10]},
                   {"type": "rectangle", "position": [0, 2, 0], "axis_u": [1, 0, 0],
                    "axis_v": [0, 0, 1], "two_sided": true, "luminance": [1, 1, 1]},
                   {"type": "spot", "position": [0, 2, 0], "direction": [0, -1, 0],
                    "inner_cone_degrees": 10, "outer_cone_degrees": 20, "intensity": [1, 1, 1]},
                   {"type": "distant_sphere", "direction": [0, -1, 0],
                    "sin_angular_radius": 0.1, "illuminance": [1, 1, 1]}],
        "resolution": [256, 256], "background": [0, 0, 0],
        "lights_visible_to_camera": false, "lights_occlude": false})";
}

std::vector<BrokenCase> brokenGltfCases()
{
    std::vector<BrokenCase> cases;
    const GltfBuilder valid = completeGltf();
    for (const Edit& edit : gltfEdits) {
        GltfBuilder b = valid;
        b.json["buffers"]; // creates the member, so that edits of the root replace everything
        b.json = edited(valid.json, edit);
        const bool isObject = b.json.is_object();
        const std::string text = isObject ? b.text() : b.json.dump();
        cases.push_back({edit.name, "scene.gltf", bytesOf(text), edit.element, edit.isRepaired});
        cases.push_back({edit.name, "scene.glb", isObject ? b.glb() : makeGlb(text, b.binary),
                         edit.element, edit.isRepaired});
    }
    const Json withBuffers = Json::parse(valid.text());
    for (const Edit& edit : bufferEdits)
        cases.push_back({edit.name, "scene.gltf", bytesOf(edited(withBuffers, edit).dump()),
                         edit.element, edit.isRepaired});
    Json longName = valid.json;
    longName["images"][0] = {{"uri", std::string(5000, 'x') + ".png"}};
    GltfBuilder b = valid;
    b.json = longName;
    cases.push_back(
        {"image name too long", "scene.gltf", bytesOf(b.text()), "images[0].uri: \"xxx", repaired});
    addDataCases(cases);
    return cases;
}

std::vector<BrokenCase> brokenContainerCases()
{
    std::vector<BrokenCase> cases;
    addTextCases(cases, "scene.gltf", completeGltf().text());
    addTextCases(cases, "scene.json", completeSceneJson());
    const Bytes valid = completeGltf().glb();
    const auto addEdited = [&](const char* name, size_t at, uint32_t value, const char* element) {
        Bytes bytes = valid;
        putLittleEndian(bytes, at, value);
        cases.push_back({name, "scene.glb", bytes, element});
    };
    const uint32_t jsonSize = valid[12] | valid[13] << 8 | valid[14] << 16;
    addEdited("version 1", 4, 1, "version 1");
    addEdited("length beyond the file", 8, 0xffffffff, "its header says");
    addEdited("length of the header alone", 8, 12, "no JSON chunk");
    addEdited("length inside the JSON chunk", 8, 100, "chunk[0]");
    addEdited("JSON chunk beyond the file", 12, 0xfffffff0, "chunk[0]: claims");
    addEdited("JSON chunk ends early", 12, jsonSize - 4, "chunk[1]");
    addEdited("JSON chunk empty", 12, 0, "chunk[1]");
    addEdited("first chunk is not JSON", 16, 0x004E4942, "chunk[0]: is not the JSON chunk");
    addEdited("binary chunk beyond the file", 20 + jsonSize, 0xffffffff, "chunk[1]: claims");
    addEdited("binary chunk 8 bytes beyond", 20 + jsonSize,
              static_cast<uint32_t>(valid.size() - 20 - jsonSize), "chunk[1]: claims");
    addEdited("second JSON chunk", 24 + jsonSize, 0x4E4F534A, "chunk[1]: is a second JSON chunk");
    addEdited("binary chunk of another type", 24 + jsonSize, 0x12345678, "buffers[0]");
    for (size_t size = 1; size < valid.size(); size += 1 + valid.size() / 40)
        cases.push_back({"cut at " + std::to_string(size), "scene.glb",
                         Bytes(valid.begin(), valid.begin() + static_cast<ptrdiff_t>(size)), ""});
    return cases;
}

std::vector<BrokenCase> brokenSceneJsonCases()
{
    std::vector<BrokenCase> cases;
    for (const Edit& edit : sceneEdits)
        cases.push_back({edit.name, "scene.json",
                         bytesOf(edited(Json::parse(completeSceneJson()), edit).dump()),
                         edit.element, edit.isRepaired});
    return cases;
}

} // namespace candelabra::test
