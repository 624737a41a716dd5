// SPDX-License-Identifier: Apache-2.0
// Progress: a line on the terminal (stderr) that shows how much of a long job is done.
#pragma once

#include <chrono>
#include <string>

namespace candelabra::app
{

class Progress
{
public:
    // `steps` is the size of the whole job, in any unit. Nothing is written unless stderr is a
    // terminal and `visible` is true.
    Progress(double steps, bool visible);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // Shows what is being done now.
    void doing(const std::string& what);
    // Counts `steps` more as done.
    void advance(double steps);

private:
    void draw();

    double steps_, done_ = 0;
    bool visible_;
    std::string what_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

} // namespace candelabra::app
