// See live_code.h.
#include "vk/live_code.h"

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

#include "vk/spirv.h"

namespace candela::vk {
namespace {

using namespace spirv;

// Ids, below the bound of the module.
class IdSet {
  public:
    explicit IdSet(uint32_t bound) : has_(bound) {}

    // Words that are not ids may be inserted too.
    void insert(uint32_t word) {
        if (word < has_.size()) has_[word] = true;
    }
    bool contains(uint32_t id) const { return has_[id]; }

  private:
    std::vector<bool> has_;
};

class Pruner {
  public:
    Pruner(std::span<const uint32_t> spirv, std::span<const uint32_t> constants)
        : header_(spirv.first(HEADER_WORDS)),
          constants_(constants),
          values_(spirv[3]),
          words_(spirv[3]),
          live_(spirv[3]),
          only_targets_(spirv[3]),
          defined_(spirv[3]) {
        for (size_t at = HEADER_WORDS; at < spirv.size(); at += spirv[at] >> 16)
            read(spirv.subspan(at, spirv[at] >> 16));
    }

    // Empty if the control flow is beyond this class.
    std::vector<uint32_t> take() {
        std::vector<uint32_t> open{entry_};
        while (!open.empty()) {
            const uint32_t id = open.back();
            open.pop_back();
            if (!called_.insert(id).second) continue;
            if (!follow(functions_.at(id), open)) return {};
        }
        return write();
    }

  private:
    void read(Instruction i) {
        const uint32_t op = op_of(i);
        if (op == OP_FUNCTION) {
            order_.push_back(i[2]);
            functions_[i[2]].head.push_back(i);
        } else if (order_.empty()) {
            globals_.push_back(i);
            read_global(i);
        } else {
            Function& function = functions_[order_.back()];
            if (op == OP_LABEL) function.blocks.emplace_back();
            if (op == OP_FUNCTION_END) {
                function.end = i;
            } else {
                (function.blocks.empty() ? function.head : function.blocks.back().code).push_back(i);
            }
        }
    }

    void read_global(Instruction i) {
        const uint32_t op = op_of(i);
        if (op == OP_ENTRY_POINT) entry_ = i[2];
        if (op == OP_DECORATE && i[2] == DECORATION_SPEC_ID) numbers_[i[1]] = i[3];
        if (op == OP_TYPE_BOOL || (op == OP_TYPE_INT && i[2] == 32)) words_.insert(i[1]);
        if (op < OP_CONSTANT_TRUE || op > OP_SPEC_CONSTANT_OP || !words_.contains(i[1])) return;
        Value& value = values_[i[2]];
        if (op == OP_CONSTANT_TRUE || op == OP_SPEC_CONSTANT_TRUE) value = 1u;
        if (op == OP_CONSTANT_FALSE || op == OP_SPEC_CONSTANT_FALSE) value = 0u;
        if (op == OP_CONSTANT || op == OP_SPEC_CONSTANT) value = i[3];
        if (op == OP_SPEC_CONSTANT_OP) value = evaluate(i[3], i.subspan(4));
        if (const auto number = numbers_.find(i[2]);
            number != numbers_.end() && number->second < constants_.size())
            value = constants_[number->second];
    }

    Value evaluate(uint32_t op, Instruction operands) const {
        const auto value = [&](size_t k) {
            return k < operands.size() && operands[k] < values_.size() ? values_[operands[k]] : std::nullopt;
        };
        return spirv::evaluate(op, value(0), value(1), value(2));
    }

    // Finds the blocks that can run, and the functions that they call.
    bool follow(const Function& function, std::vector<uint32_t>& called) {
        std::unordered_map<uint32_t, uint32_t> places;
        for (uint32_t k = 0; k < function.blocks.size(); ++k)
            places[function.blocks[k].label()] = k;
        std::set<uint32_t> open{0};
        uint32_t done = 0;  // The blocks before have been followed, those that can run.
        while (!open.empty()) {
            const uint32_t k = *open.begin();
            open.erase(open.begin());
            const CodeBlock& block = function.blocks[k];
            live_.insert(block.label());
            done = k + 1;
            for (const Instruction& i : block.code) {
                if (op_of(i) == OP_FUNCTION_CALL) called.push_back(i[3]);
                learn(block, i);
            }
            for (const uint32_t target : targets(block, places, k)) {
                edges_.emplace(block.label(), target);
                const uint32_t place = places.at(target);
                if (place >= done) {
                    open.insert(place);
                } else if (!function.blocks[place].begins_loop()) {
                    return false;
                }
            }
        }
        return std::ranges::none_of(function.blocks,
                                    [&](const CodeBlock& block) { return needs_phi_of_stub(block); });
    }

