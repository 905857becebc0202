// Specialization constants: values fixed when a kernel's pipeline is made. So a scene only pays for what it
// uses, and no branch depends on uniforms (which would make lavapipe 22.3 recompile the kernel at every
// dispatch).
//
// kernel_constants.inc lists them: GLSL gets a constant NAME for each line, C++ its number, CONSTANT_NAME,
// its default and its owner.
#ifndef SHARED_KERNEL_CONSTANTS_H
#define SHARED_KERNEL_CONSTANTS_H

#include "shared/constants.h"
#include "shared/scene_arrays.h"

#ifdef __cplusplus
#include <array>
#include <iterator>
namespace candela {
#endif

// The longest list of primitives that a kernel tests one by one; there is a LIST_CORNERS_i for each.
const uint LIST_MAX = 16u;

#ifdef __cplusplus

// What determines a constant. Scene and settings determine the image, the device only its computation.
enum class ConstantOwner { scene, settings, device };

#define CONSTANT(number, type, name, initial, owner) const uint CONSTANT_##name = number;
#include "shared/kernel_constants.inc"
#undef CONSTANT

struct ConstantEntry {
    uint number;
    uint initial;  // A bool is 0 or 1.
    ConstantOwner owner;
};

#define CONSTANT(number, type, name, initial, owner) {number, uint(initial), ConstantOwner::owner},
inline constexpr ConstantEntry CONSTANT_ENTRIES[]{
#include "shared/kernel_constants.inc"
};
#undef CONSTANT

inline constexpr uint CONSTANT_COUNT = std::size(CONSTANT_ENTRIES);

// A value for each constant, by its number.
struct KernelConstants {
    std::array<uint, CONSTANT_COUNT> values = defaults();

    uint& operator[](uint constant) { return values[constant]; }
    uint operator[](uint constant) const { return values[constant]; }
    bool operator==(const KernelConstants&) const = default;

    static constexpr std::array<uint, CONSTANT_COUNT> defaults() {
        std::array<uint, CONSTANT_COUNT> result{};
        for (const ConstantEntry& entry : CONSTANT_ENTRIES)
            result[entry.number] = entry.initial;
        return result;
    }
};

}  // namespace candela
#else

#define CONSTANT(number, type, name, initial, owner) layout(constant_id = number) const type name = initial;
#include "shared/kernel_constants.inc"
#undef CONSTANT

#endif

#endif
