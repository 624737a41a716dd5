// SPDX-License-Identifier: Apache-2.0
// Tables of the properties of glTF 2.0 that the loader reads: their types, ranges, for indices the
// array that they point into, and what is used instead of a value that is wrong. Properties that
// are not listed are not read. Internal to the glTF loader.
#pragma once

#include <limits>
#include <span>
#include <string_view>

#include "scene/json_value.h"
#include "scene/scene_file.h"

namespace candelabra::app::schema
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
    // The words of the warning that say what is used instead of a wrong value, which is removed:
    // the member, or the wrong items of Indices and Objects. nullptr: a wrong value makes the
    // object that has the member wrong.
    const char* instead = nullptr;
    // Numbers beyond an end of their range are replaced by that end.
    bool clamps = false;
    // JSON of the value that takes the place of a wrong one, and of one that is required and
    // missing, because tinygltf insists on one.
    const char* fill = nullptr;

    constexpr Field need() const
    {
        Field f = *this;
        f.required = true;
        return f;
    }
    constexpr Field orElse(const char* what) const
    {
        Field f = *this;
        f.instead = what;
        return f;
    }
    constexpr Field orFill(const char* json, const char* what) const
    {
        Field f = orElse(what);
        f.fill = json;
        return f;
    }
    constexpr Field clamped(const char* what) const
    {
        Field f = orElse(what);
        f.clamps = true;
        return f;
    }
};

