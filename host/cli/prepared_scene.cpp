// See prepared_scene.h.
#include "cli/prepared_scene.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <memory>

#include "base/cpu_time.h"
#include "cli/caught_error.h"
#include "cli/console.h"
#include "cli/loading.h"
#include "cli/outputs.h"
#include "render/make_identity.h"
#include "scene/label_scene.h"
#include "session/convergence.h"

namespace candela {
namespace {

class Preparation {
  public:
    Preparation(PicturePlan& plan, size_t i, const RenderOptions& options, std::optional<ProgressStyle> style)
        : plan_(plan), number_(i), options_(options), style_(style) {
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
            if (picture.job->aovs.needs_coverage()) picture.job->labels = labels();
            if (const auto& reference = options_.outputs.reference)
                picture.reference = load_reference(*reference, picture.job->settings);
        });
        write_cameras();
        if (!has_work()) return;
        Scene& scene = prepared_.scene;
        const Estimator estimator =
            options_.rendering.sampling.estimator.value_or(scene.integrator.estimator);
        warn(warnings_of_unseen_lights(scene, estimator));
        const auto first = std::ranges::find_if(
            prepared_.pictures, [](const PreparedPicture& picture) { return picture.job.has_value(); });
        warn(warnings_of_unseen_backs(scene, first->job->camera, first->job->settings.size));
        prepared_.records = style_ ? build_showing_progress(scene, *style_) : build_quietly(scene);
        warn(prepared_.records.warnings);
        prepared_.arrays_hash = hash_arrays(prepared_.records);
    }

    void load() {
        using Clock = std::chrono::steady_clock;
        const Clock::time_point start = Clock::now();
        const LoadingOptions& loading = options_.rendering.loading;
        const std::string& file = prepared_.file;
        prepared_.scene =
            style_ ? load_showing_progress(file, loading, *style_) : load_quietly(file, loading);
        warn(prepared_.scene.warnings);
        take_cameras();
        const std::vector<Picture> pictures = plan_.pictures_of(number_, prepared_.scene);
        prepared_.load_seconds = std::chrono::duration<double>(Clock::now() - start).count();
        name_pictures(pictures);
        choose_metered();
    }

    // Gives the scene the cameras that the options ask for, if there are any, instead of its own.
    void take_cameras() {
        Scene& scene = prepared_.scene;
        std::vector<Camera> cameras = options_.cameras.cameras(scene, options_.rendering.picture.size);
        if (!cameras.empty()) scene.cameras = std::move(cameras);
    }

    // The labels of the scene, which its pictures share.
    std::shared_ptr<const Labels> labels() {
        if (labels_) return labels_;
        labels_ = std::make_shared<const Labels>(label_scene(prepared_.scene));
        if (!options_.outputs.images.written_aovs().cryptomatte) return labels_;
        warn(warnings_of_collisions(labels_->objects, "objects"));
        warn(warnings_of_collisions(labels_->materials, "materials"));
        return labels_;
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
    PreparedScene prepared_;
};

}  // namespace

PreparedScene prepare_scene(PicturePlan& plan, size_t i, const RenderOptions& options,
                            std::optional<ProgressStyle> style) {
    return Preparation(plan, i, options, style).run();
}

}  // namespace candela
