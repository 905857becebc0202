// The names of settings in scene files, on the command line and in reports.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "scene/scene.h"

namespace candela {

// The words of a setting and their values.
template <class T, size_t N>
using Choices = std::array<std::pair<std::string_view, T>, N>;

// The word for `value`, which must be among the choices.
template <class T, size_t N>
std::string name_of(T value, const Choices<T, N>& choices) {
    return std::string(std::ranges::find(choices, value, &std::pair<std::string_view, T>::second)->first);
}

inline constexpr Choices<Estimator, 3> ESTIMATOR_NAMES{
    {{"bsdf", Estimator::bsdf}, {"light", Estimator::light}, {"mis", Estimator::mis}}};

inline constexpr Choices<SamplerKind, 3> SAMPLER_NAMES{{{"independent", SamplerKind::independent},
                                                        {"stratified", SamplerKind::stratified},
                                                        {"sobol", SamplerKind::sobol}}};

inline constexpr Choices<LightSampler, 4> LIGHT_SAMPLER_NAMES{{{"auto", LightSampler::automatic},
                                                               {"uniform", LightSampler::uniform},
                                                               {"power", LightSampler::power},
                                                               {"tree", LightSampler::tree}}};

inline constexpr Choices<Terminator, 2> TERMINATOR_NAMES{
    {{"smooth", Terminator::smooth}, {"flat", Terminator::flat}}};

inline constexpr Choices<FilterShape, 4> FILTER_SHAPE_NAMES{
    {{"box", FilterShape::box},
     {"tent", FilterShape::tent},
     {"gaussian", FilterShape::gaussian},
     {"blackman-harris", FilterShape::blackman_harris}}};

inline constexpr Choices<Mapping, 3> MAPPING_NAMES{{{"equirectangular", Mapping::equirectangular},
                                                    {"fisheye", Mapping::fisheye},
                                                    {"equisolid", Mapping::equisolid}}};

inline constexpr Choices<Catcher, 3> CATCHER_NAMES{{{"catch", Catcher::shadows},
                                                    {"catch-reflections", Catcher::reflections},
                                                    {"holdout", Catcher::holdout}}};

inline constexpr Choices<Fresnel, 2> FRESNEL_NAMES{
    {{"schlick", Fresnel::schlick}, {"exact", Fresnel::exact}}};

inline constexpr Choices<IfMissing, 2> IF_MISSING_NAMES{
    {{"white", IfMissing::white}, {"error", IfMissing::error}}};
inline constexpr Choices<Wrap, 3> WRAP_NAMES{
    {{"repeat", Wrap::repeat}, {"mirror", Wrap::mirror}, {"clamp", Wrap::clamp}}};

inline constexpr Choices<TextureFilter, 2> FILTER_NAMES{
    {{"bilinear", TextureFilter::bilinear}, {"nearest", TextureFilter::nearest}}};

inline constexpr Choices<SpotFalloff, 2> FALLOFF_NAMES{
    {{"square", SpotFalloff::square}, {"smoothstep", SpotFalloff::smoothstep}}};

inline constexpr Choices<TextureEncoding, 2> ENCODING_NAMES{
    {{"srgb", TextureEncoding::srgb}, {"linear", TextureEncoding::linear}}};

inline constexpr Choices<uint32_t, 4> CHANNEL_NAMES{{{"red", 0}, {"green", 1}, {"blue", 2}, {"alpha", 3}}};

}  // namespace candela
