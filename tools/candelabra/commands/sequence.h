// SPDX-License-Identifier: Apache-2.0
// A sequence of numbered pictures, which can be continued after it was interrupted.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "measure/frame/frames.h"

namespace candelabra::app
{

// Which frames of a sequence are there. Beside the pictures lies a text file with a line per frame
// that is complete: its number and the EV100 to which its exposure has adapted. A frame adapts from
// the one before. So when frames are left out because they are there, the next one starts from the
// EV100 in that file, and gets the same bits as if all had been drawn.
class Sequence
{
public:
    // `outputs`: names with a place for the number. `command`: the command line. With `resume`
    // frames that are there are kept. Throws UsageError if another command made them, or if the
    // text file would replace one that is none of a sequence.
    Sequence(const std::vector<std::string>& outputs, uint32_t frames, const std::string& command,
             bool resume);

    // Returns true if the frame is there, with all its pictures.
    bool has(uint32_t frame) const;
    // Returns the EV100 of a frame that is there.
    float adaptedEv100(uint32_t frame) const { return *evs_[frame]; }
    // Notes that all pictures of a frame are written. Throws RunError.
    void add(uint32_t frame, float adaptedEv100);

    std::string output(size_t which, uint32_t frame) const;
    // The name of the text file.
    const std::string& record() const { return record_; }

private:
    // Reads the text file, unless the sequence begins anew. Returns false if there is none. Throws
    // UsageError if it is another file, or of another command.
    bool readRecord(const std::string& command, bool resume);

    std::vector<std::string> outputs_;
    std::string record_;
    std::vector<std::optional<float>> evs_;
};

// The file that a sequence of pictures with these names has beside it.
std::string sequenceRecord(const std::string& output);

// Returns what draws a sequence when it is given to renderFrames(): frames that are there are left
// out, others are written to files. `camera` returns the camera of a frame. All arguments must live
// as long as what is returned.
FrameHooks sequenceHooks(const VulkanContext& context, Renderer& renderer, Sequence& sequence,
                         const std::vector<std::string>& outputs,
                         const std::function<Camera(uint32_t)>& camera);

} // namespace candelabra::app
