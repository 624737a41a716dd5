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
        --line: #d0d0d0; --dim: #505050; --bar: #0072b2; }
@media (prefers-color-scheme: dark) {
  :root { --text: #e4e4e0; --back: #141414; --soft: #202124; --line: #44474d; --dim: #a8abb2;
          --bar: #56b4e9; }
  svg { filter: invert(0.92) hue-rotate(180deg); }
}
body { font: 15px/1.5 "DejaVu Sans", Helvetica, Arial, sans-serif; color: var(--text);
       background: var(--back); margin: 2em auto; max-width: 1200px; padding: 0 1em; }
pre { font: 12.5px/1.45 "DejaVu Sans Mono", Menlo, Consolas, monospace; background: var(--soft);
      padding: 1em; overflow-x: auto; }
figure { display: inline-block; margin: 0 10px 14px 0; vertical-align: top; width: 264px; }
figure img { width: 100%; image-rendering: pixelated; display: block; background: #000; }
figcaption, .made { font-size: 12.5px; color: var(--dim); }
code { font: 12.5px "DejaVu Sans Mono", Menlo, Consolas, monospace; }
svg { max-width: 100%; height: auto; }
h2 { margin-top: 2em; border-bottom: 1px solid var(--line); }
table { border-collapse: collapse; }
th, td { text-align: right; padding: 1px 12px 1px 0; }
th:first-child, td:first-child, td.bars { text-align: left; }
td.bars { width: 320px; }
.bar { background: var(--bar); height: 11px; }
.wipe { max-width: 960px; margin-bottom: 14px; }
.wipe .pictures { position: relative; }
.wipe img { width: 100%; display: block; image-rendering: pixelated; }
.wipe img.over { position: absolute; left: 0; top: 0; }
.wipe input { width: 100%; margin: 4px 0; }
)";

// The script holds neither < nor an ampersand, because the page is XML as well.
constexpr const char* script = R"(
for (const w of document.querySelectorAll('.wipe')) {
  const [left, right] = w.querySelectorAll('select');
  const slider = w.querySelector('input');
  const show = () => {
    w.querySelector('.over').src = document.querySelector('#' + left.value + ' img').src;
    w.querySelector('.under').src = document.querySelector('#' + right.value + ' img').src;
    w.querySelector('.over').style.clipPath = 'inset(0 ' + (100 - slider.value) + '% 0 0)';
  };
  for (const input of [left, right, slider])
    input.addEventListener('input', show);
  w.hidden = false;
  show();
}
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
                       "<meta name=\"viewport\" content=\"width=device-width\"/>"
                       "<link rel=\"icon\" href=\"data:,\"/><title>{0}</title>"
                       "<style>{1}</style></head><body>\n<h1>{0}</h1>\n",
                       escaped(title), style);
}

std::string pageEnd()
{
    return fmt::format("<script>{}</script></body></html>\n", script);
}

std::string preformatted(const std::string& text)
{
    return "<pre>" + escaped(text) + "</pre>\n";
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

std::string wipe(const std::vector<WipeChoice>& choices)
{
    const auto list = [&](size_t chosen, const char* side) {
        std::string out = fmt::format("<select aria-label=\"{}\">", side);
        for (size_t i = 0; i < choices.size(); ++i)
            out +=
                fmt::format("<option value=\"{}\"{}>{}</option>", escaped(choices[i].id),
                            i == chosen ? " selected=\"selected\"" : "", escaped(choices[i].name));
        return out + "</select>";
    };
    // The wipe is hidden until the script has filled it in.
    return "<div class=\"wipe\" hidden=\"hidden\"><div class=\"pictures\">"
           "<img class=\"under\" alt=\"right\"/><img class=\"over\" alt=\"left\"/></div>"
           "<input type=\"range\" min=\"0\" max=\"100\" value=\"50\" aria-label=\"slider\"/>" +
           list(0, "left") + " | " + list(choices.size() - 1, "right") + "</div>\n";
}

} // namespace candelabra::app
