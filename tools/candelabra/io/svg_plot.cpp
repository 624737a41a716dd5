// SPDX-License-Identifier: Apache-2.0
#include "io/svg_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace candelabra::app
{
namespace
{

// Replaces & < > and " by entities.
std::string escaped(const std::string& text)
{
    std::string out;
    for (const char c : text) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else if (c == '"')
            out += "&quot;";
        else
            out += c;
    }
    return out;
}

// Size of the drawing and of its margins in pixels. The right margin holds the labels of the lines.
constexpr double width = 960, height = 600, left = 84, right = 220, top = 76, bottom = 66;

// Colours that people with any kind of colour vision can distinguish (Okabe and Ito 2008, with a
// brown for their yellow); black is the last.
constexpr std::array<const char*, 8> colours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                             "#e69f00", "#56b4e9", "#8a6d3b", "#000000"};

bool drawable(const std::pair<double, double>& p)
{
    return std::isfinite(p.first) && std::isfinite(p.second) && p.first > 0 && p.second > 0;
}

// A logarithmic axis from `from` to `to`, both on a 1-2-5 step, mapped to pixels a..b.
struct Axis {
    double from, to, a, b;
    double pixel(double value) const
    {
        return a + (b - a) * std::log(value / from) / std::log(to / from);
    }
};

// The largest 1-2-5 step that is <= value (down), or the smallest that is >= value (up).
double step(double value, bool down)
{
    const double decade = std::pow(10.0, std::floor(std::log10(value)));
    double best = down ? decade : decade * 10;
    for (const double m : {1.0, 2.0, 5.0, 10.0}) {
        // The tolerance lets a value that is a step itself be found in spite of rounding.
        const double s = decade * m;
        if (down ? s <= value * (1 + 1e-9) : s >= value * (1 - 1e-9)) {
            best = s;
            if (!down)
                break;
        }
    }
    return best;
}

Axis axisOver(std::vector<double> values, double a, double b)
{
    const auto [low, high] = std::ranges::minmax_element(values);
    double from = step(*low, true), to = step(*high, false);
    if (to <= from * 1.5) { // one value: give it room on both sides
        from = step(from / 2, true);
        to = step(to * 2, false);
    }
    return {from, to, a, b};
}

struct Tick {
    double value;
    bool labelled;
};

std::vector<Tick> ticks(const Axis& axis)
{
    const double decades = std::log10(axis.to / axis.from);
    std::vector<Tick> out;
    for (double decade = std::pow(10.0, std::floor(std::log10(axis.from)));
         decade <= axis.to * 1.001; decade *= 10)
        for (int m = 1; m < 10; ++m) {
            const double value = decade * m;
            if (value < axis.from * 0.999 || value > axis.to * 1.001)
                continue;
            const bool labelled = m == 1 || (decades < 4 && (m == 2 || m == 5));
            if (labelled || decades < 6)
                out.push_back({value, labelled});
        }
    return out;
}

std::string tickLabel(double value)
{
    if (value >= 1e6)
        return fmt::format("{:g}M", value / 1e6);
    if (value >= 1e3)
        return fmt::format("{:g}k", value / 1e3);
    const double exponent = std::floor(std::log10(value) + 1e-9);
    if (exponent < -3)
        return fmt::format("{:g}e{:g}", value / std::pow(10.0, exponent), exponent);
    return fmt::format("{:g}", value);
}

std::string frame(const PlotText& text, const Axis& x, const Axis& y)
{
    std::string out;
    for (const Tick& t : ticks(x)) {
        const double px = x.pixel(t.value);
        out += fmt::format("<line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\" "
                           "stroke=\"{3}\"/>\n",
                           px, top, height - bottom, t.labelled ? "#d0d0d0" : "#efefef");
        if (t.labelled)
            out += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", px,
                               height - bottom + 20, tickLabel(t.value));
    }
    for (const Tick& t : ticks(y)) {
        const double py = y.pixel(t.value);
        out += fmt::format("<line y1=\"{0:.1f}\" y2=\"{0:.1f}\" x1=\"{1}\" x2=\"{2}\" "
                           "stroke=\"{3}\"/>\n",
                           py, left, width - right, t.labelled ? "#d0d0d0" : "#efefef");
        if (t.labelled)
            out += fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n",
                               left - 8, py + 4.5, tickLabel(t.value));
    }
    out += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" "
                       "stroke=\"#404040\"/>\n",
                       left, top, width - left - right, height - top - bottom);
    const double middleX = (left + width - right) / 2, middleY = (top + height - bottom) / 2;
    out += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\" font-size=\"15\">{}"
                       "</text>\n",
                       middleX, height - 18, escaped(text.xAxis));
    out += fmt::format("<text transform=\"translate(24 {:.1f}) rotate(-90)\" "
                       "text-anchor=\"middle\" font-size=\"15\">{}</text>\n",
                       middleY, escaped(text.yAxis));
    return out;
}

