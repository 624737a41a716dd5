// SPDX-License-Identifier: Apache-2.0
// Integrates luminance times direction over cells of an equirectangular image.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/environment_data.h"
#include "lib/equirectangular.glsl"
#include "kernels/common/environment_image.glsl"

layout(local_size_x = ENVIRONMENT_GROUP, local_size_y = ENVIRONMENT_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    EnvironmentCellsParams params;
};
layout(scalar, binding = ENVIRONMENT_CELLS_OUTPUT) writeonly buffer Cells
{
    mat3 cells[];
};

// Returns the part of a row that lies between two columns, integrated over the azimuth: the columns
// are luminance times the sine, the cosine and 1.
mat3 integrateRow(uint row, float first, float last)
{
    mat3 sum = mat3(0.0);
    for (uint column = uint(first); float(column) < last; ++column) {
        const float from = max(float(column), first);
        const float to = min(float(column) + 1.0, last);
        const vec2 middle = azimuthCosSin(0.5 * (from + to), float(params.imageSize.x));
        const float width = (to - from) * (2.0 * PI / float(params.imageSize.x));
        const vec3 luminance = luminanceAt(column, row);
        const vec3 slice = 2.0 * smallSine(0.5 * width) * luminance;
        sum[0] += middle.y * slice;
        sum[1] += middle.x * slice;
        sum[2] += width * luminance;
    }
    return sum;
}

void main()
{
    const uvec2 cell = gl_GlobalInvocationID.xy;
    const vec2 texels =
        vec2(params.imageSize) / vec2(ENVIRONMENT_CELL_COLUMNS, ENVIRONMENT_CELL_ROWS);
    const vec2 first = vec2(cell) * texels;
    const vec2 last = vec2(cell + 1u) * texels;
    mat3 moments = mat3(0.0);
    for (uint row = uint(first.y); float(row) < last.y; ++row) {
        const float from = max(float(row), first.y);
        const float to = min(float(row) + 1.0, last.y);
        const vec2 middle = polarCosSin(0.5 * (from + to), float(params.imageSize.y));
        const float height = (to - from) * (PI / float(params.imageSize.y));
        // The integrals over the polar angle of squared sine and of sine times cosine. The height
        // is at most pi / 64, so two terms of height - sin(height) are enough.
        const float sine = smallSine(height);
        const float cube = height * height * height;
        const float sine2 =
            0.5 * cube * (1.0 / 6.0 - height * height / 120.0) + middle.y * middle.y * sine;
        const mat3 r = integrateRow(row, first.x, last.x);
        moments += transpose(mat3(sine2 * r[0], middle.x * middle.y * sine * r[2], -sine2 * r[1]));
    }
    cells[cell.y * ENVIRONMENT_CELL_COLUMNS + cell.x] = moments;
}
