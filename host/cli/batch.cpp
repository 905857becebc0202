// See batch.h.
#include "cli/batch.h"

#include <algorithm>
#include <utility>

#include "base/caught_error.h"
#include "base/cpu_time.h"
#include "base/file.h"
#include "cli/console.h"
#include "cli/outputs.h"
#include "film/accumulation.h"

namespace candela {
namespace {

// What is said of a scene among several: most messages name it already.
std::string about(const std::string& scene, const std::string& message) {
    return message.find(scene) == std::string::npos ? candela::quoted(scene) + ": " + message : message;
}

// Writes the images, and notes if that fails.
RenderedPicture written(RenderedPicture rendered, const ImageOutputs& outputs, bool is_reported) {
    if (is_reported) rendered.image_hash = image_hash(rendered.image);
    rendered.attempts.attempt([&] {
        rendered.denoising = outputs.denoise(rendered.image);
        const CpuWatch watch;
        try {
            rendered.overhead.encode = write_images(outputs, rendered.record, std::move(rendered.image));
        } catch (...) {
            throw Error(caught_error());
        }
        rendered.overhead.develop += watch.seconds() - rendered.overhead.encode;
    });
    return rendered;
}

}  // namespace

Batch::Batch(PicturePlan& plan, const RenderOptions& options, const std::string& command_line)
    : plan_(plan),
      options_(options),
      renderer_(options, plan.is_batch(), command_line),
      report_(options.outputs.report, plan.is_batch()) {}

ExitCode Batch::run() {
    bool more = true;
    for (size_t i = 0; more; ++i) {
        if (ends_early()) {
            was_interrupted_ |= renderer_.interrupted();
            break;
        }
        if (renderer_.time_is_over()) {
            if (next_.valid()) next_.wait();  // It may change the plan.
            leave_out(plan_.scenes()[i]);
            more = next_of(i).exists;
            continue;
        }
        PreparedScene scene = prepare(i);
        const auto has_job = [](const PreparedPicture& picture) { return picture.job.has_value(); };
        // Before another thread starts, since this may set variables of the environment.
        if (!scene.failure && std::ranges::any_of(scene.pictures, has_job)) renderer_.choose_device();
        const Next next = next_of(i);  // Before another thread changes the plan.
        if (next.exists) begin_next(i + 1);
        render_scene(scene, !next.exists);
        if (!next.is_frame) renderer_.leave_scene();
        more = next.exists;
    }
    settle();
    renderer_.check_validation();
    if (plan_.is_batch() || skipped_ > 0 || left_out_ > 0) print_summary();
    if (was_interrupted_) return ExitCode::interrupted;
    if (left_out_ > 0) return ExitCode::time_over;
    return code_.value_or(ExitCode::done);
}

// Whether no further picture shall be rendered.
bool Batch::ends_early() const {
    const bool lacks_exposure = options_.outputs.images.development.exposure.of_first && !first_exposure_;
    return renderer_.interrupted() || (failed_ > 0 && (options_.list.stop_on_error || lacks_exposure));
}

// Scene i, which another thread may have prepared already.
PreparedScene Batch::prepare(size_t i) {
    if (next_.valid()) {
        PreparedScene scene = next_.get();
        const bool fits = !scene.failure || scene.failure->kind() != ErrorKind::out_of_memory;
        if (fits) return scene;
        settle();
    }
    const bool shows_progress = renderer_.can_be_quit() && i == 0;
    return prepare_scene(plan_, i, options_,
                         shows_progress ? std::optional(options_.messages.progress_style()) : std::nullopt,
                         kept_);
}

Batch::Next Batch::next_of(size_t i) const {
    const std::vector<PlannedScene>& scenes = plan_.scenes();
    const bool exists = i + 1 < scenes.size();
    return {exists, exists && scenes[i + 1].number == scenes[i].number};
}

// Has another thread prepare scene i; this thread does if no other can be started.
void Batch::begin_next(size_t i) {
    next_ = std::async([this, i] { return prepare_scene(plan_, i, options_, std::nullopt, kept_); });
}

// Ends what takes memory beside the current picture.
void Batch::be_alone() {
    settle();
    next_ = {};
    kept_.reset();
}

void Batch::render_scene(PreparedScene& scene, bool is_last) {
    for (std::string& warning : scene.warnings)
        warning = about(scene.file, warning);
    print_warnings(scene.warnings);
    if (scene.failure) print_failure(scene.file, *scene.failure);
    if (scene.pictures.empty()) scene.pictures.push_back({.picture = {.scene = scene.file}});
    for (const PreparedPicture& picture : scene.pictures) {
        if (ends_early()) {
            was_interrupted_ |= renderer_.interrupted();
            return;
        }
        if (picture.is_skipped && !picture.is_metered) {
            skip(picture.picture);
        } else if (renderer_.time_is_over()) {
            leave_out(picture.picture);
        } else if (picture.failure) {
            print_failure(scene.file, *picture.failure);
            fail(picture.picture, *picture.failure);
        } else if (scene.failure) {
            fail(picture.picture, *scene.failure);
        } else {
            render(scene, picture, is_last && &picture == &scene.pictures.back());
        }
    }
}

// Renders the picture, and has its files written. `is_last`: there is nothing to render meanwhile.
void Batch::render(const PreparedScene& scene, const PreparedPicture& picture, bool is_last) {
    try {
        std::optional<RenderedPicture> rendered;
        try {
            rendered = renderer_.render(scene, picture);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::out_of_memory || is_alone()) throw;
            be_alone();
            rendered = renderer_.render(scene, picture);
        }
        settle();
        if (picture.is_metered) {
            if (rendered->state == "done" || rendered->state == "time limit") outputs_for(*rendered);
            skip(picture.picture);
        } else {
            write(std::move(*rendered), is_last);
        }
    } catch (const Error& error) {
        print_failure(scene.file, error);
        fail(picture.picture, error);
    }
}

