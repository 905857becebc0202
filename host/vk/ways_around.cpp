// See ways_around.h.
#include "vk/ways_around.h"

#include <cstddef>
#include <initializer_list>
#include <map>

#include "vk/spirv.h"

namespace candela::vk {
namespace {

using namespace spirv;

constexpr uint32_t NEVER = 0xFFFFFFFFu;  // No index of an invocation.

class Detours {
  public:
    Detours(std::span<const uint32_t> spirv, uint32_t least_blocks)
        : spirv_(spirv), least_blocks_(least_blocks), bound_(spirv[3]) {}

    std::vector<uint32_t> take() {
        size_t at = HEADER_WORDS;
        for (; at < spirv_.size() && op_at(at) != OP_FUNCTION; at = behind(at))
            note(instruction_at(at));
        if (index_ == 0 || uint_ == 0 || bool_ == 0) return {spirv_.begin(), spirv_.end()};
        never_ = bound_++;
        globals_ = {4u << 16 | OP_CONSTANT, uint_, never_, NEVER};
        const size_t functions = at;
        while (at < spirv_.size())
            at = write_function(at);
        std::vector<uint32_t> module(spirv_.begin(), spirv_.begin() + std::ptrdiff_t(functions));
        module[3] = bound_;
        module.insert(module.end(), globals_.begin(), globals_.end());
        module.insert(module.end(), code_.begin(), code_.end());
        return module;
    }

  private:
    // The instruction whose first word has that place, and the place behind it.
    Instruction instruction_at(size_t at) const { return spirv_.subspan(at, spirv_[at] >> 16); }
    size_t behind(size_t at) const { return at + (spirv_[at] >> 16); }
    uint32_t op_at(size_t at) const { return op_of(instruction_at(at)); }

    // An instruction before the first function.
    void note(Instruction i) {
        const uint32_t op = op_of(i);
        const bool is_index = op == OP_DECORATE && i[2] == DECORATION_BUILT_IN;
        if (is_index && i[3] == BUILT_IN_LOCAL_INVOCATION_INDEX) index_ = i[1];
        if (op == OP_TYPE_INT && i[2] == 32 && i[3] == 0) uint_ = i[1];
        if (op == OP_TYPE_BOOL) bool_ = i[1];
        if (op == OP_TYPE_VOID) void_ = i[1];
        if (op == OP_ENTRY_POINT) entry_ = i[2];
    }

    void write(std::initializer_list<uint32_t> words) { code_.insert(code_.end(), words); }

    // Writes the function that begins there; returns where it ends.
    size_t write_function(size_t begin) {
        const Instruction head = instruction_at(begin);
        uint32_t blocks = 0;
        size_t body = 0;  // After the label and the variables of its first block.
        size_t end = begin;
        for (; op_at(end) != OP_FUNCTION_END; end = behind(end)) {
            const uint32_t op = op_at(end);
            if (op == OP_LABEL) ++blocks;
            if (blocks == 1 && (op == OP_LABEL || op == OP_VARIABLE)) body = behind(end);
        }
        const size_t after = behind(end);
        if (blocks < least_blocks_ || head[2] == entry_) {
            copy(begin, after);
            return after;
        }
        const uint32_t index = bound_, taken = bound_ + 1, inside = bound_ + 2, around = bound_ + 3;
        bound_ += 4;
        copy(begin, body);
        write({4u << 16 | OP_LOAD, uint_, index, index_});
        write({5u << 16 | OP_I_NOT_EQUAL, bool_, taken, index, never_});
        write({3u << 16 | OP_SELECTION_MERGE, around, 0});
        write({4u << 16 | OP_BRANCH_CONDITIONAL, taken, inside, around});
        write({2u << 16 | OP_LABEL, inside});
        copy_inside(body, end, first_label(begin), inside);
        write({2u << 16 | OP_LABEL, around});
        if (head[1] == void_) {
            write({1u << 16 | OP_RETURN});
        } else {
            write({2u << 16 | OP_RETURN_VALUE, undefined(head[1])});
        }
        copy(end, after);
        return after;
    }

    uint32_t first_label(size_t function) const {
        while (op_at(function) != OP_LABEL)
            function = behind(function);
        return instruction_at(function)[1];
    }

    void copy(size_t begin, size_t end) {
        const auto part = spirv_.subspan(begin, end - begin);
        code_.insert(code_.end(), part.begin(), part.end());
    }
    // The same, where what came from block `from` comes from block `to`.
    void copy_inside(size_t begin, size_t end, uint32_t from, uint32_t to) {
        for (size_t at = begin; at < end; at = behind(at)) {
            const size_t copied = code_.size();
            copy(at, behind(at));
            if (op_at(at) != OP_PHI) continue;
            for (size_t parent = copied + 4; parent < code_.size(); parent += 2) {
                if (code_[parent] == from) code_[parent] = to;
            }
        }
    }

    // An id of that type with any value.
    uint32_t undefined(uint32_t type) {
        const auto [found, is_new] = undefined_.emplace(type, bound_);
        if (is_new) {
            globals_.insert(globals_.end(), {3u << 16 | OP_UNDEF, type, bound_});
            ++bound_;
        }
        return found->second;
    }

    std::span<const uint32_t> spirv_;
    uint32_t least_blocks_;
    uint32_t bound_;  // Above all ids.
    // Ids; 0 until they are found.
    uint32_t index_ = 0;  // Of the variable LocalInvocationIndex.
    uint32_t uint_ = 0;
    uint32_t bool_ = 0;
    uint32_t void_ = 0;
    uint32_t entry_ = 0;
    uint32_t never_ = 0;                      // The constant.
    std::map<uint32_t, uint32_t> undefined_;  // By type.
    std::vector<uint32_t> globals_;           // New constants.
    std::vector<uint32_t> code_;              // Functions.
};

}  // namespace

std::vector<uint32_t> with_ways_around(std::span<const uint32_t> spirv, uint32_t least_blocks) {
    return Detours(spirv, least_blocks).take();
}

}  // namespace candela::vk
