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
    return {frame.specular, frame.culling, frame.errorBudget, frame.heatMap};
}

FrameOptions Shading::in(FrameOptions frame) const
{
    frame.specular = specular;
    frame.culling = culling;
    frame.errorBudget = errorBudget;
    frame.heatMap = heatMap;
    return frame;
}

Shading Viewer::wantedRight() const
{
    return {panel_.wipe.specular, panel_.wipe.culling, panel_.wipe.errorBudget, HeatMap::None};
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
    const auto use = [&](const Renderer* renderer, const Shading& wanted, Shading& shown) {
        if (renderer && renderer->canDraw(wanted.in(panel_.frame)))
            shown = wanted;
    };
    use(renderer_.get(), Shading::of(panel_.frame), shownLeft_);
    use(other_.get(), wantedRight(), shownRight_);
    if (!panel_.wipe.on && other_ && !work_.busy()) {
        ring_.wait();
        other_.reset();
    }
    if (!lightsEdited_)
        return;
    const uint32_t types = lightTypesOf(scene_);
    if (!renderer_->canLightBy(types) || (other_ && !other_->canLightBy(types)))
        return;
    lightsEdited_ = false;
    renderer_->lightsChanged();
    if (other_)
        other_->lightsChanged();
    still_.change();
}

// Begins to make the first thing that is missing, if there is one.
void Viewer::startWork()
{
    if (panel_.materialsChosen) {
        panel_.materialsChosen = false;
        newMaterials_ = materials_;
        overrideMaterials(newMaterials_, panel_.materials);
        return makeRenderer(Side::Left);
    }
    if (panel_.wipe.on && !other_)
        return makeRenderer(Side::Right);
    const auto compile = [&](Renderer* renderer, const FrameOptions& frame) {
        work_.start([renderer, frame](Job& job) {
            compileShaders(job, 0, [&] { renderer->prepareToDraw(frame); });
        });
    };
    const FrameOptions left = Shading::of(panel_.frame).in(panel_.frame);
    if (!renderer_->canDraw(left))
        return compile(renderer_.get(), left);
    if (const FrameOptions right = wantedRight().in(panel_.frame);
        other_ && !other_->canDraw(right))
        return compile(other_.get(), right);
    if (pick_) { // pickPixel draws with the left renderer, also by brute force
        const FrameOptions frame = optionsAt(int32_t(pick_->x));
        FrameOptions brute = frame;
        brute.culling = CND_CULLING_BRUTE;
        brute.heatMap = HeatMap::None;
        const bool draws = pickRefusal(frame.specular, frame.influence.rule).empty();
        for (const FrameOptions& needed : {frame, brute})
            if (draws && !renderer_->canDraw(needed))
                return compile(renderer_.get(), needed);
    }
    if (lightsEdited_)
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

void Viewer::takeWork()
{
    const bool unwanted = work_.stopped();
    work_.finish();
    std::unique_ptr<Renderer> made = std::move(made_);
    if (unwanted && madeSide_ == Side::Left)
        panel_.materialsChosen = true; // still
    if (unwanted)
        madeSide_.reset();
    if (unwanted || !made)
        return;
    if (!made->canLightBy(lightTypesOf(scene_))) { // there is a new type since
        made_ = std::move(made);
        return prepareLights(*made_);
    }
    made->lightsChanged();
    const PixelSize size = renderer_->size();
    if (made->size().width != size.width || made->size().height != size.height)
        made->resize(size);
    if (std::exchange(madeSide_, std::nullopt) == Side::Left) {
        ring_.wait();
        other_.reset();
        renderer_ = std::move(made);
        scene_.materials = std::move(newMaterials_);
        shownLeft_ = madeShading_;
        forgetFrames();
    } else if (panel_.wipe.on) {
        other_ = std::move(made);
        shownRight_ = madeShading_;
    }
}

} // namespace candelabra::app
