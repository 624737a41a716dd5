// SPDX-License-Identifier: Apache-2.0
#include "picture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void stopWriting(const char* path)
{
    fprintf(stderr, "cannot write %s\n", path);
    exit(2);
}

void writePicture(const char* path, const Host* host, const float* radiance, float white)
{
    FILE* file = fopen(path, "wb");
    if (!file)
        stopWriting(path);
    fprintf(file, "P6 %u %u 255\n", host->width, host->height);
    for (size_t i = 0; i < (size_t)host->width * host->height * 4; ++i) {
        if (i % 4 == 3)
            continue;
        const float displayed = fminf(fmaxf(radiance[i] / white, 0), 1);
        fputc((int)lroundf(255 * powf(displayed, 1 / 2.2f)), file);
    }
    if (fclose(file) != 0)
        stopWriting(path);
}
