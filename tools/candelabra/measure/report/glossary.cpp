// SPDX-License-Identifier: Apache-2.0
#include "measure/report/glossary.h"

#include <algorithm>
#include <cctype>

namespace candelabra::app
{
namespace
{

bool isOfWord(char c)
{
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-';
}

bool hasWord(const std::string& text, const std::string& word)
{
    for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
        const size_t end = at + word.size();
        if ((at == 0 || !isOfWord(text[at - 1])) && (end == text.size() || !isOfWord(text[end])))
            return true;
    }
    return false;
}

const std::vector<Term> terms = {
    {"alpha",
     {"alpha"},
     "How rough a surface is in the formula of its lobe: the square of the perceptual "
     "roughness, from 0 (a mirror) to 1 (matt)."},
    {"area light",
     {"area light", "area lights", "Area lights"},
     "A light with a size, such as a ball, a tube or a rectangle, in contrast to a point."},
    {"brute force",
     {"brute force", "Brute force"},
     "Every light is evaluated at every pixel, without looking for those that matter."},
    {"conic",
     {"conic", "conic-full"},
     "Candelabra's own formula for area lights, and its default method. It adds up exactly how "
     "much of the light lies within the lobe, the bundle of directions that the surface mirrors; "
     "how its bumps hide one another, and how much more it mirrors at grazing angles, are computed "
     "for one or two directions of a light, or of each of two bands of one near the horizon. "
     "conic-full takes more of them, which takes longer."},
    {"culling",
     {"culling", "Culling"},
     "Finding, for every pixel, the few lights that can reach it, so that the others are not "
     "evaluated."},
    {"F = 1",
     {"F = 1", "F0"},
     "F is the share of light that a surface mirrors, and F0 that share seen straight ahead: 1 "
     "is a perfect metal, 0.04 is plastic."},
    {"fence",
     {"fence"},
     "A scene that the program makes: rows of wooden slats and bamboo one behind the other, lit by "
     "any number of small lamps. Nearly every part of the image shows several depths, which is "
     "hard for culling."},
    {"FLIP",
     {"FLIP"},
     "A measure of the difference that a person sees between two pictures, from 0 (none) to 1 "
     "(Andersson et al. 2020)."},
    {"floor",
     {"/ floor", "(floor)"},
     "A frame that looks for no lights: each pixel evaluates as many lights as add light to it, so "
     "that the time of evaluating lights alone remains."},
    {"form factor",
     {"form factor"},
     "The share of light that a matt surface receives from an area light, given its shape and "
     "position."},
    {"froxels",
     {"froxels", "froxel"},
     "A common way of culling: the view is cut into boxes in width, height and depth (froxels), "
     "each with a list of lights."},
    {"hall",
     {"hall"},
     "A scene that the program makes: an old hall of columns, arcades and a vault, lit by any "
     "number of small lamps."},
    {"interval",
     {"95%", "interval", "intervals"},
     "A range in square brackets that holds the true median with at least 95% confidence, "
     "whatever the distribution of the repeats (order statistics). A number after \u00b1 is the "
     "margin of a mean, with about 95% confidence, from the scatter between kinds of surface and "
     "light."},
    {"karis",
     {"karis"},
     "The representative point of Karis (2013) for spheres, which is common in games; for "
     "other shapes the same idea."},
    {"kx", {"kx"}, "A variant of karis whose brightness is corrected at the peak of the lobe."},
    {"llvmpipe",
     {"llvmpipe"},
     "A driver that runs GPU programs on the CPU. Its times say how methods compare, but not "
     "how fast a GPU is."},
    {"lobe",
     {"lobe", "lobes"},
     "The bundle of directions into which a surface mirrors light; the rougher the surface, "
     "the wider."},
    {"LTC",
     {"LTC", "ltc"},
     "Linearly transformed cosines (Heitz et al. 2016), a published approximation for area "
     "lights that looks its parameters up in a table."},
    {"median",
     {"median", "medians"},
     "The value in the middle: half of the measurements are below it."},
    {"overlaps", {"overlaps"}, "How many lights reach a surface point of the scene on average."},
    {"pair", {"pairs", "(pixel, light)"}, "One light at one pixel."},
    {"percentile",
     {"p95", "p99", "percentile"},
     "p99 is the value that 99% of the measurements do not exceed, and p95 the same for 95%."},
    {"quadrature",
     {"quadrature"},
     "Numerical integration to a known tolerance, here in double precision on the CPU. It "
     "gives the truth."},
    {"relMSE",
     {"relMSE"},
     "The mean over all pixels of the squared error divided by the squared true value (with a "
     "small constant against division by zero): 1e-4 is an error of about 1%."},
    {"representative point",
     {"representative point"},
     "An approximation of an area light by the one of its points that matters most for the "
     "reflection."},
    {"sampled",
     {"sampled"},
     "Random points on the light, the same way as in film renderers but with few points: right "
     "on average, but noisy."},
    {"tiles",
     {"tiles", "tile"},
     "A common way of culling: a list of lights for every square of pixels of the screen (a "
     "tile)."},
    {"truth",
     {"truth"},
     "What the lighting model gives if it is integrated exactly, computed by quadrature in "
     "double precision."},
};

} // namespace

const std::vector<Term>& glossary()
{
    return terms;
}

std::vector<Term> TermFinder::firstIn(const std::string& text)
{
    std::vector<Term> out;
    for (const Term& term : glossary())
        if (!found_.contains(term.name) &&
            std::any_of(term.words.begin(), term.words.end(),
                        [&](const std::string& word) { return hasWord(text, word); })) {
            found_.insert(term.name);
            out.push_back(term);
        }
    return out;
}

std::vector<Term> TermFinder::all() const
{
    std::vector<Term> out = glossary();
    std::erase_if(out, [&](const Term& term) { return !found_.contains(term.name); });
    return out;
}

} // namespace candelabra::app
