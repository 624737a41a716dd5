// SPDX-License-Identifier: Apache-2.0
// Cleaning up on signals: SIGINT, SIGTERM and SIGHUP end the program, but first the file that is
// being written is removed and the line of progress is cleared from the terminal.
#pragma once

#include <string>

namespace candelabra::app
{

// Installs the signal handlers. Call it once per process. Signals that are ignored, by nohup for
// instance, stay ignored. SIGXFSZ is ignored from then on, so that exceeding the limit on file
// sizes is a write error, as a full disk is.
void cleanUpOnSignals();

// While an object of this class lives, the signals above remove the file `path`. Only one file at a
// time is removed: further objects do nothing.
class RemovedOnSignal
{
public:
    explicit RemovedOnSignal(const std::string& path) noexcept;
    ~RemovedOnSignal();
    RemovedOnSignal(const RemovedOnSignal&) = delete;
    RemovedOnSignal& operator=(const RemovedOnSignal&) = delete;

private:
    bool mine_ = false;
};

// Says whether there is a line of progress on the terminal for the handlers to clear.
void setProgressShown(bool shown) noexcept;

} // namespace candelabra::app
