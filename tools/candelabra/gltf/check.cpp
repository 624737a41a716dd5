// SPDX-License-Identifier: Apache-2.0
// Checks and repairs the JSON of a glTF file before tinygltf reads it, because tinygltf ignores
// properties of the wrong type and truncates large integers.
//
// One wrong value does not lose a file. schema.h names the replacement of a value that is not
// needed. A wrong element is left out, unless it is used and schema.h says that the file is refused
// without it. An empty element then takes its place in the array, so indices stay valid.
// Primitives, and items of lists of indices, are removed instead. Each time a warning names the
// element, the value and the replacement.
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include "gltf/document.h"
#include "gltf/schema.h"
#include "scene/scene_error.h"

namespace candelabra::app
{

namespace
{

using schema::Field;
using schema::Kind;
using Json = nlohmann::json;

// Thrown for a reference to an element that is left out, of which a warning has told already.
struct LeftOut {
};

// Calls found(target, index) for every index in a value that is not checked yet.
void visitIndices(const Json& value, std::span<const Field> fields, const auto& found)
{
    if (!value.is_object())
        return;
    for (const Field& field : fields) {
        const auto member = value.find(field.name);
        if (member == value.end())
            continue;
        const auto reference = [&](const Json& index) {
            if (index.is_number() && index.get<double>() >= 0 &&
                index.get<double>() <= schema::maxInteger)
                found(field.target, size_t(index.get<double>()));
        };
        if (field.kind == Kind::Index)
            reference(*member);
        else if (field.kind == Kind::Object)
            visitIndices(*member, field.fields, found);
        else
            for (const Json& item : *member)
                if (field.kind == Kind::Indices || field.kind == Kind::IndexMap)
                    reference(item);
                else if (field.kind == Kind::IndexMaps)
                    std::ranges::for_each(item, reference);
                else if (field.kind == Kind::Objects)
                    visitIndices(item, field.fields, found);
    }
}

// Finds the elements that the drawn scene uses, in a document that is not checked yet.
class UseFinder
{
public:
    explicit UseFinder(const Json& document) : document_(document) {}
    GltfUse find();

private:
    void use(const char* array, size_t index);
    const Json* list(const char* array) const;

    const Json& document_;
    GltfUse used_;
    std::vector<std::pair<const char*, size_t>> open_;
};

const Json* UseFinder::list(const char* array) const
{
    const Json::json_pointer pointer(array);
    return document_.contains(pointer) && document_[pointer].is_array() ? &document_[pointer]
                                                                        : nullptr;
}

void UseFinder::use(const char* array, size_t index)
{
    const Json* elements = list(array);
    if (elements && index < elements->size() && used_[array].insert(index).second)
        open_.emplace_back(array, index);
}

GltfUse UseFinder::find()
{
    const Json* nodes = list("/nodes");
    // The transforms of a node depend on its ancestors, even if those are not drawn.
    std::multimap<size_t, size_t> parents;
    for (size_t i = 0; nodes && i < nodes->size(); ++i)
        visitIndices((*nodes)[i], schema::node, [&](std::string_view target, size_t index) {
            if (target == "/nodes")
                parents.emplace(index, i);
        });
    if (const Json* scenes = list("/scenes"); scenes && !scenes->empty()) {
        size_t drawn = 0;
        visitIndices(document_, schema::root, [&](const char*, size_t scene) {
            if (scene < scenes->size())
                drawn = scene;
        });
        use("/scenes", drawn);
    } else {
        for (size_t i = 0; nodes && i < nodes->size(); ++i)
            use("/nodes", i);
    }
    while (!open_.empty()) {
        const auto [array, index] = open_.back();
        open_.pop_back();
        for (const schema::Array& one : schema::arrays)
            if (one.pointer == std::string_view(array))
                visitIndices((*list(array))[index], one.fields,
                             [&](const char* target, size_t i) { use(target, i); });
        if (array == std::string_view("/nodes")) {
            const auto [first, last] = parents.equal_range(index);
            for (auto parent = first; parent != last; ++parent)
                use("/nodes", parent->second);
        }
    }
    return used_;
}

class Repairer
{
public:
    Repairer(const std::string& file, Json& document, LoadWarnings& warnings)
        : file_(file), document_(document), warnings_(warnings), used_(UseFinder(document).find())
    {
    }
    GltfUse repair();
    // The first fault that may have lost a mesh.
    const std::optional<SceneError>& lostMesh() const { return lostMesh_; }

private:
    JsonValue at(const Json& value, const std::string& path) const
    {
        return JsonValue(file_, value, path);
    }

