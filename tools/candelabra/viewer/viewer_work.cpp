// SPDX-License-Identifier: Apache-2.0
// The part of Viewer that lets another thread make what frames need: pipelines of other ways of
// shading and of other types of lights, the renderer of the wipe, and the one of other materials.
// Until it is there, the picture stays as it was in that respect.
#include <chrono>
#include <thread>
#include <utility>

#include "measure/frame/pick.h"
#include "viewer/viewer.h"

namespace candelabra::app
{

Shading Shading::of(const FrameOptions& frame)
{
    return {frame.specular, frame.culling, frame.heatMap};
}

FrameOptions Shading::in(FrameOptions frame) const
{
    frame.specular = specular;
    frame.culling = culling;
    frame.heatMap = heatMap;
    return frame;
}

Shading Viewer::wantedRight() const
{
    return {panel_.wipe.specular, panel_.wipe.culling, HeatMap::None};
}

FrameOptions Viewer::optionsAt(int32_t x) const
{
    return (x < wipeColumn() ? shownLeft_ : shownRight_).in(panel_.frame);
}

// Takes what the other thread has made, and lets it make the next thing that is missing. If the
// number of frames is limited, waits until nothing is missing, so that a frame has the same bits in
// every run.
void Viewer::prepare()
{
    do {
        if (work_.busy() && work_.ended())
            takeWork();
        useWhatIsThere();
        const bool sceneWaits = loader_.busy() && loader_.ended(); // takeLoaded() comes first
        if (!work_.busy() && !sceneWaits)
            startWork();
        prepared_ = !work_.busy() && !sceneWaits;
        if (options_.frames && work_.busy())
            await([&] { return work_.ended(); });
    } while (options_.frames && work_.busy());
}

// Handles events until `ended` is true.
void Viewer::await(const std::function<bool()>& ended)
{
    while (!ended()) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        window_.poll();
    }
}

// Draws as the user wants it from now on, as far as there are pipelines for it.
void Viewer::useWhatIsThere()
{
    const auto use = [&](const Renderer* renderer, const Shading& wanted, Shading& now) {
        if (renderer && renderer->canDraw(wanted.in(panel_.frame)))
            now = wanted;
    };
    use(renderer_.get(), Shading::of(panel_.frame), shownLeft_);
    use(other_.get(), wantedRight(), shownRight_);
    if (!panel_.wipe.on && other_ && !work_.busy()) {
        ring_.wait();
        other_.reset();
    }
    if (!lightsEdited_ || !canLight())
        return;
    lightsEdited_ = false;
    renderer_->lightsChanged();
    if (other_)
        other_->lightsChanged();
    still_.change();
}

// Tells whether the renderers have pipelines for all lights of the scene.
bool Viewer::canLight() const
{
    const uint32_t types = lightTypesOf(scene_);
    return renderer_->canLightBy(types) && (!other_ || other_->canLightBy(types));
}

