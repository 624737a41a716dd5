// SPDX-License-Identifier: Apache-2.0
// Checks the JSON of a glTF file before tinygltf reads it, because tinygltf ignores properties of
// the wrong type and truncates large integers.
#include <array>
#include <initializer_list>
#include <string_view>

#include "gltf/document.h"
#include "gltf/schema.h"
#include "scene/json_value.h"
#include "scene/scene_file.h"

namespace candelabra::app
{

namespace
{

using schema::Field;
using schema::Kind;

void checkObject(const nlohmann::json& document, const JsonValue& value,
                 std::span<const Field> fields);

void checkIndex(const nlohmann::json& document, const JsonValue& value, const char* target)
{
    const nlohmann::json::json_pointer pointer(target);
    const size_t size = document.contains(pointer) ? document[pointer].size() : 0;
    const int64_t i = value.integer(0, static_cast<int64_t>(schema::maxInteger));
    if (static_cast<uint64_t>(i) >= size)
        value.fail("is " + std::to_string(i) + ", but there are " + std::to_string(size) + " " +
                   pointer.back());
}

void checkField(const nlohmann::json& document, const JsonValue& value, const Field& field)
{
    switch (field.kind) {
    case Kind::Integer:
        value.integer(static_cast<int64_t>(field.range.min), static_cast<int64_t>(field.range.max));
        return;
    case Kind::Number:
        value.number(field.range);
        return;
    case Kind::Boolean:
        value.boolean();
        return;
    case Kind::String:
        value.string();
        return;
    case Kind::Index:
        checkIndex(document, value, field.target);
        return;
    case Kind::Object:
        checkObject(document, value, field.fields);
        return;
    case Kind::IndexMap:
        value.requireObject();
        for (const auto& entry : value.json().items())
            checkIndex(document, value.member(entry.key()), field.target);
        return;
    default:
        break;
    }
    value.requireArray();
    if (field.kind == Kind::Numbers &&
        (value.size() < field.minItems || value.size() > field.maxItems))
        value.fail("must have " + std::to_string(field.minItems) + " numbers, has " +
                   std::to_string(value.size()));
    for (size_t i = 0; i < value.size(); ++i) {
        if (field.kind == Kind::Numbers)
            value.item(i).number(field.range);
        else if (field.kind == Kind::Indices)
            checkIndex(document, value.item(i), field.target);
        else if (field.kind == Kind::Objects)
            checkObject(document, value.item(i), field.fields);
    }
}

void checkObject(const nlohmann::json& document, const JsonValue& value,
                 std::span<const Field> fields)
{
    value.requireObject();
    for (const Field& field : fields) {
        const std::string name(field.name);
        if (field.required)
            value.member(name); // fails when it is missing
        if (const auto member = value.find(name))
            checkField(document, *member, field);
    }
}

// --- Rules that the tables of schema.h cannot express

void checkOneOf(const JsonValue& value, std::initializer_list<const char*> allowed)
{
    std::string names;
    for (const char* name : allowed) {
        if (value.string() == name)
            return;
        names += (names.empty() ? "" : ", ") + std::string(name);
    }
    value.fail("must be one of " + names + ", is \"" + printable(value.string(), 60) + "\"");
}

void checkItems(const JsonValue& rootValue, const char* array, const auto& check)
{
    const auto items = rootValue.find(array);
    if (!items)
        return;
    items->requireArray();
    for (size_t i = 0; i < items->size(); ++i)
        check(items->item(i));
}

void checkLight(const JsonValue& light)
{
    checkOneOf(light.member("type"), {"directional", "point", "spot"});
    if (light.member("type").string() == "spot")
        light.member("spot");
}

void checkCamera(const JsonValue& camera)
{
    checkOneOf(camera.member("type"), {"perspective", "orthographic"});
    camera.member(camera.member("type").string());
}

void checkAccessor(const JsonValue& accessor)
{
    checkOneOf(accessor.member("type"), {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"});
    if (accessor.member("componentType").json() == 5124)
        accessor.member("componentType").fail("is 5124, which is not a component type of glTF 2.0");
}

void checkBufferView(const JsonValue& view)
{
    if (const auto stride = view.find("byteStride"))
        if (stride->json().get<int64_t>() % 4 != 0)
            stride->fail("must be a multiple of 4, is " + stride->json().dump());
}

void checkMaterial(const JsonValue& material)
{
    if (const auto mode = material.find("alphaMode"))
        checkOneOf(*mode, {"OPAQUE", "MASK", "BLEND"});
}

void checkSampler(const JsonValue& sampler)
{
    for (const char* name : {"wrapS", "wrapT"})
        if (const auto wrap = sampler.find(name)) {
            const int64_t mode = wrap->json().get<int64_t>();
            if (mode != 33071 && mode != 33648 && mode != 10497)
                wrap->fail("must be 33071, 33648 or 10497, is " + std::to_string(mode));
        }
}

void checkVersion(const JsonValue& asset)
{
    for (const char* name : {"version", "minVersion"})
        if (const auto version = asset.find(name)) {
            const std::string& text = version->string();
            const bool isTwo = text.substr(0, 2) == "2.";
            const bool readable = name == std::string_view("version") ? isTwo : text == "2.0";
            if (!readable)
                version->fail("is \"" + printable(text, 20) + "\"; glTF 2.0 is supported");
        }
}

constexpr std::array<std::string_view, 8> supportedExtensions = {
    "KHR_lights_punctual",   "KHR_lights_area",        "KHR_materials_emissive_strength",
    "KHR_materials_ior",     "KHR_materials_specular", "KHR_materials_unlit",
    "KHR_texture_transform", "KHR_mesh_quantization"};

bool isSupported(const std::string& extension)
{
    for (const std::string_view name : supportedExtensions)
        if (extension == name)
            return true;
    return false;
}

void checkExtensions(const JsonValue& document, const std::string& file,
                     std::vector<std::string>& warnings)
{
    checkItems(document, "extensionsRequired", [&](const JsonValue& name) {
        if (!isSupported(name.string()))
            name.fail("\"" + printable(name.string(), 60) + "\" is not supported");
    });
    checkItems(document, "extensionsUsed", [&](const JsonValue& name) {
        if (!isSupported(name.string()))
            warnings.push_back(printable(file, 4096) + ": extension \"" +
                               printable(name.string(), 60) + "\" is not supported and ignored");
    });
}

} // namespace

void checkGltfJson(const std::string& file, const nlohmann::json& json,
                   std::vector<std::string>& warnings)
{
    const JsonValue document(file, json);
    document.requireObject();
    checkVersion(document.member("asset"));
    checkExtensions(document, file, warnings);
    checkObject(json, document, schema::root);
    checkItems(document, "accessors", checkAccessor);
    checkItems(document, "bufferViews", checkBufferView);
    checkItems(document, "cameras", checkCamera);
    checkItems(document, "materials", checkMaterial);
    checkItems(document, "samplers", checkSampler);
    if (const auto* lights = GltfDocument::extension(json, "KHR_lights_punctual"))
        checkItems(JsonValue(file, *lights, "extensions.KHR_lights_punctual"), "lights",
                   checkLight);
    for (const char* unused : {"animations", "skins"})
        if (const auto items = document.find(unused); items && items->size() > 0)
            warnings.push_back(printable(file, 4096) + ": " + unused +
                               " are ignored; meshes are drawn in their rest pose");
}

} // namespace candelabra::app
