// The images that a rendering leaves behind.
#pragma once

#include <string>
#include <vector>

#include "cli/image_options.h"
#include "image/image.h"
#include "session/record.h"

namespace candela {

// Throws Error (usage) if there is no output, or one has an unknown extension or cannot hold what is asked
// for.
void check_formats(const ImageOutputs& outputs);
// The same; also throws Error if one could not be written. Call it before any long work.
void check_outputs(const ImageOutputs& outputs);

// Writes all images, in the second case with attributes, as finished work. If one fails, still writes the
// others, and then throws the Error. Returns the part of the CPU time that compressing and writing took [s].
double write_images(const ImageOutputs& outputs, Image image);
double write_images(const ImageOutputs& outputs, const RenderRecord& record, Image image);

// Writes all images, with attributes, during a rendering. A failure is a warning: the file keeps its old
// contents.
void write_current_images(const ImageOutputs& outputs, const RenderRecord& record, Image image);

}  // namespace candela
