// SPDX-License-Identifier: Apache-2.0
// Tables of the properties of glTF 2.0 that the loader reads: their types, ranges and, for indices,
// the array that they point into. Properties that are not listed are not read. Internal to the glTF
// loader.
#pragma once

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
    Index,    // an integer, an index into the array `target`
    Object,   // an object with the members `fields`
    Numbers,  // an array of minItems to maxItems numbers
    Indices,  // an array of indices into `target`
    Objects,  // an array of objects with the members `fields`
    IndexMap, // an object whose values are indices into `target`
    List      // any array
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
constexpr Field list(std::string_view n)
{
    return {n, Kind::List};
}
constexpr Field numbers(std::string_view n, size_t count, NumberRange r = {})
{
    return {n, Kind::Numbers, false, r, count, count};
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
                                     string("name"),
                                     object("sparse", sparse)};
inline constexpr Field bufferView[] = {
    index("buffer", "/buffers").need(), integer("byteOffset", 0, maxByte),
    integer("byteLength", 1, maxByte).need(), integer("byteStride", 4, 252), string("name")};
inline constexpr Field buffer[] = {integer("byteLength", 1, maxByte).need(), string("uri"),
                                   string("name")};

// --- textures and materials
inline constexpr Field image[] = {string("uri"), string("mimeType"), string("name"),
                                  index("bufferView", "/bufferViews")};
inline constexpr Field sampler[] = {integer("magFilter", 0, maxInteger),
                                    integer("wrapS", 0, maxInteger),
                                    integer("wrapT", 0, maxInteger), string("name")};
inline constexpr Field texture[] = {index("sampler", "/samplers"), index("source", "/images"),
                                    string("name")};
inline constexpr Field textureTransform[] = {numbers("offset", 2), number("rotation"),
                                             numbers("scale", 2),
                                             integer("texCoord", 0, maxInteger)};
inline constexpr Field textureExtensions[] = {object("KHR_texture_transform", textureTransform)};
inline constexpr Field textureInfo[] = {index("index", "/textures").need(),
                                        integer("texCoord", 0, maxInteger),
                                        number("scale"),    // normal textures
                                        number("strength"), // occlusion textures
                                        object("extensions", textureExtensions)};
inline constexpr Field metallicRoughness[] = {
    numbers("baseColorFactor", 4, unitInterval), object("baseColorTexture", textureInfo),
    number("metallicFactor", unitInterval), number("roughnessFactor", unitInterval),
    object("metallicRoughnessTexture", textureInfo)};
inline constexpr Field emissiveStrength[] = {number("emissiveStrength", notNegative)};
inline constexpr Field ior[] = {number("ior", notNegative)};
inline constexpr Field specular[] = {
    number("specularFactor", unitInterval), numbers("specularColorFactor", 3, notNegative),
    object("specularTexture", textureInfo), object("specularColorTexture", textureInfo)};
inline constexpr Field unlit[] = {string("name")};
inline constexpr Field materialExtensions[] = {
    object("KHR_materials_emissive_strength", emissiveStrength), object("KHR_materials_ior", ior),
    object("KHR_materials_specular", specular), object("KHR_materials_unlit", unlit)};
inline constexpr Field material[] = {string("name"),
                                     object("pbrMetallicRoughness", metallicRoughness),
                                     object("normalTexture", textureInfo),
                                     object("occlusionTexture", textureInfo),
                                     object("emissiveTexture", textureInfo),
                                     numbers("emissiveFactor", 3, unitInterval),
                                     string("alphaMode"),
                                     number("alphaCutoff", notNegative),
                                     boolean("doubleSided"),
                                     object("extensions", materialExtensions)};

// --- meshes, nodes, cameras, lights
inline constexpr Field primitive[] = {
    index("attributes", "/accessors", Kind::IndexMap).need(), index("indices", "/accessors"),
    index("material", "/materials"), integer("mode", 0, 6), list("targets")};
inline constexpr Field mesh[] = {objects("primitives", primitive).need(), string("name")};
inline constexpr Field lightReference[] = {
    index("light", "/extensions/KHR_lights_punctual/lights").need()};
inline constexpr Field areaReference[] = {
    index("light", "/extensions/KHR_lights_area/lights").need()};
inline constexpr Field nodeExtensions[] = {object("KHR_lights_punctual", lightReference),
                                           object("KHR_lights_area", areaReference)};
inline constexpr Field node[] = {index("camera", "/cameras"),
                                 index("mesh", "/meshes"),
                                 index("skin", "/skins"),
                                 index("children", "/nodes", Kind::Indices),
                                 numbers("matrix", 16, coordinate),
                                 numbers("rotation", 4, coordinate),
                                 numbers("scale", 3, coordinate),
                                 numbers("translation", 3, coordinate),
                                 string("name"),
                                 object("extensions", nodeExtensions)};
inline constexpr Field sceneFields[] = {index("nodes", "/nodes", Kind::Indices), string("name")};
inline constexpr Field perspective[] = {
    number("yfov", NumberRange::positive(3.14159)).need(),
    number("znear", NumberRange::positive(maxCoordinate)).need(),
    number("zfar", NumberRange::positive(maxCoordinate)),
    number("aspectRatio", NumberRange::positive(1e6))};
inline constexpr Field orthographic[] = {
    number("xmag", coordinate).need(), number("ymag", coordinate).need(),
    number("zfar", NumberRange::positive(maxCoordinate)).need(),
    number("znear", {0, maxCoordinate}).need()};
inline constexpr Field camera[] = {string("type").need(), string("name"),
                                   object("perspective", perspective),
                                   object("orthographic", orthographic)};
inline constexpr Field spot[] = {number("innerConeAngle"), number("outerConeAngle")};
inline constexpr Field punctual[] = {string("type").need(),
                                     string("name"),
                                     numbers("color", 3, notNegative),
                                     number("intensity", notNegative),
                                     number("range", NumberRange::positive(maxCoordinate)),
                                     object("spot", spot)};
inline constexpr Field punctualLights[] = {objects("lights", punctual).need()};
inline constexpr Field area[] = {string("shape"),
                                 string("type"), // the name of "shape" in an earlier draft
                                 string("name"),
                                 numbers("color", 3, notNegative),
                                 number("intensity", notNegative),
                                 number("radius", NumberRange::positive(maxCoordinate)),
                                 number("range", NumberRange::positive(maxCoordinate))};
inline constexpr Field areaLights[] = {objects("lights", area).need()};
inline constexpr Field rootExtensions[] = {object("KHR_lights_punctual", punctualLights),
                                           object("KHR_lights_area", areaLights)};

inline constexpr Field asset[] = {string("version").need(), string("minVersion"),
                                  string("generator"), string("copyright")};
inline constexpr Field root[] = {object("asset", asset).need(),
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
                                 list("skins")};

} // namespace candelabra::app::schema
