// SPDX-License-Identifier: Apache-2.0
// Progress: shows on stderr how much of a long job is done. On a terminal it is one line that is
// drawn again and again. In a file or a pipe it is a new line every few seconds, so that a log
// shows that the work continues.
#pragma once

#include <chrono>
#include <string>

namespace candelabra::app
{

class Progress
{
public:
    using Clock = std::chrono::steady_clock;
    // `steps` is the size of the whole job, in any unit. Nothing is written unless `visible` is
    // true. `period` is the time between two lines where stderr is no terminal.
    Progress(double steps, bool visible, Clock::duration period = std::chrono::seconds(10));
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // Shows what is being done now.
    void doing(const std::string& what);
    // Counts `steps` more as done.
    void advance(double steps);

private:
    void draw();
    void log();
    std::string timeLeft() const; // ", about 12 s left"; empty at the beginning and at the end

    double steps_, done_ = 0;
    bool visible_, terminal_;
    Clock::duration period_;
    std::string what_;
    Clock::time_point start_ = Clock::now(), logged_ = start_;
};

} // namespace candelabra::app
