// OBJ files with their own materials.
#include <algorithm>
#include <iterator>

#include "base/text.h"
#include "load/obj/counted_warnings.h"
#include "load/obj/obj.h"
#include "load/obj/obj_materials.h"
#include "load/quote.h"
#include "scene/default_view.h"
#include "scene/material_textures.h"

namespace candela {
namespace {

// The builder's name for a part's material.
std::string name_of(const std::string& shape, const ObjPart& part) {
    return part.material ? shape + '/' + part.material->name : shape + " (no material)";
}

// Whether a mesh of that look needs texture coordinates.
bool needs_uvs(const Material& material, const Textured<vec3>& emission) {
    bool needs = emission.texture.has_value();
    for_each_texture(material, [&](const Texture&) { needs = true; });
    return needs;
}

class MaterialAdder {
  public:
    MaterialAdder(const std::filesystem::path& file, const std::string& name, SceneBuilder& builder)
        : file_(file), name_(name), builder_(builder) {}

    // Adds the materials of all parts to the scene; returns warnings.
    std::vector<std::string> add(const ObjParts& obj) {
        libraries_ = load_mtl_libraries(file_, obj.libraries, builder_.scene().reach);
        known_ = materials_of(libraries_.materials);
        std::ranges::copy(libraries_.materials.files, std::back_inserter(builder_.scene().files));
        for (const ObjPart& part : obj.parts) {
            if (part.material) {
                add_named(part);
            } else {
                add_default(part, obj.parts.size() > 1);
            }
        }
        std::vector<std::string> warnings = std::move(libraries_.materials.warnings);
        std::ranges::move(warnings_.texts(), std::back_inserter(warnings));
        return warnings;
    }

  private:
    void add_default(const ObjPart& part, bool others_have_some) {
        const bool has_colors = !part.mesh.colors.empty();
        if (others_have_some) {
            const std::string count = concat(part.faces, part.faces == 1 ? " face has" : " faces have");
            const char* shown = has_colors ? "the colours of their vertices" : "grey";
            warnings_.add("none",
                          concat(file_.string(), ": ", count, " no material (usemtl); shown in ", shown));
        }
        builder_.add_file_appearance(name_of(name_, part), default_material(has_colors), std::nullopt);
    }

    void add_named(const ObjPart& part) {
        const auto found = libraries_.materials.materials.find(part.material->name);
        if (found == libraries_.materials.materials.end()) {
            const std::string place = concat(file_.string(), ':', part.material->line, ": ");
            if (libraries_.all_there) {
                warnings_.add("unknown",
                              concat(place, "unknown material ", quote(part.material->name), known_));
            }
            const Material grey = default_material(!part.mesh.colors.empty());
            return builder_.add_file_appearance(name_of(name_, part), grey, std::nullopt);
        }
        MtlMaterial material = found->second;
        for (const MtlWarning& warning : material.warnings)
            warnings_.add(warning.kind, warning.text);
        add_images(material, builder_.scene());
        const bool emits = material.emission.factor != vec3(0.0f);
        if (part.mesh.uv0.empty() && needs_uvs(material.material, material.emission)) {
            warnings_.add("uvs", concat(file_.string(), ": the material ", quote(part.material->name),
                                        " has textures, but its faces have no texture coordinates: they show "
                                        "the corner (0, 0) of each image"));
        }
        builder_.add_file_appearance(name_of(name_, part), material.material,
                                     emits ? std::optional(Emission{material.emission}) : std::nullopt);
    }

    const std::filesystem::path& file_;
    const std::string& name_;
    SceneBuilder& builder_;
    ObjLibraries libraries_;
    std::string known_;  // The materials that the libraries define, for messages.
    CountedWarnings warnings_;
};

}  // namespace

ObjShape load_obj_shape(const std::filesystem::path& file, MeshNormals normals, const std::string& name,
                        SceneBuilder& builder) {
    ObjParts obj = load_obj_parts(file, normals, builder.scene().reach);
    builder.scene().files.push_back(file);
    ObjShape shape{.groups = std::move(obj.groups),
                   .has_materials = std::ranges::any_of(
                       obj.parts, [](const ObjPart& part) { return part.material.has_value(); })};
    const auto is_there = [&](const ObjPart& part) {
        return builder.find_file_appearance(name_of(name, part)) != nullptr;
    };
    if (!std::ranges::all_of(obj.parts, is_there)) {
        shape.warnings = std::move(obj.warnings);
        std::ranges::move(MaterialAdder(file, name, builder).add(obj), std::back_inserter(shape.warnings));
    }
    for (ObjPart& part : obj.parts) {
        const Appearance& appearance = *builder.find_file_appearance(name_of(name, part));
        const Textured<vec3> none = vec3(0.0f);
        if (part.mesh.uv0.empty() && needs_uvs(builder.scene().materials[appearance.material],
                                               appearance.emission ? appearance.emission->radiance : none))
            part.mesh.uv0.resize(part.mesh.positions.size(), vec2(0.0f));
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
    if (shape.groups.empty()) shape.groups.emplace_back();
    std::ranges::replace(shape.groups, "", file.stem().string());
    builder.begin_objects(shape.groups);
    builder.add_mesh(file.string(), Transform(), std::move(shape.parts));
    add_default_view(scene);
    return scene;
}

}  // namespace candela
