// One overload of add() per kind of light.
#include "gpu_scene/punctual_lights.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/color.h"
#include "base/error.h"
#include "base/text.h"
#include "gpu_scene/beam.h"
#include "scene/geometry.h"

namespace candela {
namespace {

// Of a point light from the middle of the scene, in units of the frame: squares of distances remain finite.
constexpr double FARTHEST = 1e18;

// Floats do not tell the directions of a smaller disk apart [rad, across]: it counts as a single direction.
constexpr float SMALLEST_DISK = 1e-4f;

// The integral of the cosine to its middle over the disk of a sun [sr]: pi times the squared sine of half the
// angle across.
double projected_solid_angle(const LightRecord& sun) {
    const double h = double(sun.e2.x);
    return M_PI * h * (2.0 - h);
}

class PunctualLights {
  public:
    PunctualLights(const SceneFrame& frame, const Box& box)
        : frame_(frame), radius_(box.is_empty() ? 0.0 : 0.5 * length(glm::dvec3(box.extent()))) {}

    void add(const std::string& name, const PointLight& light) {
        LightRecord record = make_record(name, LIGHT_POINT, light.position, light.intensity);
        append(record, 4.0);
    }

    void add(const std::string& name, const SpotLight& light) {
        LightRecord record = make_record(name, LIGHT_SPOT, light.position, light.intensity);
        record.e1 = vec3(unit_direction(light.direction));
        record.e2 = cone_parameters(light.cone);
        append(record, 4.0 * mean_in_cone(light.cone));
    }

    void add(const std::string& name, const DirectionalLight& light) {
        LightRecord record{};
        record.kind = LIGHT_DIRECTIONAL;
        record.e1 = vec3(-unit_direction(light.direction));
        record.radiance = light.irradiance;
        if (light.angle < SMALLEST_DISK) return append(record, radius_ * radius_);
        record.kind = LIGHT_SUN;
        record.e2.x = float(one_minus_cos(0.5 * double(light.angle)));
        const dvec3 radiance = dvec3(light.irradiance) / projected_solid_angle(record);
        if (std::max({radiance.x, radiance.y, radiance.z}) > double(FLOAT_MAX)) {
            throw Error(
                concat("the light \"", name,
                       "\" is too bright for 32-bit floats; give it a lower irradiance or a wider angle"));
        }
        record.radiance = vec3(radiance);
        append(record, radius_ * radius_ * projected_solid_angle(record));
    }

    PoweredLights take() { return std::move(lights_); }

  private:
    // Of a light at a point. An intensity is a power, which lengths of the frame measure in units of their
    // own, too.
    LightRecord make_record(const std::string& name, uint kind, dvec3 position, vec3 intensity) const {
        const auto fail = [&](const char* what) {
            throw Error(concat("the light \"", name, "\" is ", what));
        };
        const dvec3 from_middle = (position - frame_.origin) / frame_.unit;
        if (length(from_middle) > FARTHEST)
            fail("too far from the scene for 32-bit floats; use a directional light");
        const dvec3 scaled = dvec3(intensity) / (frame_.unit * frame_.unit);
        if (std::max({scaled.x, scaled.y, scaled.z}) > double(FLOAT_MAX))
            fail("too bright for 32-bit floats in a scene of this size; give it a lower intensity");
        LightRecord record{};
        record.kind = kind;
        record.p = frame_.point(position);
        record.radiance = vec3(scaled);
        return record;
    }

    // `factor` is its power over pi if its radiance, which is an intensity or irradiance, is 1.
    void append(const LightRecord& record, double factor) {
        const double power = factor * double(luminance(record.radiance));
        if (power == 0.0) return;
        lights_.records.push_back(record);
        lights_.powers.push_back(power);
    }

    const SceneFrame& frame_;
    double radius_;  // Of the sphere around the scene.
    PoweredLights lights_;
};

}  // namespace

double irradiance_across(const LightRecord& light) {
    const double radiance = double(luminance(light.radiance));
    return light.kind == LIGHT_SUN ? radiance * projected_solid_angle(light) : radiance;
}

PoweredLights build_punctual_lights(const Scene& scene, const SceneFrame& frame, const Box& box) {
    PunctualLights lights(frame, box);
    for (const Light& light : scene.lights)
        std::visit([&](const auto& model) { lights.add(light.name, model); }, light.model);
    return lights.take();
}

}  // namespace candela
