// Checkpoints: the one to continue from, and those that are written while rendering.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "film/checkpoint.h"
#include "session/interval.h"
#include "session/job.h"

namespace candela {

// Throws Error if --checkpoint could not be written, or names an existing file without --resume (usage). Call
// it before any long work.
void check_checkpoint(const CheckpointOptions& options);

// The checkpoint that --resume continues from; nothing if the file does not exist yet. Throws Error if it is
// damaged, does not belong to `identity` and the job, is adaptive although the job is not, or the reverse, or
// holds more samples per pixel than the job's target.
std::optional<Checkpoint> load_to_resume(const RenderJob& job, const Identity& identity);

// Writes checkpoints, the first after one interval.
class CheckpointWriter {
  public:
    // `every`: seconds from the end of a write to the next.
    CheckpointWriter(std::filesystem::path path, double every);

    // Whether the interval is over.
    bool due() const { return interval_.over(); }
    // A failure is a warning: the rendering continues, the file keeps its old contents, and the next write
    // comes after another interval.
    void write(const CheckpointHeader& header, std::span<const Accumulation> states,
               const std::function<void(const std::string&)>& warn);
    // Writes the last checkpoint, as finished work. Throws Error if it could not be written in its place.
    void finish(const CheckpointHeader& header, std::span<const Accumulation> states) const;

  private:
    std::filesystem::path path_;
    Interval interval_;
};

}  // namespace candela
