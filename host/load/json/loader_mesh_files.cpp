// Shapes that are read from files of their own.
#include "base/error.h"
#include "base/memory_limit.h"
#include "load/json/loader_parts.h"
#include "load/obj/obj.h"
#include "load/ply/ply.h"
#include "load/quote.h"

namespace candela {
namespace {

constexpr std::array<std::pair<std::string_view, MeshNormals>, 3> MESH_NORMALS_NAMES{
    {{"file", MeshNormals::file}, {"smooth", MeshNormals::smooth}, {"flat", MeshNormals::flat}}};

MeshNormals normals_of(const Node& node) {
    const auto normals = node.find("normals");
    return normals ? normals->choice(MESH_NORMALS_NAMES) : MeshNormals::file;
}

// Calls a function that reads what `file` names; its errors get the place of `file`.
template <class Read>
auto read_from(const Node& file, const Scene& scene, Read read) {
    const HiddenValues hidden(scene.reach);
    try {
        return with_memory_for(
            "the mesh", [&] { return file.string(); }, read);
    } catch (const Error& error) {
        throw Error(file.place() + ": " + error.what(), error.kind());
    }
}

void warn(const Node& file, const std::vector<std::string>& warnings, Scene& scene) {
    for (const std::string& warning : warnings)
        scene.warnings.push_back(file.place() + ": " + warning);
}

// Adds an OBJ file with its own materials.
void read_obj_with_materials(const Node& node, ShapeList& shapes) {
    const Node file = node.require("file");
    const Transform transform = ShapeList::transform_of(node);
    const MeshNormals normals = normals_of(node);
    const std::filesystem::path path = shapes.path_of(file);
    ObjShape obj =
        read_from(file, shapes.scene(), [&] { return load_obj_shape(path, normals, file.string(), shapes); });
    if (!obj.has_materials) {
        node.fail(
            "the shape has neither material nor emission, and no face of its file has a material "
            "(usemtl); add one of them");
    }
    warn(file, obj.warnings, shapes.scene());

    const auto two_sided = node.find("two_sided");
    const bool both_sides = two_sided && two_sided->boolean();
    bool emits = false;
    for (MeshPart& part : obj.parts) {
        part.mesh.groups = {};  // All of it is one object.
        std::optional<Emission>& emission = part.appearance.emission;
        if (emission) emission->two_sided = both_sides;
        part.appearance.beam.spread = ShapeList::spread_of(node);
        emits = emits || emission;
    }
    if (two_sided && !emits) {
        two_sided->fail("two_sided says where emission leaves, but no material of the file emits (Ke)");
    }
    if (const auto spread = node.find("spread"); spread && !emits)
        spread->fail("spread says where emission leaves, but no material of the file emits (Ke)");
    shapes.add_mesh(node.place(), transform, std::move(obj.parts));
}

// Adds a file as one mesh with the material and emission of `node`; load(file, path, normals) reads it.
template <class Load>
void read_whole(const Node& node, ShapeList& shapes, Load load) {
    const Appearance appearance = shapes.appearance_of(node);
    const Transform transform = ShapeList::transform_of(node);
    const Node file = node.require("file");
    const MeshNormals normals = normals_of(node);
    const std::filesystem::path path = shapes.path_of(file);
    TriangleMesh mesh = read_from(file, shapes.scene(), [&] { return load(file, path, normals); });
    shapes.scene().files.push_back(path);
    shapes.add_mesh(node.place(), appearance, transform, std::move(mesh));
}

}  // namespace

void read_obj(const Node& node, ShapeList& shapes) {
    node.allow_only({"type"}, keys_of({"obj", "shape"}));
    if (!node.find("material") && !node.find("emission")) return read_obj_with_materials(node, shapes);
    read_whole(node, shapes, [&](const Node& file, const std::filesystem::path& path, MeshNormals normals) {
        std::vector<std::string> warnings;
        TriangleMesh mesh = load_obj(path, normals, shapes.scene().reach, warnings);
        warn(file, warnings, shapes.scene());
        return mesh;
    });
}

void read_ply(const Node& node, ShapeList& shapes) {
    node.allow_only({"type"}, keys_of({"ply", "shape"}));
    read_whole(node, shapes, [&](const Node& file, const std::filesystem::path& path, MeshNormals normals) {
        std::vector<std::string> warnings;
        TriangleMesh mesh = load_ply(path, normals, shapes.scene().reach, warnings);
        warn(file, warnings, shapes.scene());
        return mesh;
    });
}

}  // namespace candela
