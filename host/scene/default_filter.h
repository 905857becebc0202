// The widths that filters of pixels have if nobody gives them one.
#pragma once

#include "scene/scene.h"

namespace candela {

constexpr PixelFilter default_filter(FilterShape shape) {
    switch (shape) {
        case FilterShape::tent:
            return {shape, 2.0f};  // Linear between the centres of pixels.
        case FilterShape::gaussian:
            return {shape, 3.0f};  // A standard deviation of half a pixel.
        case FilterShape::blackman_harris:
            return {shape, 1.5f};  // As in Blender.
        case FilterShape::box:
            break;
    }
    return {shape, 1.0f};
}

}  // namespace candela
