// SPDX-License-Identifier: Apache-2.0
#include "viewer/background.h"

#include <new>
#include <utility>

#include "render/check.h"

namespace candelabra::app
{
namespace
{

struct Stopped : std::exception {
};

} // namespace

std::string messageOf(const std::exception_ptr& failure)
{
    try {
        std::rethrow_exception(failure);
    } catch (const gpu::Failure& error) {
        return error.message;
    } catch (const std::bad_alloc&) {
        return "out of memory";
    } catch (const std::exception& error) {
        return error.what();
    }
}

void beginStep(Job& job, const std::string& what, double done)
{
    if (!job.doing(what, done))
        throw Stopped();
}

Background::~Background()
{
    if (!work_)
        return;
    work_->job.stop();
    work_->thread.join();
}

void Background::start(std::function<void(Job&)> work)
{
    auto begun = std::make_unique<Work>();
    begun->thread = std::thread([&own = *begun, work = std::move(work)] {
        try {
            work(own.job);
        } catch (...) {
            own.failure = std::current_exception();
        }
        own.ended = true;
    });
    work_ = std::move(begun);
}

double Background::seconds() const
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - work_->began).count();
}

void Background::finish()
{
    const std::unique_ptr<Work> work = std::move(work_);
    work->thread.join();
    if (work->failure && !work->job.stopped())
        std::rethrow_exception(work->failure);
}

} // namespace candelabra::app
