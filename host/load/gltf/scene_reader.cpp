// Ref: Khronos, "glTF 2.0 Specification", sections 3.5, 3.7 and 3.10.
#include "load/gltf/scene_reader.h"

#include <string>
#include <utility>

#include "base/memory_limit.h"
#include "base/text.h"
#include "load/gltf/animation.h"
#include "load/gltf/camera.h"
#include "load/gltf/fit_attributes.h"
#include "load/gltf/image_light.h"
#include "load/gltf/instances.h"
#include "load/gltf/light.h"
#include "load/gltf/material.h"
#include "load/gltf/names.h"
#include "load/gltf/node_trees.h"
#include "load/gltf/placement.h"
#include "load/gltf/primitive.h"
#include "load/gltf/skin.h"
#include "load/gltf/values.h"
#include "load/gltf/variants.h"
#include "scene/materials.h"

namespace candela::gltf {

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

std::shared_ptr<Poser> SceneReader::read() {
    nodes_ = read_nodes(file_);
    if (options_.time) {
        if (file_.count("animations") == 0)
            file_.warn(file_.path().string() + ": the file has no animations: --time has no effect");
        Animation(file_, options_.animation, nodes_).pose(*options_.time, nodes_);
    }

    const std::optional<Node> scene = chosen_scene();
    if (scene) {
        auto light = with_memory_for(
            "the image-based light", [&] { return scene->place(); },
            [&] { return read_image_light(file_, *scene); });
        if (light) scene_.environment = std::move(light);
    }
    const std::vector<uint32_t> roots = root_nodes(scene);
    if (options_.frames) {
        poser_ =
            std::make_shared<Poser>(file_.contents().shared_from_this(), options_, roots, scene.has_value());
        show_what_blinks();
    }
    NodeTrees trees(file_, roots, scene.has_value(), nodes_);
    trees.place();
    primitives_ = count_primitives(trees.shown());
    for (const uint32_t i : trees.shown()) {
        with_memory_for(
            "what the node shows", [&] { return file_.element("nodes", i).place(); }, [&] { read_node(i); });
    }
    if (poser_) poser_->complete(scene_);
    return poser_;
}

void SceneReader::show_what_blinks() {
    for (uint32_t i = 0; i < nodes_.size(); ++i)
        nodes_[i].is_visible |= poser_->blinks(i);
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
    if (const auto camera = node.find("camera")) read_camera(node, file_.resolve("cameras", *camera), index);
    if (!nodes_[index].is_visible) return;  // Its camera is used even so.
    if (const auto mesh = node.find("mesh")) {
        builder_.begin_object(name_of(node, name_of(file_.resolve("meshes", *mesh), concat("node ", index))));
        read_mesh(node, index);
    }
    read_light_of(node, index);
}

void SceneReader::read_light_of(const Node& node, uint32_t index) {
    const auto light = extension_of(node, "KHR_lights_punctual");
    const auto reference = light ? light->find("light") : std::nullopt;
    if (!reference) return;
    scene_.lights.push_back(read_light(file_, *reference, nodes_[index].world, units_));
    if (poser_ && poser_->changes(index))
        poser_->add(Poser::PosedLight{uint32_t(scene_.lights.size() - 1), index, *reference});
}

void SceneReader::read_mesh(const Node& node, uint32_t index) {
    const PosedNode& posed = nodes_[index];
    const uint32_t mesh_index = file_.index("meshes", node.require("mesh"));
    const Node mesh = file_.element("meshes", mesh_index);
    const auto found = mesh.find("primitives");
    if (!found) {
        file_.warn(mesh, "left out a mesh without primitives");
        return;
    }
    const Node& primitives = *found;

    std::vector<double> weights = posed.weights;
    if (const auto own = mesh.find("weights"); own && weights.empty()) weights = own->numbers(own->size());
    if (node.find("skin")) {
        read_skinned_mesh(node, index, primitives, weights);
        return;
    }
    const bool deforms = poser_ && poser_->deforms(index);
    const bool changes = deforms || (poser_ && poser_->changes(index));
    for (const glm::dmat4& placement : read_instances(file_, node)) {
        std::optional<Transform> transform = transform_of(posed.world * placement);
        if (!transform && changes) transform = Transform();  // Until it is posed.
        if (!transform) {
            file_.warn(node, "left out a mesh that its transform shrinks to a line or a point");
            continue;
        }
        const size_t first = scene_.shapes.size();
        if (!deforms) {
            place_mesh(node, primitives, {mesh_index, weights}, *transform);
            if (changes) note_changes(first, index, placement);
        } else {
            for (const Node& primitive : primitives.elements()) {
                if (const auto shape = add_primitive(primitive, {.weights = weights}, *transform))
                    note_deformation(*shape, index, placement, primitive, {});
            }
        }
        builder_.begin_copy();
    }
    progress_("meshes", done_ += primitives.size(), primitives_);
}

void SceneReader::read_skinned_mesh(const Node& node, uint32_t index, const Node& primitives,
                                    const std::vector<double>& weights) {
    if (const auto instances = extension_of(node, "EXT_mesh_gpu_instancing"))
        file_.warn(*instances, "the mesh has a skin, and is shown once");
    const Node reference = node.require("skin");
    const Node skin = file_.resolve("skins", reference);
    const auto [known, is_new] = joints_.try_emplace(file_.index("skins", reference));
    if (is_new) known->second = joint_matrices(file_, skin, nodes_);
    const std::vector<glm::dmat4>& joints = known->second;
    // The node's transform does not move a skinned mesh, but does determine which side is the front (3.7.4).
    const bool mirrors = determinant(glm::dmat3(nodes_[index].world)) < 0.0;
    for (const Node& primitive : primitives.elements()) {
        const auto shape = add_primitive(primitive, {weights, joints, mirrors}, Transform());
        if (shape && poser_ && (poser_->deforms(index) || poser_->changes(index)))
            note_deformation(*shape, index, glm::dmat4(1.0), primitive, skin);
        progress_("meshes", ++done_, primitives_);
    }
}

void SceneReader::note_changes(size_t first, uint32_t node, const glm::dmat4& placement) {
    for (size_t i = first; i < scene_.shapes.size(); ++i)
        poser_->add(Poser::PosedShape{.shape = uint32_t(i), .node = node, .placement = placement});
}

void SceneReader::note_deformation(size_t shape, uint32_t node, const glm::dmat4& placement,
                                   const Node& primitive, const std::optional<Node>& skin) {
    poser_->add(Poser::PosedShape{.shape = uint32_t(shape),
                                  .node = node,
                                  .placement = placement,
                                  .primitive = primitive,
                                  .skin = skin,
                                  .has_alpha = has_alpha(primitive)});
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
    const uint32_t material = material_for({material_of(primitive), !mesh->colors.empty()});
    fit_attributes(file_, primitive, scene_.materials[material], has_alpha(primitive), *mesh);
    builder_.add_mesh(primitive.place(), {material, material_emission(scene_.materials[material])}, transform,
                      std::move(*mesh));
    return scene_.shapes.size() - 1;
}

bool SceneReader::has_alpha(const Node& primitive) const {
    const std::optional<uint32_t> material = material_of(primitive);
    return material && alpha_counts(file_.element("materials", *material));
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

void SceneReader::read_camera(const Node& node, const Node& camera, uint32_t index) {
    Camera result = gltf::read_camera(file_, camera);
    if (!place_camera(node, nodes_[index].world, result)) {
        file_.warn(node, "left out a camera that its transform flattens");
        return;
    }
    result.name =
        camera_names_.choose(name_of(node, name_of(camera, concat("camera ", scene_.cameras.size()))));
    scene_.cameras.push_back(result);
    if (poser_ && poser_->changes(index)) poser_->add_camera(uint32_t(scene_.cameras.size() - 1), index);
}

}  // namespace candela::gltf
