// SPDX-License-Identifier: Apache-2.0
#include "io/html_page.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "io/image.h"
#include "io/markup.h"

namespace candelabra::app
{
namespace
{

// Plots are drawn dark on white. On a dark page they are inverted, and their hues are turned back.
constexpr const char* style = R"(
:root { color-scheme: light dark; --text: #202020; --back: #ffffff; --soft: #f4f4f1;
        --line: #d0d0d0; --dim: #505050; --bar: #0072b2; --link: #00588c; }
@media (prefers-color-scheme: dark) {
  :root { --text: #e4e4e0; --back: #141414; --soft: #202124; --line: #44474d; --dim: #a8abb2;
          --bar: #56b4e9; --link: #7cc4f0; }
  svg { filter: invert(0.92) hue-rotate(180deg); }
}
body { font: 15px/1.5 "DejaVu Sans", Helvetica, Arial, sans-serif; color: var(--text);
       background: var(--back); margin: 2em auto; max-width: 1100px; padding: 0 1em;
       overflow-wrap: break-word; }
p, ol, nav { max-width: 48em; }
ol { padding-left: 1.5em; }
a { color: var(--link); }
ol.sentences li { margin: 0.6em 0; }
figure { display: inline-block; margin: 0 10px 14px 0; vertical-align: top;
         width: min(320px, 100%); }
figure img { width: 100%; image-rendering: pixelated; display: block; background: #000; }
figcaption, .made, .note { font-size: 12.5px; color: var(--dim); }
code { font: 12.5px "DejaVu Sans Mono", Menlo, Consolas, monospace; }
h2 { margin-top: 2em; border-bottom: 1px solid var(--line); }
.scroll { overflow-x: auto; margin: 1.2em 0 0.3em; }
.scroll svg { display: block; min-width: 640px; max-width: 100%; height: auto; }
table { border-collapse: collapse; font-size: 13px; font-variant-numeric: tabular-nums; }
caption { text-align: left; font-weight: bold; padding-bottom: 4px; }
thead th { vertical-align: bottom; border-bottom: 1px solid var(--line); }
th small { font-weight: normal; color: var(--dim); white-space: nowrap; }
th, td { text-align: right; padding: 2px 14px 2px 0; }
td { white-space: nowrap; }
tbody th { font-weight: normal; min-width: 9em; }
tbody tr:nth-child(even) { background: var(--soft); }
th:first-child, .words { text-align: left; }
tr.ruled > * { border-top: 1px solid var(--line); }
.terms { background: var(--soft); border-left: 3px solid var(--bar); padding: 0.5em 1em;
         max-width: 48em; font-size: 13.5px; margin: 0.8em 0 1.2em; }
.terms p { margin: 0; font-weight: bold; }
dl { margin: 0.3em 0; max-width: 48em; font-size: 13.5px; }
dt { font-weight: bold; }
dd { margin: 0 0 0.3em 1.2em; }
summary { cursor: pointer; font-size: 13px; color: var(--link); margin-bottom: 0.4em; }
.bars { max-width: 40em; font-size: 12.5px; margin: 1em 0; }
.bar { background: var(--bar); height: 8px; min-width: 1px; margin-bottom: 5px; }
.wipe { max-width: 800px; margin-bottom: 14px; }
.wipe .pair { display: flex; gap: 8px; }
.wipe .pair figure { flex: 1; margin: 0; }
.wipe .live[hidden], .wipe .pair[hidden] { display: none; }
.wipe .pictures { position: relative; }
.wipe .pictures img { width: 100%; display: block; image-rendering: pixelated; }
.wipe img.over { position: absolute; left: 0; top: 0; height: 100%; }
.wipe .split { position: absolute; top: 0; bottom: 0; width: 2px; margin-left: -1px;
               background: #fff; box-shadow: 0 0 0 1px #000; pointer-events: none; }
.wipe input { width: 100%; margin: 6px 0; }
.wipe .sides { display: flex; justify-content: space-between; gap: 8px; font-size: 13px; }
.wipe select { max-width: 100%; }
@media print {
  body { max-width: none; }
  .scroll { overflow: visible; }
  .wipe .live { display: none; }
  .wipe .pair[hidden] { display: flex; }
  figure { break-inside: avoid; }
}
)";

// The script holds neither < nor an ampersand, because the page is XML as well. Without it the
// pictures of a wipe are side by side, and what is folded is not printed.
constexpr const char* script = R"(
for (const w of document.querySelectorAll('.wipe')) {
  const [left, right] = w.querySelectorAll('select');
  const slider = w.querySelector('input');
  const over = w.querySelector('.over'), under = w.querySelector('.under');
  const split = w.querySelector('.split');
  const fill = (image, choice) => {
    image.src = document.querySelector('#' + choice.value + ' img').src;
    image.alt = choice.selectedOptions[0].textContent;
  };
  const show = () => {
    fill(over, left);
    fill(under, right);
    over.style.clipPath = 'inset(0 ' + (100 - slider.value) + '% 0 0)';
    split.style.left = slider.value + '%';
  };
  for (const input of [left, right, slider])
    input.addEventListener('input', show);
  w.querySelector('.pair').hidden = true;
  w.querySelector('.live').hidden = false;
  show();
}
addEventListener('beforeprint', () => {
  for (const d of document.querySelectorAll('details'))
    d.open = true;
});
)";

// RFC 4648.
std::string base64(const std::vector<uint8_t>& bytes)
{
    constexpr const char* digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        const size_t left = bytes.size() - i;
        const uint32_t word = uint32_t(bytes[i]) << 16 |
                              uint32_t(left > 1 ? bytes[i + 1] : 0) << 8 |
                              uint32_t(left > 2 ? bytes[i + 2] : 0);
        out += digits[word >> 18];
        out += digits[word >> 12 & 63];
        out += left > 1 ? digits[word >> 6 & 63] : '=';
        out += left > 2 ? digits[word & 63] : '=';
    }
    return out;
}

uint8_t byteOf(float x)
{
    return uint8_t(std::lround(std::clamp(x, 0.0f, 1.0f) * 255));
}

} // namespace

std::string pageHead(const std::string& title)
{
    return fmt::format("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>"
                       "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>"
                       "<link rel=\"icon\" href=\"data:,\"/><title>{0}</title>"
                       "<style>{1}</style></head><body>\n<h1>{0}</h1>\n",
                       escaped(title), style);
}

std::string pageEnd()
{
    return fmt::format("<script>{}</script></body></html>\n", script);
}

std::string plotBox(const std::string& svg, const std::string& name)
{
    return fmt::format("<div class=\"scroll\" role=\"img\" tabindex=\"0\" aria-label=\"{}\">{}"
                       "</div>\n",
                       escaped(name), svg);
}

std::string folded(const std::string& summary, const std::string& html)
{
    return "<details><summary>" + escaped(summary) + "</summary>\n" + html + "</details>\n";
}

std::string madeBy(const std::string& command)
{
    return "<p class=\"made\">made by <code>" + escaped(command) + "</code></p>\n";
}

std::string figure(const DisplayImage& image, const std::string& caption, const std::string& id)
{
    std::vector<uint8_t> rgb;
    for (const glm::vec3& p : image.pixels)
        rgb.insert(rgb.end(), {byteOf(p.x), byteOf(p.y), byteOf(p.z)});
    const std::string named = id.empty() ? "" : fmt::format(" id=\"{}\"", escaped(id));
    return fmt::format("<figure{}><img alt=\"{}\" src=\"data:image/png;base64,{}\"/><figcaption>{}"
                       "</figcaption></figure>\n",
                       named, escaped(caption),
                       base64(encodePng("page", image.width, image.height, rgb)), escaped(caption));
}

std::string wipe(const std::vector<WipeChoice>& choices, size_t left, size_t right)
{
    const auto list = [&](size_t chosen, const char* side) {
        std::string out = fmt::format("<label>{} <select>", side);
        for (size_t i = 0; i < choices.size(); ++i)
            out +=
                fmt::format("<option value=\"{}\"{}>{}</option>", escaped(choices[i].id),
                            i == chosen ? " selected=\"selected\"" : "", escaped(choices[i].name));
        return out + "</select></label>";
    };
    std::string others;
    for (size_t i = 0; i < choices.size(); ++i)
        if (i != left && i != right)
            others += choices[i].figure;
    // The live part is hidden until the script has filled it in.
    return "<div class=\"wipe\"><div class=\"pair\">" + choices[left].figure +
           choices[right].figure +
           "</div>\n<div class=\"live\" hidden=\"hidden\"><div class=\"pictures\">"
           "<img class=\"under\" alt=\"\" src=\"data:,\"/><img class=\"over\" alt=\"\" "
           "src=\"data:,\"/><div class=\"split\"></div></div><input type=\"range\" min=\"0\" "
           "max=\"100\" value=\"50\" "
           "aria-label=\"where the left picture ends and the right one begins\"/>"
           "<div class=\"sides\">" +
           list(left, "left") + list(right, "right") + "</div></div></div>\n" +
           (others.empty() ? "" : folded("All pictures of this comparison", others));
}

} // namespace candelabra::app
