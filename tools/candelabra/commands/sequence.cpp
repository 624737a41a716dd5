// SPDX-License-Identifier: Apache-2.0
#include "commands/sequence.h"

#include <charconv>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "io/error.h"
#include "io/numbered_name.h"
#include "io/report.h"
#include "render/readback.h"

namespace candelabra::app
{
namespace
{

constexpr const char* firstLine = "candelabra sequence 1";

bool fileExists(const std::string& path)
{
    std::error_code ignored;
    return std::filesystem::is_regular_file(path, ignored);
}

// Removes the options that do not change any picture.
std::string significant(std::string command)
{
    for (const std::string option : {" --resume", " --quiet", " -q"})
        for (size_t at = command.find(option); at != std::string::npos;
             at = command.find(option, at)) {
            const size_t end = at + option.size();
            if (end == command.size() || command[end] == ' ')
                command.erase(at, option.size());
            else
                at = end;
        }
    return command;
}

std::string recordLine(uint32_t frame, float ev)
{
    return fmt::format("{} {:.9g}\n", frame, ev); // nine digits tell a float from all others
}

// Reads "NUMBER EV100". Returns false for any other line, such as one that was cut off.
bool readLine(const std::string& line, uint32_t& frame, float& ev)
{
    const char* end = line.data() + line.size();
    const auto number = std::from_chars(line.data(), end, frame);
    if (number.ec != std::errc{} || number.ptr == end || *number.ptr != ' ')
        return false;
    const auto value = std::from_chars(number.ptr + 1, end, ev);
    return value.ec == std::errc{} && value.ptr == end;
}

} // namespace

std::string sequenceRecord(const std::string& output)
{
    return std::filesystem::path(namedInstead(output, "exposure")).replace_extension(".txt");
}

Sequence::Sequence(const std::vector<std::string>& outputs, uint32_t frames,
                   const std::string& command, bool resume)
    : outputs_(outputs), record_(sequenceRecord(outputs.at(0))), evs_(frames)
{
    const std::string wanted = significant(command);
    if (!readRecord(wanted, resume) && resume)
        spdlog::warn("warning: --resume: there is no {}, so all frames are drawn", record_);
    std::string text = fmt::format("{}\n{}\n", firstLine, wanted);
    for (uint32_t frame = 0; frame < frames; ++frame)
        if (evs_[frame])
            text += recordLine(frame, *evs_[frame]);
    writeText(record_, text); // without lines that were cut off
}

bool Sequence::readRecord(const std::string& command, bool resume)
{
    std::ifstream file(record_);
    std::string line;
    if (!file)
        return false;
    if (!std::getline(file, line) || line != firstLine)
        throw UsageError(record_ + ": the sequence needs a file of this name, but something else "
                                   "is there");
    if (!resume)
        return true;
    if (!std::getline(file, line) || line != command)
        throw UsageError(
            fmt::format("--resume: the frames are those of another command: {}", line));
    while (std::getline(file, line)) {
        uint32_t frame = 0;
        float ev = 0;
        if (!file.eof() && readLine(line, frame, ev) && frame < evs_.size())
            evs_[frame] = ev;
    }
    return true;
}

bool Sequence::has(uint32_t frame) const
{
    bool all = evs_[frame].has_value();
    for (size_t i = 0; i < outputs_.size(); ++i)
        all = all && fileExists(output(i, frame));
    return all;
}

void Sequence::add(uint32_t frame, float adaptedEv100)
{
    evs_[frame] = adaptedEv100;
    std::ofstream file(record_, std::ios::app);
    if (!(file << recordLine(frame, adaptedEv100) << std::flush))
        throw RunError("cannot write to " + record_);
}

std::string Sequence::output(size_t which, uint32_t frame) const
{
    return numberedName("-o", outputs_[which], frame);
}

FrameHooks sequenceHooks(const VulkanContext& context, Renderer& renderer, Sequence& sequence,
                         const std::vector<std::string>& outputs,
                         const std::function<Camera(uint32_t)>& camera)
{
    const auto leftOut = std::make_shared<bool>(false); // the frame before
    FrameHooks hooks;
    hooks.prepare = [&, camera, leftOut](uint32_t frame, FrameOptions& options) {
        options.camera = camera(frame);
        if (sequence.has(frame)) {
            *leftOut = true;
            return false;
        }
        if (std::exchange(*leftOut, false) && !options.resetExposure) {
            FrameOptions seed = options;
            seed.exposure.manual = VK_TRUE; // the next frame adapts from this EV100
            seed.exposure.manualEv100 = sequence.adaptedEv100(frame - 1);
            context.submitAndWait([&](VkCommandBuffer cmd) { renderer.record(cmd, 0, seed); });
        }
        return true;
    };
    hooks.finished = [&](uint32_t frame, const FrameStats& stats) {
        for (size_t i = 0; i < outputs.size(); ++i)
            saveFrame(context, renderer, sequence.output(i, frame));
        sequence.add(frame, stats.exposure.adaptedEv100);
    };
    return hooks;
}

} // namespace candelabra::app