    void noteLostMesh(const SceneError& error)
    {
        if (!lostMesh_)
            lostMesh_ = error;
    }
    void repairArray(const schema::Array& array);
    void repairElement(const schema::Array& array, Json& element, size_t index);
    void repairObject(Json& value, const std::string& path, std::span<const Field> fields);
    // Returns false if the value is not to be used, and throws if that makes its owner wrong.
    bool keeps(Json& value, const std::string& path, const Field& field);
    void repairValue(Json& value, const std::string& path, const Field& field);
    void repairList(Json& value, const std::string& path, const Field& field);
    void repairNumber(Json& value, const std::string& path, const Field& field);
    void repairInteger(Json& value, const std::string& path, const NumberRange& range);
    void repairIndex(Json& value, const std::string& path, const char* target);
    void repairMap(Json& value, const std::string& path, const Field& field);

    // Rules that the tables of schema.h cannot express.
    void repairVersion();
    void repairBySpecialRules(const schema::Array& array, Json& element, const std::string& path);
    void repairChoice(Json& owner, const std::string& path, const char* key, const char* instead,
                      std::initializer_list<Json> allowed);
    void repairBufferView(Json& view, const std::string& path);
    void repairLight(Json& light, const std::string& path);

    const std::string& file_;
    Json& document_;
    LoadWarnings& warnings_;
    GltfUse used_;
    std::set<std::pair<std::string_view, size_t>> leftOut_; // array and index
    std::optional<SceneError> lostMesh_;
};

void Repairer::repairInteger(Json& value, const std::string& path, const NumberRange& range)
{
    // glTF allows integers to be written as 1.0 or 1e0.
    if (value.is_number_float()) {
        const double x = value.get<double>();
        if (std::abs(x) <= schema::maxByte && x == std::floor(x)) {
            const auto whole = int64_t(x);
            warnings_.addOfKind("integer", path,
                                "is an integer that is written as " + value.dump() + "; " +
                                    std::to_string(whole) + " is used");
            value = whole;
        }
    }
    at(value, path).integer(int64_t(range.min), int64_t(range.max));
}

void Repairer::repairIndex(Json& value, const std::string& path, const char* target)
{
    repairInteger(value, path, {0, schema::maxInteger});
    const Json::json_pointer pointer(target);
    const size_t size = document_.contains(pointer) ? document_[pointer].size() : 0;
    const size_t index = value.get<size_t>();
    if (index >= size)
        at(value, path)
            .fail("is " + std::to_string(index) + ", but there are " + std::to_string(size) + " " +
                  pointer.back());
    if (leftOut_.contains({target, index}))
        throw LeftOut();
}

void Repairer::repairMap(Json& value, const std::string& path, const Field& field)
{
    at(value, path).requireObject();
    for (const auto& entry : value.items()) {
        const std::string entryPath = path + "." + entry.key();
        if (field.kind == Kind::IntegerMap)
            repairInteger(entry.value(), entryPath, field.range);
        else
            repairIndex(entry.value(), entryPath, field.target);
    }
}

void Repairer::repairNumber(Json& value, const std::string& path, const Field& field)
{
    const NumberRange& range = field.range;
    if (field.clamps && value.is_number() && !range.contains(value.get<double>())) {
        const double x = value.get<double>(), end = x < range.min ? range.min : range.max;
        // An end that only says what a float can hold is no replacement.
        if (std::abs(end) < NumberRange{}.max) {
            std::ostringstream used;
            used << std::round(end) + 0.0; // without the sign of zero
            warnings_.add(path, "must be " + range.text(x) + ", is " + value.dump() + "; " +
                                    used.str() + " is used");
            value = std::round(end) + 0.0;
            return;
        }
    }
    at(value, path).number(range);
}

void Repairer::repairList(Json& value, const std::string& path, const Field& field)
{
    at(value, path).requireArray();
    if (field.kind == Kind::Numbers &&
        (value.size() < field.minItems || value.size() > field.maxItems))
        at(value, path)
            .fail("must have " + std::to_string(field.minItems) + " numbers, has " +
                  std::to_string(value.size()));
    Json kept = Json::array();
    std::set<size_t> seen;
    Field item = field;
    item.kind = field.kind == Kind::Indices ? Kind::Index : Kind::Object;
    for (size_t i = 0; i < value.size(); ++i) {
        const std::string itemPath = path + "[" + std::to_string(i) + "]";
        if (field.kind == Kind::Numbers) {
            repairNumber(value[i], itemPath, field);
        } else if (field.kind == Kind::IndexMaps) {
            repairMap(value[i], itemPath, field);
        } else if (field.kind == Kind::Objects) {
            if (keeps(value[i], itemPath, item))
                kept.push_back(value[i]);
        } else if (field.kind == Kind::Indices) {
            if (!keeps(value[i], itemPath, item))
                continue;
            if (field.instead && !seen.insert(value[i].get<size_t>()).second)
                warnings_.add(itemPath, "is " + value[i].dump() + ", which is listed before; " +
                                            field.instead);
            else
                kept.push_back(value[i]);
        }
    }
    if (field.kind == Kind::Indices || field.kind == Kind::Objects)
        value = std::move(kept);
}

void Repairer::repairValue(Json& value, const std::string& path, const Field& field)
{
    switch (field.kind) {
    case Kind::Integer:
        return repairInteger(value, path, field.range);
    case Kind::Number:
        return repairNumber(value, path, field);
    case Kind::Boolean:
        at(value, path).boolean();
        return;
    case Kind::String:
        at(value, path).string();
        return;
    case Kind::Index:
        return repairIndex(value, path, field.target);
    case Kind::Object:
        return repairObject(value, path, field.fields);
    case Kind::IndexMap:
    case Kind::IntegerMap:
        return repairMap(value, path, field);
    default:
        return repairList(value, path, field);
    }
}

bool Repairer::keeps(Json& value, const std::string& path, const Field& field)
{
    try {
        repairValue(value, path, field);
        return true;
    } catch (const LeftOut&) {
        if (!field.instead)
            throw;
    } catch (const SceneError& error) {
        // "instead" is about the items of a list of objects, not about the list.
        if (!field.instead || field.kind == Kind::Objects)
            throw;
        warnings_.addInstead(file_, error, field.instead);
        if (field.fields.data() == schema::primitive)
            noteLostMesh(error);
    }
    return false;
}

void Repairer::repairObject(Json& value, const std::string& path, std::span<const Field> fields)
{
    at(value, path).requireObject();
    for (const Field& field : fields) {
        const std::string key(field.name), memberPath = path.empty() ? key : path + "." + key;
        const bool isNeeded = field.required && !field.fill;
        const auto instead = [&] { return field.instead ? std::string("; ") + field.instead : ""; };
        const auto member = value.find(key);
        if (member == value.end()) {
            if (!field.required)
                continue;
            if (isNeeded)
                at(value, path).member(key); // fails
            warnings_.add(path, '"' + key + "\" is missing" + instead());
        } else if (!member->is_null()) {
            if (keeps(*member, memberPath, field))
                continue;
        } else {
            if (isNeeded)
                at(*member, memberPath).fail("must not be null");
            warnings_.add(memberPath, "is null, which counts as missing" + instead());
        }
        value.erase(key);
        if (field.fill)
            value[key] = Json::parse(field.fill);
    }
}

void Repairer::repairElement(const schema::Array& array, Json& element, size_t index)
{
    const std::string path = gltfElement(array.path, index);
    const bool isUsed = used_[array.pointer].contains(index);
    // Lights of other types have no cone, whatever "spot" is.
    if (array.fields.data() == schema::punctual && element.is_object() &&
        element.value("type", Json()) != "spot")
        element.erase("spot");
    try {
        repairObject(element, path, array.fields);
        repairBySpecialRules(array, element, path);
        return;
    } catch (const LeftOut&) {
        if (isUsed && !array.instead)
            at(element, path).fail("needs an element that is left out");
    } catch (const SceneError& error) {
        if (isUsed && !array.instead)
            throw;
        const std::string_view kind = array.path;
        if (isUsed && (kind == "bufferViews" || kind == "accessors" || kind == "meshes"))
            noteLostMesh(error);
        warnings_.addInstead(file_, error,
                             isUsed ? array.instead : "nothing uses it, so it is left out");
    }
    element = Json::parse(array.stub);
    leftOut_.emplace(array.pointer, index);
}

void Repairer::repairArray(const schema::Array& array)
{
    const Json::json_pointer pointer(array.pointer);
    if (!document_.contains(pointer))
        return;
    Json& list = document_[pointer];
    if (list.is_null()) {
        warnings_.add(array.path, "is null, which counts as missing");
        document_[pointer.parent_pointer()].erase(pointer.back());
        return;
    }
    at(list, array.path).requireArray();
    for (size_t i = 0; i < list.size(); ++i)
        repairElement(array, list[i], i);
}

GltfUse Repairer::repair()
{
    at(document_, "").requireObject();
    repairVersion();
    repairObject(document_, "", schema::root);
    if (const auto names = document_.find("extensionsUsed"); names != document_.end())
        std::erase_if(names->get_ref<Json::array_t&>(), [&](const Json& name) {
            if (!name.is_string())
                warnings_.add("extensionsUsed", "has " + printable(name.dump(), 60) +
                                                    " in place of a name; it is left out");
            return !name.is_string();
        });
    for (const schema::Array& array : schema::arrays)
        repairArray(array);
    if (const auto animations = document_.find("animations");
        animations != document_.end() && !animations->empty())
        warnings_.add("",
                      "animations are not played; everything stands as the nodes of the file say");
    return used_;
}

// --- Rules that the tables of schema.h cannot express

// Checks that owner[key], if it is there, is one of these values. A wrong one is removed if
// `instead` says what is used then.
void Repairer::repairChoice(Json& owner, const std::string& path, const char* key,
                            const char* instead, std::initializer_list<Json> allowed)
{
    const auto found = owner.find(key);
    if (found == owner.end() || std::ranges::find(allowed, *found) != allowed.end())
        return;
    std::string names;
    for (const Json& one : allowed)
        names +=
            (names.empty() ? "" : ", ") + (one.is_string() ? one.get<std::string>() : one.dump());
    const std::string reason =
        "must be one of " + names + ", is " +
        (found->is_string() ? "\"" + printable(found->get<std::string>(), 60) + "\""
                            : found->dump());
    if (!instead)
        at(*found, path + "." + key).fail(reason);
    warnings_.add(path + "." + key, reason + "; " + instead);
    owner.erase(key);
}

void Repairer::repairBufferView(Json& view, const std::string& path)
{
    if (const auto stride = view.find("byteStride"); stride != view.end())
        if (stride->get<int64_t>() % 4 != 0)
            at(*stride, path + ".byteStride").fail("must be a multiple of 4, is " + stride->dump());
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
        if (view.contains("extensions") && view["extensions"].contains(name)) {
            const std::string extension = path + ".extensions." + name;
            Json& meshopt = view["extensions"][name];
            repairChoice(meshopt, extension, "mode", nullptr,
                         {"ATTRIBUTES", "TRIANGLES", "INDICES"});
            repairChoice(meshopt, extension, "filter", nullptr,
                         {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"});
        }
}

void Repairer::repairLight(Json& light, const std::string& path)
{
    repairChoice(light, path, "type", nullptr, {"directional", "point", "spot"});
    if (light["type"] == "spot" && !light.contains("spot")) {
        warnings_.add(path,
                      "is a spot without \"spot\"; its cone has the default angles 0 and pi/4");
        light["spot"] = Json::object();
    }
}

void Repairer::repairBySpecialRules(const schema::Array& array, Json& element,
                                    const std::string& path)
{
    const std::string_view kind = array.path;
    if (kind == "accessors") {
        repairChoice(element, path, "type", nullptr,
                     {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"});
        if (element["componentType"] == 5124)
            at(element, path + ".componentType")
                .fail("is 5124, which is not a component type of glTF 2.0");
    } else if (kind == "bufferViews") {
        repairBufferView(element, path);
    } else if (kind == "samplers") {
        for (const char* wrap : {"wrapS", "wrapT"})
            repairChoice(element, path, wrap, "10497 (repeat) is used", {33071, 33648, 10497});
    } else if (kind == "materials") {
        repairChoice(element, path, "alphaMode", "OPAQUE is used", {"OPAQUE", "MASK", "BLEND"});
    } else if (kind == "cameras") {
        repairChoice(element, path, "type", nullptr, {"perspective", "orthographic"});
        at(element, path).member(element["type"].get<std::string>());
    } else if (kind == "extensions.KHR_lights_punctual.lights") {
        repairLight(element, path);
    }
}

void Repairer::repairVersion()
{
    const JsonValue asset = at(document_, "").member("asset");
    for (const char* name : {"version", "minVersion"})
        if (const auto version = asset.find(name)) {
            // Files of version 1 may have a number here.
            const std::string text =
                version->json().is_number() ? version->json().dump() : version->string();
            const bool isTwo = text == "2" || text.starts_with("2.");
            const bool readable =
                name == std::string_view("version") ? isTwo : text == "2" || text == "2.0";
            if (!readable)
                version->fail("is " + printable(version->json().dump(), 20) +
                              "; only glTF 2.0 can be read" +
                              (text.starts_with("1") ? "; gltf-pipeline converts the file" : ""));
            if (version->json().is_number()) {
                warnings_.add(version->path(), "is a number, not text; \"2.0\" is used");
                document_["asset"][name] = "2.0";
            }
        }
}

} // namespace

void repairGltfJson(GltfDocument& document)
{
    Repairer repairer(document.file, document.json, document.warnings);
    document.used = repairer.repair();
    document.lostMesh = repairer.lostMesh();
}

} // namespace candelabra::app
