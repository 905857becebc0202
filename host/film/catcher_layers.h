// The layers of catchers in an image, and the alpha that they make.
#pragma once

#include <array>

#include "image/image.h"

namespace candela {

// The share of camera rays that hit a catcher first, and the alpha of everything else.
inline constexpr const char* CATCHER_ALPHA = "Catcher.A";
inline constexpr const char* FOREGROUND_ALPHA = "Foreground.A";
// Means over all camera rays of a catcher's radiance with and without the rest of the scene; 0 for other
// rays.
inline constexpr std::array<const char*, 3> CATCHER_WITH{"CatcherWith.R", "CatcherWith.G", "CatcherWith.B"};
inline constexpr std::array<const char*, 3> CATCHER_WITHOUT{"CatcherWithout.R", "CatcherWithout.G",
                                                            "CatcherWithout.B"};

// Sets A of an image with all of these layers: Foreground.A + Catcher.A (1 - with / without), where the ratio
// is that of luminances, clipped to [0, 1], and 1 where `without` is black. Does nothing if a layer is
// missing.
void set_catcher_alpha(Image& image);

}  // namespace candela