    void learn(const CodeBlock& block, Instruction i) {
        const uint32_t op = op_of(i);
        if (i.size() < 4 || i[1] >= values_.size() || !words_.contains(i[1])) return;
        if (op != OP_PHI) {
            values_[i[2]] = evaluate(op, i.subspan(3));
            return;
        }
        if (block.begins_loop()) return;
        const std::vector<uint32_t> entries = live_entries(block, i);
        if (entries.size() == 2) values_[i[2]] = values_[entries[0]];
    }

    // The values of a phi, each with the block that it comes from, if control can come from there.
    std::vector<uint32_t> live_entries(const CodeBlock& block, Instruction phi) const {
        std::vector<uint32_t> entries;
        for (size_t k = 3; k + 1 < phi.size(); k += 2) {
            if (edges_.contains({phi[k + 1], block.label()}))
                entries.insert(entries.end(), {phi[k], phi[k + 1]});
        }
        return entries;
    }

    // The only target of a conditional branch whose condition is known. A branch that closes a loop stays.
    Value only_target(const CodeBlock& block, const std::unordered_map<uint32_t, uint32_t>& places,
                      uint32_t place) {
        const Instruction branch = block.branch();
        const Value selector = values_[branch[1]];
        if (!selector) return {};
        if (op_of(branch) == OP_BRANCH_CONDITIONAL) {
            if (places.at(branch[2]) <= place || places.at(branch[3]) <= place) return {};
            return branch[*selector != 0 ? 2 : 3];
        }
        for (size_t k = 3; k + 1 < branch.size(); k += 2) {
            if (branch[k] == *selector) return branch[k + 1];
        }
        return branch[2];
    }

    std::vector<uint32_t> targets(const CodeBlock& block,
                                  const std::unordered_map<uint32_t, uint32_t>& places, uint32_t place) {
        const Instruction branch = block.branch();
        const uint32_t op = op_of(branch);
        if (op == OP_BRANCH) return {branch[1]};
        if (op != OP_BRANCH_CONDITIONAL && op != OP_SWITCH) return {};
        if (const Value only = only_target(block, places, place)) {
            only_targets_[block.label()] = *only;
            return {*only};
        }
        std::vector<uint32_t> all{branch[2]};
        for (size_t k = 3; k < branch.size(); k += op == OP_SWITCH ? 2 : 1)
            all.push_back(branch[op == OP_SWITCH ? k + 1 : k]);
        return all;
    }

    // Whether control never comes back to this loop, whose phi would need a value from there.
    bool needs_phi_of_stub(const CodeBlock& block) const {
        return live_.contains(block.label()) && block.begins_loop() && !live_.contains(block.merge()[2]) &&
               op_of(block.code[1]) == OP_PHI;
    }

    std::vector<uint32_t> write() {
        std::vector<uint32_t> bodies;
        for (const uint32_t id : order_) {
            if (called_.contains(id)) write(functions_.at(id), bodies);
        }
        std::vector<uint32_t> module(header_.begin(), header_.end());
        for (const Instruction& i : globals_) {
            const uint32_t op = op_of(i);
            if (op == OP_UNDEF || op >= OP_TYPE_VOID || op == OP_STRING || op == OP_EXT_INST_IMPORT) {
                if (op != OP_DECORATE) defined_.insert(result_of(i));
            }
        }
        for (const Instruction& i : globals_) {
            const uint32_t op = op_of(i);
            if (op == OP_NAME || op == OP_MEMBER_NAME || (op == OP_DECORATE && !defined_.contains(i[1])))
                continue;
            module.insert(module.end(), i.begin(), i.end());
        }
        module.insert(module.end(), bodies.begin(), bodies.end());
        return module;
    }

