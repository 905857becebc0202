// The parts of a SPIR-V module that live_code.h and ways_around.h read. Ref: Khronos 2023, SPIR-V
// Specification, version 1.5, sections 2.11 and 3.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace candela::vk::spirv {

// Opcodes.
inline constexpr uint32_t OP_UNDEF = 1;
inline constexpr uint32_t OP_NAME = 5;
inline constexpr uint32_t OP_MEMBER_NAME = 6;
inline constexpr uint32_t OP_STRING = 7;
inline constexpr uint32_t OP_EXT_INST_IMPORT = 11;
inline constexpr uint32_t OP_ENTRY_POINT = 15;
inline constexpr uint32_t OP_TYPE_VOID = 19;
inline constexpr uint32_t OP_TYPE_BOOL = 20;
inline constexpr uint32_t OP_TYPE_INT = 21;
inline constexpr uint32_t OP_TYPE_FORWARD_POINTER = 39;
inline constexpr uint32_t OP_CONSTANT_TRUE = 41;
inline constexpr uint32_t OP_CONSTANT_FALSE = 42;
inline constexpr uint32_t OP_CONSTANT = 43;
inline constexpr uint32_t OP_SPEC_CONSTANT_TRUE = 48;
inline constexpr uint32_t OP_SPEC_CONSTANT_FALSE = 49;
inline constexpr uint32_t OP_SPEC_CONSTANT = 50;
inline constexpr uint32_t OP_SPEC_CONSTANT_OP = 52;
inline constexpr uint32_t OP_FUNCTION = 54;
inline constexpr uint32_t OP_FUNCTION_END = 56;
inline constexpr uint32_t OP_FUNCTION_CALL = 57;
inline constexpr uint32_t OP_VARIABLE = 59;
inline constexpr uint32_t OP_LOAD = 61;
inline constexpr uint32_t OP_DECORATE = 71;
inline constexpr uint32_t OP_I_ADD = 128;
inline constexpr uint32_t OP_I_SUB = 130;
inline constexpr uint32_t OP_I_MUL = 132;
inline constexpr uint32_t OP_LOGICAL_EQUAL = 164;
inline constexpr uint32_t OP_LOGICAL_NOT_EQUAL = 165;
inline constexpr uint32_t OP_LOGICAL_OR = 166;
inline constexpr uint32_t OP_LOGICAL_AND = 167;
inline constexpr uint32_t OP_LOGICAL_NOT = 168;
inline constexpr uint32_t OP_SELECT = 169;
inline constexpr uint32_t OP_I_EQUAL = 170;
inline constexpr uint32_t OP_I_NOT_EQUAL = 171;
inline constexpr uint32_t OP_U_GREATER_THAN = 172;
inline constexpr uint32_t OP_U_GREATER_THAN_EQUAL = 174;
inline constexpr uint32_t OP_U_LESS_THAN = 176;
inline constexpr uint32_t OP_U_LESS_THAN_EQUAL = 178;
inline constexpr uint32_t OP_SHIFT_RIGHT_LOGICAL = 194;
inline constexpr uint32_t OP_SHIFT_LEFT_LOGICAL = 196;
inline constexpr uint32_t OP_BITWISE_OR = 197;
inline constexpr uint32_t OP_BITWISE_XOR = 198;
inline constexpr uint32_t OP_BITWISE_AND = 199;
inline constexpr uint32_t OP_NOT = 200;
inline constexpr uint32_t OP_PHI = 245;
inline constexpr uint32_t OP_LOOP_MERGE = 246;
inline constexpr uint32_t OP_SELECTION_MERGE = 247;
inline constexpr uint32_t OP_LABEL = 248;
inline constexpr uint32_t OP_BRANCH = 249;
inline constexpr uint32_t OP_BRANCH_CONDITIONAL = 250;
inline constexpr uint32_t OP_SWITCH = 251;
inline constexpr uint32_t OP_RETURN = 253;
inline constexpr uint32_t OP_RETURN_VALUE = 254;
inline constexpr uint32_t OP_UNREACHABLE = 255;

inline constexpr uint32_t DECORATION_SPEC_ID = 1;
inline constexpr uint32_t DECORATION_BUILT_IN = 11;
inline constexpr uint32_t BUILT_IN_LOCAL_INVOCATION_INDEX = 29;
inline constexpr uint32_t HEADER_WORDS = 5;

// Its words; the first holds their number and the opcode.
using Instruction = std::span<const uint32_t>;

inline uint32_t op_of(Instruction i) {
    return i[0] & 0xFFFFu;
}

// The id that an instruction defines, or 0. Of instructions in blocks that define none, this may be another
// id that they use.
inline uint32_t result_of(Instruction i) {
    const uint32_t op = op_of(i);
    const bool is_type = op >= OP_TYPE_VOID && op < OP_TYPE_FORWARD_POINTER;
    if (is_type || op == OP_LABEL || op == OP_STRING || op == OP_EXT_INST_IMPORT) return i[1];
    return i.size() > 2 ? i[2] : 0;
}

using Value = std::optional<uint32_t>;

// The result, bool (0 or 1) or 32 bits, of an operation on such operands, if it is known.
Value evaluate(uint32_t op, Value a, Value b, Value c);

struct CodeBlock {
    std::vector<Instruction> code;  // From its label to its branch.

    uint32_t label() const { return code.front()[1]; }
    Instruction branch() const { return code.back(); }
    // What declares the blocks where its construct ends; empty if there is none.
    Instruction merge() const {
        if (code.size() < 3) return {};
        const Instruction before = code[code.size() - 2];
        const uint32_t op = op_of(before);
        return op == OP_SELECTION_MERGE || op == OP_LOOP_MERGE ? before : Instruction();
    }
    bool begins_loop() const { return !merge().empty() && op_of(merge()) == OP_LOOP_MERGE; }
};

struct Function {
    std::vector<Instruction> head;  // Before its blocks.
    std::vector<CodeBlock> blocks;
    Instruction end;
};

}  // namespace candela::vk::spirv
