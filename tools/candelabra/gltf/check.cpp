// SPDX-License-Identifier: Apache-2.0
// Checks the JSON of a glTF file before tinygltf reads it, because tinygltf ignores properties of
// the wrong type and truncates large integers.
#include <initializer_list>
#include <limits>
#include <span>
#include <string_view>

#include "gltf/document.h"
#include "scene/json_value.h"
#include "scene/scene_file.h"

namespace candelabra::app
{

// Tables of the properties of glTF 2.0 that the loader reads: their types, ranges and, for indices,
// the array that they point into. Properties that are not listed are not read.
namespace schema
{
namespace
{

enum class Kind {
    Integer,
    Number,
    Boolean,
    String,
    Index,      // an integer, an index into the array `target`
    Object,     // an object with the members `fields`
    Numbers,    // an array of minItems to maxItems numbers
    Indices,    // an array of indices into `target`
    Objects,    // an array of objects with the members `fields`
    IndexMap,   // an object whose values are indices into `target`
    IndexMaps,  // an array of such objects
    IntegerMap, // an object whose values are integers
    List        // any array
};

struct Field {
    std::string_view name;
    Kind kind = Kind::Number;
    bool required = false;
    NumberRange range = {};
    size_t minItems = 0, maxItems = 0;
    const char* target = nullptr; // JSON pointer of the array that an index points into
    std::span<const Field> fields = {};

