// Specialization constants: what is fixed when a kernel's pipeline is made. So a scene pays only for what it
// uses, and no branch depends on uniforms (which would make lavapipe 22.3 compile the kernel anew at every
// dispatch).
//
// kernel_constants.inc lists them: GLSL gets a constant NAME for each line, C++ its number, CONSTANT_NAME,
// its default and its owner.
#ifndef SHARED_KERNEL_CONSTANTS_H
#define SHARED_KERNEL_CONSTANTS_H

#include "shared/constants.h"
#include "shared/scene_arrays.h"

// The longest list of primitives that a kernel tests one by one: as many LIST_CORNERS_i there are.
const uint LIST_MAX = 16u;

#ifdef __cplusplus
#include <array>
namespace candela {

// Who sets a constant: what is in the scene and what is asked for decide the image, the device how it is
// computed.
enum class ConstantOwner { SCENE, SETTINGS, DEVICE };

#define CONSTANT(number, type, name, initial, owner) CONSTANT_##name,
enum KernelConstant : uint {
#include "shared/kernel_constants.inc"
    CONSTANT_COUNT
};
#undef CONSTANT

#define CONSTANT(number, type, name, initial, owner) static_assert(CONSTANT_##name == number);
#include "shared/kernel_constants.inc"
#undef CONSTANT

// A value for each constant; a bool is 0 or 1.
struct KernelConstants {
#define CONSTANT(number, type, name, initial, owner) uint(initial),
    std::array<uint, CONSTANT_COUNT> values{
#include "shared/kernel_constants.inc"
    };
#undef CONSTANT

    uint& operator[](KernelConstant constant) {
        return values[constant];
    }
    uint operator[](KernelConstant constant) const {
        return values[constant];
    }
    bool operator==(const KernelConstants&) const = default;
};

#define CONSTANT(number, type, name, initial, owner) ConstantOwner::owner,
inline constexpr std::array<ConstantOwner, CONSTANT_COUNT> CONSTANT_OWNERS{
#include "shared/kernel_constants.inc"
};
#undef CONSTANT

}  // namespace candela
#else

#define CONSTANT(number, type, name, initial, owner) layout(constant_id = number) const type name = initial;
#include "shared/kernel_constants.inc"
#undef CONSTANT

#endif

#endif
