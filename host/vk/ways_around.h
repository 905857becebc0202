// A work-around for SwiftShader's compiler, whose time doubles with each branch of a loop.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace candela::vk {

// The SPIR-V module with a way around the body of each function of `least_blocks` or more, which no
// invocation takes.
//
// For each loop, SwiftShader searches for a path from its header to the blocks before it. It notes a block
// when it leaves it, not when it finds it: where two ways of the same length meet, it goes on twice. Twenty
// branches, one after the other, are a million paths. A way around is shorter than all others, so that what
// follows is searched once. (ExistsPath() in SpirvShaderControlFlow.cpp, June 2026.)
//
// A module that does not read its LocalInvocationIndex, which decides, is returned as it is. The module must
// be valid.
std::vector<uint32_t> with_ways_around(std::span<const uint32_t> spirv, uint32_t least_blocks);

}  // namespace candela::vk