// Begins to make the first thing that is missing, if there is one.
void Viewer::startWork()
{
    if (panel_.materialsChosen) {
        panel_.materialsChosen = false;
        newMaterials_ = materials_;
        newOverride_ = panel_.materials;
        overrideMaterials(newMaterials_, newOverride_);
        takeBack_ = [this] {
            panel_.materials = shownOverride_;
            panel_.materialsChosen = false;
        };
        return makeRenderer(Side::Left);
    }
    if (panel_.wipe.on && !other_) {
        takeBack_ = [this] { panel_.wipe.on = false; };
        return makeRenderer(Side::Right);
    }
    const auto compile = [&](Renderer* renderer, const FrameOptions& frame) {
        work_.start([renderer, frame](Job& job) {
            compileShaders(job, 0, [&] { renderer->prepareToDraw(frame); });
        });
    };
    const FrameOptions left = Shading::of(panel_.frame).in(panel_.frame);
    if (!renderer_->canDraw(left)) {
        takeBack_ = [this] { panel_.frame = shownLeft_.in(panel_.frame); };
        return compile(renderer_.get(), left);
    }
    if (const FrameOptions wanted = wantedRight().in(panel_.frame);
        other_ && !other_->canDraw(wanted)) {
        takeBack_ = [this] {
            panel_.wipe.specular = shownRight_.specular;
            panel_.wipe.culling = shownRight_.culling;
        };
        return compile(other_.get(), wanted);
    }
    if (pick_) { // pickPixel draws with the left renderer, also by brute force
        const FrameOptions frame = optionsAt(int32_t(pick_->x));
        FrameOptions brute = frame;
        brute.culling = CND_CULLING_BRUTE;
        brute.heatMap = HeatMap::None;
        const bool draws = pickRefusal(frame).empty();
        takeBack_ = [this] { pick_.reset(); };
        for (const FrameOptions& needed : {frame, brute})
            if (draws && !renderer_->canDraw(needed))
                return compile(renderer_.get(), needed);
    }
    if (!lightsEdited_)
        return;
    takeBack_ = [this] { takeBackLights(); };
    prepareLights(renderer_->canLightBy(lightTypesOf(scene_)) ? *other_ : *renderer_);
}

// Lets the other thread make the pipelines of the scene's light types.
void Viewer::prepareLights(Renderer& renderer)
{
    work_.start([&renderer, types = lightTypesOf(scene_)](Job& job) {
        compileShaders(job, 0, [&] { renderer.prepareToLightBy(types); });
    });
}

// Lets the other thread make a renderer of the scene, which takes the place of one of the two. It
// reads nothing of the scene that the user may change meanwhile.
void Viewer::makeRenderer(Side side)
{
    madeSide_ = side;
    madeShading_ = side == Side::Left ? Shading::of(panel_.frame) : wantedRight();
    RendererOptions options = rendererOptions(options_, madeShading_.in(panel_.frame));
    options.size = renderer_->size();
    options.lightTypes = lightTypesOf(scene_);
    if (side == Side::Left)
        options.materials = &newMaterials_;
    work_.start([this, options](Job& job) {
        made_ = candelabra::app::makeRenderer(context_, scene_, options, 0, job);
    });
}

// Uses the result of the other thread. If that failed, the viewer says so and continues without it.
void Viewer::takeWork()
{
    const bool unwanted = work_.stopped();
    try {
        work_.finish();
        if (!unwanted)
            return useMade();
        if (madeSide_ == Side::Left)
            panel_.materialsChosen = true; // still
    } catch (...) {
        takeBack_();
        showNote(messageOf(std::current_exception()), spdlog::level::err);
    }
    made_.reset();
    madeSide_.reset();
}

// Undoes the last edits of lights, back to those for which there are pipelines.
void Viewer::takeBackLights()
{
    while (!canLight() && panel_.editor.history.canUndo())
        undoEdit(scene_, panel_.editor);
    lightsEdited_ = false; // what was undone is an edit as well, which the next frame notes
}

// Installs a renderer that is complete, or lets the other thread continue with one that is not.
void Viewer::useMade()
{
    std::unique_ptr<Renderer> made = std::move(made_);
    if (!made)
        return;
    if (!made->canLightBy(lightTypesOf(scene_))) { // there is a new type since
        made_ = std::move(made);
        return prepareLights(*made_);
    }
    made->lightsChanged();
    if (made->size() != renderer_->size())
        made->resize(renderer_->size());
    if (std::exchange(madeSide_, std::nullopt) == Side::Left) {
        ring_.wait();
        other_.reset();
        renderer_ = std::move(made);
        scene_.materials = std::move(newMaterials_);
        shownOverride_ = newOverride_;
        shownLeft_ = madeShading_;
        forgetFrames();
    } else if (panel_.wipe.on) {
        other_ = std::move(made);
        shownRight_ = madeShading_;
        dropPicture();
    }
}

} // namespace candelabra::app
