// SPDX-License-Identifier: Apache-2.0
// Measures how far the closed form of sphere lights is from quadrature, over a set of lights, as a
// function of its fitted constants (shaders/shared/conic_constants.h). `candelabra_fit conic`
// minimises it. The closed form is that of the shaders in double precision (tools/formula); the
// truth comes from engine/reference, which shares no code with shaders.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formula/formula.h"
#include "measure/accuracy/sample_set.h"
#include "measure/kernels/light_kernels.h"

namespace candelabra::fit
{

using formula::ConicConstants;

// One fitted constant: its name, what it weighs, its member, and its value in the shaders.
struct ConicConstant {
    const char* name;
    const char* meaning;
    double ConicConstants::*value;
    double committed;
    double limit; // the formulas allow values from 0 to below this
};
std::span<const ConicConstant> conicConstants();

// Absolute errors in percent of the highest true response in their group of samples: their mean,
// root mean square, 99th percentile and largest.
struct ErrorFigures {
    double mean = 0, rms = 0, p99 = 0, largest = 0;
};
struct HorizonFigures {
    ErrorFigures all, above; // every light that is not below the horizon; those wholly above it
};
struct MethodFigures {
    HorizonFigures mirror, dielectric; // F0 = 1 and F0 = 0.04
};
// conic takes shadowing and Fresnel at one point of the light where that will do and at two
// elsewhere; conicFull takes them at two for every light.
struct ConicResiduals {
    MethodFigures conic, conicFull;
};

class ConicObjective
{
public:
    // The lights of `set` are spheres, and their truth has been integrated.
    explicit ConicObjective(app::SampleSet set);

    const app::SampleSet& set() const { return set_; }

    ConicResiduals residuals(const ConicConstants& constants) const;

    // The sum over both methods of
    //   20 mean + p99 + largest / 3   with F0 = 1, and a quarter of that with F0 = 0.04.
    // The three terms are about 1 each for the committed constants. Infinite for constants that the
    // formulas do not allow.
    double cost(const ConicConstants& constants) const;

    // The groups with the largest errors (conic, F0 = 1), the worst first.
    std::vector<uint32_t> worstGroups(const ConicConstants& constants, size_t count) const;

private:
    struct Error {
        double mirror, dielectric;
    };
    Error error(size_t i, const formula::Settings& settings) const;

    app::SampleSet set_;
    app::PreparedLights lights_;    // of set_
    std::vector<uint32_t> counted_; // samples that reach above the horizon, of groups with a peak
    std::vector<double> mirrorPeak_, dielectricPeak_; // highest true response, by group
};

// Sphere lights in `groups` groups, drawn as measure/accuracy/sample_set.h says, with their truth.
// The same seed gives the same set.
app::SampleSet drawSamples(uint32_t groups, uint64_t seed);

// The constants are fitted to `groups` groups and to the `hard` hardest of `others` further groups:
// those in which the committed constants err most. `hard` is at most `others`.
struct TrainingSize {
    uint32_t groups = 700, others = 3000, hard = 25;
    uint64_t seed = 11;
};
app::SampleSet drawTrainingSamples(const TrainingSize& size);

// The small set on which a test evaluates the committed constants again.
app::SampleSet drawCheckSamples();

} // namespace candelabra::fit
