// See spirv.h.
#include "vk/spirv.h"

namespace candela::vk::spirv {

Value evaluate(uint32_t op, Value a, Value b, Value c) {
    if (op == OP_SELECT) return a ? (*a != 0 ? b : c) : std::nullopt;
    if ((op == OP_LOGICAL_AND || op == OP_BITWISE_AND) && (a == 0u || b == 0u)) return 0u;
    if (op == OP_LOGICAL_OR && (a == 1u || b == 1u)) return 1u;
    if (!a) return {};
    if (op == OP_LOGICAL_NOT) return 1u - *a;
    if (op == OP_NOT) return ~*a;
    if (!b) return {};
    switch (op) {
        case OP_I_ADD:
            return *a + *b;
        case OP_I_SUB:
            return *a - *b;
        case OP_I_MUL:
            return *a * *b;
        case OP_LOGICAL_EQUAL:
        case OP_I_EQUAL:
            return *a == *b;
        case OP_LOGICAL_NOT_EQUAL:
        case OP_I_NOT_EQUAL:
            return *a != *b;
        case OP_LOGICAL_OR:
        case OP_BITWISE_OR:
            return *a | *b;
        case OP_LOGICAL_AND:
        case OP_BITWISE_AND:
            return *a & *b;
        case OP_BITWISE_XOR:
            return *a ^ *b;
        case OP_U_GREATER_THAN:
            return *a > *b;
        case OP_U_GREATER_THAN_EQUAL:
            return *a >= *b;
        case OP_U_LESS_THAN:
            return *a < *b;
        case OP_U_LESS_THAN_EQUAL:
            return *a <= *b;
        case OP_SHIFT_RIGHT_LOGICAL:
            return *b < 32 ? Value(*a >> *b) : std::nullopt;
        case OP_SHIFT_LEFT_LOGICAL:
            return *b < 32 ? Value(*a << *b) : std::nullopt;
        default:
            return {};
    }
}

}  // namespace candela::vk::spirv