// Begins to write the files, of a whole picture, or of what there is of a single one.
void Batch::write(RenderedPicture&& rendered, bool is_last) {
    if (rendered.state == "interrupted") {
        was_interrupted_ = true;
        const bool is_kept = !plan_.is_batch() && !options_.list.skip_existing;
        if (!is_kept) {
            report(rendered.picture, rendered.state);
            return;
        }
    }
    if (rendered.state == "left out") {
        ++left_out_;
        report(rendered.picture, rendered.state);
        return;
    }
    const CpuWatch watch;
    const ImageOutputs outputs = outputs_for(rendered);
    rendered.overhead.develop = watch.seconds();
    rendered.exposure = outputs.development.exposure.ev;
    writing_ =
        std::async(is_last ? std::launch::deferred : std::launch::async | std::launch::deferred,
                   [this, rendered = std::move(rendered), outputs]() mutable {
                       return written(std::move(rendered), outputs, options_.outputs.report.has_value());
                   });
}

// How and where the picture is written. Finds its exposure if that is automatic, and says it.
ImageOutputs Batch::outputs_for(const RenderedPicture& rendered) {
    ImageOutputs outputs = options_.outputs.images.renamed(rendered.picture.files);
    Exposure& exposure = outputs.development.exposure;
    if (first_exposure_) exposure = {.ev = *first_exposure_};
    if (!exposure.automatic) return outputs;
    const bool is_for_all = exposure.of_first;
    outputs = outputs.exposed_for(rendered.image);
    if (is_for_all) first_exposure_ = exposure.ev;
    if (!options_.messages.quiet && options_.messages.progress != ProgressStyle::json) {
        print_note((plan_.is_batch() ? outputs.files.front() + ": " : "") +
                   "exposure: " + fixed(exposure.ev, 2) + " EV");
    }
    return outputs;
}

// Waits until the last picture is written, and counts it.
void Batch::settle() {
    if (!writing_.valid()) return;
    RenderedPicture rendered = writing_.get();
    Attempts& attempts = rendered.attempts;
    attempts.attempt([&] {
        const std::optional<Error> failure = rendered.failure ? rendered.failure : attempts.failure();
        report_.add(rendered, failure);
    });
    attempts.attempt([&] {
        if (rendered.failure) throw Error(*rendered.failure);
    });
    if (!plan_.is_batch()) attempts.finish();
    if (attempts.failure()) {
        print_failure(rendered.picture.scene, *attempts.failure());
        count_failure(*attempts.failure());
        return;
    }
    ++done_;
    rendered.progress->end(rendered.state);
}

void Batch::skip(const Picture& picture) {
    settle();
    ++skipped_;
    report(picture, "skipped");
}

// Leaves out all pictures of a scene, for which there is no time, except those that are there.
void Batch::leave_out(const PlannedScene& scene) {
    for (const Picture& picture : scene.pictures)
        leave_out(picture);
    if (scene.pictures.empty()) leave_out(Picture{.scene = scene.file});  // Their number is unknown.
}

void Batch::leave_out(const Picture& picture) {
    if (options_.list.skip_existing && is_there(picture)) {
        skip(picture);
        return;
    }
    settle();
    ++left_out_;
    report(picture, "left out");
}

// Reports a picture that has no files now. A batch goes on if that fails.
void Batch::report(const Picture& picture, const std::string& state, const std::optional<Error>& failure) {
    try {
        report_.add(picture, state, failure);
    } catch (const Error& error) {
        if (!plan_.is_batch()) throw;
        print_error(error.what());
        code_ = ExitCode::failed;
    }
}

// Prints the Error of a scene or a picture among several; that of a single one is thrown.
void Batch::print_failure(const std::string& scene, const Error& error) const {
    if (plan_.is_batch()) print_error(about(scene, error.what()));
}

// Reports and counts a picture that has not been rendered; throws its Error if it is the only one.
void Batch::fail(const Picture& picture, const Error& error) {
    settle();
    report(picture, "failed", error);
    if (!plan_.is_batch()) throw Error(error);
    count_failure(error);
    if (options_.outputs.images.development.exposure.of_first && !first_exposure_) {
        print_error(
            "--exposure first: the first picture failed, and no other is developed without its exposure; "
            "mend it, or give auto or a number");
    }
}

void Batch::count_failure(const Error& error) {
    ++failed_;
    const ExitCode code = exit_code(error.kind());
    code_ = code_.value_or(code) == code ? code : ExitCode::failed;
}

void Batch::print_summary() const {
    if (options_.messages.quiet || options_.messages.progress == ProgressStyle::json) return;
    print_note(std::to_string(done_) + " done, " + std::to_string(skipped_) + " skipped, " +
               std::to_string(failed_) + " failed" +
               (left_out_ > 0
                    ? ", " + std::to_string(left_out_) + " left out: the time (--batch-time) is over"
                    : "") +
               (was_interrupted_ ? "; interrupted before the others" : ""));
}

}  // namespace candela