    void write(const Function& function, std::vector<uint32_t>& words) {
        // Where constructs end that remain, and where a loop begins that would end there if control came so
        // far.
        std::map<uint32_t, uint32_t> ends;
        IdSet used(header_[3]);
        for (const CodeBlock& block : function.blocks) {
            if (!live_.contains(block.label())) continue;
            if (keeps_merge(block)) {
                ends.emplace(block.merge()[1], 0);
                if (block.begins_loop()) ends.emplace(block.merge()[2], block.label());
            }
            for (const Instruction& i : block.code) {
                if (op_of(i) == OP_VARIABLE) continue;
                for (const uint32_t word : i.subspan(1))
                    used.insert(word);
            }
        }
        const auto add = [&](Instruction i) { words.insert(words.end(), i.begin(), i.end()); };
        for (const Instruction& i : function.head) {
            defined_.insert(result_of(i));
            add(i);
        }
        for (const CodeBlock& block : function.blocks) {
            if (live_.contains(block.label())) {
                write(block, used, words);
            } else if (const auto end = ends.find(block.label()); end != ends.end()) {
                add(block.code.front());
                defined_.insert(block.label());
                if (end->second != 0) {
                    add(std::vector<uint32_t>{2u << 16 | OP_BRANCH, end->second});
                } else {
                    add(std::vector<uint32_t>{1u << 16 | OP_UNREACHABLE});
                }
            }
        }
        add(function.end);
    }

    // A branch with one target is no selection.
    bool keeps_merge(const CodeBlock& block) const {
        if (block.merge().empty()) return false;
        return op_of(block.branch()) != OP_BRANCH_CONDITIONAL || block.begins_loop() ||
               only_targets_[block.label()] == 0;
    }

    void write(const CodeBlock& block, const IdSet& used, std::vector<uint32_t>& words) {
        const uint32_t only = only_targets_[block.label()];
        for (const Instruction& i : block.code) {
            const uint32_t op = op_of(i);
            if (op == OP_VARIABLE && !used.contains(i[2])) continue;
            if (op == OP_SELECTION_MERGE && !keeps_merge(block)) continue;
            defined_.insert(result_of(i));
            std::vector<uint32_t> changed;
            if (op == OP_PHI) {
                changed = live_entries(block, i);
                changed.insert(changed.begin(), {uint32_t(changed.size() + 3) << 16 | OP_PHI, i[1], i[2]});
            } else if (op == OP_BRANCH_CONDITIONAL && only != 0) {
                changed = {2u << 16 | OP_BRANCH, only};
            } else if (op == OP_SWITCH && only != 0) {
                changed = {3u << 16 | OP_SWITCH, i[1], only};
            } else {
                changed.assign(i.begin(), i.end());
            }
            words.insert(words.end(), changed.begin(), changed.end());
        }
    }

    Instruction header_;
    std::span<const uint32_t> constants_;
    std::vector<Instruction> globals_;
    std::vector<uint32_t> order_;  // Ids of functions.
    std::unordered_map<uint32_t, Function> functions_;
    std::unordered_map<uint32_t, uint32_t> numbers_;  // Of specialization constants, by their ids.
    std::vector<Value> values_;                       // By ids; those that are known.
    IdSet words_;                                     // Types of values that may be known.
    uint32_t entry_ = 0;

    std::set<uint32_t> called_;                      // Functions.
    IdSet live_;                                     // Labels of blocks that can run.
    std::set<std::pair<uint32_t, uint32_t>> edges_;  // Between labels, where control can go.
    std::vector<uint32_t> only_targets_;             // By labels; 0: there are several, or no choice.
    IdSet defined_;
};

}  // namespace

std::vector<uint32_t> live_code(std::span<const uint32_t> spirv, std::span<const uint32_t> constants) {
    std::vector<uint32_t> live = Pruner(spirv, constants).take();
    return live.empty() ? std::vector<uint32_t>(spirv.begin(), spirv.end()) : live;
}

}  // namespace candela::vk
