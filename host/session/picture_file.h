// What the files of pictures for the screen hold besides what is developed.
#pragma once

#include "image/background.h"
#include "image/image.h"
#include "image/image_io.h"
#include "image/tonemap.h"
#include "scene/names.h"

namespace candela {

inline constexpr Choices<Tonemap, 5> TONEMAP_NAMES{{{"linear", Tonemap::linear},
                                                    {"reinhard", Tonemap::reinhard},
                                                    {"aces", Tonemap::aces},
                                                    {"agx", Tonemap::agx},
                                                    {"neutral", Tonemap::neutral}}};

// What a picture stands before if nobody says: a soft grey if its scene has catchers, or is in a studio that
// the camera does not see; null: what the image shows.
const Background* default_background(const Image& image);

// What the file states: the image's texts, without the command line and the time, so that files of equal
// pictures are equal, and name nothing of the computer's folders.
PictureNotes picture_notes(const Image& image);

}  // namespace candela
