// See scene_stages.h. Each stage is made by one function, if what it is made of is other than before; the
// stages that follow learn from `Work` whether it is.
#include "gpu_scene/scene_stages.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>
#include <variant>

#include "bvh/two_levels.h"
#include "gpu_scene/coplanar_lights.h"
#include "gpu_scene/light_sampler_rule.h"
#include "gpu_scene/punctual_lights.h"

namespace candela {
namespace {

// Whether the lights of two states have the same places among the pieces of meshes.
bool same_places(const Lamps& a, const Lamps& b) {
    return std::ranges::equal(a, b, [](const auto& one, const auto& other) {
        return one.first == other.first && one.second.area.of_pieces == other.second.area.of_pieces;
    });
}

// Whether the shape is a copy of one of these meshes.
bool shows_one_of(const Shape& shape, const std::vector<uint32_t>& meshes) {
    const auto* instance = std::get_if<MeshInstance>(&shape.geometry);
    return instance != nullptr && std::ranges::find(meshes, instance->mesh) != meshes.end();
}

// What decides whether a mesh needs another tree, if the mesh itself is as it was.
std::vector<std::pair<ShownMesh, bool>> kinds_of(const MeshTrees& trees) {
    std::vector<std::pair<ShownMesh, bool>> kinds;
    for (const auto& [mesh, tree] : trees)
        kinds.emplace_back(mesh, tree.passable);
    return kinds;
}

}  // namespace

SceneStages::SceneStages(const Scene& scene, const Options& options)
    : given_frame_(options.frame), rule_(options.rule) {
    const SceneChange everything;
    Work work{.scene = scene, .change = everything, .all = true};
    make(work, options.packed);
}

BufferSet SceneStages::update(const Scene& scene, const SceneChange& change) {
    changed_.reset();
    Work work{.scene = scene, .change = change};
    make(work, [](size_t) {});
    return changed_;
}

void SceneStages::put(uint32_t array, std::vector<uvec4>&& words) {
    Words made(std::move(words));
    if (gpu_.arrays[array] == made) return;
    gpu_.arrays[array] = std::move(made);
    changed_.set(SCENE_ARRAYS[array].buffer);
}

void SceneStages::make(Work& work, const std::function<void(size_t)>& packed) {
    make_frame(work);
    make_materials(work);
    make_nesting(work);
    make_surfaces(work);
    gpu_.bvh_seconds = 0.0;
    const auto timed = [&](const auto& function) {
        const auto start = std::chrono::steady_clock::now();
        function();
        gpu_.bvh_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    timed([&] { make_mesh_trees(work); });
    make_area_lights(work);
    if (work.texels)  // Lights have read the images.
        put(ARRAY_TEXELS, build_texels(work.scene.images, materials_.image_places, packed));
    timed([&] {
        make_tree(work);
        make_geometry(work);
    });
    make_lights(work);
    gpu_.warnings = nesting_.warnings;
    if (coplanar_lights_) gpu_.warnings.push_back(*coplanar_lights_);
    std::ranges::copy(warn_of_small_shapes(gpu_.frame, surfaces_, trees_), std::back_inserter(gpu_.warnings));
}

void SceneStages::make_frame(Work& work) {
    if (!work.all && (work.scene.motion || !work.change.of_geometry())) return;
    const SceneFrame frame = given_frame_ ? *given_frame_ : choose_frame(work.scene);
    work.frame = work.all || frame != gpu_.frame;
    gpu_.frame = frame;
}

void SceneStages::make_materials(Work& work) {
    const SceneChange& change = work.change;
    work.materials = work.all || work.frame || change.materials || change.images || !change.shapes.empty() ||
                     !change.meshes.empty();
    if (!work.materials) return;
    MaterialArrays made = build_material_arrays(work.scene, gpu_.frame);
    work.attributes = work.all || made.facts.attributes != materials_.facts.attributes;
    work.texels = work.all || change.images || made.image_places != materials_.image_places;
    materials_ = std::move(made);
    static_cast<MaterialFacts&>(gpu_) = materials_.facts;
    put(ARRAY_MATERIALS, std::move(materials_.materials));
    put(ARRAY_MEDIA, std::move(materials_.media));
    put(ARRAY_MATERIAL_TEXTURES, std::move(materials_.material_textures));
    put(ARRAY_TEXTURES, std::move(materials_.textures));
}

void SceneStages::make_nesting(const Work& work) {
    // Cameras, which may move with a motion, also decide.
    if (work.all || work.materials || work.change.of_geometry() || work.change.lights || work.scene.motion) {
        nesting_ = find_nesting(work.scene);
        gpu_.nested_media = nesting_.nested;
        gpu_.sealed_media = nesting_.sealed;
    }
    if (work.all || work.change.of_geometry()) coplanar_lights_ = warn_of_coplanar_lights(work.scene);
}

// Whether flatten() would make something else of the shapes that are not instances.
bool SceneStages::has_other_surfaces(const Work& work, const Instancing& instancing,
                                     const std::vector<bool>& passable) const {
    if (work.all || work.frame || work.attributes || work.normals) return true;
    if (instancing.is_instance != instancing_.is_instance) return true;
    const auto is_surface = [&](uint32_t i) { return !instancing.is_instance[i]; };
    if (std::ranges::any_of(work.change.moved, is_surface) ||
        std::ranges::any_of(work.change.shapes, is_surface))
        return true;
    for (uint32_t i = 0; i < passable.size(); ++i) {
        if (is_surface(i) &&
            (passable[i] != passable_[i] || shows_one_of(work.scene.shapes[i], work.change.meshes)))
            return true;
    }
    return false;
}

void SceneStages::make_surfaces(Work& work) {
    // Emissions decide which instances emit alike.
    if (!work.materials && !work.change.of_geometry() && !work.change.radiance) return;
    const Scene& scene = work.scene;
    Instancing instancing = choose_instances(scene, rule_);
    check_emitters(scene, instancing);
    work.instances = instancing.shapes != instancing_.shapes || instancing.shown != instancing_.shown;
    const bool has_normals = has_shading_normals(scene);
    work.normals = has_normals != has_normals_;
    std::vector<bool> passable;
    for (const Shape& shape : scene.shapes)
        passable.push_back(lets_rays_pass(scene, shape));
    work.surfaces = has_other_surfaces(work, instancing, passable);
    instancing_ = std::move(instancing);
    has_normals_ = has_normals;
    passable_ = std::move(passable);
    if (work.surfaces)
        surfaces_ = flatten(scene, gpu_.frame, materials_.facts.attributes, instancing_.is_instance);
}

void SceneStages::make_area_lights(Work& work) {
    const bool emissions = work.change.radiance || work.change.materials || work.change.images;
    if (work.surfaces || emissions) {
        AreaLights made = build_area_lights(work.scene, surfaces_);
        work.leaves = made.of_pieces != area_lights_.of_pieces;
        area_lights_ = std::move(made);
    }
    if (work.trees || emissions) {
        Lamps made = build_lamps(work.scene, trees_);
        work.leaves |= !same_places(made, lamps_);
        lamps_ = std::move(made);
    }
}

void SceneStages::make_mesh_trees(Work& work) {
    if (!work.materials && !work.change.of_geometry() && !work.instances) return;
    MeshTrees known;
    const auto before = kinds_of(trees_);
    if (!work.attributes && !work.normals) known = std::move(trees_);
    const auto has_changed = [&](const ShownMesh& shown) {
        return std::ranges::find(work.change.meshes, shown.mesh) != work.change.meshes.end() ||
               std::ranges::find(work.change.shapes, shown.emitter) != work.change.shapes.end();
    };
    std::erase_if(known, [&](const auto& tree) { return has_changed(tree.first); });
    const size_t kept = known.size();
    trees_ = build_mesh_trees(work.scene, instancing_, materials_.facts.attributes, std::move(known));
    work.trees = kept != trees_.size() || kinds_of(trees_) != before;
}

// The tree over the surfaces, if something moves among them: they are not looked at again in the next frame.
const Bvh* SceneStages::kept_tree(const Work& work) {
    if (!work.scene.motion || surfaces_.primitives.empty()) return nullptr;
    if (work.surfaces || !surface_tree_) {
        surface_tree_ = build_bvh(boxes_of(surfaces_.primitives));
        sort_children(*surface_tree_);
    }
    return &*surface_tree_;
}

void SceneStages::make_tree(Work& work) {
    work.tree = work.all || work.surfaces || work.instances || work.trees || !work.change.moved.empty() ||
                !work.change.shapes.empty();
    if (!work.tree) return;
    SceneTree made =
        build_scene_tree(work.scene, gpu_.frame, surfaces_, instancing_, trees_, kept_tree(work));
    work.leaves |= made.order != tree_.order || made.instances.empty() != tree_.instances.empty();
    tree_ = std::move(made);
}

void SceneStages::make_geometry(const Work& work) {
    if (work.all || work.surfaces || work.trees || work.leaves) {
        LeafArrays leaves =
            build_leaf_arrays(surfaces_, area_lights_, tree_, trees_, lamps_, materials_.facts.attributes);
        static_cast<LeafFacts&>(gpu_) = std::move(leaves.facts);
        put(ARRAY_PRIMITIVES, std::move(leaves.primitives));
        put(ARRAY_SURFACES, std::move(leaves.surfaces));
        put(ARRAY_NORMALS, std::move(leaves.normals));
        put(ARRAY_ATTRIBUTES, std::move(leaves.attributes));
    }
    if (work.tree || work.leaves) {
        number_lamps(tree_, lamps_, uint32_t(area_lights_.pieces.size()));
        NodeArrays nodes = build_node_arrays(surfaces_, tree_, trees_);
        static_cast<NodeFacts&>(gpu_) = std::move(nodes.facts);
        put(ARRAY_NODES, std::move(nodes.nodes));
    }
}

void SceneStages::make_lights(const Work& work) {
    const Scene& scene = work.scene;
    gpu_.environment_rotation = scene.environment ? scene.environment->rotation : 0.0f;
    const bool other_sky = work.all || work.change.environment;
    if (!other_sky && !work.tree && !work.materials && !work.change.radiance && !work.change.lights) return;
    std::optional<EnvironmentMap> map;
    if (other_sky && scene.environment) map = build_environment_map(*scene.environment);
    if (other_sky) sky_ = map ? std::optional<SkyLight>(*map) : std::nullopt;

    const PoweredLights punctual = build_punctual_lights(scene, gpu_.frame, tree_.bounds);
    const std::vector<PlacedLamp> placed = place_lamps(lamps_, tree_);
    const std::vector<LightBounds> bounds = bounds_of_placed(area_lights_.lights, placed, punctual);
    const std::vector<vec3> places = some_places(surfaces_, tree_);
    if (work.all || work.tree || work.materials || work.change.radiance || work.change.lights)
        light_tree_ = build_light_tree(bounds);
    LightArrays made =
        build_light_arrays({area_lights_, lamps_, placed, punctual, bounds, light_tree_, sky_, places},
                           tree_.bounds, materials_.facts.small_model);
    static_cast<LightFacts&>(gpu_) = made.facts;
    put(ARRAY_LIGHTS, std::move(made.lights));
    put(ARRAY_LIGHT_ALIAS, std::move(made.alias));
    put(ARRAY_LIGHT_TREE, std::move(made.tree.nodes));
    put(ARRAY_LIGHT_TRAILS, std::move(made.tree.trails));
    put(ARRAY_LIGHT_TEXTURES, light_textures(scene, materials_, surfaces_, area_lights_, tree_.order, trees_,
                                             lamps_, made.first_of_lamps));

    const bool small_model = materials_.facts.small_model;
    if (other_sky || made.sky_is_light != sky_is_light_ || small_model != small_model_) {
        if (scene.environment && !map) map = build_environment_map(*scene.environment);
        SkyArrays sky =
            map ? build_sky_arrays(*scene.environment, std::move(*map), made.sky_is_light) : SkyArrays{};
        if (!map && small_model) add_dark_sky(sky);
        static_cast<SkyFacts&>(gpu_) = sky.facts;
        put(ARRAY_ENVIRONMENT, std::move(sky.texels));
        put(ARRAY_ENVIRONMENT_CDF, std::move(sky.cdf));
    }
    sky_is_light_ = made.sky_is_light;
    small_model_ = small_model;
}

}  // namespace candela
