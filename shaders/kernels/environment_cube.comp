// SPDX-License-Identifier: Apache-2.0
// Converts an equirectangular radiance image into a cube.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/environment_data.h"
#include "lib/cube.glsl"
#include "lib/equirectangular.glsl"
#include "kernels/common/environment_image.glsl"

layout(local_size_x = ENVIRONMENT_GROUP, local_size_y = ENVIRONMENT_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    EnvironmentCubeParams params;
};
layout(binding = ENVIRONMENT_CUBE_OUTPUT, rgba32f) uniform image2DArray cube;
layout(binding = ENVIRONMENT_CUBE_MIRROR, rgba32f) uniform writeonly image2DArray mirror;

// A texel of the cube, which gathers from within one texel around its centre.
struct Receiver {
    mat3 face;      // columns: directions of u, of v, and of the middle of the face
    vec2 centre;    // u and v
    float size;     // of a texel, in u and v
    float perSize;  // 1 / size
    bvec2 atLowest; // it is the first texel of its row, of its column
    bvec2 atHighest;
};

// A range of texels of the image, not rounded: the columns may begin below 0 and end beyond the
// width.
struct Range {
    vec2 first, last;
};

Receiver receiverAt(uvec3 texel)
{
    const vec3 middle = cubeDirection(texel.z, vec2(0.0));
    const mat3 face = mat3(cubeDirection(texel.z, vec2(1.0, 0.0)) - middle,
                           cubeDirection(texel.z, vec2(0.0, 1.0)) - middle, middle);
    return Receiver(face, cubeTexelCentre(texel.xy, params.cubeSize), 2.0 / float(params.cubeSize),
                    0.5 * float(params.cubeSize),
                    equal(texel.xy, uvec2(0u)), equal(texel.xy, uvec2(params.cubeSize - 1u)));
}

// Returns a number in [-2, 2] that grows with the angle of (x, y) in [-pi, pi], and takes less time.
float turnOf(float x, float y)
{
    const float turn = y / (abs(x) + abs(y));
    return x >= 0.0 ? turn : (y >= 0.0 ? 2.0 : -2.0) - turn;
}

// Returns the angle for which turnOf() gives this number.
float angleOf(float turn)
{
    const float x = 1.0 - abs(turn);
    return atan(x >= 0.0 ? turn : (turn >= 0.0 ? 2.0 : -2.0) - turn, x);
}

// Returns the texels of the image that the receiver gathers from, all columns if a pole is among
// them.
Range rangeOf(Receiver r)
{
    const vec2 low = max(r.centre - r.size, -1.0);
    const vec2 high = min(r.centre + r.size, 1.0);
    const vec2 nearest = clamp(vec2(0.0), low, high);
    const vec3 towards = r.face * vec3(r.centre, 1.0);
    vec2 turns = vec2(0.0); // least and greatest azimuth, relative to the centre's
    vec2 cotangents = vec2(1e30, -1e30);
    for (uint i = 0u; i < 9u; ++i) {
        const uvec2 at = uvec2(i % 3u, i / 3u);
        const vec2 uv = mix(mix(low, nearest, equal(at, uvec2(1u))), high, equal(at, uvec2(2u)));
        const vec3 d = r.face * vec3(uv, 1.0);
        const float turn = turnOf(dot(d.xz, towards.xz), d.z * towards.x - d.x * towards.z);
        turns = vec2(min(turns.x, turn), max(turns.y, turn));
        const float cotangent = d.y / max(length(d.xz), 1e-20);
        cotangents = vec2(min(cotangents.x, cotangent), max(cotangents.y, cotangent));
    }
    const vec2 azimuths = vec2(angleOf(turns.x), angleOf(turns.y));
    const vec2 size = vec2(params.imageSize);
    const bool hasPole = r.face[2].y != 0.0 && nearest == vec2(0.0);
    const float middle = (atan(towards.x, -towards.z) * (0.5 * INV_PI) + 0.5) * size.x;
    const vec2 columns = hasPole ? vec2(0.0, size.x) : middle + azimuths * (0.5 * INV_PI * size.x);
    const vec2 rows = vec2(atan(1.0, cotangents.y), atan(1.0, cotangents.x)) * (INV_PI * size.y);
    return Range(vec2(columns.x, rows.x), vec2(columns.y, rows.y));
}

// Returns into how many parts a texel of a row is divided: so many that parts are at most 0.8 texels of
// the cube wide and high, and on the faces around the poles, where parts lie askew, 0.6 texels high.
uvec2 partsOfTexels(uint row)
{
    const vec2 polar = polarCosSin(float(row) + 0.5, float(params.imageSize.y));
    const float cos2 = polar.x * polar.x;
    // The faces around the poles reach to a cos2 of 1/3, a little farther with a whole row.
    const vec2 stretch =
        cos2 > 0.25 ? vec2(polar.y * inversesqrt(cos2), 1.3 / cos2) : vec2(1.0);
    const vec2 angles = vec2(2.0 * PI, PI) / vec2(params.imageSize);
    return uvec2(max(ceil(0.625 * float(params.cubeSize) * stretch * angles - 0.01), 1.0));
}

