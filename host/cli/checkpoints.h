// The checkpoints of `candela render`: the one to continue from, and those that are written on the way.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include "cli/interval.h"
#include "cli/render_options.h"
#include "film/checkpoint.h"

namespace candela {

// Throws Error if --checkpoint could not be written, or names a file that exists already although there is no
// --resume (usage). To be called before any long work.
void check_checkpoint(const CheckpointOptions& options);

// What --resume says to continue from; nothing, which a line on stderr tells, if the file does not exist yet.
// Throws Error if it is damaged, belongs to another rendering than `identity` or the job, is adaptive where
// the job is not or the other way round, or holds more samples per pixel than the job's target.
std::optional<Checkpoint> load_to_resume(const RenderJob& job, const Identity& identity);

// Writes checkpoints, the first after one interval. A write that fails is a warning: the rendering goes on,
// the file keeps its old contents, and the next interval tries again.
class CheckpointWriter {
  public:
    // `every`: seconds from the end of a write to the next.
    CheckpointWriter(std::filesystem::path path, double every);

    // The interval is over.
    bool due() const { return interval_.over(); }
    void write(const CheckpointHeader& header, std::span<const Accumulation> states);

  private:
    std::filesystem::path path_;
    Interval interval_;
};

}  // namespace candela
