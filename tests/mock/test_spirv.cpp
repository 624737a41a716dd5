// SPDX-License-Identifier: Apache-2.0
// Reflection of SPIR-V, on modules written here word by word. Instructions that are too short, ids
// of the wrong kind and types that contain themselves must be refused instead of misread.
#include <string>

#include <gtest/gtest.h>

#include "gpu/failure.h"
#include "gpu/spirv.h"

namespace candelabra::test
{
namespace
{

using Words = std::vector<uint32_t>;

// SPIR-V specification 1.6, section 3; only those operands that the engine distinguishes.
enum : uint32_t {
    TypeInt = 21,
    TypeFloat = 22,
    TypeVector = 23,
    TypeMatrix = 24,
    TypeImage = 25,
    TypeSampler = 26,
    TypeSampledImage = 27,
    TypeArray = 28,
    TypeStruct = 30,
    TypePointer = 32,
    Constant = 43,
    FunctionEnd = 56,
    Variable = 59,
    Load = 61,
    Decorate = 71,
    MemberDecorate = 72,
    RelaxedPrecision = 0,
    ArrayStride = 6,
    MatrixStride = 7,
    Binding = 33,
    DescriptorSet = 34,
    Offset = 35,
    UniformConstant = 0,
    Uniform = 2,
    PushConstant = 9,
    StorageBuffer = 12,
    TwoDimensional = 1,
    Buffer = 5,
    Sampled = 1,
    Stored = 2,
};

// Returns an instruction of an opcode and its operands, with its length filled in.
Words instruction(Words opcodeAndOperands)
{
    opcodeAndOperands[0] |= uint32_t(opcodeAndOperands.size()) << 16;
    return opcodeAndOperands;
}

Words moduleOf(const std::vector<Words>& instructions)
{
    Words all = {0x07230203, 0x00010600, 0, 100, 0};
    for (const Words& each : instructions) {
        const Words whole = instruction(each);
        all.insert(all.end(), whole.begin(), whole.end());
    }
    all.insert(all.end(), 1u << 16 | FunctionEnd);
    return all;
}

// Returns the message about the words; empty if they are accepted.
std::string sentence(const Words& words, CndResult expected = CND_ERROR_INVALID_ARGUMENT)
{
    const Words exact(words); // no spare capacity at the end, for the sanitizers
    try {
        gpu::reflect({"moon.comp", exact});
    } catch (const gpu::Failure& failure) {
        EXPECT_EQ(failure.code, expected) << failure.message;
        return failure.message;
    }
    return "";
}

constexpr const char* notWhole = "moon.comp is not SPIR-V, or is truncated";
constexpr const char* undefined =
    "moon.comp is SPIR-V that refers to an id that it does not define";
constexpr const char* endless =
    "moon.comp is SPIR-V with a type that contains itself or a type defined later";

// Appends push constants of the type with id 9.
std::vector<Words> pushing(std::vector<Words> types)
{
    types.push_back({TypePointer, 20, PushConstant, 9});
    types.push_back({Variable, 20, 21, PushConstant});
    return types;
}

// Appends a variable of the type with id 9, at binding 0.
std::vector<Words> bound(std::vector<Words> types, uint32_t storage)
{
    types.push_back({TypePointer, 20, storage, 9});
    types.push_back({Variable, 20, 21, storage});
    types.push_back({Decorate, 21, Binding, 0});
    return types;
}

} // namespace

TEST(Spirv, BindingsAndPushConstantsAreRead)
{
    const std::vector<Words> types = {{TypeFloat, 1, 32},
                                      {TypeInt, 2, 32, 0},
                                      {TypeVector, 3, 1, 3},
                                      {TypeMatrix, 4, 3, 2},
                                      {Constant, 2, 5, 7},
                                      {TypeArray, 6, 2, 5},
                                      {TypeStruct, 7, 3, 2},
                                      {TypeStruct, 9, 3, 4, 6, 7},
                                      {Decorate, 6, ArrayStride, 4},
                                      {MemberDecorate, 7, 0, Offset, 0},
                                      {MemberDecorate, 7, 1, Offset, 12},
                                      {MemberDecorate, 9, 0, Offset, 0},
                                      {MemberDecorate, 9, 1, Offset, 12},
                                      {MemberDecorate, 9, 1, MatrixStride, 12},
                                      {MemberDecorate, 9, 2, Offset, 36},
                                      {MemberDecorate, 9, 3, Offset, 64}};
    const gpu::Reflection pushed = gpu::reflect({"moon.comp", moduleOf(pushing(types))});
    EXPECT_EQ(pushed, (gpu::Reflection{.pushConstantSize = 80}));

    std::vector<Words> resources = {{TypeFloat, 1, 32},
                                    {TypeInt, 2, 32, 0},
                                    {Constant, 2, 3, 5},
                                    {TypeSampler, 10},
                                    {TypeImage, 11, 1, TwoDimensional, 0, 0, 0, Sampled, 0},
                                    {TypeImage, 12, 1, TwoDimensional, 0, 0, 0, Stored, 0},
                                    {TypeImage, 13, 1, Buffer, 0, 0, 0, Sampled, 0},
                                    {TypeImage, 14, 1, Buffer, 0, 0, 0, Stored, 0},
                                    {TypeSampledImage, 15, 11},
                                    {TypeArray, 16, 11, 3},
                                    {TypeStruct, 17}};
    gpu::Reflection expected{.usesHostSet = true};
    const auto add = [&](uint32_t type, uint32_t storage, uint32_t binding, VkDescriptorType is,
                         uint32_t count) {
        resources.push_back({TypePointer, 40 + binding, storage, type});
        resources.push_back({Variable, 40 + binding, 60 + binding, storage});
        resources.push_back({Decorate, 60 + binding, Binding, binding});
        resources.push_back({Decorate, 60 + binding, DescriptorSet, 0});
        expected.bindings.insert(expected.bindings.begin(), {binding, is, count});
    };
    add(17, Uniform, 8, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1); // bindings are sorted when read
    add(17, StorageBuffer, 7, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1);
    add(16, UniformConstant, 6, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 5);
    add(15, UniformConstant, 5, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1);
    add(14, UniformConstant, 4, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, 1);
    add(13, UniformConstant, 3, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, 1);
    add(12, UniformConstant, 2, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1);
    add(11, UniformConstant, 1, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1);
    add(10, UniformConstant, 0, VK_DESCRIPTOR_TYPE_SAMPLER, 1);
    resources.push_back({Variable, 40, 90, UniformConstant}); // belongs to the host's set
    resources.push_back({Decorate, 90, Binding, 0});
    resources.push_back({Decorate, 90, DescriptorSet, 1});
    EXPECT_EQ(gpu::reflect({"moon.comp", moduleOf(resources)}), expected);
}

// Each instruction is accepted at the very end of a module if all words that are read exist, and
// refused with one word less.
TEST(Spirv, InstructionsThatAreTooShortAreRefused)
{
    const Words least[] = {{TypeInt, 1, 32, 0},
                           {TypeFloat, 1, 32},
                           {TypeVector, 1, 2, 3},
                           {TypeMatrix, 1, 2, 3},
                           {TypeImage, 1, 2, TwoDimensional, 0, 0, 0, Sampled, 0},
                           {TypeSampler, 1},
                           {TypeSampledImage, 1},
                           {TypeArray, 1, 2, 3},
                           {TypeStruct, 1},
                           {TypePointer, 1, Uniform, 2},
                           {Constant, 1, 2, 5},
                           {Load, 1, 2, 3},
                           {Decorate, 1, RelaxedPrecision},
                           {Decorate, 1, Binding, 0},
                           {Decorate, 1, DescriptorSet, 0},
                           {Decorate, 1, ArrayStride, 4},
                           {MemberDecorate, 1, 0, RelaxedPrecision},
                           {MemberDecorate, 1, 0, Offset, 0},
                           {MemberDecorate, 1, 0, MatrixStride, 16}};
    for (Words words : least) {
        EXPECT_EQ(sentence(moduleOf({words})), "") << words[0];
        words.pop_back();
        EXPECT_EQ(sentence(moduleOf({words})), notWhole) << words[0];
    }
    const std::vector<Words> variable = bound({{TypeStruct, 9}}, Uniform);
    EXPECT_EQ(sentence(moduleOf(variable)), "");
    EXPECT_EQ(sentence(moduleOf({variable[0], variable[1], {Variable, 20, 21}})), notWhole);
}

TEST(Spirv, ModulesThatAreNotWholeAreRefused)
{
    const Words whole = moduleOf(bound({{TypeSampler, 9}}, UniformConstant));
    EXPECT_EQ(sentence(whole), "");
    for (size_t count = 0; count < whole.size(); ++count)
        EXPECT_EQ(sentence({whole.begin(), whole.begin() + long(count)}), notWhole) << count;
    Words swapped = whole; // the other byte order
    swapped[0] = 0x03022307;
    EXPECT_EQ(sentence(swapped), notWhole);
    Words stuck = whole; // an instruction of no words
    stuck.back() = FunctionEnd;
    EXPECT_EQ(sentence(stuck), notWhole);
    Words beyond = whole; // an instruction that extends beyond the end
    beyond.back() = 2u << 16 | FunctionEnd;
    EXPECT_EQ(sentence(beyond), notWhole);
}

TEST(Spirv, IdsOfSomethingElseAreRefused)
{
    const auto refused = [](const std::vector<Words>& instructions) {
        EXPECT_EQ(sentence(moduleOf(instructions)), undefined);
    };
    refused(bound({}, Uniform));                        // there is no type 9
    refused(bound({{TypeStruct, 9}}, UniformConstant)); // a struct in place of an image
    // a type in place of a count
    refused(bound({{TypeSampler, 8}, {TypeArray, 9, 8, 8}}, UniformConstant));
    refused({{Decorate, 21, Binding, 0}, {TypeSampler, 20}, {Variable, 20, 21, Uniform}});
    refused(pushing({{TypeStruct, 9}})); // a struct without decorations
    refused(pushing({{TypeFloat, 1, 32}, {TypeStruct, 9, 1}, {MemberDecorate, 9, 1, Offset, 0}}));
    refused(pushing({{TypeSampler, 8},
                     {TypeArray, 7, 8, 8},
                     {TypeStruct, 9, 7},
                     {Decorate, 7, ArrayStride, 4},
                     {MemberDecorate, 9, 0, Offset, 0}}));
    EXPECT_EQ(sentence(moduleOf({{TypeSampler, 9},
                                 {TypePointer, 20, UniformConstant, 9},
                                 {Variable, 20, 21, UniformConstant},
                                 {Decorate, 21, Binding, 0},
                                 {Decorate, 21, DescriptorSet, 2}}),
                       CND_ERROR_UNSUPPORTED),
              "shader moon.comp uses a descriptor set above 1");
}

TEST(Spirv, TypesThatHoldThemselvesAreRefused)
{
    const Words offset = {MemberDecorate, 9, 0, Offset, 0};
    const std::vector<Words> types[] = {
        {{TypeStruct, 9, 9}, offset},
        {{TypeStruct, 9, 8}, {TypeStruct, 8, 9}, offset, {MemberDecorate, 8, 0, Offset, 0}},
        {{TypeVector, 8, 8, 3}, {TypeStruct, 9, 8}, offset},
        {{TypeMatrix, 8, 7, 3}, {TypeVector, 7, 8, 3}, {TypeStruct, 9, 8}, offset}};
    for (const std::vector<Words>& each : types)
        EXPECT_EQ(sentence(moduleOf(pushing(each))), endless);
}

} // namespace candelabra::test
