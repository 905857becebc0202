// Ref: Khronos, "glTF 2.0 Specification", sections 3.5, 3.7 and 3.10.
#include "load/gltf/scene_reader.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/limits.h"
#include "base/memory_limit.h"
#include "base/text.h"
#include "load/gltf/animation.h"
#include "load/gltf/image_light.h"
#include "load/gltf/instances.h"
#include "load/gltf/light.h"
#include "load/gltf/material.h"
#include "load/gltf/names.h"
#include "load/gltf/node_trees.h"
#include "load/gltf/primitive.h"
#include "load/gltf/skin.h"
#include "load/gltf/values.h"
#include "load/gltf/variants.h"
#include "scene/material_textures.h"
#include "scene/materials.h"

namespace candela::gltf {
namespace {

// Keeps only the attributes that a material looks up, and adds missing ones. `has_alpha`: whether the file's
// material uses alpha.
void fit_attributes(File& file, const Node& primitive, const Material& material, bool has_alpha,
                    TriangleMesh& mesh) {
    uint32_t sets = 0;
    for_each_texture(material, [&](const Texture& texture) { sets |= 1u << texture.uv_set; });
    if (needs_tangents(material)) {
        sets |= 1u << tangent_uv_set(material);
    } else {
        mesh.tangents.clear();
    }
    for (const auto& [set, uvs] : {std::pair(0u, &mesh.uv0), std::pair(1u, &mesh.uv1)}) {
        if ((sets >> set & 1u) == 0) {
            uvs->clear();
        } else if (uvs->empty()) {
            file.warn(primitive, concat("the material has textures, but the primitive has no TEXCOORD_", set,
                                        ": they show their upper left corner everywhere"));
            uvs->assign(mesh.positions.size(), vec2(0.0f, 1.0f));
        }
    }
    const Opacity& opacity = material.opacity;
    if (has_alpha || opacity.value != Textured<float>(1.0f) || opacity.cutoff) return;
    for (vec4& color : mesh.colors)
        color.w = 1.0f;
}

// The transform, with a little thickness added if it flattens bodies into plane figures, so that their front
// and back do not share a plane. Nothing if it leaves no area.
std::optional<glm::dmat4> thickened(const glm::dmat4& world) {
    constexpr double THIN = 1e-12;      // As in Transform.
    constexpr double THICKNESS = 1e-5;  // Relative to the longest edge of a cube's image.
    const glm::dmat3 m(world);
    const double longest = std::max({length(m[0]), length(m[1]), length(m[2])});
    // The cofactors of a matrix of rank 2 are the product of the figures' normal and the axis that vanishes.
    const glm::dmat3 cofactor(cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1]));
    const double size = length(dvec3(length(cofactor[0]), length(cofactor[1]), length(cofactor[2])));
    if (!(size > THIN * longest * longest) || !std::isfinite(size)) return std::nullopt;
    glm::dmat4 result = world;
    for (glm::length_t i = 0; i < 3; ++i)
        result[i] += glm::dvec4(THICKNESS * longest / size * cofactor[i], 0.0);
    return result;
}

// Nothing for a transform under which a mesh shows no surface.
std::optional<Transform> transform_of(const glm::dmat4& world) {
    Transform transform;
    if (transform.append(world)) return transform;
    const std::optional<glm::dmat4> thick = thickened(world);
    transform = Transform();
    if (thick && transform.append(*thick)) return transform;
    return std::nullopt;
}

}  // namespace

SceneReader::SceneReader(File& file, Scene& scene, const GltfOptions& options, const LoadProgress& progress)
    : file_(file),
      scene_(scene),
      options_(options),
      progress_(progress),
      builder_(scene),
      units_(units_of(file, options)) {
    for (uint32_t i = 0; i < scene.materials.size(); ++i)
        known_materials_.try_emplace(scene.materials[i].name, i);
    for (const Camera& camera : scene.cameras)
        camera_names_.note(camera.name);
    if (options.variant) variant_ = find_variant(file, *options.variant);
}

void SceneReader::read() {
    nodes_ = read_nodes(file_);
    if (options_.time) animate(file_, options_.animation, *options_.time, nodes_);

    const std::optional<Node> scene = chosen_scene();
    if (scene) {
        auto light = with_memory_for(
            "the image-based light", [&] { return scene->place(); },
            [&] { return read_image_light(file_, *scene); });
        if (light) scene_.environment = std::move(light);
    }
    NodeTrees trees(file_, root_nodes(scene), scene.has_value(), nodes_);
    trees.place();
    primitives_ = count_primitives(trees.shown());
    for (const uint32_t i : trees.shown()) {
        with_memory_for(
            "what the node shows", [&] { return file_.element("nodes", i).place(); }, [&] { read_node(i); });
    }
}

