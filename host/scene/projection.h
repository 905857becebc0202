// Where a camera shows a point, in double precision.
#pragma once

#include <optional>

#include "scene/camera_axes.h"
#include "scene/scene.h"

namespace candela {

// The sharp picture of a camera: that of its lens closed to a pinhole. Places are in pixels from the top left
// corner of the whole picture, y downwards, so that pixel (x, y) has its centre at (x + 0.5, y + 0.5).
class Projection {
  public:
    // `size`: of the whole picture [pixels].
    Projection(const Camera& camera, uvec2 size);

    // Where the picture shows a point of the world, also beyond its edges; none for a point that it cannot
    // show, which is behind the plane of a camera with a perspective, or where the camera is.
    std::optional<glm::dvec2> place_of(dvec3 point) const;
    // The same for something infinitely far away in a direction of any length; none for parallel rays, which
    // see one direction alone, and that everywhere.
    std::optional<glm::dvec2> place_of_direction(dvec3 direction) const;
    // The direction in which the camera sees a place, of any length; none if it does not see anything there.
    std::optional<dvec3> direction_at(glm::dvec2 place) const;
    // The way between two places: the shorter one, where the picture goes on beyond an edge at the other.
    glm::dvec2 way(glm::dvec2 from, glm::dvec2 to) const;

    // Whether it is that of parallel rays.
    bool is_parallel() const { return camera_.ortho_height.has_value(); }

  private:
    bool is(Mapping mapping) const { return camera_.panorama && camera_.panorama->mapping == mapping; }
    glm::dvec2 place_of_halves(glm::dvec2 halves) const;

    Camera camera_;
    CameraAxes axes_;
    glm::dvec2 size_;
    glm::dvec2 principal_point_;  // As Parameters::principal_point.
    glm::dvec2 half_;             // Half the view: at distance 1, or for parallel rays [m]; or of the circle.
};

}  // namespace candela
