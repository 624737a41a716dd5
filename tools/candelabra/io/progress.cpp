// SPDX-License-Identifier: Apache-2.0
#include "io/progress.h"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

#include "io/interrupts.h"

namespace candelabra::app
{
namespace
{
constexpr int barWidth = 12; // characters; the whole line stays under 80

double secondsSince(Progress::Clock::time_point start)
{
    return std::chrono::duration<double>(Progress::Clock::now() - start).count();
}

} // namespace

Progress::Progress(double steps, bool visible, Clock::duration period)
    : steps_(std::max(steps, 1.0)),
      visible_(visible),
      terminal_(isatty(STDERR_FILENO)),
      period_(period)
{
}

Progress::~Progress()
{
    if (!visible_ || !terminal_)
        return;
    setProgressShown(false);
    std::fputs("\r\x1b[K", stderr); // clears the line
}

void Progress::doing(const std::string& what)
{
    what_ = what;
    draw();
}

void Progress::advance(double steps)
{
    done_ = std::min(done_ + steps, steps_);
    draw();
}

std::string Progress::timeLeft() const
{
    constexpr double first = 0.05; // the share of the job after which its speed is known
    if (done_ < first * steps_ || done_ == steps_)
        return "";
    return fmt::format(", about {:.0f} s left", secondsSince(start_) * (steps_ / done_ - 1));
}

void Progress::draw()
{
    if (!visible_)
        return;
    if (!terminal_)
        return log();
    setProgressShown(true);
    const int filled = int(barWidth * done_ / steps_);
    const std::string line =
        fmt::format("\r[{}{}] {:3.0f}% {:4.0f} s{}  {:.32}\x1b[K", std::string(filled, '#'),
                    std::string(barWidth - filled, ' '), 100 * done_ / steps_, secondsSince(start_),
                    timeLeft(), what_);
    std::fputs(line.c_str(), stderr);
    std::fflush(stderr);
}

void Progress::log()
{
    if (Clock::now() - logged_ < period_)
        return;
    logged_ = Clock::now();
    const std::string line = fmt::format("{:3.0f}% after {:.0f} s{}: {}\n", 100 * done_ / steps_,
                                         secondsSince(start_), timeLeft(), what_);
    std::fputs(line.c_str(), stderr);
    std::fflush(stderr);
}

} // namespace candelabra::app
