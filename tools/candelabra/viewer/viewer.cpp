// SPDX-License-Identifier: Apache-2.0
#include "viewer/viewer.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "generate/generators.h"
#include "io/error.h"
#include "io/image.h"
#include "io/table.h"
#include "render/camera.h"
#include "render/image_barrier.h"
#include "render/readback.h"

namespace candelabra::app
{
namespace
{

constexpr double fixedFrameTime = 1.0 / 60; // s between frames when their number is limited
// Longest time in s by which one frame advances camera and lights, so that a stall (a scene is
// built, the window is dragged) does not become a leap.
constexpr double longestStep = 0.25;

constexpr ImageAccess shown{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, 0,
                            VK_IMAGE_LAYOUT_PRESENT_SRC_KHR};

// Longest time in s between two frames while another thread works, and while a widget is held or a
// cursor blinks in a field.
constexpr double widgetTime = 0.05;

using Clock = std::chrono::steady_clock;

// Blits the columns first .. end - 1 of the window's image, which has the size `window`, from the
// display image, which is scaled up if it is smaller. A copy would not do, because the window's
// format may have another order of channels.
void blitColumns(VkCommandBuffer cmd, const Renderer& renderer, VkImage to, PixelSize window,
                 int32_t first, int32_t end)
{
    const PixelSize drawn = renderer.size();
    const auto column = [&](int32_t x) {
        return int32_t(std::lround(double(x) * drawn.width / window.width));
    };
    if (first == end)
        return;
    // Any columns of the window show at least one of the display image, which may be smaller.
    const int32_t from = std::min(column(first), int32_t(drawn.width) - 1);
    const int32_t until = std::max(column(end), from + 1);
    const VkImageSubresourceLayers layers{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    const VkImageBlit region{.srcSubresource = layers,
                             .srcOffsets = {{from, 0, 0}, {until, int32_t(drawn.height), 1}},
                             .dstSubresource = layers,
                             .dstOffsets = {{first, 0, 0}, {end, int32_t(window.height), 1}}};
    vkCmdBlitImage(cmd, renderer.display().image.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region,
                   drawn != window ? VK_FILTER_LINEAR : VK_FILTER_NEAREST);
}

// By how much the eye has still to adapt.
float evLeft(const CndExposureStats& exposure)
{
    return exposure.targetEv100 - exposure.adaptedEv100;
}

} // namespace

RendererOptions rendererOptions(const ViewerOptions& options, const FrameOptions& frame)
{
    return {.gbufferLayout = options.gbufferLayout,
            .framesInFlight = Screen::slotCount,
            .specularMethods = 1u << frame.specular,
            .shading = shadingOf(frame),
            .shadows = options.frame.shadows,
            .influenceByError = options.frame.influence.rule == CND_INFLUENCE_BY_ERROR};
}

Viewer::Viewer(const ViewerOptions& options, Screen& screen, SceneLoader& loader,
               std::unique_ptr<LoadedScene> first)
    : options_(options),
      screen_(screen),
      window_(screen.window),
      context_(screen.context),
      swapchain_(screen.swapchain),
      overlay_(screen.overlay),
      ring_(screen.ring),
      loader_(loader),
      camera_(first->view.camera, cruisingSpeed(first->scene)),
      panel_{
          .frame = options.frame, .visible = options.overlay, .whileMoving = options.whileMoving},
      loadingShading_(Shading::of(options.frame))
{
    show(std::move(first));
    figures_.device = context_.info().name;
    time_ = options.frame.time;
    if (!options.screenshot.empty() && !swapchain_.readable())
        throw RunError("--screenshot: the window's images cannot be copied from on " +
                       context_.info().name);
}

Viewer::~Viewer()
{
    // After an exception the GPU may still use the renderers.
    context_.waitBeforeDestruction();
}

void Viewer::open(const std::string& scene, const SceneOptions& options, Kept kept)
{
    if (kept == Kept::Nothing) // the number of lights was wanted of the scene before
        panel_.wantedLights = uint32_t(scene_.lights.size());
    wantedScene_ = scene;
    wantedOptions_ = options;
    loadingShading_ = Shading::of(panel_.frame);
    loadingKept_ = kept;
    loader_.start({.scene = scene,
                   .options = options,
                   .renderer = rendererOptions(options_, panel_.frame),
                   .choosesShadows = options_.choosesShadows,
                   .uncut = options_.frame.influence.rule == CND_INFLUENCE_UNCUT,
                   .view =
                       [size = swapchain_.size()](const Scene& loaded) {
                           return SceneView{selectCamera(loaded, ""), size};
                       },
                   .kept = kept});
}

void Viewer::takeLoaded()
{
    if (work_.busy()) { // it is for the present scene
        if (loader_.busy() && loader_.ended())
            work_.stop();
        return;
    }
    if (options_.frames && loader_.busy())
        await([&] { return loader_.ended(); });
    std::unique_ptr<LoadedScene> loaded;
    try {
        loaded = loader_.take();
    } catch (...) {
        showNote(messageOf(std::current_exception()), spdlog::level::err);
        panel_.wantedLights = uint32_t(scene_.lights.size());
        wantedScene_ = sceneName_;
        wantedOptions_ = sceneOptions_;
    }
    if (!loaded)
        return;
    for (const std::string& note : loaded->scene.notes)
        spdlog::info("{}", note);
    figures_.note.clear();
    logShadowsLeftOut(*loaded);
    show(std::move(loaded));
    spdlog::info("{}: {}", scene_.name, counted(scene_.lights.size(), "light"));
}

void Viewer::show(std::unique_ptr<LoadedScene> loaded)
{
    ring_.wait();
    renderer_.reset();
    other_.reset();
    const Kept kept = loaded->request.kept;
    if (kept == Kept::CameraAndLights) {
        std::swap(scene_.lights, loaded->scene.lights);
        std::swap(scene_.lightMotions, loaded->scene.lightMotions);
    }
    scene_ = std::move(loaded->scene);
    renderer_ = std::move(loaded->renderer);
    options_.frame.shadows = panel_.frame.shadows = loaded->shadows;
    if (loadingShading_.heatMap == HeatMap::Shadow && !loaded->shadows)
        loadingShading_.heatMap = panel_.frame.heatMap = HeatMap::None; // there are none to show
    renderer_->sceneMoved(scene_);
    source_ = std::move(loaded->source);
    sceneName_ = loaded->request.scene;
    sceneOptions_ = loaded->request.options;
    wantedScene_ = sceneName_;
    wantedOptions_ = sceneOptions_;
    if (kept == Kept::Nothing) {
        home_ = loaded->view.camera;
        camera_ = FlyCamera(home_, cruisingSpeed(scene_));
    }
    seenFrom_ = camera_.camera();
    shownLeft_ = loadingShading_;
    lightsEdited_ = kept == Kept::CameraAndLights;
    takeScene(kept);
    forgetFrames();
}

// Sets everything that depends on the scene to the scene that was just loaded.
void Viewer::takeScene(Kept kept)
{
    materials_ = scene_.materials;
    handleDrag_.reset();
    if (kept != Kept::CameraAndLights) {
        ownLights_ = scene_.lights.size() - sceneOptions_.lights.value_or(0);
        panel_.editor = {.watts = panel_.editor.watts}; // the unit stays as the user chose it
        savedState_ = panel_.editor.history.state();
    }
    panel_.frame.lightsVisible = options_.lightsVisible.value_or(scene_.lightsVisible);
    CndExposureSettings& exposure = panel_.frame.exposure;
    if (std::exchange(knownExposure_, false))
        exposure.manual = VK_FALSE;
    knownExposure_ = !exposure.manual && scene_.knownEv100;
    useKnownExposure(scene_, exposure);
    panel_.wantedLights = uint32_t(scene_.lights.size());
    panel_.object.reset();
    rays_.reset();
    figures_.picked.reset();
    shownOverride_ = {};
    panel_.materialsChosen = panel_.materials.on;
}

void Viewer::forgetFrames()
{
    figures_.passes.clear();
    recorded_ = {};
    dropPicture();
    resetExposure_ = true;
}

// Begins the picture again, with renderers that have nothing to show yet.
void Viewer::dropPicture()
{
    still_.change();
    picture_.reset();
    hasPicture_ = false;
}

void Viewer::rebuild(uint32_t wanted)
{
    if (loader_.busy() && loadingKept_ == Kept::Nothing) {
        panel_.wantedLights = uint32_t(scene_.lights.size());
        return showNote("the number of lights stays, because another scene is being loaded");
    }
    const uint32_t lights = uint32_t(std::min<uint64_t>(wanted, maxLightsOf(context_.info())));
    loadingLights_ = wanted;
    spdlog::info("building {} with {}", sceneName_, counted(lights, "light"));
    SceneOptions sceneOptions = wantedOptions_; // an environment may be being loaded
    // SceneOptions::lights is the number of lights of a generated scene, but for a file it is the
    // number to add to the file's own.
    const uint32_t own = uint32_t(ownLights_);
    sceneOptions.lights = isGenerated(sceneName_) ? lights : lights > own ? lights - own : 0;
    open(sceneName_, sceneOptions, Kept::Camera);
}

bool Viewer::rebuilds() const
{
    const bool wanted = !panel_.editor.changed && panel_.wantedLights != scene_.lights.size();
    return wanted || (loader_.busy() && loadingKept_ == Kept::Camera);
}

void Viewer::noteEdits()
{
    if (!std::exchange(panel_.editor.changed, false))
        return;
    if (panel_.wantedLights != scene_.lights.size())
        figures_.picked.reset(); // the indices of the picked lights are no longer valid
    panel_.wantedLights = uint32_t(scene_.lights.size());
    lightsEdited_ = true;
}

// Heat maps show single pixels, and what is saved or picked has the window's pixels.
PixelSize Viewer::drawnSize() const
{
    const bool half =
        movingSize_.isHalf() && shownLeft_.heatMap == HeatMap::None && !saveAs_ && !pick_;
    return half ? halfOf(swapchain_.size()) : swapchain_.size();
}

// Resizes the window's images to the window's size, and the renderers.
void Viewer::fitToWindow()
{
    screen_.fit();
    const PixelSize wanted = drawnSize();
    if (wanted != renderer_->size()) {
        ring_.wait();
        renderer_->resize(wanted);
        if (other_)
            other_->resize(wanted);
        recorded_ = {};
        figures_.passes.clear();
        dropPicture();
        spdlog::debug("picture: {}x{} pixels", wanted.width, wanted.height);
    }
}

void Viewer::collectStats(const FrameRing::Frame& frame)
{
    if (!frame.reused || recorded_[frame.slot] == Recorded::Nothing)
        return;
    if (recorded_[frame.slot] == Recorded::Picture) {
        FrameStats stats = renderer_->stats(frame.slot);
        figures_.passes.push_back(std::move(stats.passes));
        while (figures_.passes.size() > panelFrames)
            figures_.passes.pop_front();
        if (stats.lit)
            figures_.lighting = stats.lighting;
    }
    figures_.exposure = renderer_->exposureStats(frame.slot);
    float ev = evLeft(figures_.exposure);
    if (right() && still_.hasTwoSides(frame.slot))
        ev = std::max(std::abs(ev), std::abs(evLeft(right()->exposureStats(frame.slot))));
    still_.measured(frame.slot, ev);
}

int32_t Viewer::wipeColumn() const
{
    const int32_t width = int32_t(swapchain_.size().width);
    return right() ? int32_t(std::lround(panel_.wipe.at * float(width))) : width;
}

void Viewer::recordWindow(VkCommandBuffer cmd, const Swapchain::Target& target)
{
    // This transition waits for the semaphore Target::acquired: both have the transfer stage in
    // common (FrameRing::submit).
    transition(cmd, target.image, discarded, transferWrite);
    const PixelSize size = swapchain_.size();
    const int32_t split = wipeColumn();
    blitColumns(cmd, *renderer_, target.image, size, 0, split);
    if (right())
        blitColumns(cmd, *right(), target.image, size, split, int32_t(size.width));
    transition(cmd, target.image, transferWrite, colorAttachment);
    overlay_.record(cmd, swapchain_, target);
}

gpu::Buffer Viewer::recordScreenshot(VkCommandBuffer cmd, VkImage image) const
{
    transition(cmd, image, shown, transferRead);
    gpu::Buffer pixels = recordReadback(context_.device(), cmd, image, swapchain_.size(), 4);
    transition(cmd, image, transferRead, shown);
    return pixels;
}

void Viewer::saveScreenshot(const gpu::Buffer& pixels) const
{
    const PixelSize size = swapchain_.size();
    const bool blueFirst = swapchain_.format() == VK_FORMAT_B8G8R8A8_UNORM;
    const auto texels = pixels.as<const uint8_t>();
    std::vector<uint8_t> rgb(size_t(size.width) * size.height * 3);
    for (size_t i = 0; i < rgb.size() / 3; ++i)
        for (size_t c = 0; c < 3; ++c)
            rgb[i * 3 + c] = texels[i * 4 + (blueFirst ? 2 - c : c)];
    savePng(options_.screenshot, size.width, size.height, rgb);
    spdlog::info("wrote {}", options_.screenshot);
}

PictureSettings Viewer::pictureSettings() const
{
    const auto settings = [&](FrameOptions frame) {
        if (scene_.lightMotions.empty())
            frame.time = 0;
        frame.sample = {};
        frame.deltaTime = 0;
        frame.resetExposure = false;
        frame.ditherSeed = 0;
        return frame;
    };
    PictureSettings out{.left = settings(shownLeft_.in(panel_.frame))};
    if (right())
        out.right = settings(shownRight_.in(panel_.frame));
    return out;
}

void Viewer::beginPicture(FrameSample sample)
{
    const auto optionsOf = [&](const Shading& shading) {
        FrameOptions out = shading.in(panel_.frame);
        out.deltaTime = float(pictureTime_);
        if (sample.count > 1 && isSummed(out)) { // the same picture as that of `render --aa`
            out.sample = sample;
            out.resetExposure = true;
            out.ditherSeed = 0;
        }
        return out;
    };
    FrameOptions& options = panel_.frame;
    options.resetExposure = std::exchange(resetExposure_, false);
    ++options.ditherSeed; // dither noise that changes every frame is less visible
    picture_ =
        Picture{.sample = sample, .left = optionsOf(shownLeft_), .version = still_.version()};
    if (right())
        picture_->right = optionsOf(shownRight_);
    pictureTime_ = 0;
}

// Tells whether a picture that begins now is drawn in pieces: if it takes long and an earlier
// one can be shown meanwhile. Pictures that reuse the lit image take less long.
bool Viewer::drawsInPieces(const FrameSample& sample) const
{
    const auto can = [](const FrameOptions& frame, const Shading& shading) {
        return isSummed(shading.in(frame)); // so that no piece needs what another one finds
    };
    return movingSize_.isSlow() && hasPicture_ && !options_.frames &&
           drawnSize() == swapchain_.size() && (sample.count > 1 || still_.isFresh()) &&
           can(panel_.frame, shownLeft_) && (!right() || can(panel_.frame, shownRight_));
}

void Viewer::recordPicture(const FrameRing::Frame& frame)
{
    renderer_->record(frame.cmd, frame.slot, picture_->left);
    if (right())
        right()->record(frame.cmd, frame.slot, *picture_->right);
    recorded_[frame.slot] = Recorded::Picture;
    endPicture(frame);
}

// Records the next piece of the picture. Returns whether it was the last one.
bool Viewer::recordPiece(const FrameRing::Frame& frame)
{
    Picture& p = *picture_;
    const uint32_t height = renderer_->size().height;
    const uint32_t first = p.row.value_or(0), end = p.row ? pieceRows_.endOf(first, height) : 0;
    const auto record = [&](Renderer& renderer, const FrameOptions& options) {
        if (p.row)
            renderer.recordBand(frame.cmd, frame.slot, options, first, end);
        else
            renderer.recordUnlit(frame.cmd, options, frame.slot);
    };
    record(*renderer_, p.left);
    if (right())
        record(*right(), *p.right);
    const bool last = p.row && end == height; // which also ends the picture
    p.row = end;
    if (!last)
        return false;
    recorded_[frame.slot] = Recorded::LastPiece;
    endPicture(frame);
    return true;
}

void Viewer::endPicture(const FrameRing::Frame& frame)
{
    const bool sums = picture_->sample.count > 1;
    movingSize_.drew(drawnSize() == swapchain_.size() && (sums || still_.isFresh()));
    if (picture_->version == still_.version())
        still_.drawn(frame.slot);
    else // something has changed since it began
        still_.forget(frame.slot);
    picture_.reset();
    hasPicture_ = true;
    settling_ = panelSettles;
    ++figures_.frames;
}

// Records what the frame draws of the picture: all, a piece or nothing.
void Viewer::recordNext(const FrameRing::Frame& frame)
{
    // A sample of a sum is dropped if something has changed since it began. A picture of one sample
    // is finished, because otherwise steady changes would never show one.
    if (picture_ && ((picture_->sample.count > 1 && picture_->version != still_.version()) ||
                     picture_->right.has_value() != (right() != nullptr)))
        picture_.reset();
    const bool complete = still_.isComplete();
    if (!std::exchange(complete_, complete) && complete)
        spdlog::debug("picture: complete after {}", counted(figures_.frames, "frame"));
    recorded_[frame.slot] = Recorded::Nothing;
    if (complete) {
        still_.forget(frame.slot);
        movingSize_.drew(false);
        ++panelOnly_;
        settling_ -= std::min(settling_, 1u);
        return;
    }
    const FrameSample sample = *still_.next();
    const bool pieces = picture_ || drawsInPieces(sample);
    // The panel alone is drawn soon. So an event is answered before the next piece.
    answered_ = std::exchange(handled_, false) && pieces && !answered_;
    if (!picture_ && !answered_)
        beginPicture(sample);
    if (pieces && (answered_ || !recordPiece(frame)))
        still_.forget(frame.slot);
    else if (!pieces)
        recordPicture(frame);
}

void Viewer::drawFrame(double seconds, bool screenshot)
{
    const FrameRing::Frame frame = ring_.begin();
    collectStats(frame);
    const Swapchain::Target target = screen_.acquire(frame.slot);

    panel_.frame.camera = camera_.camera();
    overlay_.begin();
    drawOverlay();
    // Moving lights uploads all lights, including edited ones, whose pipelines may be missing. So
    // lights do not move while there are edits.
    if (!lightsEdited_ && !panel_.editor.changed)
        panel_.frame.time = time_;
    if (loader_.busy())
        drawProgress(loader_.state(), true);
    still_.show(pictureSettings());
    pictureTime_ += seconds;
    recordNext(frame);
    recordWindow(frame.cmd, target);
    gpu::Buffer pixels;
    if (screenshot)
        pixels = recordScreenshot(frame.cmd, target.image);
    ring_.submit(target.acquired, target.presented);
    submitted_ = Clock::now();
    screen_.present(target);
    if (screenshot) {
        ring_.wait();
        saveScreenshot(pixels);
    }
    doRequests();
}

// Fulfils requests of keys that take longer than a frame.
void Viewer::doRequests()
{
    if (std::exchange(saveScene_, false))
        saveScene();
    if (!prepared_) // what is drawn now is not what the user wants to be saved or picked
        return;
    // While samples are summed or a picture is lit, the radiance image is not that of the picture.
    const bool sums = picture_ || (still_.summed() && !still_.isComplete());
    if (saveAs_ && !(sums && std::string_view(saveAs_) == ".exr"))
        saveImage(std::exchange(saveAs_, nullptr));
    if (const auto pixel = std::exchange(pick_, std::nullopt))
        pick(*pixel);
}

bool Viewer::awaitEvents()
{
    window_.poll();
    if (options_.frames || settling_ || !still_.isComplete() || !window_.events.empty())
        return false;
    if (loader_.busy() || work_.busy() || overlay_.isActive())
        window_.wait(widgetTime);
    else if (panel_.noteLeft > 0)
        window_.wait(panel_.noteLeft);
    else
        window_.wait();
    settling_ = 1;
    return true;
}

void Viewer::advance(double seconds, double wall)
{
    moveCamera(seconds);
    if (panel_.animate && !lightsEdited_ && !panel_.editor.changed) // as in drawFrame()
        time_ += seconds;
    if (!dropped_.empty())
        onDrop(std::exchange(dropped_, ""));
    takeLoaded();
    // A single edit, such as that of a key, is not a movement.
    const bool editedBefore = std::exchange(edited_, panel_.editor.changed);
    const Camera camera = camera_.camera();
    const bool moves = std::exchange(seenFrom_, camera) != camera || (edited_ && editedBefore);
    moves_ |= moves;
    pictureWall_ += wall;
    if (!picture_) {
        movingSize_.advance(pictureWall_, std::exchange(moves_, false), panel_.whileMoving);
        if (!complete_)
            figures_.wallMs = pictureWall_ * 1e3;
        pictureWall_ = 0;
    }
    noteEdits();
    const uint32_t wanted = panel_.wantedLights;
    const bool builds = loader_.busy() && loadingKept_ == Kept::Camera && wanted == loadingLights_;
    if (wanted != scene_.lights.size() && !builds)
        rebuild(wanted);
    fitToWindow();
    prepare();
    figures_.scene = scene_.name;
    figures_.lights = uint32_t(scene_.lights.size());
    figures_.moving = !scene_.lightMotions.empty();
    figures_.speed = camera_.speed();
    figures_.size = swapchain_.size();
    figures_.drawnSize = renderer_->size();
    figures_.summed = still_.summed();
    figures_.complete = still_.isComplete();
}

// Waits for the GPU. On slow devices only one piece is in flight at a time, so that the next
// submission can answer an event.
void Viewer::waitForGpu()
{
    if (movingSize_.isSlow())
        screen_.waitForAll();
    else
        screen_.waitForSlot();
    pieceRows_.took(std::chrono::duration<double>(Clock::now() - submitted_).count());
}

// Returns whether the viewer ends. If edits are not saved, closing the window asks first.
bool Viewer::ends()
{
    if (!window_.wantsToClose() || asks_ || !hasUnsavedEdits())
        return window_.wantsToClose();
    glfwSetWindowShouldClose(window_.get(), GLFW_FALSE);
    glfwRestoreWindow(window_.get()); // a minimised window would not show the question
    ask();
    settling_ = panelSettles;
    return false;
}

void Viewer::run()
{
    Clock::time_point last = Clock::now();
    for (uint32_t i = 0; !ends() && (!options_.frames || i < options_.frames); ++i) {
        const bool waited = awaitEvents();
        waitForGpu();
        const PixelSize size = window_.framebufferSize();
        if (!size.width || !size.height) { // minimised
            window_.wait();
            --i;
            continue;
        }
        const Clock::time_point now = Clock::now();
        const double wall = std::chrono::duration<double>(now - last).count();
        last = now;
        // Nothing moves while the viewer waits for events.
        const double seconds =
            options_.frames || waited ? fixedFrameTime : std::min(wall, longestStep);
        advance(seconds, wall);
        drawFrame(seconds, !options_.screenshot.empty() && i + 1 == options_.frames);
    }
    spdlog::debug("picture: {} drawn, and {} for the panel alone",
                  counted(figures_.frames, "frame"), panelOnly_);
    window_.hide(); // the GPU, or a scene that is being loaded, may take a while to come to an end
    ring_.wait();
}

} // namespace candelabra::app
