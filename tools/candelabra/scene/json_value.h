// SPDX-License-Identifier: Apache-2.0
// A JSON value that knows its file and its place in it, so that every error message names them:
// "scene.json: lights[3].radius: must be > 0, is -1". All functions throw SceneError.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

namespace candelabra::app
{

// The range from `min` to `max`. Both ends belong to it, but `min` does not if minExcluded is true.
struct NumberRange {
    double min = -double(std::numeric_limits<float>::max());
    double max = double(std::numeric_limits<float>::max());
    bool minExcluded = false;

    static constexpr NumberRange positive(double max = std::numeric_limits<float>::max())
    {
        return {0, max, true};
    }
    constexpr bool contains(double x) const
    {
        return (minExcluded ? x > min : x >= min) && x <= max;
    }
    // Says what x, which is not in the range, should have been: "> 0", "between 0 and 1", ...
    std::string text(double x) const;
};

// Refers to the document and the file name that it is constructed with; both must outlive it.
class JsonValue
{
public:
    JsonValue(const std::string& file, const nlohmann::json& value, std::string path = "");

    const nlohmann::json& json() const { return *value_; }
    const std::string& file() const { return *file_; }
    const std::string& path() const { return path_; }
    [[noreturn]] void fail(const std::string& reason) const;

    // For objects. find() is empty if the key is missing; member() fails.
    void requireObject() const;
    JsonValue member(const std::string& key) const;
    std::optional<JsonValue> find(const std::string& key) const;
    void refuseOtherKeys(const std::vector<std::string>& known) const;

    // For arrays.
    void requireArray() const;
    size_t size() const { return value_->size(); }
    JsonValue item(size_t i) const;

    // The value as a type. They fail if it has another type or, for numbers, is out of range.
    double number(const NumberRange& range = {}) const;
    int64_t integer(int64_t min, int64_t max) const;
    bool boolean() const;
    const std::string& string() const;
    glm::dvec3 vector3(const NumberRange& range = {}) const; // [x, y, z]

private:
    [[noreturn]] void failType(const std::string& wanted) const;

    const std::string* file_;
    const nlohmann::json* value_;
    std::string path_;
};

} // namespace candelabra::app
