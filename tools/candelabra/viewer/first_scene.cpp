// SPDX-License-Identifier: Apache-2.0
#include "viewer/first_scene.h"

#include <exception>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace candelabra::app
{
namespace
{

constexpr double redrawAfter = 0.05; // s; more often would take time from the work that is shown

// Draws one frame and handles events.
void drawAndWait(Screen& screen, const std::function<void()>& widgets)
{
    const PixelSize size = screen.window.framebufferSize();
    screen.waitForSlot();
    if (size.width && size.height && !screen.window.wantsToClose()) // 0x0 while minimised
        screen.draw(widgets);
    screen.window.wait(redrawAfter);
    for (const InputEvent& event : std::exchange(screen.window.events, {}))
        if (event.kind == InputEvent::Kind::Key && event.down && event.code == GLFW_KEY_ESCAPE)
            screen.window.close();
}

void showUntilClosed(Screen& screen, const std::string& message)
{
    while (!screen.window.wantsToClose())
        drawAndWait(screen, [&] { drawMessage(message, "Esc closes this window."); });
}

} // namespace

std::unique_ptr<LoadedScene> waitForFirstScene(Screen& screen, SceneLoader& loader,
                                               bool showFailure)
{
    while (!screen.window.wantsToClose()) {
        const Job::State state = loader.state();
        try {
            if (std::unique_ptr<LoadedScene> loaded = loader.take()) {
                screen.window.resize(loaded->view.size);
                return loaded;
            }
        } catch (...) {
            if (showFailure)
                showUntilClosed(screen, messageOf(std::current_exception()));
            throw;
        }
        drawAndWait(screen, [&] { drawProgress(state, false); });
    }
    screen.window.hide(); // the work ends soon, but not at once
    return nullptr;
}

} // namespace candelabra::app
