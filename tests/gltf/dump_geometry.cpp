// Writes the triangles of a glTF file as candela shows them, for the scripts that compare them with another
// reader's:
//
//     dump_geometry FILE OUTPUT [--scene NAME] [--animation NAME] [--time SECONDS]
//
// OUTPUT gets 24 doubles per triangle: of each corner, counter-clockwise seen from the front, the position
// and the unit normal in world space, and the first texture coordinates, v upwards; NaN where candela keeps
// none, because nothing looks them up. Little-endian, in the order of the scene.
#include <cstdio>
#include <exception>
#include <fstream>
#include <limits>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/error.h"
#include "load/gltf/gltf.h"
#include "scene/scene.h"

namespace candela {
namespace {

void append(std::vector<double>& numbers, const dvec3& v) {
    numbers.insert(numbers.end(), {v.x, v.y, v.z});
}

void append_triangles(const TriangleMesh& mesh, const Transform& transform, std::vector<double>& numbers) {
    constexpr double NONE = std::numeric_limits<double>::quiet_NaN();
    const auto place = [&](uint32_t vertex) {
        return transform.point(mesh.origin + dvec3(mesh.positions[vertex]));
    };
    for (uvec3 t : mesh.triangles) {
        if (transform.mirrors()) std::swap(t.y, t.z);
        const dvec3 flat = normalize(cross(place(t.y) - place(t.x), place(t.z) - place(t.x)));
        for (glm::length_t i = 0; i < 3; ++i) {
            append(numbers, place(t[i]));
            append(numbers, mesh.normals.empty() ? flat : dvec3(transform.normal(mesh.normals[t[i]])));
            const bool has_uv = !mesh.uv0.empty();
            numbers.push_back(has_uv ? double(mesh.uv0[t[i]].x) : NONE);
            numbers.push_back(has_uv ? double(mesh.uv0[t[i]].y) : NONE);
        }
    }
}

int run(const std::vector<std::string>& arguments) {
    if (arguments.size() < 2 || arguments.size() % 2 != 0) {
        throw Error("usage: dump_geometry FILE OUTPUT [--scene NAME] [--animation NAME] [--time SECONDS]",
                    ErrorKind::request);
    }
    GltfOptions options;
    for (size_t i = 2; i < arguments.size(); i += 2) {
        const std::string& value = arguments[i + 1];
        if (arguments[i] == "--scene") {
            options.scene = value;
        } else if (arguments[i] == "--animation") {
            options.animation = value;
        } else if (arguments[i] == "--time") {
            options.time = std::stod(value);
        } else {
            throw Error("unknown option " + arguments[i], ErrorKind::request);
        }
    }
    const Scene scene = load_gltf_scene(arguments[0], options);
    std::vector<double> numbers;
    for (const Shape& shape : scene.shapes) {
        const auto& instance = std::get<MeshInstance>(shape.geometry);
        append_triangles(scene.meshes[instance.mesh], instance.transform, numbers);
    }
    std::ofstream file(arguments[1], std::ios::binary);
    file.write(reinterpret_cast<const char*>(numbers.data()),
               std::streamsize(numbers.size() * sizeof(double)));
    file.close();
    if (!file) throw Error(arguments[1] + ": cannot write the file");
    return 0;
}

}  // namespace
}  // namespace candela

int main(int argc, char** argv) {
    try {
        return candela::run({argv + 1, argv + argc});
    } catch (const std::exception& error) {
        std::fprintf(stderr, "dump_geometry: %s\n", error.what());
        return 1;
    }
}
