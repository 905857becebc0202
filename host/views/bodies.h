// What a scene shows, as bodies that a camera can be fitted to.
#pragma once

#include <span>
#include <vector>

#include "scene/scene.h"

namespace candela {

// All points within `radius` of a circle about the vertical axis: a point if both radii are 0.
struct Body {
    dvec3 center{0};
    double ring = 0.0;    // Radius of the circle [m].
    double radius = 0.0;  // [m].
};

// How far bodies reach along a direction n: the greatest dot(n, p) of their points p; and its derivative if n
// changes by dn.
struct Reach {
    double value;
    double slope;
};
Reach reach(std::span<const Body> bodies, dvec3 n, dvec3 dn = dvec3(0));

// What the shapes of a scene cover: vertices of triangles, corners of quads, spheres, and polygons around
// disks, which exceed these by at most 0.01 % of their radius. Shapes that all rays pass are left out. Copied
// meshes that have very many vertices in all are replaced by the corners of their boxes. Of a frame of an
// animation, the shapes that move cover their ways in all frames. Coordinates are
// relative to `origin`, which is the centre of the box around all. If the scene shows nothing, or a single
// point, there is a sphere of radius 1.
struct ShownBodies {
    dvec3 origin{0};
    std::vector<Body> bodies{};
};
ShownBodies shown_bodies(const Scene& scene);

// What the bodies cover while they turn about the vertical axis through their origin.
std::vector<Body> turned_about_axis(std::span<const Body> bodies);

// The sphere around their origin that holds them.
Body ball_around(std::span<const Body> bodies);

}  // namespace candela
