// The names of what is in layers of ids, as attributes of the image.
#pragma once

#include "image/image.h"
#include "image/labels.h"

namespace candela {

// Adds candela.ids and the attributes of Cryptomatte, as far as the image has their layers.
void add_label_attributes(Image& image, const Labels& labels);

}  // namespace candela
