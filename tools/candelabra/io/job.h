// SPDX-License-Identifier: Apache-2.0
// Job: what a thread that does long work tells the thread that waits for it, and the wish to stop.
#pragma once

#include <mutex>
#include <string>

namespace candelabra::app
{

class Job
{
public:
    struct State {
        std::string doing; // a sentence
        double done = 0;   // part of the whole work, 0..1
    };

    // For the thread that works: says what it does now. Returns false if it should stop instead.
    [[nodiscard]] bool doing(const std::string& what, double done)
    {
        const std::lock_guard lock(mutex_);
        state_ = {what, done};
        return !stopped_;
    }

    // For the thread that waits.
    State state() const
    {
        const std::lock_guard lock(mutex_);
        return state_;
    }
    void stop()
    {
        const std::lock_guard lock(mutex_);
        stopped_ = true;
    }
    bool stopped() const
    {
        const std::lock_guard lock(mutex_);
        return stopped_;
    }

private:
    mutable std::mutex mutex_;
    State state_;
    bool stopped_ = false;
};

} // namespace candelabra::app
