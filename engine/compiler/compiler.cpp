// SPDX-License-Identifier: Apache-2.0
#include "candelabra/compiler.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include "compiler/shader_sources.h"
#include "gpu/failure.h"
#include "shading/light_family.h"

struct CndCompiledKernels_T {
    struct Kernel {
        std::string name;
        std::vector<uint32_t> words;
    };
    std::vector<Kernel> kernels;
    std::vector<CndKernelCode> codes; // one per kernel, pointing into `kernels`
};

namespace candelabra::compiler
{
namespace
{

using Compiled = CndCompiledKernels_T;

// Initialises glslang while it lives; glslang counts its users.
struct Process {
    Process() { glslang::InitializeProcess(); }
    ~Process() { glslang::FinalizeProcess(); }
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;
};

const ShaderSource* findSource(std::string_view name)
{
    const auto sources = shaderSources();
    const auto found = std::ranges::find(sources, name, &ShaderSource::name);
    return found == sources.end() ? nullptr : &*found;
}

class Includer final : public glslang::TShader::Includer
{
public:
    IncludeResult* includeLocal(const char* name, const char*, size_t) override
    {
        const ShaderSource* source = findSource(name);
        return source ? new IncludeResult(name, source->text.data(), source->text.size(), nullptr)
                      : nullptr;
    }
    void releaseInclude(IncludeResult* result) override { delete result; }
};

// A kernel to compile, and the family of lights (shared/light_type_list.h) to compile it for; empty
// if the kernel does not depend on the family.
struct Job {
    std::string kernel, family;
    bool shadows = false; // the kernel differs if the module has shadows
    bool points = false;  // the kernel calls candelabraVisiblePoints
    // Kernels that replace others have their names (engine/surfaces/host_kernels.cpp).
    std::string name() const
    {
        return kernel +
               (points    ? "_points"
                : shadows ? "_shadows"
                          : "") +
               (family.empty() ? "" : ":" + family);
    }
};

// Returns the families of light types that these types need with these methods, both of which are
// masks of 1 << id.
std::vector<std::string> familiesOf(uint32_t types, uint32_t methods)
{
    types |= 1u << CND_LIGHT_SPHERE; // always: every CndLighting creates their pipelines
    std::set<uint32_t> families;
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        for (uint32_t method = 0; method < CND_SPECULAR_METHOD_COUNT; ++method)
            if (types >> type & methods >> method & 1)
                families.insert(lighting::familyOf(type, CndSpecularMethod(method)));
    static constexpr const char* names[] = {
#define X(index, NAME, iterations) #NAME,
        CND_LIGHT_FAMILIES(X)
#undef X
    };
    std::vector<std::string> out;
    for (const uint32_t family : families)
        out.push_back(names[family]);
    return out;
}

std::vector<Job> jobsOf(const CndCompileDesc& desc)
{
    const uint32_t types = desc.lightTypes ? desc.lightTypes : ~0u;
    const uint32_t methods = desc.specularMethods ? desc.specularMethods : 1u << CND_SPECULAR_CONIC;
    const bool reads = desc.functions & CND_HOST_READ_SURFACE_BIT;
    const bool points = desc.functions & CND_HOST_VISIBLE_POINTS_BIT;
    const bool shadows = desc.shadows != VK_FALSE;
    std::vector<Job> jobs;
    for (const std::string& family : familiesOf(types, methods)) {
        if (desc.functions & ~uint32_t(CND_HOST_VISIBLE_POINTS_BIT))
            for (const char* kernel : {"shade_tiles", "shade_brute"})
                jobs.push_back({kernel, family, shadows});
        jobs.push_back({"shade_unlisted", family, shadows, points});
        if (reads)
            jobs.push_back({"count_pairs", family});
    }
    if (points || (reads && shadows))
        jobs.push_back({"pair_visibility", "", false, points});
    if (reads)
        for (const char* kernel : {"tile_clusters", "split_tiles", "cpu/tile_clusters",
                                   "cpu/split_tiles", "surface_overlay", "shade_environment"})
            jobs.push_back({kernel, ""});
    return jobs;
}

// Fails with the first error of the compiler's log, as the end of one sentence.
[[noreturn]] void fail(const Job& job, const CndCompileDesc& desc, const std::string& log)
{
    constexpr std::string_view error = "ERROR: ";
    const std::string kernel = " (in " + job.name() + ")";
    if (log.find("No function definition (body) found") != std::string::npos)
        for (const char* function :
             {"candelabraVisibility", "candelabraReadSurface", "candelabraVisiblePoints"})
            if (log.find(function) != std::string::npos)
                gpu::failArgument(std::string("cndCompileKernels: ") +
                                  (desc.sourceName ? desc.sourceName : "source") +
                                  " does not define " + function +
                                  " with the parameters of CndHostFunctionBits");
    const size_t at = log.find(error);
    const size_t from = at == std::string::npos ? 0 : at + error.size();
    std::string line = log.substr(from, log.find('\n', from) - from);
    line.erase(line.find_last_not_of(" \r") + 1);
    gpu::failArgument("cndCompileKernels: " + line + kernel);
}

// The newest SPIR-V of a version of Vulkan.
struct Target {
    uint32_t apiVersion;
    glslang::EShTargetClientVersion vulkan;
    glslang::EShTargetLanguageVersion spirv;
};
constexpr Target targets[] = {
    {VK_API_VERSION_1_1, glslang::EShTargetVulkan_1_1, glslang::EShTargetSpv_1_3},
    {VK_API_VERSION_1_2, glslang::EShTargetVulkan_1_2, glslang::EShTargetSpv_1_5},
    {VK_API_VERSION_1_3, glslang::EShTargetVulkan_1_3, glslang::EShTargetSpv_1_6}};

// Returns null for other versions.
const Target* targetOf(const CndCompileDesc& desc)
{
    const uint32_t version = desc.apiVersion ? desc.apiVersion : targets[0].apiVersion;
    const auto found = std::ranges::find(targets, version, &Target::apiVersion);
    return found == std::end(targets) ? nullptr : found;
}

std::vector<uint32_t> compile(const Job& job, const CndCompileDesc& desc)
{
    std::string preamble = "#extension GL_GOOGLE_include_directive : require\n";
    if (!job.family.empty())
        preamble += "#define CND_LIGHT_FAMILY_" + job.family + "\n";
    if (job.kernel == "pair_visibility") // evaluates no light, but knows what a light is
        preamble += "#define CND_LIGHT_FAMILY_SPHERE\n";
    if (job.shadows)
        preamble += "#define CND_SHADOWS\n";
    if (desc.functions & CND_HOST_VISIBILITY_BIT && !job.family.empty())
        preamble += "#define CANDELABRA_VISIBILITY\n";
    if (desc.functions & CND_HOST_READ_SURFACE_BIT)
        preamble += "#define CANDELABRA_READ_SURFACE\n";
    if (job.points)
        preamble += "#define CANDELABRA_VISIBLE_POINTS\n";

    const std::string kernelName = "kernels/" + job.kernel + ".comp";
    const ShaderSource& kernel = *findSource(kernelName);
    const std::string_view source = desc.source;
    // Every kernel includes the declarations of the queries: those that evaluate no lights get the
    // same source, and a source that lacks the promised function is then reported as such instead
    // of "CndShadowQuery undeclared".
    std::string query = "\n#include \"lib/shadow_query.glsl\"\n";
    if (desc.functions & CND_HOST_VISIBLE_POINTS_BIT)
        query += "#include \"lib/visibility_query.glsl\"\n";
    const char* const texts[] = {kernel.text.data(), query.data(), source.data()};
    const int lengths[] = {int(kernel.text.size()), int(query.size()), int(source.size())};
    const char* const names[] = {kernelName.c_str(), kernelName.c_str(),
                                 desc.sourceName ? desc.sourceName : "source"};

    glslang::TShader shader(EShLangCompute);
    shader.setStringsWithLengthsAndNames(texts, lengths, names, 3);
    shader.setPreamble(preamble.c_str());
    shader.setEnvInput(glslang::EShSourceGlsl, EShLangCompute, glslang::EShClientVulkan, 100);
    const Target& target = *targetOf(desc);
    shader.setEnvClient(glslang::EShClientVulkan, target.vulkan);
    shader.setEnvTarget(glslang::EShTargetSpv, target.spirv);
    constexpr auto messages = EShMessages(EShMsgSpvRules | EShMsgVulkanRules);
    Includer includer;
    if (!shader.parse(GetDefaultResources(), 460, false, messages, includer))
        fail(job, desc, shader.getInfoLog());
    glslang::TProgram program;
    program.addShader(&shader);
    if (!program.link(messages))
        fail(job, desc, program.getInfoLog());
    std::vector<uint32_t> words;
    glslang::GlslangToSpv(*program.getIntermediate(EShLangCompute), words);
    return words;
}

void check(const CndCompileDesc& desc)
{
    if (desc.structSize != sizeof desc)
        gpu::failArgument("CndCompileDesc: structSize is " + std::to_string(desc.structSize) +
                          ", this library expects " + std::to_string(sizeof desc));
    if (!desc.functions ||
        desc.functions & ~uint32_t(CND_HOST_VISIBILITY_BIT | CND_HOST_READ_SURFACE_BIT |
                                   CND_HOST_VISIBLE_POINTS_BIT))
        gpu::failArgument("CndCompileDesc: functions must be a mask of CndHostFunctionBits");
    if (desc.functions & CND_HOST_VISIBLE_POINTS_BIT && !desc.shadows)
        gpu::failArgument("CndCompileDesc: CND_HOST_VISIBLE_POINTS_BIT needs shadows");
    if (!desc.source)
        gpu::failArgument("CndCompileDesc: source is null");
    if (desc.lightTypes >> CND_LIGHT_TYPE_COUNT)
        gpu::failArgument("CndCompileDesc: lightTypes has bits beyond the last CndLightType");
    lighting::checkSpecularMethods("CndCompileDesc", desc.specularMethods);
    if (!targetOf(desc))
        gpu::failArgument("CndCompileDesc: apiVersion must be 0, VK_API_VERSION_1_1, "
                          "VK_API_VERSION_1_2 or VK_API_VERSION_1_3");
}

} // namespace
} // namespace candelabra::compiler

using namespace candelabra;

CndResult cndCompileKernels(const CndCompileDesc* desc, CndCompiledKernels* kernels,
                            CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndCompileKernels", {desc, kernels});
        compiler::check(*desc);
        const compiler::Process process;
        auto out = std::make_unique<CndCompiledKernels_T>();
        for (const compiler::Job& job : compiler::jobsOf(*desc))
            out->kernels.push_back({job.name(), compiler::compile(job, *desc)});
        for (const auto& kernel : out->kernels)
            out->codes.push_back(
                {kernel.name.c_str(), kernel.words.data(), uint32_t(kernel.words.size())});
        *kernels = out.release();
    });
}

const CndKernelCode* cndGetKernelCode(CndCompiledKernels kernels, uint32_t* count)
{
    *count = kernels ? uint32_t(kernels->codes.size()) : 0;
    return kernels ? kernels->codes.data() : nullptr;
}

void cndDestroyCompiledKernels(CndCompiledKernels kernels)
{
    delete kernels;
}
