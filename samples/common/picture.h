// SPDX-License-Identifier: Apache-2.0
// Pictures that samples write.
#ifndef CANDELABRA_SAMPLES_PICTURE_H
#define CANDELABRA_SAMPLES_PICTURE_H

#include "host.h"

#ifdef __cplusplus
extern "C" {
#endif

// Writes radiance (4 floats per pixel, rows from the top, cd/m^2) as a picture in the format PPM.
// Luminance of `white` and more is displayed as white.
void writePicture(const char* path, const Host* host, const float* radiance, float white);

#ifdef __cplusplus
}
#endif
#endif