    constexpr Field need() const
    {
        Field f = *this;
        f.required = true;
        return f;
    }
};

constexpr double maxInteger = 2147483647;    // the largest int of tinygltf
constexpr double maxByte = 9007199254740991; // 2^53 - 1, exact in double
// Factors of 0 to 1. Exporters' rounding is accepted, and the values are clamped when they are
// used.
constexpr NumberRange unitInterval{-1e-4, 1.0001};
constexpr NumberRange coordinate{-maxCoordinate, maxCoordinate};
constexpr NumberRange notNegative{0};

constexpr Field number(std::string_view n, NumberRange r = {})
{
    return {n, Kind::Number, 0, r};
}
constexpr Field integer(std::string_view n, double lo, double hi)
{
    return {n, Kind::Integer, false, {lo, hi}};
}
constexpr Field boolean(std::string_view n)
{
    return {n, Kind::Boolean};
}
constexpr Field string(std::string_view n)
{
    return {n, Kind::String};
}
constexpr Field list(std::string_view n)
{
    return {n, Kind::List};
}
constexpr Field numbers(std::string_view n, size_t count, NumberRange r = {})
{
    return {n, Kind::Numbers, false, r, count, count};
}
constexpr Field anyNumbers(std::string_view n, NumberRange r)
{
    return {n, Kind::Numbers, false, r, 0, std::numeric_limits<size_t>::max()};
}
constexpr Field index(std::string_view n, const char* target, Kind kind = Kind::Index)
{
    return {n, kind, false, {}, 0, 0, target};
}
constexpr Field object(std::string_view n, std::span<const Field> fields, Kind kind = Kind::Object)
{
    return {n, kind, false, {}, 0, 0, nullptr, fields};
}
constexpr Field objects(std::string_view n, std::span<const Field> fields)
{
    return object(n, fields, Kind::Objects);
}

// --- accessors
constexpr Field sparseIndices[] = {index("bufferView", "/bufferViews").need(),
                                   integer("byteOffset", 0, maxInteger),
                                   integer("componentType", 5121, 5125).need()};
constexpr Field sparseValues[] = {index("bufferView", "/bufferViews").need(),
                                  integer("byteOffset", 0, maxInteger)};
constexpr Field sparse[] = {integer("count", 1, maxInteger).need(),
                            object("indices", sparseIndices).need(),
                            object("values", sparseValues).need()};
constexpr Field accessor[] = {index("bufferView", "/bufferViews"),
                              integer("byteOffset", 0, maxByte),
                              integer("componentType", 5120, 5126).need(),
                              boolean("normalized"),
                              integer("count", 1, maxByte).need(),
                              string("type").need(),
                              string("name"),
                              object("sparse", sparse)};
constexpr Field meshopt[] = {index("buffer", "/buffers").need(),
                             integer("byteOffset", 0, maxByte),
                             integer("byteLength", 1, maxByte).need(),
                             integer("byteStride", 1, 256).need(),
                             integer("count", 1, maxInteger).need(),
                             string("mode").need(),
                             string("filter")};
constexpr Field bufferViewExtensions[] = {object("EXT_meshopt_compression", meshopt),
                                          object("KHR_meshopt_compression", meshopt)};
constexpr Field bufferView[] = {index("buffer", "/buffers").need(),
                                integer("byteOffset", 0, maxByte),
                                integer("byteLength", 1, maxByte).need(),
                                integer("byteStride", 4, 252),
                                string("name"),
                                object("extensions", bufferViewExtensions)};
constexpr Field fallback[] = {boolean("fallback")};
constexpr Field bufferExtensions[] = {object("EXT_meshopt_compression", fallback),
                                      object("KHR_meshopt_compression", fallback)};
constexpr Field buffer[] = {integer("byteLength", 1, maxByte).need(), string("uri"), string("name"),
                            object("extensions", bufferExtensions)};

// --- textures and materials
constexpr Field image[] = {string("uri"), string("mimeType"), string("name"),
                           index("bufferView", "/bufferViews")};
constexpr Field sampler[] = {integer("magFilter", 0, maxInteger), integer("wrapS", 0, maxInteger),
                             integer("wrapT", 0, maxInteger), string("name")};
constexpr Field textureSource[] = {index("source", "/images").need()};
constexpr Field textureSources[] = {object("EXT_texture_webp", textureSource)};
constexpr Field texture[] = {index("sampler", "/samplers"), index("source", "/images"),
                             string("name"), object("extensions", textureSources)};
constexpr Field textureTransform[] = {numbers("offset", 2), number("rotation"), numbers("scale", 2),
                                      integer("texCoord", 0, maxInteger)};
constexpr Field textureExtensions[] = {object("KHR_texture_transform", textureTransform)};
constexpr Field textureInfo[] = {index("index", "/textures").need(),
                                 integer("texCoord", 0, maxInteger),
                                 number("scale"),    // normal textures
                                 number("strength"), // occlusion textures
                                 object("extensions", textureExtensions)};
constexpr Field metallicRoughness[] = {
    numbers("baseColorFactor", 4, unitInterval), object("baseColorTexture", textureInfo),
    number("metallicFactor", unitInterval), number("roughnessFactor", unitInterval),
    object("metallicRoughnessTexture", textureInfo)};
constexpr Field emissiveStrength[] = {number("emissiveStrength", notNegative)};
constexpr Field ior[] = {number("ior", notNegative)};
constexpr Field specular[] = {
    number("specularFactor", unitInterval), numbers("specularColorFactor", 3, notNegative),
    object("specularTexture", textureInfo), object("specularColorTexture", textureInfo)};
constexpr Field transmission[] = {number("transmissionFactor", unitInterval),
                                  object("transmissionTexture", textureInfo)};
constexpr Field volume[] = {number("thicknessFactor", notNegative)};
constexpr Field unlit[] = {string("name")};
constexpr Field specularGlossiness[] = {
    numbers("diffuseFactor", 4, unitInterval), object("diffuseTexture", textureInfo),
    numbers("specularFactor", 3, unitInterval), number("glossinessFactor", unitInterval),
    object("specularGlossinessTexture", textureInfo)};
constexpr Field materialExtensions[] = {
    object("KHR_materials_emissive_strength", emissiveStrength),
    object("KHR_materials_ior", ior),
    object("KHR_materials_specular", specular),
    object("KHR_materials_transmission", transmission),
    object("KHR_materials_volume", volume),
    object("KHR_materials_unlit", unlit),
    object("KHR_materials_pbrSpecularGlossiness", specularGlossiness)};
constexpr Field material[] = {string("name"),
                              object("pbrMetallicRoughness", metallicRoughness),
                              object("normalTexture", textureInfo),
                              object("occlusionTexture", textureInfo),
                              object("emissiveTexture", textureInfo),
                              numbers("emissiveFactor", 3, NumberRange{unitInterval.min}),
                              string("alphaMode"),
                              number("alphaCutoff", notNegative),
                              boolean("doubleSided"),
                              object("extensions", materialExtensions)};

// --- meshes, nodes, cameras, lights
constexpr Field draco[] = {index("bufferView", "/bufferViews").need(),
                           Field{"attributes", Kind::IntegerMap, true, {0, maxInteger}}};
constexpr Field primitiveExtensions[] = {object("KHR_draco_mesh_compression", draco)};
constexpr Field primitive[] = {index("attributes", "/accessors", Kind::IndexMap).need(),
                               index("indices", "/accessors"),
                               index("material", "/materials"),
                               integer("mode", 0, 6),
                               index("targets", "/accessors", Kind::IndexMaps),
                               object("extensions", primitiveExtensions)};
constexpr Field mesh[] = {objects("primitives", primitive).need(),
                          anyNumbers("weights", coordinate), string("name")};
constexpr Field skin[] = {index("joints", "/nodes", Kind::Indices).need(),
                          index("inverseBindMatrices", "/accessors"), string("name")};
constexpr Field lightReference[] = {
    index("light", "/extensions/KHR_lights_punctual/lights").need()};
constexpr Field areaReference[] = {index("light", "/extensions/KHR_lights_area/lights").need()};
constexpr Field instancing[] = {index("attributes", "/accessors", Kind::IndexMap).need()};
constexpr Field nodeExtensions[] = {object("KHR_lights_punctual", lightReference),
                                    object("KHR_lights_area", areaReference),
                                    object("EXT_mesh_gpu_instancing", instancing)};
constexpr Field node[] = {index("camera", "/cameras"),
                          index("mesh", "/meshes"),
                          index("skin", "/skins"),
                          index("children", "/nodes", Kind::Indices),
                          numbers("matrix", 16, coordinate),
                          numbers("rotation", 4, coordinate),
                          numbers("scale", 3, coordinate),
                          numbers("translation", 3, coordinate),
                          anyNumbers("weights", coordinate),
                          string("name"),
                          object("extensions", nodeExtensions)};
constexpr Field sceneFields[] = {index("nodes", "/nodes", Kind::Indices), string("name")};
constexpr Field perspective[] = {number("yfov", NumberRange::positive(3.14159)).need(),
                                 number("znear", NumberRange::positive(maxCoordinate)).need(),
                                 number("zfar", NumberRange::positive(maxCoordinate)),
                                 number("aspectRatio", NumberRange::positive(1e6))};
constexpr Field orthographic[] = {number("xmag", coordinate).need(),
                                  number("ymag", coordinate).need(),
                                  number("zfar", NumberRange::positive(maxCoordinate)).need(),
                                  number("znear", {0, maxCoordinate}).need()};
constexpr Field camera[] = {string("type").need(), string("name"),
                            object("perspective", perspective),
                            object("orthographic", orthographic)};
constexpr Field spot[] = {number("innerConeAngle"), number("outerConeAngle")};
constexpr Field punctual[] = {string("type").need(),
                              string("name"),
                              numbers("color", 3, notNegative),
                              number("intensity", notNegative),
                              number("range", NumberRange::positive(maxCoordinate)),
                              object("spot", spot)};
constexpr Field punctualLights[] = {objects("lights", punctual).need()};
constexpr Field area[] = {string("shape"),
                          string("type"), // the name of "shape" in an earlier draft
                          string("name"),
                          numbers("color", 3, notNegative),
                          number("intensity", notNegative),
                          number("radius", NumberRange::positive(maxCoordinate)),
                          number("range", NumberRange::positive(maxCoordinate))};
constexpr Field areaLights[] = {objects("lights", area).need()};
constexpr Field rootExtensions[] = {object("KHR_lights_punctual", punctualLights),
                                    object("KHR_lights_area", areaLights)};

constexpr Field asset[] = {string("version").need(), string("minVersion"), string("generator"),
                           string("copyright")};
constexpr Field root[] = {object("asset", asset).need(),
                          object("extensions", rootExtensions),
                          list("extensionsUsed"),
                          list("extensionsRequired"),
                          objects("accessors", accessor),
                          objects("bufferViews", bufferView),
                          objects("buffers", buffer),
                          objects("images", image),
                          objects("samplers", sampler),
                          objects("textures", texture),
                          objects("materials", material),
                          objects("meshes", mesh),
                          objects("nodes", node),
                          objects("cameras", camera),
                          objects("scenes", sceneFields),
                          index("scene", "/scenes"),
                          list("animations"),
                          objects("skins", skin)};

} // namespace
} // namespace schema

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

void checkIndexMap(const nlohmann::json& document, const JsonValue& value, const char* target)
{
    value.requireObject();
    for (const auto& entry : value.json().items())
        checkIndex(document, value.member(entry.key()), target);
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
        checkIndexMap(document, value, field.target);
        return;
    case Kind::IntegerMap:
        value.requireObject();
        for (const auto& entry : value.json().items())
            value.member(entry.key())
                .integer(static_cast<int64_t>(field.range.min),
                         static_cast<int64_t>(field.range.max));
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
        else if (field.kind == Kind::IndexMaps)
            checkIndexMap(document, value.item(i), field.target);
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
    const auto extensions = view.find("extensions");
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
        if (const auto meshopt = extensions ? extensions->find(name) : std::nullopt) {
            checkOneOf(meshopt->member("mode"), {"ATTRIBUTES", "TRIANGLES", "INDICES"});
            if (const auto filter = meshopt->find("filter"))
                checkOneOf(*filter, {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"});
        }
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
            // Files of version 1 may have a number here.
            const std::string text =
                version->json().is_number() ? version->json().dump() : version->string();
            const bool isTwo = text.substr(0, 2) == "2.";
            const bool readable = name == std::string_view("version") ? isTwo : text == "2.0";
            if (!readable)
                version->fail("is " + printable(version->json().dump(), 20) +
                              "; only glTF 2.0 can be read" +
                              (text.starts_with("1") ? "; gltf-pipeline converts the file" : ""));
            version->string(); // fails for numbers
        }
}

} // namespace

void checkGltfJson(const std::string& file, const nlohmann::json& json, GltfWarnings& warnings)
{
    const JsonValue document(file, json);
    document.requireObject();
    checkVersion(document.member("asset"));
    checkObject(json, document, schema::root);
    checkItems(document, "accessors", checkAccessor);
    checkItems(document, "bufferViews", checkBufferView);
    checkItems(document, "cameras", checkCamera);
    checkItems(document, "materials", checkMaterial);
    checkItems(document, "samplers", checkSampler);
    if (const auto* lights = GltfDocument::extension(json, "KHR_lights_punctual"))
        checkItems(JsonValue(file, *lights, "extensions.KHR_lights_punctual"), "lights",
                   checkLight);
    if (const auto animations = document.find("animations"); animations && animations->size() > 0)
        warnings.add("",
                     "animations are not played; everything stands as the nodes of the file say");
}

} // namespace candelabra::app
