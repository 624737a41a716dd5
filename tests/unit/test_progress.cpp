// SPDX-License-Identifier: Apache-2.0
// Progress of a long job as a log has it: standard error is no terminal here.
#include <regex>

#include <gtest/gtest.h>

#include "io/progress.h"

namespace candelabra::test
{
namespace
{

std::string logOf(bool visible, app::Progress::Clock::duration period)
{
    testing::internal::CaptureStderr();
    {
        app::Progress progress(4, visible, period);
        progress.doing("counting");
        progress.advance(1);
        progress.advance(2);
    }
    return testing::internal::GetCapturedStderr();
}

} // namespace

TEST(Progress, IsALinePerPeriodInALog)
{
    const std::string log = logOf(true, std::chrono::seconds(0));
    EXPECT_TRUE(std::regex_match(log, std::regex("  0% after 0 s: counting\n"
                                                 " 25% after 0 s, about 0 s left: counting\n"
                                                 " 75% after 0 s, about 0 s left: counting\n")))
        << log;
}

TEST(Progress, OfAShortJobIsNotInALog)
{
    EXPECT_EQ(logOf(true, std::chrono::hours(1)), "");
}

TEST(Progress, IsSilentWhereNobodyAskedForIt)
{
    EXPECT_EQ(logOf(false, std::chrono::seconds(0)), "");
}

} // namespace candelabra::test
