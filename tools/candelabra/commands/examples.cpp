// SPDX-License-Identifier: Apache-2.0
// candelabra examples: writes small files to try the program with.
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "commands/commands.h"
#include "generate/examples.h"
#include "io/error.h"
#include "io/image_file.h"
#include "io/report.h"

namespace candelabra::app
{
namespace
{

int writeExamples(const std::string& directory, bool replace)
{
    const auto place = [&](const char* name) {
        const std::string path =
            (std::filesystem::path(directory) / name).lexically_normal().string();
        requireWritable("examples", path);
        std::error_code ignored;
        if (!replace && std::filesystem::exists(path, ignored))
            throw UsageError(path + ": exists already; --replace replaces it");
        return path;
    };
    const std::string gltf = place("scene.glb"), json = place("scene.json"), sky = place("sky.hdr");
    writeFileAtomically(gltf, exampleGltf());
    writeText(json, exampleSceneJson());
    saveHdr(sky, exampleSky());
    writeText("-", fmt::format("{}  a glTF scene with two lamps\n"
                               "{}  balls on a floor under lights of three types\n"
                               "{}  a sky at dusk, for --environment\n",
                               gltf, json, sky));
    return exitOk;
}

} // namespace

void addExamplesCommand(CLI::App& app, Run& run)
{
    CLI::App* command = app.add_subcommand(
        "examples", "Write small example files: scene.glb, scene.json and sky.hdr");
    const auto directory = std::make_shared<std::string>(".");
    const auto replace = std::make_shared<bool>(false);
    addOption(*command, "directory", *directory, "DIR", "directory for the files");
    command->add_flag("--replace", *replace, "replace existing files");
    command->footer("Examples:\n"
                    "  candelabra examples && candelabra render scene.glb -o scene.png");
    command->callback([&run, directory, replace] {
        run = [directory, replace](const ProgramContext&) {
            return writeExamples(*directory, *replace);
        };
    });
}

} // namespace candelabra::app
