// OBJ files with the materials that they name.
#include <algorithm>
#include <iterator>

#include "load/obj/obj.h"
#include "load/obj/obj_materials.h"
#include "scene/default_view.h"

namespace candela {
namespace {

// The name by which the builder finds a part's material.
std::string name_of(const std::string& shape, const ObjPart& part) {
    return part.material ? shape + '/' + part.material->name : shape + " (no material)";
}

// Adds the materials of all parts to the scene; returns warnings.
std::vector<std::string> add_materials(const std::filesystem::path& file, const ObjParts& obj,
                                       const std::string& name, SceneBuilder& builder) {
    MtlLibrary library = load_mtl_libraries(file, obj.libraries, builder.scene().reach);
    std::ranges::copy(library.files, std::back_inserter(builder.scene().files));
    std::vector<std::string> warnings = std::move(library.warnings);
    for (const ObjPart& part : obj.parts) {
        if (!part.material) {
            const bool has_colors = !part.mesh.colors.empty();
            if (obj.parts.size() > 1) {
                warnings.push_back(file.string() + ": " + std::to_string(part.faces) +
                                   (part.faces == 1 ? " face" : " faces") +
                                   " before the first usemtl; shown in " +
                                   (has_colors ? "the colours of their vertices" : "grey"));
            }
            builder.add_file_appearance(name_of(name, part), default_material(has_colors), std::nullopt);
            continue;
        }
        MtlMaterial material = find_mtl_material(library, file, *part.material);
        std::ranges::copy(material.warnings, std::back_inserter(warnings));
        add_images(material, builder.scene());
        const bool emits = material.emission.factor != vec3(0.0f);
        builder.add_file_appearance(name_of(name, part), material.material,
                                    emits ? std::optional(Emission{material.emission}) : std::nullopt);
    }
    return warnings;
}

bool has_material(const ObjPart& part) {
    return part.material.has_value();
}

}  // namespace

ObjShape load_obj_shape(const std::filesystem::path& file, MeshNormals normals, const std::string& name,
                        SceneBuilder& builder) {
    ObjParts obj = load_obj_parts(file, normals, builder.scene().reach);
    builder.scene().files.push_back(file);
    ObjShape shape{.has_materials = std::ranges::any_of(obj.parts, has_material)};
    const auto is_there = [&](const ObjPart& part) {
        return builder.find_file_appearance(name_of(name, part)) != nullptr;
    };
    if (!std::ranges::all_of(obj.parts, is_there)) shape.warnings = add_materials(file, obj, name, builder);
    for (ObjPart& part : obj.parts) {
        const Appearance& appearance = *builder.find_file_appearance(name_of(name, part));
        shape.parts.push_back({appearance, std::move(part.mesh)});
    }
    return shape;
}

Scene load_obj_scene(const std::filesystem::path& file, const ReachOptions& reach) {
    Scene scene;
    scene.reach = FileReach(file, reach);
    SceneBuilder builder(scene);
    ObjShape shape = load_obj_shape(file, MeshNormals::file, file.filename().string(), builder);
    scene.warnings = std::move(shape.warnings);
    builder.add_mesh(file.string(), Transform(), std::move(shape.parts));
    add_default_view(scene);
    return scene;
}

}  // namespace candela