std::optional<Node> SceneReader::chosen_scene() const {
    const auto scenes = file_.root().find("scenes");
    if (options_.scene) {
        const size_t index = find_by_name(file_, scenes, *options_.scene, "scenes", "--scene");
        return (*scenes)[index];
    }
    if (const auto chosen = file_.root().find("scene")) return file_.resolve("scenes", *chosen);
    if (scenes && scenes->size() > 0) return (*scenes)[0];
    return std::nullopt;
}

std::vector<uint32_t> SceneReader::root_nodes(const std::optional<Node>& scene) const {
    std::vector<uint32_t> roots;
    if (scene) {
        const auto nodes = scene->find("nodes");
        if (!nodes) return roots;
        for (const Node& reference : nodes->elements())
            roots.push_back(file_.index("nodes", reference));
        return roots;
    }
    std::vector<bool> is_child(nodes_.size(), false);
    for (const PosedNode& node : nodes_) {
        for (const uint32_t child : node.children)
            is_child[child] = true;
    }
    for (uint32_t i = 0; i < nodes_.size(); ++i) {
        if (!is_child[i]) roots.push_back(i);
    }
    return roots;
}

size_t SceneReader::count_primitives(const std::vector<uint32_t>& nodes) const {
    size_t primitives = 0;
    for (const uint32_t i : nodes) {
        const auto mesh = file_.element("nodes", i).find("mesh");
        if (!mesh || !nodes_[i].is_visible) continue;
        const auto all = file_.resolve("meshes", *mesh).find("primitives");
        primitives += all ? all->size() : 0;
    }
    return primitives;
}

void SceneReader::read_node(uint32_t index) {
    const Node node = file_.element("nodes", index);
    const PosedNode& posed = nodes_[index];
    if (const auto camera = node.find("camera")) read_camera(node, file_.resolve("cameras", *camera), posed);
    if (!posed.is_visible) return;  // Its camera is used even so.
    if (const auto mesh = node.find("mesh")) {
        builder_.begin_object(name_of(node, name_of(file_.resolve("meshes", *mesh), concat("node ", index))));
        read_mesh(node, posed);
    }
    if (const auto light = extension_of(node, "KHR_lights_punctual")) {
        if (const auto reference = light->find("light"))
            scene_.lights.push_back(read_light(file_, *reference, posed.world, units_));
    }
}

void SceneReader::read_mesh(const Node& node, const PosedNode& posed) {
    const Node reference = node.require("mesh");
    const uint32_t index = file_.index("meshes", reference);
    const Node mesh = file_.element("meshes", index);
    const auto found = mesh.find("primitives");
    if (!found) {
        file_.warn(mesh, "left out a mesh without primitives");
        return;
    }
    const Node& primitives = *found;

    std::vector<double> weights = posed.weights;
    if (const auto own = mesh.find("weights"); own && weights.empty()) weights = own->numbers(own->size());
    if (const auto skin = node.find("skin")) {
        if (const auto instances = extension_of(node, "EXT_mesh_gpu_instancing"))
            file_.warn(*instances, "the mesh has a skin, and is shown once");
        const auto [known, is_new] = joints_.try_emplace(file_.index("skins", *skin));
        if (is_new) known->second = joint_matrices(file_, file_.resolve("skins", *skin), nodes_);
        const std::vector<glm::dmat4>& joints = known->second;
        // The node's transform does not move a skinned mesh, but does determine which side is the front
        // (3.7.4).
        const bool mirrors = determinant(glm::dmat3(posed.world)) < 0.0;
        for (const Node& primitive : primitives.elements()) {
            add_primitive(primitive, {weights, joints, mirrors}, Transform());
            progress_("meshes", ++done_, primitives_);
        }
        return;
    }
    for (const glm::dmat4& placement : read_instances(file_, node)) {
        if (const auto transform = transform_of(posed.world * placement)) {
            place_mesh(node, primitives, {index, weights}, *transform);
        } else {
            file_.warn(node, "left out a mesh that its transform shrinks to a line or a point");
        }
        builder_.begin_copy();
    }
    progress_("meshes", done_ += primitives.size(), primitives_);
}