inline constexpr double maxInteger = 2147483647;    // the largest int of tinygltf
inline constexpr double maxByte = 9007199254740991; // 2^53 - 1, exact in double
// Factors of 0 to 1. Exporters' rounding is accepted, and the values are clamped when they are
// used.
inline constexpr NumberRange unitInterval{-1e-4, 1.0001};
inline constexpr NumberRange coordinate{-maxCoordinate, maxCoordinate};
inline constexpr NumberRange notNegative{0};

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
constexpr Field name()
{
    return string("name").orElse("it has no name");
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
constexpr Field extension(std::string_view n, std::span<const Field> fields)
{
    return object(n, fields).orElse("the extension is left out");
}
constexpr Field extensions(std::span<const Field> fields)
{
    return object("extensions", fields).orElse("they are left out");
}
constexpr Field objects(std::string_view n, std::span<const Field> fields)
{
    return object(n, fields, Kind::Objects);
}

// --- accessors
inline constexpr Field sparseIndices[] = {index("bufferView", "/bufferViews").need(),
                                          integer("byteOffset", 0, maxInteger),
                                          integer("componentType", 5121, 5125).need()};
inline constexpr Field sparseValues[] = {index("bufferView", "/bufferViews").need(),
                                         integer("byteOffset", 0, maxInteger)};
inline constexpr Field sparse[] = {integer("count", 1, maxInteger).need(),
                                   object("indices", sparseIndices).need(),
                                   object("values", sparseValues).need()};
inline constexpr Field accessor[] = {index("bufferView", "/bufferViews"),
                                     integer("byteOffset", 0, maxByte),
                                     integer("componentType", 5120, 5126).need(),
                                     boolean("normalized"),
                                     integer("count", 1, maxByte).need(),
                                     string("type").need(),
                                     name(),
                                     object("sparse", sparse)};
inline constexpr Field meshopt[] = {index("buffer", "/buffers").need(),
                                    integer("byteOffset", 0, maxByte),
                                    integer("byteLength", 1, maxByte).need(),
                                    integer("byteStride", 1, 256).need(),
                                    integer("count", 1, maxInteger).need(),
                                    string("mode").need(),
                                    string("filter")};
inline constexpr Field bufferViewExtensions[] = {object("EXT_meshopt_compression", meshopt),
                                                 object("KHR_meshopt_compression", meshopt)};
inline constexpr Field bufferView[] = {index("buffer", "/buffers").need(),
                                       integer("byteOffset", 0, maxByte),
                                       integer("byteLength", 1, maxByte).need(),
                                       integer("byteStride", 4, 252),
                                       name(),
                                       object("extensions", bufferViewExtensions)};
inline constexpr Field fallback[] = {boolean("fallback")};
inline constexpr Field bufferExtensions[] = {object("EXT_meshopt_compression", fallback),
                                             object("KHR_meshopt_compression", fallback)};
inline constexpr Field buffer[] = {integer("byteLength", 1, maxByte).need(), string("uri"), name(),
                                   object("extensions", bufferExtensions)};

// --- textures and materials
inline constexpr const char* noTexture = "the texture is left out";
inline constexpr Field image[] = {string("uri"), string("mimeType").orElse("it is not needed"),
                                  name(), index("bufferView", "/bufferViews")};
inline constexpr Field sampler[] = {
    integer("magFilter", 0, maxInteger).orElse("texels are interpolated"),
    integer("wrapS", 0, maxInteger).orElse("10497 (repeat) is used"),
    integer("wrapT", 0, maxInteger).orElse("10497 (repeat) is used"), name()};
inline constexpr Field textureSource[] = {index("source", "/images").need()};
inline constexpr Field textureSources[] = {object("EXT_texture_webp", textureSource)};
inline constexpr Field texture[] = {index("sampler", "/samplers").orElse("the texture repeats"),
                                    index("source", "/images"), name(),
                                    object("extensions", textureSources)};
inline constexpr Field textureTransform[] = {
    numbers("offset", 2).orElse("0, 0 is used"), number("rotation").orElse("0 is used"),
    numbers("scale", 2).orElse("1, 1 is used"),
    integer("texCoord", 0, maxInteger).orElse("the texCoord of the texture is used")};
inline constexpr Field textureExtensions[] = {extension("KHR_texture_transform", textureTransform)};
inline constexpr Field textureInfo[] = {index("index", "/textures").need(),
                                        integer("texCoord", 0, maxInteger).orElse("0 is used"),
                                        number("scale").orElse("1 is used"),    // normal textures
                                        number("strength").orElse("1 is used"), // occlusion
                                        extensions(textureExtensions)};
constexpr Field textureOf(std::string_view n)
{
    return object(n, textureInfo).orElse(noTexture);
}
constexpr Field factor(std::string_view n, const char* otherwise = "1 is used")
{
    return number(n, unitInterval).clamped(otherwise);
}
inline constexpr const char* white = "1, 1, 1 is used";
inline constexpr Field metallicRoughness[] = {
    numbers("baseColorFactor", 4, unitInterval).clamped("1, 1, 1, 1 is used"),
    textureOf("baseColorTexture"), factor("metallicFactor"), factor("roughnessFactor"),
    textureOf("metallicRoughnessTexture")};
inline constexpr Field emissiveStrength[] = {
    number("emissiveStrength", notNegative).clamped("1 is used")};
inline constexpr Field ior[] = {number("ior", notNegative).orElse("1.5 is used")};
inline constexpr Field specular[] = {
    factor("specularFactor"), numbers("specularColorFactor", 3, notNegative).clamped(white),
    textureOf("specularTexture"), textureOf("specularColorTexture")};
inline constexpr Field transmission[] = {factor("transmissionFactor", "0 is used"),
                                         textureOf("transmissionTexture")};
inline constexpr Field volume[] = {number("thicknessFactor", notNegative).clamped("0 is used")};
inline constexpr Field unlit[] = {name()};
inline constexpr Field specularGlossiness[] = {
    numbers("diffuseFactor", 4, unitInterval).clamped("1, 1, 1, 1 is used"),
    textureOf("diffuseTexture"), numbers("specularFactor", 3, unitInterval).clamped(white),
    factor("glossinessFactor"), textureOf("specularGlossinessTexture")};
inline constexpr Field materialExtensions[] = {
    extension("KHR_materials_emissive_strength", emissiveStrength),
    extension("KHR_materials_ior", ior),
    extension("KHR_materials_specular", specular),
    extension("KHR_materials_transmission", transmission),
    extension("KHR_materials_volume", volume),
    extension("KHR_materials_unlit", unlit),
    extension("KHR_materials_pbrSpecularGlossiness", specularGlossiness)};
inline constexpr Field material[] = {
    name(),
    object("pbrMetallicRoughness", metallicRoughness).orElse("its default is used"),
    textureOf("normalTexture"),
    textureOf("occlusionTexture"),
    textureOf("emissiveTexture"),
    numbers("emissiveFactor", 3, NumberRange{unitInterval.min}).clamped("0, 0, 0 is used"),
    string("alphaMode").orElse("OPAQUE is used"),
    number("alphaCutoff", notNegative).clamped("0.5 is used"),
    boolean("doubleSided").orElse("false is used"),
    extensions(materialExtensions)};

// --- meshes, nodes, cameras, lights
inline constexpr Field draco[] = {index("bufferView", "/bufferViews").need(),
                                  Field{"attributes", Kind::IntegerMap, true, {0, maxInteger}}};
inline constexpr Field primitiveExtensions[] = {object("KHR_draco_mesh_compression", draco)};
inline constexpr Field primitive[] = {
    index("attributes", "/accessors", Kind::IndexMap).need(),
    index("indices", "/accessors"),
    index("material", "/materials").orElse("the default material is used"),
    integer("mode", 0, 6),
    index("targets", "/accessors", Kind::IndexMaps),
    object("extensions", primitiveExtensions)};
inline constexpr Field mesh[] = {
    objects("primitives", primitive).need().orElse("the primitive is left out"),
    anyNumbers("weights", coordinate).orElse("weights of 0 are used"), name()};
inline constexpr Field skin[] = {index("joints", "/nodes", Kind::Indices).need(),
                                 index("inverseBindMatrices", "/accessors"), name()};
inline constexpr Field lightReference[] = {
    index("light", "/extensions/KHR_lights_punctual/lights").need()};
inline constexpr Field areaReference[] = {
    index("light", "/extensions/KHR_lights_area/lights").need()};
inline constexpr Field instancing[] = {index("attributes", "/accessors", Kind::IndexMap).need()};
inline constexpr Field nodeExtensions[] = {
    object("KHR_lights_punctual", lightReference).orElse("the node has no light"),
    object("KHR_lights_area", areaReference).orElse("the node has no light"),
    object("EXT_mesh_gpu_instancing", instancing).orElse("the mesh is drawn once")};
inline constexpr Field node[] = {
    index("camera", "/cameras").orElse("the node has no camera"),
    index("mesh", "/meshes").orElse("the node has no mesh"),
    index("skin", "/skins").orElse("the node has no skin"),
    index("children", "/nodes", Kind::Indices).orElse("it is left out"),
    numbers("matrix", 16, coordinate),
    numbers("rotation", 4, coordinate).orElse("no rotation is used"),
    numbers("scale", 3, coordinate).orElse(white),
    numbers("translation", 3, coordinate).orElse("0, 0, 0 is used"),
    anyNumbers("weights", coordinate).orElse("the weights of the mesh are used"),
    name(),
    object("extensions", nodeExtensions)};
inline constexpr Field sceneFields[] = {
    index("nodes", "/nodes", Kind::Indices).orElse("it is left out"), name()};
inline constexpr Field perspective[] = {
    number("yfov", NumberRange::positive(3.14159)).need(),
    number("znear", NumberRange::positive(maxCoordinate)).need().orFill("0.001", "0.001 is used"),
    number("zfar", NumberRange::positive(maxCoordinate)).orElse("the far plane is at infinity"),
    number("aspectRatio", NumberRange::positive(1e6)).orElse("that of the picture is used")};
inline constexpr Field orthographic[] = {
    number("xmag", coordinate).need(), number("ymag", coordinate).need(),
    number("zfar", NumberRange::positive(maxCoordinate)).need().orFill("1e12", "1e+12 is used"),
    number("znear", {0, maxCoordinate}).need().orFill("0", "0 is used")};
inline constexpr Field camera[] = {string("type").need(), name(),
                                   object("perspective", perspective),
                                   object("orthographic", orthographic)};
inline constexpr const char* noRange = "the light has no range";
inline constexpr Field spot[] = {number("innerConeAngle", notNegative).clamped("0 is used"),
                                 number("outerConeAngle", notNegative).orElse("pi/4 is used")};
inline constexpr Field punctual[] = {
    string("type").need(),
    name(),
    numbers("color", 3, notNegative).clamped(white),
    number("intensity", notNegative).clamped("1 is used"),
    number("range", NumberRange::positive(maxCoordinate)).orElse(noRange),
    object("spot", spot).orFill("{}", "the default cone is used, with angles of 0 and pi/4")};
inline constexpr Field area[] = {
    string("shape"),
    string("type"), // the name of "shape" in an earlier draft
    name(),
    numbers("color", 3, notNegative).clamped(white),
    number("intensity", notNegative).clamped("1 is used"),
    number("radius", NumberRange::positive(maxCoordinate)).orElse("1 is used"),
    number("width", NumberRange::positive(maxCoordinate)).orElse("1 is used"),
    number("height", NumberRange::positive(maxCoordinate)).orElse("1 is used"),
    number("range", NumberRange::positive(maxCoordinate)).orElse(noRange)};
inline constexpr Field lightList[] = {list("lights").need()};
inline constexpr const char* noLights = "the file has no such lights";
inline constexpr Field rootExtensions[] = {
    object("KHR_lights_punctual", lightList).orElse(noLights),
    object("KHR_lights_area", lightList).orElse(noLights)};

inline constexpr Field asset[] = {string("version").need(), string("minVersion"),
                                  string("generator").orElse("it is not needed"),
                                  string("copyright").orElse("it is not needed")};
inline constexpr Field root[] = {object("asset", asset).need(),
                                 extensions(rootExtensions),
                                 list("extensionsUsed").orElse("it is not needed"),
                                 list("extensionsRequired"),
                                 index("scene", "/scenes").orElse("the first scene is drawn"),
                                 list("animations").orElse("there are no animations")};

// The arrays whose elements others refer to, in an order in which references, but for those of
// nodes to one another, point to arrays before.
struct Array {
    const char* pointer; // JSON pointer
    const char* path;    // as messages name it
    std::span<const Field> fields;
    // Says what happens without an element that is wrong and used; nullptr: the file is refused.
    const char* instead;
    const char* stub; // what takes the place of an element that is wrong
};
inline constexpr const char* noUser = "what uses it is left out";
inline constexpr Array arrays[] = {
    {"/buffers", "buffers", buffer, nullptr, R"({"byteLength": 1, "uri": "data:;base64,AAAA"})"},
    {"/bufferViews", "bufferViews", bufferView, noUser, R"({"buffer": 0, "byteLength": 1})"},
    {"/accessors", "accessors", accessor, noUser,
     R"({"componentType": 5126, "count": 1, "type": "SCALAR"})"},
    {"/images", "images", image, noTexture, "{}"},
    {"/samplers", "samplers", sampler, "the default sampler is used", "{}"},
    {"/textures", "textures", texture, noTexture, "{}"},
    {"/materials", "materials", material, "the default material is used", "{}"},
    {"/meshes", "meshes", mesh, "the mesh is left out", R"({"primitives": []})"},
    {"/cameras", "cameras", camera, "the camera is left out",
     R"({"type": "perspective", "perspective": {"yfov": 1, "znear": 1}})"},
    {"/extensions/KHR_lights_punctual/lights", "extensions.KHR_lights_punctual.lights", punctual,
     "the light is left out", R"({"type": "point"})"},
    {"/extensions/KHR_lights_area/lights", "extensions.KHR_lights_area.lights", area,
     "the light is left out", R"({"shape": "sphere"})"},
    {"/skins", "skins", skin, "the skin is left out", R"({"joints": [0]})"},
    {"/nodes", "nodes", node, nullptr, "{}"},
    {"/scenes", "scenes", sceneFields, nullptr, "{}"}};

} // namespace candelabra::app::schema
