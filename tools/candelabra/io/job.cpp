// SPDX-License-Identifier: Apache-2.0
#include "io/job.h"

namespace candelabra::app
{

bool Job::doing(const std::string& what, double done)
{
    const std::lock_guard lock(mutex_);
    state_ = {what, done};
    return !stopped_;
}

Job::State Job::state() const
{
    const std::lock_guard lock(mutex_);
    return state_;
}

void Job::stop()
{
    const std::lock_guard lock(mutex_);
    stopped_ = true;
}

bool Job::stopped() const
{
    const std::lock_guard lock(mutex_);
    return stopped_;
}

} // namespace candelabra::app
