// The code of a kernel that can run. A kernel is written for all scenes, and drivers spend most of the time
// of its compilation on code that the values of its specialization constants leave out.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace candela::vk {

// The SPIR-V module without the blocks, functions, variables and names that cannot matter if its
// specialization constants 0, 1, 2, … have these values (32 bits each), which it still needs. Nothing else
// changes: instructions that remain keep their order and decorations. Returns a copy of a module whose
// control flow is beyond it: with a block that comes before one that leads to it, other than by a loop. The
// module must be valid.
std::vector<uint32_t> live_code(std::span<const uint32_t> spirv, std::span<const uint32_t> constants);

}  // namespace candela::vk
