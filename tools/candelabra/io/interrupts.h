// SPDX-License-Identifier: Apache-2.0
// Ending early: SIGINT, SIGTERM and SIGHUP end the program as they always do, after the file that
// is being written is removed and the line of progress is cleared.
#pragma once

#include <string>

namespace candelabra::app
{

// For the whole process, once. Signals that are ignored stay so (nohup). SIGXFSZ becomes ignored:
// files that may not grow are errors like full disks.
void cleanUpOnSignals();

// While one lives, signals remove the file of its name. One at a time; others do nothing.
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

// Whether there is a line on the terminal to clear.
void setProgressShown(bool shown) noexcept;

} // namespace candelabra::app