constexpr size_t markerShapes = 4;

// The shape of a series' markers. Series that share a colour have different shapes.
size_t markerOf(size_t series)
{
    return (series + series / colours.size()) % markerShapes;
}

std::string marker(size_t shape, double x, double y, const char* colour)
{
    switch (shape) {
    case 0:
        return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4.5\" fill=\"{}\"/>\n", x, y,
                           colour);
    case 1:
        return fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"8\" height=\"8\" "
                           "fill=\"{}\"/>\n",
                           x - 4, y - 4, colour);
    case 2:
        return fmt::format("<path d=\"M{0:.1f} {1:.1f}l5 9h-10z\" fill=\"{2}\"/>\n", x, y - 5.5,
                           colour);
    default:
        return fmt::format("<path d=\"M{0:.1f} {1:.1f}l5 5l-5 5l-5 -5z\" fill=\"{2}\"/>\n", x,
                           y - 5, colour);
    }
}

struct Label {
    double y;
    std::string text;
    const char* colour;
    std::optional<size_t> shape; // none: no marker
};

// Moves labels apart until none overlaps, keeping their order and the middle of each cluster.
void spreadLabels(std::vector<Label>& labels)
{
    constexpr double gap = 18; // pixels between baselines of 13 px text
    std::ranges::stable_sort(labels, {}, &Label::y);
    for (int round = 0; round < 200; ++round)
        for (size_t i = 1; i < labels.size(); ++i)
            if (const double lack = gap - (labels[i].y - labels[i - 1].y); lack > 0) {
                labels[i - 1].y -= lack / 2;
                labels[i].y += lack / 2;
            }
    // The pushing above settles only approximately; this makes it exact from the top.
    double floor = top;
    for (Label& label : labels) {
        label.y = std::max(label.y, floor);
        floor = label.y + gap;
    }
}

std::string lines(const std::vector<PlotSeries>& series, const Axis& x, const Axis& y)
{
    std::string out;
    std::vector<Label> labels;
    for (size_t i = 0; i < series.size(); ++i) {
        const char* colour = colours[i % colours.size()];
        std::string path, markers;
        double lastY = 0;
        for (const auto& point : series[i].points) {
            if (!drawable(point))
                continue;
            const double px = x.pixel(point.first);
            lastY = y.pixel(point.second);
            path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", px, lastY);
            if (series[i].marked)
                markers += marker(markerOf(i), px, lastY, colour);
        }
        if (path.empty())
            continue;
        if (series[i].connected)
            out +=
                fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"{}/>\n",
                            path, colour, series[i].emphasised ? 3.5 : 1.8,
                            series[i].marked ? "" : " stroke-dasharray=\"8 5\"");
        out += markers;
        labels.push_back({lastY, series[i].name, colour,
                          series[i].marked ? std::optional(markerOf(i)) : std::nullopt});
    }
    spreadLabels(labels);
    for (const Label& label : labels)
        out +=
            (label.shape ? marker(*label.shape, width - right + 14, label.y, label.colour) : "") +
            fmt::format("<text x=\"{}\" y=\"{:.1f}\" fill=\"{}\">{}</text>\n", width - right + 26,
                        label.y + 4.5, label.colour, escaped(label.text));
    return out;
}

} // namespace

std::string logLogPlot(const PlotText& text, const std::vector<PlotSeries>& series)
{
    std::string out = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
        "height=\"{1}\" font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\" "
        "font-size=\"13\" fill=\"#202020\">\n<rect width=\"{0}\" height=\"{1}\" "
        "fill=\"white\"/>\n<text x=\"{2}\" y=\"32\" font-size=\"20\">{3}</text>\n"
        "<text x=\"{2}\" y=\"56\" fill=\"#606060\">{4}</text>\n",
        width, height, left, escaped(text.title), escaped(text.subtitle));
    std::vector<double> xs, ys;
    for (const PlotSeries& s : series)
        for (const auto& point : s.points)
            if (drawable(point)) {
                xs.push_back(point.first);
                ys.push_back(point.second);
            }
    if (xs.empty())
        return out + fmt::format("<text x=\"{}\" y=\"{}\">no measurement to draw</text>\n</svg>\n",
                                 left, height / 2);
    const Axis x = axisOver(xs, left, width - right);
    const Axis y = axisOver(ys, height - bottom, top);
    return out + frame(text, x, y) + lines(series, x, y) + "</svg>\n";
}

} // namespace candelabra::app
