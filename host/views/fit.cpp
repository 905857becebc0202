// See fit.h.
//
// A camera that is at (a, b, c) to the right, up and forwards sees the point (x, y, z) between the planes of
// tangent t if |x - a| <= t (z - c). With the reach R(t) of all points along (1, -t) and L(t) along (-1, -t),
// this means R(t) + t c <= a and L(t) + t c <= -a. Such an a exists if R(t) + L(t) + 2 t c <= 0; where that
// is 0, points touch both planes.
#include "views/fit.h"

#include <algorithm>
#include <cmath>

namespace candela {
namespace {

// What bodies need along one axis of the picture.
class Span {
  public:
    Span(std::span<const Body> bodies, dvec3 axis, dvec3 forward)
        : bodies_(bodies), axis_(axis), forward_(forward) {}

    // The farthest forwards that a camera may be for that tangent.
    double closest(double tangent) const {
        return -(towards(1.0, tangent).value + towards(-1.0, tangent).value) / (2.0 * tangent);
    }

    // Where along the axis it must be for both sides to have the same angle, if it is at `depth` forwards.
    // By Newton's method, which comes to the root of a falling, convex function from below.
    double middle(double depth) const {
        constexpr int MAX_STEPS = 16;
        constexpr double TOLERANCE = 1e-12;
        double tangent = 0.0;
        for (int step = 0;; ++step) {
            const Reach right = towards(1.0, tangent), left = towards(-1.0, tangent);
            const double excess = right.value + left.value + 2.0 * tangent * depth;
            const double slope = right.slope + left.slope + 2.0 * depth;
            const double change = excess / -slope;
            if (step == MAX_STEPS || !(change > TOLERANCE * tangent)) return 0.5 * (right.value - left.value);
            tangent += change;
        }
    }

  private:
    Reach towards(double side, double tangent) const {
        return reach(bodies_, side * axis_ - tangent * forward_, -forward_);
    }

    std::span<const Body> bodies_;
    dvec3 axis_, forward_;
};

}  // namespace

dvec3 fitted_position(std::span<const Body> bodies, const CameraAxes& axes, glm::dvec2 tangents) {
    const Span across(bodies, axes.right, axes.forward), upwards(bodies, axes.up, axes.forward);
    const double depth = std::min(across.closest(tangents.x), upwards.closest(tangents.y));
    return across.middle(depth) * axes.right + upwards.middle(depth) * axes.up + depth * axes.forward;
}

}  // namespace candela
