// SPDX-License-Identifier: Apache-2.0
// Leaves out the triangles that the rasteriser would set up without any effect: they are outside of the
// image, face away, or cover no centre of a pixel, where surfaces are sampled. One lane tests up to
// PIECE_TRIANGLES consecutive triangles of one drawn instance. It writes the indices of the triangles
// that remain, in their old order, and a draw command for them. Every test allows for rounding, here
// and in the vertex shader, and for the grid to which the rasteriser moves vertices: it may keep a
// triangle that covers nothing, but drops none that covers a sample.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "lib/camera_relative.glsl"
#include "gbuffer/sample_bounds.glsl"
#include "gbuffer/slack.glsl"
#include "shared/raster.h"

layout(local_size_x = CULL_TRIANGLES_GROUP) in;
layout(scalar, binding = CULL_TRIANGLES_FRAME) uniform FrameBuffer
{
    CullTrianglesFrame frame;
};
layout(binding = CULL_TRIANGLES_INSTANCES) uniform textureBuffer instances;
layout(binding = CULL_TRIANGLES_CORNERS) uniform textureBuffer corners;
layout(scalar, binding = CULL_TRIANGLES_BATCHES) readonly buffer Batches
{
    PieceBatch batches[];
};
layout(scalar, binding = CULL_TRIANGLES_PIECE_BATCHES) readonly buffer PieceBatches
{
    uint pieceBatches[];
};
layout(scalar, binding = CULL_TRIANGLES_VISIBLE) readonly buffer Visible
{
    uint visible[];
};
layout(scalar, binding = CULL_TRIANGLES_COMMANDS) readonly buffer Commands
{
    DrawCommand commands[];
};
layout(scalar, binding = CULL_TRIANGLES_KEPT) writeonly buffer Kept
{
    uint kept[];
};
layout(scalar, binding = CULL_TRIANGLES_DRAWS) writeonly buffer Draws
{
    DrawCommand draws[];
};

// Samples are looked for in triangles that reach over at most so many rows or columns of pixels.
const int SMALL_ROWS = 4;

// The parts of a piece.
struct Piece {
    uint triangles; // 0: the piece is not needed in this frame
    uint firstCorner;
    uint firstKept;
    uint slot; // place of its instance in `visible`
    uint vertexOffset;
};

// Maps an instance to the image. A point at (x, y, w) = numerators * (position, 1) is in the pixel
// (x / w, y / w).
struct Projection {
    mat4x3 numerators;
    float error;  // largest rounding error of x and y, pixels times metres
    float wError; // largest rounding error of w
};

Piece pieceAt(uint index, PieceBatch batch)
{
    uint left = index - batch.firstPiece;
    uint kept = batch.firstKept;
    Piece piece = Piece(0u, 0u, 0u, 0u, 0u);
    // All levels are tried, so that lanes of pieces of different levels stay together.
    for (uint level = 0u; level < batch.levelCount; ++level) {
        const DrawCommand command = commands[batch.firstCommand + level];
        const uint triangles = command.indexCount / 3u;
        const uint pieces = (triangles + PIECE_TRIANGLES - 1u) / PIECE_TRIANGLES;
        const uint levelPieces = pieces * command.instanceCount;
        if (left < levelPieces) {
            const uint instance = left / pieces;
            const uint first = (left % pieces) * PIECE_TRIANGLES;
            piece.triangles = min(triangles - first, PIECE_TRIANGLES);
            piece.firstCorner = batch.firstCorner + command.firstIndex - batch.firstIndex + first * 3u;
            piece.firstKept = kept + instance * command.indexCount + first * 3u;
            piece.slot = command.firstInstance + instance;
            piece.vertexOffset = command.vertexOffset;
            left = 0xffffffffu; // no other level has it
        } else if (left != 0xffffffffu) {
            left -= levelPieces;
        }
        kept += command.instanceCount * command.indexCount;
    }
    return piece;
}

Projection projectionOf(uint instance, PieceBatch batch)
{
    const int texel = int(instance * INSTANCE_TEXELS);
    const vec4 x = texelFetch(instances, texel);
    const vec4 y = texelFetch(instances, texel + 1);
    const vec4 z = texelFetch(instances, texel + 2);
    const vec4 last = texelFetch(instances, texel + 3);
    const vec3 origin = cameraRelative(vec3(x.w, y.w, z.w), last.xyz, frame.cameraHi, frame.cameraLo);

    const mat4 p = frame.clipFromView;
    const vec4 rowX = vec4(p[0].x, p[1].x, p[2].x, p[3].x);
    const vec4 rowY = vec4(p[0].y, p[1].y, p[2].y, p[3].y);
    const vec4 rowW = vec4(p[0].w, p[1].w, p[2].w, p[3].w);
    const vec2 halfSize = 0.5 * frame.size;
    const mat3 r = frame.viewFromWorld;
    const mat4 viewFromObject =
        mat4(vec4(r * x.xyz, 0), vec4(r * y.xyz, 0), vec4(r * z.xyz, 0), vec4(r * origin, 1));
    const vec4 pixelX = halfSize.x * (rowX + rowW);
    const vec4 pixelY = halfSize.y * (rowY + rowW);

    Projection projection;
    const mat3x4 rows = mat3x4(pixelX * viewFromObject, pixelY * viewFromObject, rowW * viewFromObject);
    projection.numerators = transpose(rows);
    // A coordinate of a vertex in view space is at most this long, and so is each of the products and
    // sums of which it consists.
    const float longest = abs(origin.x) + abs(origin.y) + abs(origin.z) + batch.scale * batch.reach;
    const vec4 magnitudes = vec4(vec3(longest), 1.0);
    projection.wError = SLACK * dot(abs(rowW), magnitudes);
    const vec2 errors = SLACK * vec2(dot(abs(rowX), magnitudes), dot(abs(rowY), magnitudes));
    projection.error = max(halfSize.x * (errors.x + projection.wError),
                           halfSize.y * (errors.y + projection.wError));
    return projection;
}

