// SPDX-License-Identifier: Apache-2.0
// The error of the responses by outline on the GPU, in float32, against quadrature: percent of the
// highest true response among the light directions of a group (one roughness, view and light).
#include "harness/full_tests.h"
#include "harness/gpu_fixture.h"
#include "measure/accuracy/kernel_error.h"
#include "measure/accuracy/sample_set.h"
#include "measure/kernels/light_kernels.h"
#include "scene/light_types.h"

using namespace candelabra;
using namespace candelabra::app;

namespace
{

class OutlineAccuracy : public test::GpuTest
{
};

} // namespace

// The bounds of the mean for tubes and rectangles are below the errors that the shaders have if the
// elongation and the slant of these lights are taken as 0 (0.084 and 0.104).
TEST_F(OutlineAccuracy, AgainstQuadrature)
{
    struct Case {
        uint32_t type;
        double mean, p99, dielectricP99; // upper bounds, percent
    };
    for (const Case& c :
         {Case{CND_LIGHT_TUBE, 0.05, 1.1, 3.5}, Case{CND_LIGHT_RECTANGLE, 0.08, 1.7, 3.5},
          Case{CND_LIGHT_DISC, 0.1, 1.7, 3.5}, Case{CND_LIGHT_POLYGON, 0.08, 1.6, 3.5}}) {
        SampleSet set = makeSamples(c.type, test::fullTests() ? 500 : 60, 3);
        integrateTruth(set, 1e-5, [](size_t) {});
        const LightEvaluator evaluator(context(),
                                       {.lightType = c.type, .method = CND_SPECULAR_CONIC});
        const KernelError error = kernelError(set, evaluator.evaluate(set.receivers, set.lights));
        const ErrorStatistics &all = error.mirror.all, &dielectric = error.dielectric.all;
        std::cout << lightTypeName(c.type) << ": mean " << 100 * all.mean << ", p99 "
                  << 100 * all.p99 << ", largest " << 100 * all.max << "; F0 = 0.04: mean "
                  << 100 * dielectric.mean << ", p99 " << 100 * dielectric.p99 << ", largest "
                  << 100 * dielectric.max << "\n";
        EXPECT_EQ(error.invalid, 0u) << lightTypeName(c.type);
        EXPECT_LE(100 * all.mean, c.mean) << lightTypeName(c.type);
        EXPECT_LE(100 * all.p99, c.p99) << lightTypeName(c.type);
        EXPECT_LE(100 * dielectric.p99, c.dielectricP99) << lightTypeName(c.type);
    }
}
