// SPDX-License-Identifier: Apache-2.0
// Background: does long work on another thread, so that the window reacts meanwhile.
#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "io/job.h"

namespace candelabra::app
{

// The sentence of an exception of the program or of the engine.
std::string messageOf(const std::exception_ptr& failure);

// Says what a piece of work does now, and how much of it is done (0..1). Throws to end the work if
// the job is to stop.
void beginStep(Job& job, const std::string& what, double done);

class Background
{
public:
    Background() = default;
    ~Background(); // stops the work and waits until it has ended
    Background(const Background&) = delete;
    Background& operator=(const Background&) = delete;

    // Begins a piece of work. There must be none. What `work` throws, finish() throws.
    void start(std::function<void(Job&)> work);
    // True from start() until finish().
    bool busy() const { return work_ != nullptr; }
    // The rest may be called only while busy() is true.
    double seconds() const; // since start()
    Job::State state() const { return work_->job.state(); }
    // Asks the work to end. It does so when it next calls beginStep() or makes a pipeline, and
    // finish() then throws nothing.
    void stop() { work_->job.stop(); }
    bool stopped() const { return work_->job.stopped(); }
    bool ended() const { return work_->ended; }
    // Waits until the work has ended.
    void finish();

private:
    struct Work {
        Job job;
        std::exception_ptr failure; // read after `ended` only
        std::atomic<bool> ended{false};
        std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();
        std::thread thread;
    };
    std::unique_ptr<Work> work_;
};

} // namespace candelabra::app
