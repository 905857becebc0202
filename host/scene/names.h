// The names of the settings that are chosen by name, in scene files, on the command line and in reports.
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "scene/scene.h"

namespace candela {

inline constexpr std::array<std::pair<std::string_view, Estimator>, 3> ESTIMATOR_NAMES{
    {{"bsdf", Estimator::bsdf}, {"light", Estimator::light}, {"mis", Estimator::mis}}};

inline constexpr std::array<std::pair<std::string_view, SamplerKind>, 3> SAMPLER_NAMES{
    {{"independent", SamplerKind::independent},
     {"stratified", SamplerKind::stratified},
     {"sobol", SamplerKind::sobol}}};

inline constexpr std::array<std::pair<std::string_view, Fresnel>, 2> FRESNEL_NAMES{
    {{"schlick", Fresnel::schlick}, {"exact", Fresnel::exact}}};

}  // namespace candela
