// SPDX-License-Identifier: Apache-2.0
// A line plot with logarithmic axes as an SVG file. It is drawn here, because it is the only kind
// of plot: Debian's plotting libraries draw many kinds into many formats (PLplot, MathGL), or run
// gnuplot, which users would have to install.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace candelabra::app
{

struct PlotSeries {
    std::string name;
    std::vector<std::pair<double, double>> points; // values <= 0 or not finite are left out
    bool emphasised = false;                       // drawn thicker
    bool connected = true;                         // false: markers without a line
    bool marked = true;                            // false: a dashed line without markers
};

struct PlotText {
    std::string title, subtitle, xAxis, yAxis; // the axes' names contain the unit
};

// A complete SVG document. Series differ by colour, marker shape and a label at the end of the
// line. If no point can be drawn, the plot says so.
std::string logLogPlot(const PlotText& text, const std::vector<PlotSeries>& series);

} // namespace candelabra::app
