// SPDX-License-Identifier: Apache-2.0
#include "measure/profile/run_file.h"

#include <filesystem>

#include <fmt/format.h>

#include "measure/profile/profile_frames.h"
#include "scene/json_value.h"
#include "scene/scene_file.h"

namespace candelabra::app
{
namespace
{

ProfiledRun readRun(const std::string& path, const JsonValue& json)
{
    const JsonValue schema = json.member("schema");
    if (schema.string() != profileSchema)
        schema.fail(fmt::format("must be \"{}\", as candelabra profile writes it", profileSchema));
    ProfiledRun out{.where = json.path().empty() ? path : path + ": " + json.path()};
    const JsonValue from = json.member("provenance");
    for (const char* key : {"device", "driver"})
        out.conditions.emplace_back(key, from.member(key).string());
    for (const char* key : {"scene", "image", "path"})
        out.conditions.emplace_back(key, json.member(key).json().dump());
    const auto inFlight = json.find("framesInFlight"); // runs of older versions had one
    out.conditions.emplace_back("framesInFlight", inFlight ? inFlight->json().dump() : "1");
    const JsonValue variants = json.member("variants");
    variants.requireArray();
    if (variants.size() != 1)
        variants.fail("must hold one variant: a run with --ab or --what-if compares its variants "
                      "itself");
    const JsonValue variant = variants.item(0);
    out.version = {{"commit", from.member("commit").string()},
                   {"settings", variant.member("settings").json().dump()}};
    const JsonValue time = variant.member("time"), passes = time.member("passes");
    out.conditions.emplace_back("frames", time.member("frames").json().dump());
    passes.requireArray();
    const auto timeOf = [](std::string name, const JsonValue& row) {
        return ProfiledTime{.name = std::move(name),
                            .minMs = row.member("minMs").number({0}),
                            .medianMs = row.member("medianMs").number({0})};
    };
    const auto upload = time.find("upload"); // the time of moving lights
    out.still = json.member("path").json() == "still" &&
                (!upload || upload->member("medianMs").number({0}) == 0);
    for (size_t i = 0; i < passes.size(); ++i)
        out.times.push_back(timeOf(passes.item(i).member("name").string(), passes.item(i)));
    for (const WholeTime& whole : wholeTimes)
        if (const auto row = time.find(whole.key))
            if (ProfiledTime t = timeOf(whole.name, *row); t.medianMs > 0)
                out.times.push_back(std::move(t));
    return out;
}

nlohmann::json parseRuns(const std::string& path)
{
    const std::vector<uint8_t> bytes = readSceneFile(path);
    return parseSceneJson(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

} // namespace

std::vector<ProfiledRun> readRuns(const std::string& path)
{
    const nlohmann::json document = parseRuns(path);
    const JsonValue root(path, document);
    if (!document.is_array())
        return {readRun(path, root)};
    std::vector<ProfiledRun> out;
    for (size_t i = 0; i < root.size(); ++i)
        out.push_back(readRun(path, root.item(i)));
    if (out.empty())
        root.fail("holds no run");
    return out;
}

Json withRun(const std::string& path, const Json& run)
{
    Json out = Json::array();
    if (std::filesystem::exists(path)) {
        readRuns(path); // throws if the file holds something else
        const std::vector<uint8_t> bytes = readSceneFile(path);
        const Json before = Json::parse(bytes.begin(), bytes.end());
        out = before.is_array() ? before : Json::array({before});
    }
    out.push_back(run);
    return out;
}

} // namespace candelabra::app
