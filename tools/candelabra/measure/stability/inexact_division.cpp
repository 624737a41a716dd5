// SPDX-License-Identifier: Apache-2.0
#include "measure/stability/inexact_division.h"

#include <map>

#include <glslang/SPIRV/GLSL.std.450.h>
#include <glslang/SPIRV/spirv.hpp>

namespace candelabra::app
{
namespace
{

constexpr size_t headerWords = 5;
constexpr size_t boundWord = 3; // of the header: one more than the largest id

using Instruction = std::span<const uint32_t>;

uint32_t opcode(Instruction i)
{
    return i[0] & 0xFFFFu;
}

class Rewriter
{
public:
    Rewriter(std::span<const uint32_t> spirv, uint32_t seed)
        : seed_(seed), out_(spirv.begin(), spirv.begin() + headerWords)
    {
        for (size_t at = headerWords; at < spirv.size(); at += instructions_.back().size())
            instructions_.push_back(spirv.subspan(at, spirv[at] >> 16));
        for (const Instruction i : instructions_)
            learn(i);
        for (const Instruction i : instructions_)
            if (const uint32_t range = rangeOf(i))
                moved_[i[2]] = {newId(), range};
    }

    std::vector<uint32_t> rewritten()
    {
        bool inFunctions = false;
        for (const Instruction i : instructions_) {
            if (opcode(i) == spv::OpFunction && !inFunctions) {
                declare();
                inFunctions = true;
            }
            const size_t begin = out_.size();
            out_.insert(out_.end(), i.begin(), i.end());
            // Decorations, such as `precise`, are of the instruction.
            const bool decorates = opcode(i) == spv::OpDecorate && moved_.contains(i[1]);
            if (decorates)
                out_[begin + 1] = moved_.at(i[1]).exact;
            else if (rangeOf(i)) {
                out_[begin + 2] = moved_.at(i[2]).exact;
                move(i[1], i[2], moved_.at(i[2]));
            }
        }
        defineMove();
        out_[boundWord] = bound_;
        return std::move(out_);
    }

private:
    struct Moved {
        uint32_t exact; // id of the value before it is moved
        uint32_t range; // by how many different steps it may be moved: 3 or 5
    };

    uint32_t newId() { return bound_++; }

    void emit(uint32_t op, std::initializer_list<uint32_t> operands)
    {
        out_.push_back(uint32_t(operands.size() + 1) << 16 | op);
        out_.insert(out_.end(), operands);
    }

    // Emits an instruction with a result and returns the id of the result.
    uint32_t emitValue(uint32_t op, uint32_t type, std::initializer_list<uint32_t> operands)
    {
        const uint32_t id = newId();
        out_.push_back(uint32_t(operands.size() + 3) << 16 | op);
        out_.insert(out_.end(), {type, id});
        out_.insert(out_.end(), operands);
        return id;
    }

    void learn(Instruction i)
    {
        if (opcode(i) == spv::OpTypeBool)
            boolType_ = i[1];
        else if (opcode(i) == spv::OpTypeInt && i[2] == 32 && i[3] == 0)
            uintType_ = i[1];
        else if (opcode(i) == spv::OpTypeFloat && i[2] == 32)
            floatType_ = i[1];
        else if (opcode(i) == spv::OpTypeVector && i[2] == floatType_)
            lengths_[i[1]] = i[3];
        else if (opcode(i) == spv::OpExtInstImport)
            glsl_ = i[1]; // the only set that kernels use
    }

    // Returns how many steps the result of the instruction may be moved by, 0 if it stays.
    uint32_t rangeOf(Instruction i) const
    {
        const bool isQuotient = opcode(i) == spv::OpFDiv;
        const bool isExtended = opcode(i) == spv::OpExtInst && i[3] == glsl_;
        if (!isQuotient && !isExtended)
            return 0;
        if (i[1] != floatType_ && !lengths_.contains(i[1]))
            return 0;
        if (isExtended && i[4] == GLSLstd450InverseSqrt)
            return 3;
        const bool isRoot =
            isExtended && (i[4] == GLSLstd450Sqrt || i[4] == GLSLstd450Length ||
                           i[4] == GLSLstd450Distance || i[4] == GLSLstd450Normalize);
        return isQuotient || isRoot ? 5 : 0;
    }

    uint32_t constant(uint32_t value) { return constants_.at(value); }

