// Adaptive sampling: samples go where the error is, and the image stays unbiased.
//
// A rendering is two halves with seeds of their own, and its image the plain mean of their images. A half is
// two states: in one, every pixel has the same number of samples; in the other it has extra samples, as many
// as its limit says. The limits of a half follow from the even samples of the other half, which nothing
// steers. So no sample has a say in how many others it is averaged with, and both means are unbiased. Were it
// otherwise, a pixel that missed a light at first would stop early, and stay dark: see Kirk and Arvo,
// "Unbiased sampling techniques for image synthesis" (1991).
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "film/accumulation.h"
#include "render/steady_renderer.h"

namespace candela {

// The four states, with values, but no sample yet. make_image() makes the image of them.
std::vector<Accumulation> adaptive_states(const RenderSettings& settings);

// The end of the next pass, in samples that a pixel has on average, if there are `spp`; at most `target`. It
// depends on nothing else, and never on time: one rendering always ends with the same samples.
uint32_t next_pass_end(uint32_t spp, uint32_t target);

// Of `half` samples that a pixel of a half has on average, those that all pixels have.
uint32_t even_samples(uint32_t half);

// Sets the limits of a half's extra samples, so that a pixel has `half` samples on average, `even` of which
// all pixels have. The others go where the relative error is large and samples are cheap, in proportion to
// the root of variance over rays, as the other half's even samples tell: that makes relative_mse() of the
// image least for the time that it takes. All pixels of a work group get the same. A limit never falls.
void plan_extra_samples(const Accumulation& other_even, uint32_t even, uint32_t half, Accumulation& extra);

// Renders to the end of a pass at `spp` samples on average, an even number. `planned` is the pass whose
// limits the states have, 0 at first. As SteadyRenderer::render() otherwise.
bool render_pass(SteadyRenderer& renderer, uint32_t spp, uint32_t& planned,
                 const std::function<bool(double progress)>& keep_going);

}  // namespace candela
