// See medium.h.
#include "scene/medium.h"

namespace candela {

dvec3 single_scattering_albedo(dvec3 reflectance, float g) {
    const dvec3& r = reflectance;
    const dvec3 s = 4.09712 + 4.20863 * r - sqrt(9.59217 + 41.6808 * r + 17.7126 * r * r);
    return clamp((1.0 - s * s) / (1.0 - double(g) * s * s), dvec3(0.0), dvec3(1.0));
}

Medium scattering_medium(dvec3 albedo, dvec3 mean_free_path, float g) {
    const dvec3 extinction = 1.0 / mean_free_path;
    return {vec3(extinction * (1.0 - albedo)), vec3(extinction * albedo), g};
}

}  // namespace candela
