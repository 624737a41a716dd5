// SPDX-License-Identifier: Apache-2.0
// candelabra view: shows a scene in a window.
#include <memory>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "commands/commands.h"
#include "commands/messages.h"
#include "io/error.h"
#include "render/pipeline_watch.h"
#include "viewer/first_scene.h"
#include "viewer/keys.h"
#include "viewer/viewer.h"

namespace candelabra::app
{
namespace
{

struct ViewArguments {
    DeviceArguments device;
    SceneArguments scene;
    FrameArguments frame;
    std::string frames = "0", whileMoving = "auto", screenshot;
    bool noOverlay = false, verbose = false;
};

ViewerOptions optionsOf(const ViewArguments& a)
{
    ViewerOptions out{.gbufferLayout = a.frame.gbufferLayout(),
                      .frame = a.frame.frameOptions(),
                      .choosesShadows = !a.frame.shadowPoints(),
                      .lightsVisible = a.frame.lightsVisibleOverride(),
                      .overlay = !a.noOverlay,
                      .frames = unsignedOption("--frames", a.frames, 0, 1'000'000),
                      .whileMoving = choose("--while-moving", a.whileMoving, whileMovingChoices),
                      .screenshot = a.screenshot};
    out.frame.edgeFilter = true;
    // Sizes that follow from times would not be the same in every run.
    if (out.frames && out.whileMoving == WhileMoving::Auto)
        out.whileMoving = WhileMoving::Full;
    if (!out.screenshot.empty()) {
        if (!out.frames)
            throw UsageError("--screenshot: needs --frames N, and shows the last of these frames");
        if (!out.screenshot.ends_with(".png"))
            throw UsageError("--screenshot " + out.screenshot + ": the name must end in .png");
        requireWritable("--screenshot", out.screenshot);
    }
    return out;
}

SceneRequest requestOf(const ViewArguments& a, const ViewerOptions& options)
{
    SceneRequest out{.scene = a.scene.scene,
                     .options = a.scene.options(a.scene.lightCount()),
                     .renderer = rendererOptions(options, options.frame),
                     .choosesShadows = options.choosesShadows,
                     .uncut = options.frame.influence.rule == CND_INFLUENCE_UNCUT,
                     .view = [frame = a.frame](const Scene& scene) {
                         const Camera camera = frame.chosenCamera(scene);
                         return SceneView{camera, frame.pixelSize(scene, camera)};
                     }};
    out.options.imageAspect = a.frame.imageAspect();
    return out;
}

int view(const ViewArguments& a)
{
    if (a.verbose)
        spdlog::set_level(spdlog::level::debug);
    const ViewerOptions options = optionsOf(a);
    SceneRequest request = requestOf(a, options);
    a.scene.warnOfIdleOptions(request.options.lights);
    a.device.requireRoomFor(request.options.lights.value_or(0));
    const WindowSystem system;
    ContextOptions contextOptions = a.device.contextOptions(Presentation::Window);
    contextOptions.engineFunctions = watchedFunctions;
    Screen screen(system, contextOptions, a.frame.givenSize());
    {
        SceneLoader loader(screen.context);
        loader.start(std::move(request));
        const bool interactive = !options.frames;
        if (auto first = waitForFirstScene(screen, loader, interactive)) {
            logWarnings(first->scene);
            if (first->shadows)
                warnOfShadows(first->scene);
            logShadowsLeftOut(*first);
            Viewer viewer(options, screen, loader, std::move(first));
            spdlog::info("on {}; F2 lists keys and mouse", screen.context.info().name);
            viewer.run();
        }
    }
    return printValidationMessages(screen.context) ? exitFailed : exitOk;
}

} // namespace

void addViewCommand(CLI::App& app, Run& run)
{
    CLI::App* command = app.add_subcommand("view", "Fly through a scene in a window");
    const auto a = std::make_shared<ViewArguments>();
    a->scene.addTo(*command, "hall");
    a->scene.addLightsTo(*command);
    a->scene.addDefaultLightTo(*command);
    addOption(*command, "--frames", a->frames, "N",
              "stop after N frames, which are 1/60 s apart; 0 means never");
    addChoice(*command, "--while-moving", a->whileMoving, whileMovingChoices,
              "size of the picture while you move the camera or drag a light; auto halves width "
              "and height if frames take longer than 1/15 s, except with --frames");
    addOption(*command, "--screenshot", a->screenshot, "FILE",
              "PNG file for a picture of the window at the last frame of --frames");
    command->add_flag("--no-overlay", a->noOverlay, "start without the panel (F1 shows it)");
    command->add_flag("--verbose", a->verbose,
                      "report on stderr what each key and click does, where the camera stops, and "
                      "when the picture is complete");
    a->frame.addAllTo(*command, Reuse::Lighting);
    a->device.addTo(*command);
    command->footer(
        "Keys and mouse:\n" + keyHelpText() +
        "\n"
        "The window opens at once and shows the progress of loading. At first, only the\n"
        "shaders of the first picture are compiled. What you choose later appears when its\n"
        "shaders are ready, and the picture goes on meanwhile. While one scene replaces\n"
        "another, both are in memory. So are old and new surfaces while the material of\n"
        "everything changes.\n\n"
        "Examples:\n"
        "  candelabra view hall --lights 4000 --moving\n"
        "  candelabra view model.glb --lights 200 --shadows off\n"
        "  xvfb-run -a candelabra view hall --frames 30 --screenshot view.png");
    command->callback([&run, a] { run = [a](const ProgramContext&) { return view(*a); }; });
}

} // namespace candelabra::app