    // Declares what the module lacks, before its first function.
    void declare()
    {
        if (!boolType_) {
            boolType_ = newId();
            emit(spv::OpTypeBool, {boolType_});
        }
        functionType_ = newId();
        emit(spv::OpTypeFunction, {functionType_, floatType_, floatType_, uintType_, uintType_});
        for (const uint32_t value : {1u, 2u, 3u, 5u, 15u, 23u, 252u, 255u, multiplier})
            constants_[value] = emitValue(spv::OpConstant, uintType_, {value});
        for (const auto& [id, moved] : moved_)
            salts_[id] = emitValue(spv::OpConstant, uintType_, {(id ^ seed_ << 16) * multiplier});
        function_ = newId();
    }

    uint32_t call(uint32_t id, uint32_t value, const Moved& moved)
    {
        return emitValue(spv::OpFunctionCall, floatType_,
                         {function_, value, salts_.at(id), constant(moved.range)});
    }

    // Gives `id`, which had the value moved.exact, that value moved.
    void move(uint32_t type, uint32_t id, const Moved& moved)
    {
        if (type == floatType_) {
            emit(spv::OpFunctionCall,
                 {type, id, function_, moved.exact, salts_.at(id), constant(moved.range)});
            return;
        }
        std::vector<uint32_t> parts{type, id};
        for (uint32_t k = 0; k < lengths_.at(type); ++k) {
            const uint32_t part = emitValue(spv::OpCompositeExtract, floatType_, {moved.exact, k});
            parts.push_back(call(id, part, moved));
        }
        out_.push_back(uint32_t(parts.size() + 1) << 16 | spv::OpCompositeConstruct);
        out_.insert(out_.end(), parts.begin(), parts.end());
    }

    // Defines the function that moves a float by -range / 2 to range / 2, according to a hash.
    void defineMove()
    {
        emit(spv::OpFunction, {floatType_, function_, 0, functionType_});
        const uint32_t value = emitValue(spv::OpFunctionParameter, floatType_, {});
        const uint32_t salt = emitValue(spv::OpFunctionParameter, uintType_, {});
        const uint32_t range = emitValue(spv::OpFunctionParameter, uintType_, {});
        emit(spv::OpLabel, {newId()});
        const auto integer = [&](uint32_t op, uint32_t a, uint32_t b) {
            return emitValue(op, uintType_, {a, b});
        };
        const uint32_t bits = emitValue(spv::OpBitcast, uintType_, {value});
        uint32_t hash = integer(spv::OpBitwiseXor, bits, salt);
        for (int round = 0; round < 2; ++round) {
            hash = integer(spv::OpIMul, hash, constant(multiplier));
            const uint32_t high = integer(spv::OpShiftRightLogical, hash, constant(15));
            hash = integer(spv::OpBitwiseXor, hash, high);
        }
        const uint32_t up = integer(spv::OpUMod, hash, range);
        const uint32_t down = integer(spv::OpShiftRightLogical, range, constant(1));
        const uint32_t higher = integer(spv::OpIAdd, bits, up);
        const uint32_t steps = integer(spv::OpISub, higher, down);
        const uint32_t other = emitValue(spv::OpBitcast, floatType_, {steps});
        // Exponents of 2 to 253, all but those of the smallest and largest values.
        const uint32_t signExponent = integer(spv::OpShiftRightLogical, bits, constant(23));
        const uint32_t exponent = integer(spv::OpBitwiseAnd, signExponent, constant(255));
        const uint32_t fromTwo = integer(spv::OpISub, exponent, constant(2));
        const uint32_t usual = emitValue(spv::OpULessThan, boolType_, {fromTwo, constant(252)});
        emit(spv::OpReturnValue, {emitValue(spv::OpSelect, floatType_, {usual, other, value})});
        emit(spv::OpFunctionEnd, {});
    }

    static constexpr uint32_t multiplier = 0x2C1B3C6D; // odd, with a good mix of bits

    uint32_t seed_;
    std::vector<uint32_t> out_;
    uint32_t bound_ = out_[boundWord];
    std::vector<Instruction> instructions_;
    uint32_t boolType_ = 0, uintType_ = 0, floatType_ = 0, functionType_ = 0, function_ = 0,
             glsl_ = 0;
    std::map<uint32_t, uint32_t> lengths_;           // of vectors of floats, by type
    std::map<uint32_t, Moved> moved_;                // by id
    std::map<uint32_t, uint32_t> constants_, salts_; // ids, by value and by moved id
};

} // namespace

std::vector<uint32_t> withInexactDivision(std::span<const uint32_t> spirv, uint32_t seed)
{
    return Rewriter(spirv, seed).rewritten();
}

} // namespace candelabra::app