void SceneReader::place_mesh(const Node& node, const Node& primitives, const StandingMesh& mesh,
                             const Transform& transform) {
    const auto [known, is_new] = shapes_.try_emplace(mesh);
    if (is_new) {
        for (const Node& primitive : primitives.elements()) {
            known->second.push_back(add_primitive(primitive, {.weights = mesh.second}, transform));
            if (known->second.size() < primitives.size())
                progress_("meshes", done_ + known->second.size(), primitives_);
        }
        return;
    }
    for (const std::optional<size_t>& shape : known->second) {
        if (shape) builder_.add_instance(node.place(), *shape, transform);
    }
}

std::optional<size_t> SceneReader::add_primitive(const Node& primitive, const Deformation& deformation,
                                                 const Transform& transform) {
    std::optional<TriangleMesh> mesh = read_primitive(file_, primitive, deformation);
    if (!mesh) return std::nullopt;
    const std::optional<uint32_t> of_file = material_of(primitive);
    const uint32_t material = material_for({of_file, !mesh->colors.empty()});
    const bool has_alpha = of_file && alpha_counts(file_.element("materials", *of_file));
    fit_attributes(file_, primitive, scene_.materials[material], has_alpha, *mesh);
    builder_.add_mesh(primitive.place(), {material, material_emission(scene_.materials[material])}, transform,
                      std::move(*mesh));
    return scene_.shapes.size() - 1;
}

std::optional<uint32_t> SceneReader::material_of(const Node& primitive) const {
    if (variant_) {
        if (const auto material = variant_material(file_, primitive, *variant_))
            return file_.index("materials", *material);
    }
    const auto material = primitive.find("material");
    if (!material) return std::nullopt;
    return file_.index("materials", *material);
}

uint32_t SceneReader::material_for(MaterialUse use) {
    const auto [known, is_new] = materials_.try_emplace(use);
    if (!is_new) return known->second;
    const auto& [material, has_colors] = use;
    if (!has_colors && material) return known->second = read_file_material(*material);
    Material copy = material ? scene_.materials[material_for({material, false})] : default_material();
    copy.vertex_colors = has_colors;
    return known->second = builder_.add_material(std::move(copy));
}

uint32_t SceneReader::read_file_material(uint32_t index) {
    const Node node = file_.element("materials", index);
    const std::string name = name_of(node, concat("material ", index));
    if (const auto known = known_materials_.find(name); known != known_materials_.end()) return known->second;
    Material material = read_material(file_, scene_, node);
    material.name = name;
    return builder_.add_material(std::move(material));
}

void SceneReader::read_camera(const Node& node, const Node& camera, const PosedNode& posed) {
    constexpr uint32_t LINES = 720;
    const Node type = camera.require("type");
    Camera result;
    double aspect = 0.0;  // 0: the file states none.
    if (type.string() == "orthographic") {
        const Node sizes = camera.require("orthographic");
        const auto half = [&](const char* key) {
            const Node value = sizes.require(key);
            if (value.number() < 0.0) file_.warn(value, "the sign of the view's size is ignored");
            const double size = std::abs(value.number());
            if (size < double(FLOAT_MIN) || size > double(MAX_COORDINATE))
                value.fail_expected("a number from 1.2e-38 to 1e37, half the size of the view");
            return size;
        };
        const double half_width = half("xmag"), half_height = half("ymag");
        result.ortho_height = 2.0 * half_height;
        aspect = half_width / half_height;
    } else if (type.string() == "perspective") {
        const Node view = camera.require("perspective");
        const Node angle = view.require("yfov");
        result.vertical_fov = float(angle.number());
        if (!(result.vertical_fov > 0.0f && result.vertical_fov < PI))
            angle.fail_expected("an angle between 0 and pi");
        if (const auto ratio = view.find("aspectRatio")) {
            aspect = std::max(ratio->number(), 0.0);
            if (aspect == 0.0) file_.warn(*ratio, "an aspect ratio that is not above 0 is ignored");
        }
    } else {
        type.fail_expected(R"("perspective" or "orthographic")");
    }
    if (aspect > 0.0) {
        result.film_size =
            uvec2(uint32_t(std::clamp(std::round(aspect * LINES), 1.0, double(MAX_PICTURE_SIZE))), LINES);
    }
    const dvec3 backwards(posed.world[2]);
    const dvec3 up(posed.world[1]);
    if (!has_direction(cross(backwards, up)) || !has_direction(backwards) || !has_direction(up)) {
        file_.warn(node, "left out a camera that its transform flattens");
        return;
    }
    result.name =
        camera_names_.choose(name_of(node, name_of(camera, concat("camera ", scene_.cameras.size()))));
    result.position = position_of(node, posed.world);
    result.look_at = result.position - normalize(backwards);
    result.up = vec3(normalize(up));
    scene_.cameras.push_back(result);
}

}  // namespace candela::gltf
