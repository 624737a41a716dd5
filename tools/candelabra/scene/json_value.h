// SPDX-License-Identifier: Apache-2.0
// A JSON value that knows where it came from, so that every complaint names file and element:
// "scene.json: lights[3].radius: must be > 0, is -1". Everything throws SceneError.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

namespace candelabra::app
{

// Closed range, or half open at `min`.
struct NumberRange {
    double min = -static_cast<double>(std::numeric_limits<float>::max());
    double max = static_cast<double>(std::numeric_limits<float>::max());
    bool minExcluded = false;

    static constexpr NumberRange positive(double max = std::numeric_limits<float>::max())
    {
        return {0, max, true};
    }
    constexpr bool contains(double x) const
    {
        return (minExcluded ? x > min : x >= min) && x <= max;
    }
    // What x should have been: "> 0", "between 0 and 1", ...
    std::string text(double x) const;
};

// Borrows the document and the file name; both must outlive it.
class JsonValue
{
public:
    JsonValue(const std::string& file, const nlohmann::json& value, std::string path = "");

    const nlohmann::json& json() const { return *value_; }
    const std::string& path() const { return path_; }
    [[noreturn]] void fail(const std::string& reason) const;

    // Objects. member() fails when the key is missing.
    void requireObject() const;
    JsonValue member(const std::string& key) const;
    std::optional<JsonValue> find(const std::string& key) const;
    void refuseOtherKeys(const std::vector<std::string>& known) const;

    // Arrays.
    void requireArray() const;
    size_t size() const { return value_->size(); }
    JsonValue item(size_t i) const;

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
