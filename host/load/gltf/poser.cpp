// See poser.h.
#include "load/gltf/poser.h"

#include <algorithm>
#include <variant>

#include "base/error.h"
#include "base/text.h"
#include "load/gltf/camera.h"
#include "load/gltf/far_points.h"
#include "load/gltf/fit_attributes.h"
#include "load/gltf/light.h"
#include "load/gltf/placement.h"
#include "load/gltf/skin.h"
#include "scene/geometry.h"
#include "scene/scene_builder.h"

namespace candela::gltf {
namespace {

void darken(Light& light) {
    if (auto* sun = std::get_if<DirectionalLight>(&light.model)) sun->irradiance = vec3(0.0f);
    if (auto* point = std::get_if<PointLight>(&light.model)) point->intensity = vec3(0.0f);
    if (auto* spot = std::get_if<SpotLight>(&light.model)) spot->intensity = vec3(0.0f);
}

}  // namespace

Poser::Poser(std::shared_ptr<Contents> contents, const GltfOptions& options,
             const std::vector<uint32_t>& roots, bool has_scene)
    : contents_(std::move(contents)),
      options_(options),
      file_(*contents_, no_progress),
      nodes_(read_nodes(file_)),
      trees_(file_, roots, has_scene, nodes_),
      file_nodes_(nodes_),
      animation_(file_, options.animation, nodes_),
      moves_(nodes_.size(), false),
      hides_(nodes_.size(), false),
      has_weights_(nodes_.size(), false) {
    if (animation_.channels().empty()) {
        throw Error(file_.path().string() +
                        (file_.count("animations") == 0 ? ": the file has no animations"
                                                        : ": the animation moves neither nodes nor weights") +
                        ", so that all frames would be the same; leave --frames out",
                    ErrorKind::request);
    }
    const std::vector<double> keys = times_of(animation_, 1);
    times_ = {keys.front(), keys.back()};
    find_changes();
}

void Poser::find_changes() {
    for (const Channel& channel : animation_.channels()) {
        auto& animated = channel.path == Path::weights   ? has_weights_
                         : channel.path == Path::visible ? hides_
                                                         : moves_;
        animated[channel.node] = true;
    }
    blinks_ = hides_;
    for (std::vector<bool>* const changes : {&moves_, &hides_}) {
        std::vector<bool> done(nodes_.size(), false);
        for (uint32_t i = 0; i < nodes_.size(); ++i) {
            std::vector<uint32_t> path;
            std::optional<uint32_t> at = i;
            for (; at && !done[*at]; at = nodes_[*at].parent)
                path.push_back(*at);
            bool above = at && (*changes)[*at];
            for (; !path.empty(); path.pop_back()) {
                above = above || (*changes)[path.back()];
                (*changes)[path.back()] = above;
                done[path.back()] = true;
            }
        }
    }
}

bool Poser::deforms(uint32_t node) const {
    if (has_weights_[node]) return true;
    const auto skin = file_.element("nodes", node).find("skin");
    if (!skin) return false;
    return std::ranges::any_of(file_.resolve("skins", *skin).require("joints").elements(),
                               [&](const Node& joint) { return moves_[file_.index("nodes", joint)]; });
}

void Poser::place(double time) {
    nodes_ = file_nodes_;
    animation_.pose(time, nodes_);
    trees_.place();
}

// The weights of the morph targets of a node, as it is posed.
std::vector<double> Poser::weights_of(uint32_t node) const {
    if (!nodes_[node].weights.empty()) return nodes_[node].weights;
    const Node mesh = file_.resolve("meshes", file_.element("nodes", node).require("mesh"));
    const auto own = mesh.find("weights");
    return own ? own->numbers(own->size()) : std::vector<double>();
}

std::map<uint32_t, WeightRanges> Poser::weights_at(const std::vector<double>& times) {
    std::map<uint32_t, WeightRanges> ranges;
    for (const double time : times) {
        place(time);
        for (const PosedShape& posed : shapes_) {
            if (!posed.primitive) continue;
            const std::vector<double> weights = weights_of(posed.node);
            WeightRanges& range = ranges[posed.node];
            for (size_t i = 0; i < weights.size(); ++i) {
                if (i == range.size()) range.emplace_back(weights[i], weights[i]);
                range[i] = {std::min(range[i].first, weights[i]), std::max(range[i].second, weights[i])};
            }
        }
    }
    return ranges;
}

std::vector<Cloud> Poser::clouds_of(const Scene& scene, const std::vector<double>& times) {
    std::vector<Cloud> clouds;
    std::map<uint32_t, WeightRanges> weights = weights_at(times);
    std::map<uint32_t, std::vector<dvec3>> known;  // Of meshes.
    for (const PosedShape& posed : shapes_) {
        if (posed.primitive) {
            add_clouds(file_, *posed.primitive, weights[posed.node], posed.skin, posed.node, clouds);
            continue;
        }
        const auto [points, is_new] = known.try_emplace(posed.mesh);
        if (is_new) {
            const TriangleMesh& mesh = scene.meshes[posed.mesh];
            FarPoints far;
            for (const vec3 p : mesh.positions)
                far.add(mesh.origin + dvec3(p));
            points->second = far.points();
        }
        Cloud cloud{posed.node, posed.node, points->second};
        for (dvec3& p : cloud.points)
            p = dvec3(posed.placement * glm::dvec4(p, 1.0));
        clouds.push_back(std::move(cloud));
    }
    return clouds;
}

// Points around what moves at all times.
std::vector<dvec3> Poser::find_ways(const Scene& scene) {
    // So many points are looked at, but at some times even if there are very many.
    constexpr size_t MOST_POINTS = size_t(1) << 20u, FEWEST_TIMES = 64, MOST_TIMES = 1024;
    const auto most = [&](size_t points) {
        return std::clamp(MOST_POINTS / (points + 1), FEWEST_TIMES, MOST_TIMES);
    };
    const std::vector<Cloud> clouds = clouds_of(scene, times_of(animation_, most(nodes_.size())));
    size_t points = nodes_.size();
    for (const Cloud& cloud : clouds)
        points += cloud.points.size();
    FarPoints far;
    for (const double time : times_of(animation_, most(points))) {
        place(time);
        for (const Cloud& cloud : clouds) {
            if (!nodes_[cloud.carrier].is_visible) continue;
            for (const dvec3 p : cloud.points)
                far.add(dvec3(nodes_[cloud.node].world * glm::dvec4(p, 1.0)));
        }
    }
    return far.points();
}

void Poser::complete(Scene& scene) {
    nothing_ = uint32_t(scene.meshes.size());
    scene.meshes.emplace_back();
    Motion motion;
    motion.moves.resize(scene.shapes.size(), false);
    for (PosedShape& posed : shapes_) {
        motion.moves[posed.shape] = true;
        posed.mesh = std::get<MeshInstance>(scene.shapes[posed.shape].geometry).mesh;
    }
    const ShapeBounds bounds_of(scene);
    for (size_t i = 0; i < scene.shapes.size(); ++i) {
        if (!motion.moves[i]) motion.still.extend(bounds_of(scene.shapes[i]));
    }
    motion.ways = find_ways(scene);
    scene.motion = std::move(motion);
}

const std::vector<glm::dmat4>& Poser::joints_of(const Node& skin) {
    const auto [known, is_new] = joints_.try_emplace(skin.place());
    if (is_new) known->second = joint_matrices(file_, skin, nodes_);
    return known->second;
}

// What deforms a mesh now. `weights`: of the shape's node; it must outlive the result.
Deformation Poser::deformation_of(const PosedShape& posed, const std::vector<double>& weights) {
    Deformation deformation{.weights = weights};
    if (posed.skin) {
        deformation.joints = joints_of(*posed.skin);
        deformation.mirrors = determinant(glm::dmat3(nodes_[posed.node].world)) < 0.0;
    }
    return deformation;
}

// The mesh of a shape as it is now; without triangles if it has no area.
TriangleMesh Poser::deformed(const Scene& scene, PosedShape& posed) {
    const Shape& shape = scene.shapes[posed.shape];
    const std::vector<double> weights = weights_of(posed.node);
    std::optional<TriangleMesh> mesh =
        read_primitive(file_, *posed.primitive, deformation_of(posed, weights));
    posed.copies.clear();
    if (!mesh) return {};
    const size_t own = mesh->positions.size();
    const std::vector<uvec3> triangles = mesh->triangles;
    fit_attributes(file_, *posed.primitive, scene.materials[shape.material], posed.has_alpha, *mesh);
    finish_mesh(scene, posed.primitive->place(), {shape.material, shape.emission}, *mesh);
    posed.copies.resize(mesh->positions.size() - own);
    for (size_t i = 0; i < triangles.size() && !posed.copies.empty(); ++i) {
        for (const int c : {0, 1, 2}) {
            const uint32_t vertex = mesh->triangles[i][c];
            if (vertex >= own) posed.copies[vertex - own] = triangles[i][c];
        }
    }
    return std::move(*mesh);
}

// The positions of the vertices of a mesh that deforms, if the nodes are placed at another time than when the
// mesh was made.
std::vector<dvec3> Poser::positions_of(const PosedShape& posed) {
    const std::vector<double> weights = weights_of(posed.node);
    std::vector<dvec3> positions = read_positions(file_, *posed.primitive, deformation_of(posed, weights));
    for (const uint32_t vertex : posed.copies)
        positions.push_back(positions[vertex]);
    return positions;
}

void Poser::pose_shape(Scene& scene, PosedShape& posed, SceneChange& change) {
    Shape& shape = scene.shapes[posed.shape];
    const Shape before = shape;
    const PosedNode& node = nodes_[posed.node];
    const std::optional<Transform> transform =
        posed.skin ? Transform() : transform_of(node.world * posed.placement);
    const bool is_shown = node.is_visible && transform;
    shape.geometry = MeshInstance{is_shown ? posed.mesh : nothing_, is_shown ? *transform : Transform()};
    note_shape(change, posed.shape, before, shape);
    if (!is_shown) return;
    if (posed.primitive) {
        TriangleMesh mesh = deformed(scene, posed);
        if (!is_same(mesh, scene.meshes[posed.mesh])) {
            scene.meshes[posed.mesh] = std::move(mesh);
            change.meshes.push_back(posed.mesh);
        }
    }
    if (!reaches_no_farther(scene.meshes[posed.mesh], *transform))
        throw Error(file_.element("nodes", posed.node).place() + ": " + TOO_FAR);
}

void Poser::pose_camera(PosedCamera& posed, Camera& camera) {
    if (!posed.before) posed.before = camera;
    const Node node = file_.element("nodes", posed.node);
    if (place_camera(node, nodes_[posed.node].world, camera)) return;
    camera = *posed.before;
    file_.warn(node,
               "at some times, the node's transform flattens its camera, which is then where it is "
               "without the animation");
}

SceneChange Poser::pose(Scene& scene, double time) {
    place(time);
    joints_.clear();
    SceneChange change;
    for (PosedShape& posed : shapes_)
        pose_shape(scene, posed, change);
    for (PosedCamera& posed : cameras_)
        pose_camera(posed, scene.cameras[posed.camera]);
    for (const PosedLight& posed : lights_) {
        Light& light = scene.lights[posed.light];
        light = read_light(file_, posed.reference, nodes_[posed.node].world, units_of(file_, options_));
        if (!nodes_[posed.node].is_visible) darken(light);
        change.lights = true;
    }
    return change;
}

PlacesBefore Poser::places_at(const Scene& scene, double time) {
    place(time);
    joints_.clear();
    PlacesBefore places{.cameras = scene.cameras, .shapes = {}};
    for (const PosedShape& posed : shapes_) {
        const uint32_t mesh = std::get<MeshInstance>(scene.shapes[posed.shape].geometry).mesh;
        if (scene.meshes[mesh].triangles.empty()) continue;
        PlaceBefore& before = places.shapes.emplace_back();
        before.shape = posed.shape;
        if (!posed.skin) {
            const glm::dmat4 world = nodes_[posed.node].world * posed.placement;
            const std::optional<Transform> transform = transform_of(world);
            before.transform = transform ? transform->matrix() : world;
        }
        if (posed.primitive) before.positions = positions_of(posed);
    }
    for (PosedCamera& posed : cameras_)
        pose_camera(posed, places.cameras[posed.camera]);
    return places;
}

std::vector<std::string> Poser::take_warnings() {
    std::vector<std::string> warnings(file_.warnings().begin() + std::ptrdiff_t(told_),
                                      file_.warnings().end());
    told_ = file_.warnings().size();
    return warnings;
}

}  // namespace candela::gltf
