// See checkpoints.h.
#include "session/checkpoints.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "base/file.h"

namespace candela {

void check_checkpoint(const CheckpointOptions& options) {
    if (!options.file) return;
    const std::string& path = *options.file;
    check_writable(path);
    std::error_code unreadable;  // Ignored: reading the file will report it.
    if (!options.resume && std::filesystem::exists(path, unreadable)) {
        throw Error("--checkpoint: \"" + path +
                        "\" exists; add --resume to continue from it, or remove it to start over",
                    ErrorKind::request);
    }
}

std::optional<Checkpoint> load_to_resume(const RenderJob& job, const Identity& identity) {
    if (!job.checkpoint.resume) return std::nullopt;
    const std::string& path = *job.checkpoint.file;
    std::error_code unreadable;
    if (!std::filesystem::exists(path, unreadable)) return std::nullopt;
    Checkpoint checkpoint = load_checkpoint(path);
    const auto refuse = [&](const std::string& why, const std::string& remedy) {
        throw Error("--resume: cannot continue from \"" + path + "\": " + why + "; " + remedy);
    };
    const std::string same = "render the same scene with the same options, or give another --checkpoint";
    const std::string different = difference(checkpoint.header.identity, identity);
    if (!different.empty()) refuse(different, same);
    const bool adaptive = checkpoint.states.size() > 1;
    if (adaptive != job.adaptive) {
        refuse(std::string("it was made with") + (adaptive ? " --adaptive" : "out --adaptive"), same);
    }
    const Accumulation& state = checkpoint.states.front();
    if (state.first_sample != job.settings.first_sample) {
        refuse("its first sample is " + std::to_string(state.first_sample) + ", not " +
                   std::to_string(job.settings.first_sample),
               same);
    }
    if ((state.layers_before_guides() != LAYER_COUNT_COLOUR) != job.settings.aovs) {
        refuse(std::string("it holds ") + (job.settings.aovs ? "no " : "") +
                   "albedo and normals, which the outputs " + (job.settings.aovs ? "need" : "do not need"),
               "give the same outputs and --aov as for the checkpoint");
    }
    if ((state.denoising_layer != 0) != job.settings.guides) {
        refuse(std::string("it holds ") + (job.settings.guides ? "no " : "") +
                   "guides for denoisers, which the outputs " +
                   (job.settings.guides ? "need" : "do not need"),
               "give the same outputs, --aov and --denoise as for the checkpoint");
    }
    const uint32_t max = adaptive ? std::max(checkpoint.header.planned, samples_per_pixel(checkpoint.states))
                                  : state.max_samples();
    if (max > job.target) {
        refuse("it holds up to " + std::to_string(max) + " samples per pixel, but " +
                   std::to_string(job.target) + " are asked for",
               "ask for at least as many");
    }
    return checkpoint;
}

CheckpointWriter::CheckpointWriter(std::filesystem::path path, double every)
    : path_(std::move(path)), interval_(every) {}

void CheckpointWriter::write(const CheckpointHeader& header, std::span<const Accumulation> states,
                             const std::function<void(const std::string&)>& warn) {
    try {
        save_checkpoint(path_, header, states);
    } catch (const Error& error) {
        warn(std::string(error.what()) + "; rendering continues without this checkpoint");
    }
    interval_.restart();
}

void CheckpointWriter::finish(const CheckpointHeader& header, std::span<const Accumulation> states) const {
    save_checkpoint(path_, header, states, write_finished_work);
}

}  // namespace candela
