// SPDX-License-Identifier: Apache-2.0
#include "io/interrupts.h"

#include <atomic>
#include <csignal>
#include <cstring>

#include <unistd.h>

namespace candelabra::app
{
namespace
{

// The signal handler reads nothing but these. The flags are lock-free, because the handler may run
// between any two instructions.
char removedPath[PATH_MAX];
std::atomic<bool> taken{false}, ready{false}, progressShown{false};

void cleanUpAndEnd(int signal)
{
    if (ready)
        unlink(removedPath);
    constexpr char clearLine[] = "\r\x1b[K";
    if (progressShown) {
        const ssize_t ignored = write(STDERR_FILENO, clearLine, sizeof clearLine - 1);
        static_cast<void>(ignored); // if the terminal is gone, nothing can be done about it
    }
    raise(signal); // SA_RESETHAND has restored the default action, which ends the program
}

} // namespace

void cleanUpOnSignals()
{
    // Exceeding the limit on file sizes then fails the write, which writeFileAtomically reports.
    std::signal(SIGXFSZ, SIG_IGN);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction old = {};
        if (sigaction(signal, nullptr, &old) || old.sa_handler != SIG_DFL)
            continue;
        struct sigaction action = {};
        action.sa_handler = cleanUpAndEnd;
        action.sa_flags = int(SA_RESETHAND);
        sigaction(signal, &action, nullptr);
    }
}

RemovedOnSignal::RemovedOnSignal(const std::string& path) noexcept
{
    mine_ = path.size() < sizeof removedPath && !taken.exchange(true);
    if (!mine_)
        return;
    std::memcpy(removedPath, path.c_str(), path.size() + 1);
    ready = true;
}

RemovedOnSignal::~RemovedOnSignal()
{
    if (!mine_)
        return;
    ready = false;
    taken = false;
}

void setProgressShown(bool shown) noexcept
{
    progressShown = shown;
}

} // namespace candelabra::app
