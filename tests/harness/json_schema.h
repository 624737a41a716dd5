// SPDX-License-Identifier: Apache-2.0
// A validator for the part of JSON Schema (2020-12) that tools/candelabra/schemas uses. Any other
// keyword in a schema is reported as a fault.
#pragma once

#include <algorithm>
#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

#include "harness/paths.h"

namespace candelabra::test
{

class JsonSchema
{
public:
    // `name`: file name of a schema in tools/candelabra/schemas.
    explicit JsonSchema(const std::string& name)
        : root_(
              nlohmann::json::parse(std::ifstream(sourcePath("tools/candelabra/schemas/" + name))))
    {
    }
    // Returns what is wrong with the value, and where; empty if it is valid.
    std::string fault(const nlohmann::json& value) const { return check(value, root_, "value"); }
    // As fault(), for a part of the schema such as "#/properties/points".
    std::string faultOfPart(const nlohmann::json& value, const std::string& place) const
    {
        return checkReference(value, place, "value");
    }
    // Returns a keyword of the schema that is not checked here; empty if there is none.
    std::string unknownKeyword() const { return unknownKeyword(root_); }
    // Returns the value that the member "schema" must have.
    std::string name() const { return root_.at("properties").at("schema").at("const"); }

private:
    static bool is(const nlohmann::json& value, const std::string& type)
    {
        return type == "object"    ? value.is_object()
               : type == "array"   ? value.is_array()
               : type == "string"  ? value.is_string()
               : type == "number"  ? value.is_number()
               : type == "integer" ? value.is_number_integer()
               : type == "boolean" ? value.is_boolean()
                                   : type == "null" && value.is_null();
    }
    static bool isAny(const nlohmann::json& value, const nlohmann::json& types)
    {
        return types.is_string() ? is(value, types)
                                 : std::any_of(types.begin(), types.end(),
                                               [&](const auto& t) { return is(value, t); });
    }

    std::string check(const nlohmann::json& value, const nlohmann::json& schema,
                      const std::string& at) const
    {
        for (const auto& [key, rule] : schema.items()) {
            std::string fault;
            if (key == "$ref")
                fault = checkReference(value, rule, at);
            else if (key == "type" && !isAny(value, rule))
                fault = at + ": is not " + rule.dump();
            else if (key == "const" && value != rule)
                fault = at + ": is not " + rule.dump();
            else if (key == "enum" && std::find(rule.begin(), rule.end(), value) == rule.end())
                fault = at + ": " + value.dump() + " is none of " + rule.dump();
            else if (key == "minimum" && value.is_number() && value < rule)
                fault = at + ": is below " + rule.dump();
            else if (key == "maximum" && value.is_number() && value > rule)
                fault = at + ": is above " + rule.dump();
            else if (key == "exclusiveMinimum" && value.is_number() && value <= rule)
                fault = at + ": is not above " + rule.dump();
            else if ((key == "minItems" && value.size() < rule.get<size_t>()) ||
                     (key == "maxItems" && value.size() > rule.get<size_t>()))
                fault = at + ": has " + std::to_string(value.size()) + " items";
            else if (key == "items" && value.is_array())
                for (size_t i = 0; i < value.size() && fault.empty(); ++i)
                    fault = check(value[i], rule, at + "[" + std::to_string(i) + "]");
            else if (key == "required" && value.is_object()) {
                for (const auto& name : rule)
                    if (fault.empty() && !value.contains(name.get<std::string>()))
                        fault = at + ": lacks " + name.dump();
            } else if (key == "properties" && value.is_object())
                fault = checkMembers(value, schema, at);
            else if (!known(key))
                fault = "the schema has " + key + ", which is not checked";
            if (!fault.empty())
                return fault;
        }
        return "";
    }

    // `reference` is "#/place" in this file or "file#/place" in another file.
    std::string checkReference(const nlohmann::json& value, const std::string& reference,
                               const std::string& at) const
    {
        const size_t hash = reference.find('#');
        if (hash > 0)
            return JsonSchema(reference.substr(0, hash))
                .checkReference(value, reference.substr(hash), at);
        const nlohmann::json::json_pointer place(reference.substr(1));
        return check(value, root_.at(place), at);
    }

    std::string checkMembers(const nlohmann::json& value, const nlohmann::json& schema,
                             const std::string& at) const
    {
        for (const auto& [name, member] : value.items()) {
            const auto rule = schema["properties"].find(name);
            if (rule != schema["properties"].end()) {
                if (const std::string fault = check(member, *rule, at + "." + name); !fault.empty())
                    return fault;
            } else if (schema.contains("additionalProperties")) { // the schemas use no other value
                                                                  // than false
                return at + ": has \"" + name + "\", which is not in the schema";
            }
        }
        return "";
    }

    static bool known(const std::string& key)
    {
        constexpr const char* keys[] = {"$schema",    "$defs",
                                        "$ref",       "title",
                                        "type",       "const",
                                        "enum",       "minimum",
                                        "items",      "required",
                                        "minItems",   "maxItems",
                                        "properties", "additionalProperties",
                                        "maximum",    "exclusiveMinimum",
                                        "description"};
        return std::find(std::begin(keys), std::end(keys), key) != std::end(keys);
    }

    static std::string unknownKeyword(const nlohmann::json& schema)
    {
        for (const auto& [key, rule] : schema.items()) {
            std::string found = known(key) ? "" : key;
            if (key == "items")
                found = unknownKeyword(rule);
            else if (key == "properties" || key == "$defs")
                for (const auto& [name, member] : rule.items())
                    if (found.empty())
                        found = unknownKeyword(member);
            if (!found.empty())
                return found;
        }
        return "";
    }

    nlohmann::json root_;
};

} // namespace candelabra::test
