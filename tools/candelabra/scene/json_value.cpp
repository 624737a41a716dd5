// SPDX-License-Identifier: Apache-2.0
#include "scene/json_value.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "scene/scene_file.h"

namespace candelabra::app
{

namespace
{

std::string numberText(double x)
{
    std::ostringstream s;
    s.precision(9);
    s << x;
    return s.str();
}

// The value as it is written in the file, cut to a length that fits into a sentence.
std::string describeValue(const nlohmann::json& value)
{
    if (value.is_object())
        return "an object";
    if (value.is_array())
        return "an array of " + std::to_string(value.size());
    using Handler = nlohmann::json::error_handler_t;
    return printable(value.dump(-1, ' ', true, Handler::replace), 60);
}

} // namespace

std::string NumberRange::text(double x) const
{
    // Names only the exceeded bound if the other is so large that no one would exceed it.
    constexpr double distracting = 1e9;
    const bool isLow = minExcluded ? x <= min : x < min;
    if (isLow && max >= distracting)
        return (minExcluded ? "> " : ">= ") + numberText(min);
    if (!isLow && min <= -distracting)
        return "<= " + numberText(max);
    if (minExcluded)
        return "> " + numberText(min) + " and <= " + numberText(max);
    return "between " + numberText(min) + " and " + numberText(max);
}

JsonValue::JsonValue(const std::string& file, const nlohmann::json& value, std::string path)
    : file_(&file), value_(&value), path_(std::move(path))
{
}

void JsonValue::fail(const std::string& reason) const
{
    failScene(*file_, path_, reason);
}

void JsonValue::failType(const std::string& wanted) const
{
    fail("must be " + wanted + ", is " + describeValue(*value_));
}

void JsonValue::requireObject() const
{
    if (!value_->is_object())
        failType("an object");
}

void JsonValue::requireArray() const
{
    if (!value_->is_array())
        failType("an array");
}

std::optional<JsonValue> JsonValue::find(const std::string& key) const
{
    requireObject();
    const auto it = value_->find(key);
    if (it == value_->end())
        return std::nullopt;
    return JsonValue(*file_, *it, path_.empty() ? key : path_ + "." + key);
}

JsonValue JsonValue::member(const std::string& key) const
{
    std::optional<JsonValue> found = find(key);
    if (!found)
        fail("\"" + key + "\" is missing");
    return *found;
}

void JsonValue::refuseOtherKeys(const std::vector<std::string>& known) const
{
    requireObject();
    for (const auto& [key, value] : value_->items())
        if (std::ranges::find(known, key) == known.end())
            fail(fmt::format("unknown key \"{}\"; the known ones are {}", printable(key, 60),
                             fmt::join(known, ", ")));
}

JsonValue JsonValue::item(size_t i) const
{
    return JsonValue(*file_, value_->at(i), path_ + "[" + std::to_string(i) + "]");
}

double JsonValue::number(const NumberRange& range) const
{
    if (!value_->is_number())
        failType("a number");
    const double x = value_->get<double>();
    if (!range.contains(x))
        failType(range.text(x));
    return x;
}

int64_t JsonValue::integer(int64_t min, int64_t max) const
{
    const std::string wanted =
        "an integer between " + std::to_string(min) + " and " + std::to_string(max);
    if (value_->is_number_float()) { // JSON does not tell 2.0 from 2
        const double x = value_->get<double>();
        if (x != std::floor(x) || x < double(min) || x > double(max))
            failType(wanted);
        return int64_t(x);
    }
    if (!value_->is_number_integer())
        failType(wanted);
    // Unsigned numbers beyond int64 would wrap in get<int64_t>().
    if (value_->is_number_unsigned() && value_->get<uint64_t>() > uint64_t(max))
        failType(wanted);
    const int64_t x = value_->get<int64_t>();
    if (x < min || x > max)
        failType(wanted);
    return x;
}

bool JsonValue::boolean() const
{
    if (!value_->is_boolean())
        failType("true or false");
    return value_->get<bool>();
}

const std::string& JsonValue::string() const
{
    if (!value_->is_string())
        failType("a string");
    return value_->get_ref<const std::string&>();
}

glm::dvec3 JsonValue::vector3(const NumberRange& range) const
{
    if (!value_->is_array() || value_->size() != 3)
        failType("an array of 3 numbers");
    glm::dvec3 v;
    for (int i = 0; i < 3; ++i)
        v[i] = item(size_t(i)).number(range);
    return v;
}

} // namespace candelabra::app
