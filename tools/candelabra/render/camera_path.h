// SPDX-License-Identifier: Apache-2.0
// Where the camera is in each frame of a sequence.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace candelabra::app
{

// Returns the camera turned about the vertical through its position by a share of a whole turn.
Camera turnedBy(const Camera& camera, double share);

class CameraPath
{
public:
    // `path`: "still", "turn" for one whole turn in all frames, or the name of a text file with a
    // camera per line, each as selectCamera() takes it, of which the first frame shows the first
    // and the last frame the last; empty lines and lines that begin with # are left out. Throws
    // UsageError or SceneError.
    CameraPath(const Scene& scene, const Camera& start, const std::string& path);

    bool moves() const { return turns_ || keys_.size() > 1; }
    // The camera of the frame `index` of `count`.
    Camera at(uint32_t index, uint32_t count) const;
    // The camera of the first frame.
    const Camera& start() const { return keys_.front(); }

private:
    bool turns_ = false;
    std::vector<Camera> keys_; // one unless they are from a file
};

} // namespace candelabra::app
