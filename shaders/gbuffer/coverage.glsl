// SPDX-License-Identifier: Apache-2.0
// Surfaces that cover only a share of each pixel. A G-buffer holds one surface per pixel, so such a
// surface is drawn at that share of the pixels, and at other pixels in each of several frames that are
// averaged. All of it is integer arithmetic, so that every device draws the same pixels.
#ifndef CND_GBUFFER_COVERAGE
#define CND_GBUFFER_COVERAGE

// Returns a number between 0 and 1. A surface is drawn at a pixel if its coverage there is above.
// Along x, y and `frame` the numbers are additive recurrences, whose first n terms fill the range
// evenly for every n. Their steps along x and y are powers of the inverse roots of x^(d+1) = x + 1
// (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences") for d = 2, 3 and 4, along
// frames the fractions of the roots of 2, 3, 5 and 7. A `layer` takes one of 16 combinations of them,
// so that several layers cover a pixel independently of each other.
float coverageThreshold(uvec2 pixel, uint frame, uint layer)
{
    // in units of 2^-32
    const uint steps[8] = {0xC13FA9A9u, 0x91E10DA5u, 0xD1B54A32u, 0xABC98388u,
                           0x8CB92BA7u, 0xDB4F0B91u, 0xBBE05633u, 0xA0F2EC75u};
    const uint frameSteps[4] = {0x6A09E667u, 0xBB67AE85u, 0x3C6EF372u, 0xA54FF53Au};
    const uint symmetry = layer & 3u;
    const uint pair = 2u * (layer >> 2u & 3u);
    const uint alongX = steps[pair + (symmetry & 1u)] * pixel.x;
    const uint alongY = steps[pair + 1u - (symmetry & 1u)] * pixel.y;
    const uint offset = 0x9E3779B9u * (layer >> 4u); // the golden section
    const uint sum =
        alongX + (symmetry < 2u ? alongY : 0u - alongY) + frameSteps[symmetry] * frame + offset;
    return (float(sum >> 16u) + 0.5) / 65536.0;
}

#endif
