// SPDX-License-Identifier: Apache-2.0
// The exposure module: eye adaptation by luminance histogram, and tone mapping.
#ifndef CANDELABRA_EXPOSURE_H
#define CANDELABRA_EXPOSURE_H

#include "candelabra/core.h"

#ifdef __cplusplus
extern "C" {
#endif

// Exposure of one view. It holds the adaptation history, so every view needs its own object.
typedef struct CndExposure_T* CndExposure;

// The curve that maps exposed values to display values. All curves display the exposed value 0.18
// (middle grey) as 0.18 of the display's white, which is 118 of 255 after the sRGB encoding. For
// this, toneMap() in shaders/lib/tone_map.glsl first multiplies exposed values by a constant of the
// curve. So another curve changes contrast and highlights, but not middle grey.
typedef enum CndToneMap {
    CND_TONEMAP_NONE = 0, // clips exposed values to [0,1]
    CND_TONEMAP_REINHARD = 1,
    CND_TONEMAP_ACES = 2,
    CND_TONEMAP_PBR_NEUTRAL = 3,
    CND_TONEMAP_AGX = 4,
    CND_TONEMAP_COUNT = 5,
    CND_TONEMAP_MAX_ENUM = 0x7FFFFFFF
} CndToneMap;

// How much each pixel weighs in the histogram.
typedef enum CndMetering {
    CND_METERING_AVERAGE = 0,         // every pixel weighs 1
    CND_METERING_CENTRE_WEIGHTED = 1, // integer weights 1..15, falling with the distance to the
                                      // image centre
    CND_METERING_MASK = 2,            // weights set by cndSetExposureMask
    CND_METERING_MAX_ENUM = 0x7FFFFFFF
} CndMetering;

typedef struct CndExposureDesc {
    uint32_t structSize;
    uint32_t framesInFlight; // 1..8: frames recorded and not yet waited for
    // VK_TRUE: measure the GPU time of every kernel.
    VkBool32 timestamps;
    // Format of the frames' display images: R8G8B8A8_UNORM (VK_FORMAT_UNDEFINED, 0, means this) or,
    // on devices that can write them as storage images without a format in the shader,
    // B8G8R8A8_UNORM, A2B10G10R10_UNORM_PACK32 or A2R10G10B10_UNORM_PACK32. No device writes _SRGB
    // formats as storage images. Create an image of such a format with
    // VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT and VK_IMAGE_CREATE_EXTENDED_USAGE_BIT, and pass a _UNORM
    // view of it. The values that are written are already sRGB-encoded.
    VkFormat displayFormat;
} CndExposureDesc;

// EV here is EV100 = log2(L * 100 / 12.5) for average luminance L in cd/m^2 (ISO 2720, K = 12.5).
// The average is the mean of log2 luminance between two percentiles of a histogram. The histogram
// has 8 bins per octave from 2^-12 to 2^20 cd/m^2. Darker pixels count in the first bin, brighter
// ones in the last. Pixels without any light (zero or negative luminance, such as an empty
// background) also count in the first bin, but are left out of the mean unless there are no other
// pixels.
typedef struct CndExposureSettings {
    VkBool32 manual;    // VK_TRUE: use manualEv100 and build no histogram
    float manualEv100;  // -64..64; not limited by minEv100 and maxEv100
    float compensation; // EV, -32..32; added brightness: +1 doubles the exposed values
    // The calibration: the exposed value, from 0.000001 to 1, of a surface with the luminance that
    // EV100 stands for, 2^EV100 / 8 cd/m^2. With 0.18, a grey card that fills the metered picture
    // is displayed as middle grey. 0.1042 (12.5 / 120) is the saturation-based calibration (ISO
    // 12232; Lagarde and de Rousiers 2014, eq. 85), in which the exposed value 1 is 3.26 EV above
    // the metered luminance.
    float middleGrey;
    float minEv100, maxEv100; // -64..64, min <= max: range of the metered EV100
    // The mean ignores the darkest lowPercentile and the brightest 1 - highPercentile of the
    // histogram's weight. 0 <= lowPercentile, lowPercentile + 1e-6 <= highPercentile <= 1.
    float lowPercentile;
    float highPercentile;
    // Adaptation rates in 1/s, > 0, towards brighter (up) and darker (down) scenes:
    // ev(t+dt) = target + (ev(t) - target) exp(-dt * speed).
    float speedUp, speedDown;
    CndMetering metering;
    CndToneMap toneMap;
    // VK_TRUE: add noise before rounding to the steps of the display, so that the mean is kept. The
    // noise has a triangular distribution over two output steps. Within half a step of black and of
    // white it is uniform over one step.
    VkBool32 dither;
} CndExposureSettings;

// Writes the default settings: automatic exposure, no compensation, middle grey 0.18, EV100 range
// -6..18, percentiles 0.10..0.90, speeds 3 and 1 per second, centre-weighted metering, PBR Neutral,
// dithering, and manualEv100 10. `settings` must not be NULL.
CND_API void cndDefaultExposureSettings(CndExposureSettings* settings);

// Returns the EV100 of camera settings, log2(N^2 / t * 100 / S): `aperture` N in f-stops,
// `shutterTime` t in seconds, `iso` S. The arguments must be > 0 and are not checked.
CND_API float cndEv100FromCamera(float aperture, float shutterTime, float iso);
// Returns the factor from luminance (cd/m^2) to exposed value, middleGrey / (2^EV100 / 8), for a
// CndExposureSettings::middleGrey. The arguments are not checked.
CND_API float cndExposureFromEv100(float ev100, float middleGrey);

// One frame of one view.
//
// On entry: radiance (any format that shaders read as floats) in SHADER_READ_ONLY_OPTIMAL (or as
// radianceImageLayout says), visible to COMPUTE_SHADER / SHADER_SAMPLED_READ; display (storage
// image of CndExposureDesc::displayFormat) in GENERAL, or VK_NULL_HANDLE to adapt without tone
// mapping. On exit: layouts unchanged; display has been written by COMPUTE_SHADER /
// SHADER_STORAGE_WRITE and is not yet made visible.
//
// Radiance may hold any value. NaN and negative channels are displayed as 0, and infinity as white.
// NaN pixels are not metered.
typedef struct CndExposureFrame {
    uint32_t structSize;
    uint32_t frameSlot; // 0..framesInFlight-1; the GPU must have finished the slot's previous frame
    // The frame is a rectangle of its images: x and y are its top left pixel, for example that of a
    // half of a split screen or of a tile of an atlas. x + width and y + height are at most 16384
    // and inside every image, which the module cannot check.
    uint32_t x, y;
    uint32_t width, height; // pixels, 1..16384; may change between frames, the history is kept
    VkImageView radiance;
    // Layout of radiance: SHADER_READ_ONLY_OPTIMAL (VK_IMAGE_LAYOUT_UNDEFINED, 0, means this),
    // READ_ONLY_OPTIMAL or GENERAL.
    VkImageLayout radianceImageLayout;
    // The image from which the exposure is metered, for hosts that display another one. For
    // example, if it is the radiance without glare, glare does not darken the picture. It has the
    // size and the layout of `radiance`. VK_NULL_HANDLE: the exposure is metered from `radiance`.
    VkImageView meteredRadiance;
    VkImageView display; // receives sRGB-encoded values; alpha is 1
    float deltaTime;     // seconds since the previous frame, finite and >= 0
    // VK_TRUE: jump to the converged value. Set it after a camera cut. The first frame always does
    // so.
    VkBool32 reset;
    uint32_t ditherSeed; // seed of the dithering noise; the same seed gives the same image
    CndExposureSettings settings;
} CndExposureFrame;

#define CND_HISTOGRAM_BINS 256

typedef struct CndExposureStats {
    uint32_t structSize;
    // The metered EV100 before adaptation, limited to minEv100..maxEv100. In manual mode it is
    // manualEv100. If no pixel could be metered, it is adaptedEv100 of the previous frame (with
    // `reset`: 0), limited to the same range.
    float targetEv100;
    float adaptedEv100;     // EV100 in use, before compensation; the next frame adapts from it
    float exposure;         // factor applied to luminance, compensation included
    uint32_t invalidPixels; // pixels whose luminance is NaN; they are left out of the histogram
    uint32_t histogram[CND_HISTOGRAM_BINS]; // weighted counts; all zero in manual mode
    uint32_t kernelTimeCount;               // 0 without timestamps
    CndKernelTime kernelTimes[CND_MAX_KERNEL_TIMES];
    uint32_t passCount; // all passes of the module, in order
    CndPassPlan passes[CND_MAX_PASSES];
} CndExposureStats;

// Writes exactly how much memory cndCreateExposure will take, without allocating any. Fails with
// the same errors as creation would.
CND_API CndResult cndPlanExposure(const CndDeviceDesc* device, const CndExposureDesc* desc,
                                  CndMemoryUsage* usage, CndError* error);
CND_API CndResult cndCreateExposure(const CndDeviceDesc* device, const CndExposureDesc* desc,
                                    CndExposure* exposure, CndError* error);
// The GPU must have finished all work recorded with the object. NULL is ignored.
CND_API void cndDestroyExposure(CndExposure exposure);
// Writes how much memory the object holds. It stays the same from creation on.
CND_API CndResult cndGetExposureMemory(CndExposure exposure, CndMemoryUsage* usage,
                                       CndError* error);
// Sets the metering mask: width x height weights 0..15, row by row from the top, at most 64 x 64.
// The mask is stretched over the frame: pixel (x, y) of a frame of w x h pixels takes the weight in
// row y * height / h, column x * width / w. The GPU must not be using the object.
CND_API CndResult cndSetExposureMask(CndExposure exposure, const uint8_t* weights, uint32_t width,
                                     uint32_t height, CndError* error);
// Records metering, adaptation and, if there is a display image, tone mapping. The history is on
// the GPU, so submit frames in the order in which they are to adapt. The first frame always behaves
// as with `reset`. Changes the compute pipeline, compute descriptor set 0 and the push constants;
// must be recorded outside a render pass.
CND_API CndResult cndRecordExposure(CndExposure exposure, VkCommandBuffer cmd,
                                    const CndExposureFrame* frame, CndError* error);
// Writes statistics of the last frame recorded in frameSlot. Returns CND_NOT_READY until the GPU
// has finished that frame (a host that has waited for the slot never sees this), and
// CND_ERROR_INVALID_ARGUMENT before the first frame of the slot.
CND_API CndResult cndGetExposureStats(CndExposure exposure, uint32_t frameSlot,
                                      CndExposureStats* stats);

#ifdef __cplusplus
}
#endif
#endif
