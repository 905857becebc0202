// Layers of ids, made of what pixels show first.
#pragma once

#include <string_view>

#include "film/accumulation.h"
#include "film/coverage.h"
#include "image/image.h"
#include "image/labels.h"

namespace candela {

// The channels of the numbers of what covers most of a pixel; 0: nothing.
inline constexpr const char* OBJECT_ID = "ObjectId.V";
inline constexpr const char* INSTANCE_ID = "InstanceId.V";
inline constexpr const char* MATERIAL_ID = "MaterialId.V";

// Appends the layers that the selection names: the three above, and those of Cryptomatte (cryptomatte.h),
// whose ids are those of the names. Of what covers equal parts of a pixel, the lower number or id comes
// first, and nothing before anything. `coverage` is that of the image's pixels.
void add_id_layers(Image& image, const AovSelection& aovs, const Coverage& coverage, const Labels& labels);

// Whether a channel is one of those that add_id_layers() makes.
bool is_id_channel(std::string_view name);

// The attribute with the names of the numbers; those of Cryptomatte begin with CRYPTO_PREFIX.
inline constexpr std::string_view IDS_ATTRIBUTE = "candela.ids";

// Whether an attribute says what numbers or ids mean.
bool is_label_attribute(std::string_view name);

// Removes such attributes where the image has none of the channels that they are about.
void drop_stray_label_attributes(Image& image);

}  // namespace candela
