// SPDX-License-Identifier: Apache-2.0
// Progress: one line on the terminal (stderr) that says how far a long job is.
#pragma once

#include <chrono>
#include <string>

namespace candelabra::app
{

class Progress
{
public:
    // `steps` in all. Writes nothing unless stderr is a terminal and `visible`.
    Progress(double steps, bool visible);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // Says what is going on now.
    void doing(const std::string& what);
    // `steps` more are done.
    void advance(double steps);

private:
    void draw();

    double steps_, done_ = 0;
    bool visible_;
    std::string what_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

} // namespace candelabra::app
