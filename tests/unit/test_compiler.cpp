// SPDX-License-Identifier: Apache-2.0
// Compiles GLSL functions of hosts: into which kernels, and what is said about mistakes in them.
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "candelabra/compiler.hpp"

namespace candelabra::test
{
namespace
{

constexpr const char* shadow = "float candelabraVisibility(CndShadowQuery q)\n"
                               "{\n"
                               "    return q.light == 3u ? 0.5 : 1.0;\n"
                               "}\n";

std::string compileError(CndCompileDesc desc)
{
    const auto compiled = CompiledKernels::create(desc);
    return compiled ? "no error" : compiled.error().message;
}

std::set<std::string> kernelsOf(CndCompileDesc desc)
{
    auto compiled = CompiledKernels::create(desc);
    std::set<std::string> names;
    if (!compiled) {
        ADD_FAILURE() << compiled.error().message;
        return names;
    }
    const CndHostKernels kernels = compiled.value().hostKernels();
    for (uint32_t i = 0; i < kernels.count; ++i)
        names.insert(kernels.kernels[i].name);
    EXPECT_EQ(names.size(), kernels.count);
    return names;
}

TEST(Compiler, MakesTheKernelsThatTheFunctionsBelongIn)
{
    const std::set<std::string> points = {"shade_tiles:PUNCTUAL", "shade_unlisted:PUNCTUAL",
                                          "shade_brute:PUNCTUAL", "shade_tiles:CONIC",
                                          "shade_unlisted:CONIC", "shade_brute:CONIC"};
    EXPECT_EQ(kernelsOf({.functions = CND_HOST_VISIBILITY_BIT,
                         .source = shadow,
                         .lightTypes = 1u << CND_LIGHT_POINT}),
              points);
    const std::string both = std::string(shadow) + "CndSurface candelabraReadSurface(ivec2 pixel)\n"
                                                   "{\n"
                                                   "    CndSurface s;\n"
                                                   "    s.normal = vec3(0.0, 0.0, 1.0);\n"
                                                   "    s.albedo = s.F0 = vec3(0.5);\n"
                                                   "    s.specularWeight = 1.0;\n"
                                                   "    s.perceptualRoughness = 0.5;\n"
                                                   "    return s;\n"
                                                   "}\n";
    EXPECT_EQ(kernelsOf({.functions = CND_HOST_VISIBILITY_BIT | CND_HOST_READ_SURFACE_BIT,
                         .source = both.c_str(),
                         .lightTypes = 1u << CND_LIGHT_DISTANT_SPHERE,
                         .specularMethods = 1u << CND_SPECULAR_KARIS}),
              (std::set<std::string>{"shade_tiles:SPHERE", "shade_unlisted:SPHERE",
                                     "shade_brute:SPHERE", "count_pairs:SPHERE", "tile_clusters",
                                     "split_tiles", "cpu/tile_clusters", "cpu/split_tiles",
                                     "surface_overlay", "shade_environment"}));
    EXPECT_EQ(kernelsOf({.functions = CND_HOST_VISIBILITY_BIT | CND_HOST_READ_SURFACE_BIT,
                         .source = both.c_str(),
                         .lightTypes = 1u << CND_LIGHT_DISTANT_SPHERE,
                         .specularMethods = 1u << CND_SPECULAR_KARIS,
                         .shadows = VK_TRUE}),
              (std::set<std::string>{"shade_tiles_shadows:SPHERE", "shade_unlisted_shadows:SPHERE",
                                     "shade_brute_shadows:SPHERE", "count_pairs:SPHERE",
                                     "pair_visibility", "tile_clusters", "split_tiles",
                                     "cpu/tile_clusters", "cpu/split_tiles", "surface_overlay",
                                     "shade_environment"}));
}

// A host's ray queries need SPIR-V 1.4. Kernels that call no function of the host stay ours.
TEST(Compiler, VisiblePointsMayComeFromRayQueries)
{
    const std::string rays = R"(
#extension GL_EXT_ray_query : require
layout(set = 1, binding = 0) uniform accelerationStructureEXT scene;
uvec2 candelabraVisiblePoints(CndVisibilityQuery q)
{
    const bool endless = q.facet.front.inverseDistance == 0.0;
    const vec3 away = 4.0 * q.ownDistance * q.normal;
    uvec2 seen = uvec2(0u);
    for (uint i = 0u; i < q.count; ++i) {
        if ((q.points[i / 32u] >> i % 32u & 1u) == 0u)
            continue;
        const vec3 way = cndLightPoint(q, i) - (endless ? vec3(0.0) : away);
        rayQueryEXT ray;
        rayQueryInitializeEXT(ray, scene, gl_RayFlagsTerminateOnFirstHitEXT, 0xFF,
                              q.position + away, 0.0, way, endless ? 1e30 : 1.0);
        while (rayQueryProceedEXT(ray)) {}
        if (rayQueryGetIntersectionTypeEXT(ray, true) == gl_RayQueryCommittedIntersectionNoneEXT)
            seen[i / 32u] |= 1u << i % 32u;
    }
    return seen;
}
)";
    CndCompileDesc desc{.functions = CND_HOST_VISIBLE_POINTS_BIT,
                        .source = rays.c_str(),
                        .lightTypes = 1u << CND_LIGHT_SPHERE,
                        .shadows = VK_TRUE,
                        .apiVersion = VK_API_VERSION_1_2};
    EXPECT_EQ(kernelsOf(desc),
              (std::set<std::string>{"shade_unlisted_points:CONIC", "pair_visibility_points"}));
    const std::string both = rays + shadow;
    desc.source = both.c_str();
    desc.functions |= CND_HOST_VISIBILITY_BIT;
    EXPECT_EQ(kernelsOf(desc),
              (std::set<std::string>{"shade_tiles_shadows:CONIC", "shade_brute_shadows:CONIC",
                                     "shade_unlisted_points:CONIC", "pair_visibility_points"}));
}

TEST(Compiler, ErrorsNameTheLineOfTheSource)
{
    EXPECT_EQ(compileError({.functions = CND_HOST_VISIBILITY_BIT,
                            .source = "float candelabraVisibility(CndShadowQuery q)\n"
                                      "{\n"
                                      "    return moon(q.light);\n"
                                      "}\n",
                            .sourceName = "shadow.glsl"}),
              "cndCompileKernels: shadow.glsl:3: 'moon' : no matching overloaded function found "
              "(in shade_tiles:PUNCTUAL)");
    EXPECT_EQ(compileError({.functions = CND_HOST_VISIBILITY_BIT, .source = ""}),
              "cndCompileKernels: source does not define candelabraVisibility with the parameters "
              "of CndHostFunctionBits");
    // The source defines the other function instead of the promised one.
    EXPECT_EQ(
        compileError({.functions = CND_HOST_READ_SURFACE_BIT,
                      .source = shadow,
                      .sourceName = "shadow.glsl"}),
        "cndCompileKernels: shadow.glsl does not define candelabraReadSurface with the parameters "
        "of CndHostFunctionBits");
    EXPECT_EQ(compileError({.functions = CND_HOST_VISIBLE_POINTS_BIT,
                            .source = "uvec2 candelabraVisiblePoints(CndShadowQuery q)\n"
                                      "{\n"
                                      "    return uvec2(0u);\n"
                                      "}\n",
                            .shadows = VK_TRUE}),
              "cndCompileKernels: source does not define candelabraVisiblePoints with the "
              "parameters of CndHostFunctionBits");
    EXPECT_NE(
        compileError({.functions = CND_HOST_VISIBILITY_BIT, .source = "#include \"moon.glsl\"\n"})
            .find("source:1: '#include' : "),
        std::string::npos);
}

TEST(Compiler, RefusesWhatIsOutOfRange)
{
    EXPECT_EQ(compileError({.source = shadow}),
              "CndCompileDesc: functions must be a mask of CndHostFunctionBits");
    EXPECT_EQ(compileError({.functions = 8, .source = shadow}),
              "CndCompileDesc: functions must be a mask of CndHostFunctionBits");
    EXPECT_EQ(compileError({.functions = CND_HOST_VISIBILITY_BIT}),
              "CndCompileDesc: source is null");
    EXPECT_EQ(compileError({.functions = CND_HOST_VISIBLE_POINTS_BIT, .source = shadow}),
              "CndCompileDesc: CND_HOST_VISIBLE_POINTS_BIT needs shadows");
    EXPECT_EQ(compileError({.functions = CND_HOST_VISIBILITY_BIT,
                            .source = shadow,
                            .lightTypes = 1u << CND_LIGHT_TYPE_COUNT}),
              "CndCompileDesc: lightTypes has bits beyond the last CndLightType");
    EXPECT_EQ(compileError({.functions = CND_HOST_VISIBILITY_BIT,
                            .source = shadow,
                            .specularMethods = 1u << CND_SPECULAR_METHOD_COUNT}),
              "CndCompileDesc: specularMethods has bits beyond the last CndSpecularMethod");
    EXPECT_EQ(
        compileError(
            {.functions = CND_HOST_VISIBILITY_BIT, .source = shadow, .specularMethods = 1}),
        "CndCompileDesc: specularMethods has bit 0, CND_SPECULAR_DEFAULT, which is no method: name "
        "methods, or pass 0");
    CndCompileDesc desc{.structSize = 1, .functions = CND_HOST_VISIBILITY_BIT, .source = shadow};
    CndCompiledKernels kernels{};
    CndError error{};
    EXPECT_EQ(cndCompileKernels(&desc, &kernels, &error), CND_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(std::string(error.message).find("structSize is 1"), std::string::npos);
    EXPECT_EQ(cndCompileKernels(nullptr, &kernels, &error), CND_ERROR_INVALID_ARGUMENT);
    uint32_t count = 1;
    EXPECT_EQ(cndGetKernelCode(nullptr, &count), nullptr);
    EXPECT_EQ(count, 0u);
    cndDestroyCompiledKernels(nullptr);
}

TEST(Compiler, CompilesForTheVersionOfTheHost)
{
    const std::pair<uint32_t, uint32_t> versions[] = {{0, 0x00010300},
                                                      {VK_API_VERSION_1_1, 0x00010300},
                                                      {VK_API_VERSION_1_2, 0x00010500},
                                                      {VK_API_VERSION_1_3, 0x00010600}};
    for (const auto& [vulkan, spirv] : versions) {
        auto compiled = CompiledKernels::create({.functions = CND_HOST_VISIBILITY_BIT,
                                                 .source = shadow,
                                                 .lightTypes = 1u << CND_LIGHT_POINT,
                                                 .apiVersion = vulkan});
        ASSERT_TRUE(compiled) << compiled.error().message;
        EXPECT_EQ(compiled.value().hostKernels().kernels[0].words[1], spirv) << vulkan;
    }
    EXPECT_EQ(compileError({.functions = CND_HOST_VISIBILITY_BIT,
                            .source = shadow,
                            .apiVersion = VK_API_VERSION_1_0}),
              "CndCompileDesc: apiVersion must be 0, VK_API_VERSION_1_1, VK_API_VERSION_1_2 or "
              "VK_API_VERSION_1_3");
}

} // namespace
} // namespace candelabra::test
