// The files that a rendering leaves behind.
#pragma once

#include <optional>
#include <string>

#include "cli/image_options.h"
#include "image/image.h"
#include "session/record.h"

namespace candela {

// Throws Error (usage) if there is no output or one has an unknown extension, and Error if one could not be
// written. Call it before any long work.
void check_outputs(const ImageOutputs& outputs);
// Throws Error if the report could not be written.
void check_report(const std::optional<std::string>& file);

// Writes all images, as finished work. If one fails, still writes the others, and then throws the Error.
void write_images(const ImageOutputs& outputs, Image image);

// Writes all images, with attributes, during a rendering. A failure is a warning: the file keeps its old
// contents.
void write_current_images(const ImageOutputs& outputs, const RenderRecord& record, Image image);

// Writes all images, with attributes, and the report, if a file is given, as finished work. If one fails,
// still writes the others, and then throws the Error.
void write_outputs(const ImageOutputs& outputs, const std::optional<std::string>& report,
                   const RenderRecord& record, Image image);

}  // namespace candela
