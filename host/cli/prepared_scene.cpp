// See prepared_scene.h.
#include "cli/prepared_scene.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <memory>
#include <utility>

#include "base/caught_error.h"
#include "base/cpu_time.h"
#include "base/memory_limit.h"
#include "cli/console.h"
#include "cli/loading.h"
#include "cli/outputs.h"
#include "render/make_identity.h"
#include "scene/catchers.h"
#include "scene/label_scene.h"
#include "session/convergence.h"

namespace candela {
namespace {

// Has catchers seen as such: the picture then stands before something other than the sky.
void show_catchers(RenderJob& job) {
    job.aovs.catchers = true;
    job.settings.aovs = job.settings.catchers = true;
    if (job.settings.backdrop == Backdrop::environment) job.settings.backdrop = Backdrop::background;
}

class Preparation {
  public:
    Preparation(PicturePlan& plan, size_t i, const RenderOptions& options, std::optional<ProgressStyle> style,
                std::unique_ptr<KeptScene>& kept)
        : plan_(plan), number_(i), options_(options), style_(style), kept_(kept) {
        prepared_.file = plan.scenes()[i].file;
        for (const Picture& picture : plan.scenes()[i].pictures)
            prepared_.pictures.push_back({.picture = picture});
    }

    PreparedScene run() {
        const CpuWatch watch;
        try {
            for_each([this](PreparedPicture& picture) { check_files(picture); });
            const bool may_have_more = prepared_.pictures.empty();
            if (!may_have_more) choose_metered();
            if (may_have_more || has_work()) prepare();
        } catch (...) {
            prepared_.failure = caught_error();
            kept_.reset();
        }
        prepared_.cpu_seconds = watch.seconds();
        return std::move(prepared_);
    }

  private:
    bool has_work() const {
        return std::ranges::any_of(prepared_.pictures, [](const PreparedPicture& picture) {
            return (!picture.is_skipped || picture.is_metered) && !picture.failure;
        });
    }

    // Calls action(picture) for all that can still be rendered; an Error is the failure of that picture
    // alone.
    template <class Action>
    void for_each(const Action& action) {
        for (PreparedPicture& picture : prepared_.pictures) {
            if ((picture.is_skipped && !picture.is_metered) || picture.failure) continue;
            try {
                action(picture);
            } catch (...) {
                picture.failure = caught_error();
            }
        }
    }

    // Has the first picture of all rendered, though it is there, if there are others to develop alike.
    void choose_metered() {
        if (!options_.outputs.images.development.exposure.of_first || number_ > 0) return;
        PreparedPicture& first = prepared_.pictures.front();
        first.is_metered = first.is_skipped && (has_work() || !plan_.is_complete_from(1));
    }

    // Finds out whether the picture is there, and otherwise whether it can be written, if it has names.
    void check_files(PreparedPicture& prepared) const {
        const std::vector<std::string>& files = prepared.picture.files;
        if (files.empty()) return;
        prepared.is_skipped = options_.list.skip_existing && is_there(prepared.picture);
        if (prepared.is_skipped) return;
        plan_.make_folders(prepared.picture);
        check_outputs(options_.outputs.images.renamed(files));
    }

    // Prints the warnings of the only picture; keeps those of one among several, to be printed in its turn.
    void warn(const std::vector<std::string>& warnings) {
        if (plan_.is_batch()) {
            std::ranges::copy(warnings, std::back_inserter(prepared_.warnings));
        } else {
            print_warnings(warnings);
        }
    }

    void prepare() {
        load();
        for_each([this](PreparedPicture& picture) {
            picture.job = options_.job(prepared_.scene, picture.picture.camera);
            if (has_catchers(shown())) show_catchers(*picture.job);
            if (picture.job->aovs.needs_coverage()) picture.job->labels = labels();
            if (options_.frames.seed_per_frame) picture.job->settings.seed += *picture.picture.frame;
            if (const auto& reference = options_.outputs.reference)
                picture.reference = load_reference(*reference, picture.job->settings);
        });
        write_cameras();
        if (!has_work()) return;
        if (options_.frames.frames) {
            if (!std::exchange(kept_->was_checked, true)) check_pictures(kept_->scene.scene());
            build_frame();
        } else {
            check_pictures(prepared_.scene);
            build_scene();
        }
        prepared_.arrays_hash = hash_arrays(prepared_.records);
    }

    // The scene that the pictures show.
    const Scene& shown() const { return options_.frames.frames ? kept_->scene.scene() : prepared_.scene; }

    void build_scene() {
        Scene& scene = prepared_.scene;
        prepared_.records = style_ ? build_showing_progress(scene, *style_) : build_quietly(scene);
        warn(prepared_.records.warnings);
    }

    // Warns of what the pictures of the scene will miss.
    void check_pictures(const Scene& scene) {
        const Estimator estimator =
            options_.rendering.sampling.estimator.value_or(scene.integrator.estimator);
        warn(warnings_of_unseen_lights(scene, estimator));
        const auto first = std::ranges::find_if(
            prepared_.pictures, [](const PreparedPicture& picture) { return picture.job.has_value(); });
        warn(warnings_of_unseen_backs(scene, first->job->camera, first->job->settings.size));
    }

    void build_frame() {
        const LimitedMemory limited;
        prepared_.records = with_memory_for(
            "the tree and the records of what it shows", [this] { return prepared_.file; },
            [this] { return kept_->scene.build(); });
        find_motion();
        warn(kept_->scene.take_warnings());
    }

