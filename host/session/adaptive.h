// Adaptive sampling: more samples where the error is, without bias.
//
// A rendering consists of two halves with different seeds, and its image is the unweighted mean of theirs. A
// half has two states: in one, every pixel has the same number of samples; in the other, it has as many extra
// samples as its limit says. The limits of a half follow from the even samples of the other half, whose
// number depends on no sample. So no sample influences how many others it is averaged with, and both means
// are unbiased. Otherwise, a pixel that missed a light at first would stop early and stay dark. Ref: Kirk and
// Arvo, "Unbiased sampling techniques for image synthesis" (1991).
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "film/accumulation.h"
#include "session/steady_renderer.h"

namespace candela {

// The four states, with values but without samples. make_image() turns them into the image.
std::vector<Accumulation> adaptive_states(const RenderSettings& settings);

// The end of the pass after `spp`, at most `target`, all in samples per pixel on average. It does not depend
// on time, so that a rendering always ends with the same samples.
uint32_t next_pass_end(uint32_t spp, uint32_t target);

// The number of even samples, which all pixels have, among the `half` samples that a pixel of a half has on
// average.
uint32_t even_samples(uint32_t half);

// Sets the limits of a half's extra samples, so that a pixel has `half` samples on average, `even` of which
// all pixels have. The others go where the relative error is large and samples are cheap, in proportion to
// the square root of variance over rays, estimated from the other half's even samples. This minimises
// relative_mse() of the image for the time that it takes. All pixels of a work group get the same number. A
// limit never decreases.
void plan_extra_samples(const Accumulation& other_even, uint32_t even, uint32_t half, Accumulation& extra);

// Renders to the end of a pass, at `spp` samples per pixel on average, an even number. `planned`: the end of
// the pass whose limits the states have; 0 at first. Otherwise as SteadyRenderer::render().
bool render_pass(SteadyRenderer& renderer, uint32_t spp, uint32_t& planned,
                 const std::function<bool(double progress)>& keep_going);

}  // namespace candela