// Returns the integral of a receiver's tent from its centre to x (in texels), along u and along v.
// Beyond the centre of a texel at the edge of the face the tent is flat up to the edge.
vec2 tentIntegral(vec2 x, bvec2 atLowest, bvec2 atHighest)
{
    const vec2 distance = abs(x);
    const bvec2 flatHere = mix(atHighest, atLowest, lessThan(x, vec2(0.0)));
    const vec2 inside = min(distance, 1.0);
    return sign(x) * mix(inside - 0.5 * inside * inside, min(distance, 0.5), flatHere);
}

// Returns the share of a part's light that a receiver gets. `middle` is its direction,
// `alongColumn` and `alongRow` are half its extent. On the face it is taken for a rectangle that is
// as wide.
float shareOf(Receiver r, vec3 middle, vec3 alongColumn, vec3 alongRow)
{
    const vec3 at = middle * r.face;
    if (at.z <= 0.0)
        return 0.0;
    const float perDepth = 1.0 / at.z;
    const vec2 uv = at.xy * perDepth;
    const vec3 column = alongColumn * r.face;
    const vec3 row = alongRow * r.face;
    const vec2 columnExtent = column.xy - uv * column.z;
    const vec2 rowExtent = row.xy - uv * row.z;
    // In texels of the cube.
    const vec2 centre = (uv - r.centre) * r.perSize;
    const vec2 extent = max(sqrt(columnExtent * columnExtent + rowExtent * rowExtent) *
                                (perDepth * r.perSize), 0.01);
    const vec2 shares = (tentIntegral(centre + extent, r.atLowest, r.atHighest) -
                         tentIntegral(centre - extent, r.atLowest, r.atHighest)) /
                        (2.0 * extent);
    return shares.x * shares.y;
}

// Returns the number of a part that may be counted from beyond an end of its row.
float wrapped(int part, float columns)
{
    return float(part) + (part < 0 ? columns : float(part) < columns ? 0.0 : -columns);
}

// Returns what a receiver gets from one row: luminance times solid angle, and the solid angle.
vec4 gatherRow(Receiver r, Range range, uint row)
{
    const uvec2 parts = partsOfTexels(row);
    const float columns = float(params.imageSize.x * parts.x);
    const float rows = float(params.imageSize.y * parts.y);
    // The ranges in parts, with a margin, because the rectangles differ a little from the parts.
    const vec2 edges = vec2(range.first.x, range.last.x) * float(parts.x) + vec2(-0.05, 0.05);
    const bool isWhole = edges.y - edges.x >= columns;
    const int first = isWhole ? 0 : int(floor(edges.x));
    const int last = isWhole ? int(columns) : int(ceil(edges.y));
    const vec2 within =
        (vec2(range.first.y, range.last.y) - float(row)) * float(parts.y) + vec2(-0.05, 0.05);
    const vec2 halfExtent = vec2(PI, HALF_PI) / vec2(columns, rows);
    const float perTexel = 1.0 / float(parts.x);
    const float halfSine = smallSine(halfExtent.x);
    const vec2 turn = vec2(1.0 - 2.0 * halfSine * halfSine, smallSine(2.0 * halfExtent.x));
    vec4 sum = vec4(0.0);
    for (uint j = uint(max(floor(within.x), 0.0)); float(j) < min(ceil(within.y), float(parts.y));
         ++j) {
        const vec2 polar = polarCosSin(float(row * parts.y + j) + 0.5, rows);
        // The azimuth is turned from part to part, which takes less time than its cosine and sine do.
        vec2 azimuth = azimuthCosSin(wrapped(first, columns) + 0.5, columns);
        vec4 partSum = vec4(0.0);
        for (int i = first; i < last; ++i) {
            const float part = wrapped(i, columns) + 0.5;
            const vec3 middle = vec3(azimuth.y * polar.y, polar.x, -azimuth.x * polar.y);
            const vec3 alongRow = halfExtent.x * polar.y * vec3(azimuth.x, 0.0, azimuth.y);
            const vec3 alongColumn =
                halfExtent.y * vec3(azimuth.y * polar.x, -polar.y, -azimuth.x * polar.x);
            const float share = shareOf(r, middle, alongColumn, alongRow);
            partSum += share * vec4(luminanceAt(uint(part * perTexel), row), 1.0);
            azimuth = vec2(azimuth.x * turn.x - azimuth.y * turn.y,
                           azimuth.y * turn.x + azimuth.x * turn.y);
        }
        sum += polar.y * partSum;
    }
    return 4.0 * halfExtent.x * smallSine(halfExtent.y) * sum;
}

void main()
{
    const uvec3 texel = gl_GlobalInvocationID;
    if (any(greaterThanEqual(texel.xy, uvec2(params.cubeSize))))
        return;
    const Receiver receiver = receiverAt(texel);
    const Range range = rangeOf(receiver);
    const uint firstRow = uint(max(floor(range.first.y - 0.05), 0.0));
    const uint lastRow = uint(min(ceil(range.last.y + 0.05), float(params.imageSize.y)));
    const uint begin = firstRow + params.skippedRows;
    const uint end = min(begin + params.rows, lastRow);
    if (begin >= end)
        return;
    vec4 sum = params.skippedRows > 0u ? imageLoad(cube, ivec3(texel)) : vec4(0.0);
    for (uint row = begin; row < end; ++row)
        sum += gatherRow(receiver, range, row);
    if (end == lastRow) {
        sum = vec4(sum.rgb / sum.a, 1.0);
        imageStore(mirror, ivec3(texel), sum);
    }
    imageStore(cube, ivec3(texel), sum);
}