float cross2(vec2 a, vec2 b)
{
    return a.x * b.y - a.y * b.x;
}

// What an edge leaves of a row of samples at y: the points up to atZero + slope * y if `isUpper`, else
// the points from there on.
struct RowBound {
    float atZero;
    float slope;
    bool isUpper;
};

// Returns what is left by an edge from p to p + d. Points s of the triangle have cross2(d, s - p) >= 0.
// The ends of the edge may be off by `error` pixels in x and in y, so points that are so far outside
// are left, too.
RowBound rowBound(vec2 p, vec2 d, float error)
{
    const float inverse = 1.0 / (abs(d.y) < 1e-12 ? 1e-12 : d.y);
    const float slope = d.x * inverse;
    const float slack = error * (abs(d.x) + abs(d.y)) * inverse;
    return RowBound(p.x + slack - slope * p.y, slope, inverse > 0.0);
}

void narrow(RowBound bound, float y, inout float low, inout float high)
{
    const float x = bound.atZero + bound.slope * y;
    high = bound.isUpper ? min(high, x) : high;
    low = bound.isUpper ? low : max(low, x);
}

// Tells whether a triangle certainly covers none of the samples in its bounds, which are at most
// SMALL_ROWS columns or rows. `sense` is the sign of its area. Its corners may be off by `error`
// pixels.
bool missesSamples(vec2 a, vec2 b, vec2 c, SampleBounds samples, float sense, float error)
{
    vec2 first = samples.first, last = samples.last;
    if (last.x - first.x < last.y - first.y) { // so that there are few rows
        a = a.yx;
        b = b.yx;
        c = c.yx;
        first = first.yx;
        last = last.yx;
        sense = -sense;
    }
    const RowBound ab = rowBound(a, sense * (b - a), error);
    const RowBound bc = rowBound(b, sense * (c - b), error);
    const RowBound ca = rowBound(c, sense * (a - c), error);
    bool misses = true;
    for (int row = 0; row < SMALL_ROWS; ++row) {
        const float y = first.y + float(row) + 0.5;
        float low = first.x + 0.5, high = last.x + 0.5;
        narrow(ab, y, low, high);
        narrow(bc, y, low, high);
        narrow(ca, y, low, high);
        const bool holdsSample = ceil(low - (0.5 + error)) <= floor(high - (0.5 - error));
        misses = misses && (y > last.y + 1.0 || !holdsSample);
    }
    return misses;
}

// Tells whether a triangle with corners (x, y, w) certainly covers no sample.
bool coversNothing(vec3 a, vec3 b, vec3 c, Projection projection, float front)
{
    const float w = min(a.z, min(b.z, c.z));
    if (!(w > 4.0 * projection.wError))
        return false; // it reaches the plane of the eye
    const vec2 pa = a.xy / a.z, pb = b.xy / b.z, pc = c.xy / c.z;
    const vec2 low = min(pa, min(pb, pc)), high = max(pa, max(pb, pc));
    const vec2 largest = max(abs(low), abs(high));
    const float far = max(largest.x, largest.y);
    // The last term is the rounding of the divisions and of what follows.
    const float error = (projection.error + far * projection.wError) / (w - projection.wError) +
                        frame.snap + 1e-6 * far;
    const SampleBounds samples = samplesIn(low, high, error, frame.size);
    const vec2 size = high - low;
    const float area = cross2(pb - pa, pc - pa);
    const float rounding = 1e-6 * size.x * size.y; // of the area
    const float areaError = 4.0 * error * (size.x + size.y + error) + rounding;
    const bool facesAway = front * area < -areaError;
    const vec2 reach = samples.last - samples.first;
    const bool small = min(reach.x, reach.y) < float(SMALL_ROWS) && abs(area) > rounding;
    return isEmpty(samples) || facesAway ||
           (small && missesSamples(pa, pb, pc, samples, sign(area), error));
}

void main()
{
    const uint index = gl_GlobalInvocationID.x;
    if (index >= frame.pieceCount)
        return;
    const PieceBatch batch = batches[pieceBatches[index]];
    const Piece piece = pieceAt(index, batch);
    if (piece.triangles == 0u) {
        draws[index] = DrawCommand(0u, 0u, 0u, 0u, 0u);
        return;
    }
    const Projection projection = projectionOf(visible[piece.slot], batch);
    const float front = batch.front * frame.winding;
    uint end = piece.firstKept;
    for (uint t = 0u; t < piece.triangles; ++t) {
        const int corner = int(piece.firstCorner + 3u * t);
        const vec4 a = texelFetch(corners, corner);
        const vec4 b = texelFetch(corners, corner + 1);
        const vec4 c = texelFetch(corners, corner + 2);
        const vec3 pa = projection.numerators * vec4(a.xyz, 1.0);
        const vec3 pb = projection.numerators * vec4(b.xyz, 1.0);
        const vec3 pc = projection.numerators * vec4(c.xyz, 1.0);
        if (!coversNothing(pa, pb, pc, projection, front)) {
            kept[end] = uint(a.w);
            kept[end + 1u] = uint(b.w);
            kept[end + 2u] = uint(c.w);
            end += 3u;
        }
    }
    const uint count = end - piece.firstKept;
    draws[index] = DrawCommand(count, 1u, piece.firstKept, piece.vertexOffset, piece.slot);
}
