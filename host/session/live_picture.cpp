// See live_picture.h.
#include "session/live_picture.h"

#include <string>
#include <utility>

#include "film/identity.h"
#include "render/make_identity.h"
#include "session/record.h"

namespace candela {
namespace {

// Whether a rendering that was made for one selection can make the images of the other. What pixels show
// first is looked up for all of a rendering, or never.
bool looks_up_the_same(const AovSelection& a, const AovSelection& b) {
    return a.needs_positions() == b.needs_positions() && a.distance == b.distance &&
           a.needs_coverage() == b.needs_coverage();
}

}  // namespace

void LivePicture::update() {
    const BufferSet changed = scene_.update();
    if (changed.any()) arrays_hash_ = hash_arrays(scene_.records());
    changed_ |= changed;
}

// Whether the samples so far are the first of the job's picture. A target error ends a picture at some number
// of samples, so that one with another target may need fewer.
bool LivePicture::continues(const RenderJob& job, const RenderRecord& record) const {
    return rendering_ && job.aovs == job_.aovs && job.settings.aovs == job_.settings.aovs &&
           job.settings.backdrop == job_.settings.backdrop && job.adaptive == job_.adaptive &&
           (!job.target_error || job.target_error == job_.target_error) &&
           rendering_->max_spp() <= job.target &&
           difference(rendering_->record().identity, record.identity).empty();
}

void LivePicture::prepare(RenderJob job) {
    update();
    RenderRecord record = make_record(scene_.scene(), scene_.records(), arrays_hash_, job);
    if (continues(job, record)) {
        rendering_->set_target(job);
        job_ = std::move(job);
        return;
    }
    const bool fits = !rendering_ || looks_up_the_same(job.aovs, job_.aovs);
    std::unique_ptr<Rendering> rendering = std::move(rendering_);  // If this fails, it is unusable.
    if (std::exchange(has_failed_, true)) device_->close();
    if (!fits) rendering.reset();
    job_ = job;
    if (rendering) {
        rendering->restart(std::move(job), std::move(record), changed_);
    } else {
        rendering = std::make_unique<Rendering>(
            Rendering::Source{.device = device_, .scene = &scene_.records(), .resumed = {}, .reference = {}},
            std::move(job), std::move(record));
    }
    rendering_ = std::move(rendering);
    changed_.reset();
    has_failed_ = false;
}

std::optional<Error> LivePicture::render(RenderJob job, RenderCallbacks callbacks) {
    prepare(std::move(job));
    return rendering_->run(std::move(callbacks));
}

}  // namespace candela
