// SPDX-License-Identifier: Apache-2.0
// The exposure module: histogram eye adaptation and tone mapping.
#ifndef CANDELABRA_EXPOSURE_H
#define CANDELABRA_EXPOSURE_H

#include "candelabra/core.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct CndExposure_T* CndExposure; // one per view: holds the adaptation history

typedef enum CndToneMap {
    CND_TONEMAP_NONE = 0, // exposed radiance clipped to [0,1]
    CND_TONEMAP_REINHARD = 1,
    CND_TONEMAP_ACES = 2,
    CND_TONEMAP_PBR_NEUTRAL = 3,
    CND_TONEMAP_AGX = 4,
    CND_TONEMAP_COUNT = 5,
    CND_TONEMAP_MAX_ENUM = 0x7FFFFFFF
} CndToneMap;

typedef enum CndMetering {
    CND_METERING_AVERAGE = 0,         // every pixel weighs 1
    CND_METERING_CENTRE_WEIGHTED = 1, // integer weights 1..15, falling with distance to the centre
    CND_METERING_MASK = 2,            // weights from cndSetExposureMask
    CND_METERING_MAX_ENUM = 0x7FFFFFFF
} CndMetering;

typedef struct CndExposureDesc {
    uint32_t structSize;
    uint32_t framesInFlight; // 1..8
    VkBool32 timestamps;
} CndExposureDesc;

// EV here is EV100 = log2(L * 100 / 12.5) for average luminance L in cd/m^2 (ISO 2720, K = 12.5).
// The average is the mean of log2 luminance between two percentiles of a histogram with 8 bins per
// octave from 2^-12 to 2^20 cd/m^2; darker pixels count in the first bin, brighter ones in the
// last. Pixels without any light (zero or negative luminance: an empty background) are counted in
// the first bin but left out of the mean, unless there is nothing else.
typedef struct CndExposureSettings {
    VkBool32 manual;          // use manualEv100, build no histogram
    float manualEv100;        // -64..64
    float compensation;       // EV, -32..32, added brightness: +1 doubles the image
    float minEv100, maxEv100; // -64..64, clamp of the adapted value, min <= max
    float lowPercentile;      // 0 <= low, low + 1e-6 <= high, high <= 1: share of the weighted
    float highPercentile;     //   histogram that is ignored below low and above high
    float speedUp, speedDown; // 1/s, > 0: rate towards brighter / darker scenes;
                              //   ev(t+dt) = target + (ev(t) - target) exp(-dt * speed)
    CndMetering metering;
    CndToneMap toneMap;
    // Noise before rounding to 8 bits that keeps the mean: triangular over two output steps, within
    // half a step of black and white uniform over one.
    VkBool32 dither;
} CndExposureSettings;

// Fills in the defaults: automatic, no compensation, EV100 -6..18, percentiles 0.10..0.90, speeds
// 3 and 1 per second, centre-weighted, PBR Neutral, dithered.
CND_API void cndDefaultExposureSettings(CndExposureSettings* settings);

// EV100 of a camera: log2(N^2 / t * 100 / S), aperture N in f-stops, shutter t in s, sensitivity S
// ISO.
CND_API float cndEv100FromCamera(float aperture, float shutterTime, float iso);
// Factor from luminance (cd/m^2) to exposed value: 1 / (1.2 * 2^EV100) (saturation-based speed,
// ISO 12232; Lagarde and de Rousiers 2014, eq. 85).
CND_API float cndExposureFromEv100(float ev100);

// On entry: radiance (R32G32B32A32_SFLOAT) in SHADER_READ_ONLY_OPTIMAL, visible to COMPUTE_SHADER
// SAMPLED_READ; display (R8G8B8A8_UNORM, storage) in GENERAL, or VK_NULL_HANDLE to adapt only.
// On exit: layouts unchanged, display written by COMPUTE_SHADER / SHADER_STORAGE_WRITE, not yet
// made visible. Radiance may hold anything: on the display NaN and negative channels are 0 and
// infinity is white; NaN is not metered.
typedef struct CndExposureFrame {
    uint32_t structSize;
    uint32_t frameSlot; // 0..framesInFlight-1; the GPU must have finished the slot's previous frame
    uint32_t width, height; // pixels, 1..16384; may change between frames, the history is kept
    VkImageView radiance;
    VkImageView display; // receives sRGB-encoded values
    float deltaTime;     // s since the previous frame, >= 0
    VkBool32 reset;      // jump to the converged value: first frame, camera cut, single image
    uint32_t ditherSeed; // same seed, same image
    CndExposureSettings settings;
} CndExposureFrame;

#define CND_HISTOGRAM_BINS 256

typedef struct CndExposureStats {
    uint32_t structSize;
    // Of the histogram (or manualEv100), clamped, before adaptation; where nothing was measured,
    // the history (with reset: EV 0).
    float targetEv100;
    float adaptedEv100;                     // in use, before compensation; the history
    float exposure;                         // factor applied to luminance, compensation included
    uint32_t invalidPixels;                 // NaN; left out of the histogram
    uint32_t histogram[CND_HISTOGRAM_BINS]; // weighted counts; zero in manual mode
    uint32_t kernelTimeCount;
    CndKernelTime kernelTimes[CND_MAX_KERNEL_TIMES];
    uint32_t passCount; // all the module has, in order
    CndPassPlan passes[CND_MAX_PASSES];
} CndExposureStats;

// What creation will take: exactly that, with nothing allocated. Fails like it.
CND_API CndResult cndPlanExposure(const CndDeviceDesc* device, const CndExposureDesc* desc,
                                  CndMemoryUsage* usage, CndError* error);
CND_API CndResult cndCreateExposure(const CndDeviceDesc* device, const CndExposureDesc* desc,
                                    CndExposure* exposure, CndError* error);
CND_API void cndDestroyExposure(CndExposure exposure);
// What it holds, from creation on.
CND_API CndResult cndGetExposureMemory(CndExposure exposure, CndMemoryUsage* usage,
                                       CndError* error);
// Metering mask: width x height weights 0..15, row by row from the top, at most 64 x 64,
// stretched over the frame: pixel (x, y) of w x h takes row y * height / h, column x * width / w.
// The GPU must not be using the object.
CND_API CndResult cndSetExposureMask(CndExposure exposure, const uint8_t* weights, uint32_t width,
                                     uint32_t height, CndError* error);
// Records metering, adaptation and, with a display, tone mapping. The history lives on the GPU:
// submit frames in the order in which they are to adapt. The first one is always a reset. Changes
// compute pipeline, compute descriptor set 0 and push constants; must be outside a render pass.
CND_API CndResult cndRecordExposure(CndExposure exposure, VkCommandBuffer cmd,
                                    const CndExposureFrame* frame, CndError* error);
// Statistics of the last frame recorded in frameSlot; CND_NOT_READY until the GPU has finished it,
// which a host that waited for the slot never sees. CND_ERROR_INVALID_ARGUMENT before the first.
CND_API CndResult cndGetExposureStats(CndExposure exposure, uint32_t frameSlot,
                                      CndExposureStats* stats);

#ifdef __cplusplus
}
#endif
#endif