    // Looks up where everything was in the frame before, if a picture shows it.
    void find_motion() {
        const auto shows_motion = [](const PreparedPicture& picture) {
            return picture.job && picture.job->aovs.motion;
        };
        if (std::ranges::none_of(prepared_.pictures, shows_motion)) return;
        const double frame = *plan_.scenes()[number_].frame;
        const auto motion = std::make_shared<const SceneMotion>(with_memory_for(
            "the motion since the frame before", [this] { return prepared_.file; },
            [&] { return kept_->scene.motion_since((frame - 1.0) / options_.frames.fps); }));
        Scene before;
        before.cameras = kept_->cameras->empty() ? motion->cameras : *kept_->cameras;
        before.film = prepared_.scene.film;
        for_each([&](PreparedPicture& picture) {
            picture.job->motion = {options_.job(before, picture.picture.camera).camera, motion};
        });
    }

    void load() {
        using Clock = std::chrono::steady_clock;
        const Clock::time_point start = Clock::now();
        if (options_.frames.frames) {
            load_frame();
        } else {
            load_scene();
        }
        const std::vector<Picture> pictures = plan_.pictures_of(number_, prepared_.scene);
        prepared_.load_seconds = std::chrono::duration<double>(Clock::now() - start).count();
        name_pictures(pictures);
        choose_metered();
    }

    // Its cameras are those that the options ask for, if there are any, instead of its own.
    void load_scene() {
        const LoadingOptions& loading = options_.rendering.loading;
        const std::string& file = prepared_.file;
        Scene& scene = prepared_.scene;
        scene = style_ ? load_showing_progress(file, loading, *style_) : load_quietly(file, loading);
        warn(scene.warnings);
        std::vector<Camera> cameras = options_.cameras.cameras(scene, options_.rendering.picture.size);
        if (!cameras.empty()) scene.cameras = std::move(cameras);
    }

    // The labels of the scene, which its pictures and frames share.
    std::shared_ptr<const Labels> labels() {
        std::shared_ptr<const Labels>& labels = options_.frames.frames ? kept_->labels : labels_;
        if (labels) return labels;
        labels = std::make_shared<const Labels>(label_scene(shown()));
        if (!options_.outputs.images.written_aovs().cryptomatte) return labels;
        warn(warnings_of_collisions(labels->objects, "objects"));
        warn(warnings_of_collisions(labels->materials, "materials"));
        return labels;
    }

    // The same for a frame, of which there may be more.
    void load_frame() {
        const std::string& file = prepared_.file;
        const size_t number = plan_.scenes()[number_].number;
        if (!kept_ || kept_->number != number) {
            kept_.reset();
            if (style_) {
                show_progress(*style_, [&](const LoadProgress& progress) { keep_scene(number, progress); });
            } else {
                keep_scene(number, no_progress);
            }
        }
        if (!plan_.scenes()[number_].frame)
            plan_.set_frames(number_, options_.frames.between(file, kept_->scene.times()));
        const LimitedMemory limited;
        with_memory_for(
            "the frame", [&] { return file; },
            [&] { kept_->scene.pose(*plan_.scenes()[number_].frame / options_.frames.fps); });
        warn(kept_->scene.take_warnings());
        const Scene& scene = kept_->scene.scene();
        if (!kept_->cameras)
            kept_->cameras = options_.cameras.cameras(scene, options_.rendering.picture.size);
        prepared_.scene.cameras = kept_->cameras->empty() ? scene.cameras : *kept_->cameras;
        prepared_.scene.film = scene.film;
        prepared_.scene.integrator = scene.integrator;
        prepared_.scene.files = scene.files;
        prepared_.scene.attributes = scene.attributes;
    }

    void keep_scene(size_t number, const LoadProgress& progress) {
        const LoadOptions options = load_options(options_.rendering.loading, progress);
        const LimitedMemory limited;
        kept_ = with_memory_for(
            "the scene", [this] { return prepared_.file; },
            [&] {
                return std::make_unique<KeptScene>(KeptScene{number, AnimatedScene(prepared_.file, options)});
            });
    }

    // Writes the cameras of all pictures of the scene, if the options ask for it.
    void write_cameras() const {
        const std::optional<std::string> file = plan_.make_cameras_file(number_);
        if (!file) return;
        std::vector<PictureCamera> cameras;
        for (const PreparedPicture& prepared : prepared_.pictures) {
            const RenderJob job = options_.job(prepared_.scene, prepared.picture.camera);
            cameras.push_back({job.camera, job.settings.size, prepared.picture.files.front()});
        }
        candela::write_cameras(*file, std::move(cameras));
    }

    // Takes over what the plan says of the pictures now that the scene is known.
    void name_pictures(const std::vector<Picture>& pictures) {
        prepared_.pictures.resize(pictures.size());
        for_each([&](PreparedPicture& prepared) {
            const bool was_named = !prepared.picture.files.empty();
            prepared.picture = pictures[size_t(&prepared - prepared_.pictures.data())];
            if (!was_named) check_files(prepared);
        });
    }

    PicturePlan& plan_;
    size_t number_;
    const RenderOptions& options_;
    std::optional<ProgressStyle> style_;
    std::shared_ptr<const Labels> labels_;
    std::unique_ptr<KeptScene>& kept_;
    PreparedScene prepared_;
};

}  // namespace

PreparedScene prepare_scene(PicturePlan& plan, size_t i, const RenderOptions& options,
                            std::optional<ProgressStyle> style, std::unique_ptr<KeptScene>& kept) {
    return Preparation(plan, i, options, style, kept).run();
}

}  // namespace candela
