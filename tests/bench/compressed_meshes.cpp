// What it takes to load a mesh of a million triangles, plain, under Draco and under meshopt, beside the
// decoders alone: CPU time, the least of several, and the greatest memory of the process. In each case a
// process of its own does all.
//
//     compressed_meshes [FOLDER]      FOLDER gets the files; by default a temporary one
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <meshoptimizer.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/cpu_time.h"
#include "base/math.h"
#include "base/text.h"
#include "load/gltf/gltf.h"
#include "load/gltf/gltf_file.h"
#include "load/gltf/vertex_data.h"

namespace candela {
namespace {

constexpr uint32_t AROUND = 1000, ALONG = 500;
constexpr uint32_t VERTICES = (AROUND + 1) * (ALONG + 1), CORNERS = 6 * AROUND * ALONG;
constexpr int RUNS = 5;

// A torus with bumps.
struct Torus {
    std::vector<vec3> positions, normals;
    std::vector<uint32_t> indices;

    Torus() {
        for (uint32_t i = 0; i <= AROUND; ++i) {
            for (uint32_t j = 0; j <= ALONG; ++j) {
                const float u = 2 * std::numbers::pi_v<float> * float(i % AROUND) / float(AROUND);
                const float v = 2 * std::numbers::pi_v<float> * float(j % ALONG) / float(ALONG);
                const vec3 n(std::cos(u) * std::cos(v), std::sin(v), std::sin(u) * std::cos(v));
                const float bump = 0.3f + 0.01f * std::sin(40 * u) * std::cos(30 * v);
                positions.push_back(vec3(std::cos(u), 0.0f, std::sin(u)) + bump * n);
                normals.push_back(n);
            }
        }
        for (uint32_t i = 0; i < AROUND; ++i) {
            for (uint32_t j = 0; j < ALONG; ++j) {
                const uint32_t a = i * (ALONG + 1) + j, b = a + ALONG + 1;
                for (const uint32_t c : {a, b + 1, b, a, a + 1, b + 1})
                    indices.push_back(c);
            }
        }
    }
};

template <class T>
std::string bytes_of(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

std::string draco_stream(const Torus& torus) {
    draco::Mesh mesh;
    mesh.set_num_points(VERTICES);
    const auto add = [&](draco::GeometryAttribute::Type kind, const std::vector<vec3>& values) {
        draco::GeometryAttribute attribute;
        attribute.Init(kind, nullptr, 3, draco::DT_FLOAT32, false, sizeof(vec3), 0);
        const int id = mesh.AddAttribute(attribute, true, VERTICES);
        for (uint32_t i = 0; i < VERTICES; ++i)
            mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), &values[i]);
    };
    add(draco::GeometryAttribute::POSITION, torus.positions);
    add(draco::GeometryAttribute::NORMAL, torus.normals);
    for (size_t i = 0; i < CORNERS; i += 3) {
        mesh.AddFace({draco::PointIndex(torus.indices[i]), draco::PointIndex(torus.indices[i + 1]),
                      draco::PointIndex(torus.indices[i + 2])});
    }
    draco::Encoder encoder;
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, 10);
    draco::EncoderBuffer buffer;
    if (!encoder.EncodeMeshToBuffer(mesh, &buffer).ok()) std::abort();
    return {buffer.data(), buffer.size()};
}

std::string vertex_stream(const std::vector<vec3>& values) {
    std::string stream(meshopt_encodeVertexBufferBound(values.size(), sizeof(vec3)), '\0');
    stream.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(stream.data()), stream.size(),
                                             values.data(), values.size(), sizeof(vec3)));
    return stream;
}

std::string index_stream(const std::vector<uint32_t>& indices) {
    std::string stream(meshopt_encodeIndexBufferBound(indices.size(), VERTICES), '\0');
    stream.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(stream.data()), stream.size(),
                                            indices.data(), indices.size()));
    return stream;
}

// A file whose views are these parts of its buffer; `views` has a key more for each, or is empty.
void write_glb(const std::filesystem::path& path, const std::vector<std::string>& parts,
               const std::vector<std::string>& views, bool has_views, const std::string& extension,
               const std::string& more_buffers) {
    std::string buffer, list;
    for (size_t i = 0; i < parts.size(); ++i) {
        const std::string place =
            concat(R"("buffer": 0, "byteOffset": )", buffer.size(), R"(, "byteLength": )", parts[i].size());
        list += (i > 0 ? ", " : "") + (views.empty() ? "{" + place + "}" : views[i] + place + "}}}");
        buffer += parts[i];
        buffer.resize((buffer.size() + 3) / 4 * 4);
    }
    const auto view = [&](int i) { return has_views ? concat(R"("bufferView": )", i, ", ") : std::string(); };
    std::string text = concat(
        R"({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}], "meshes": [{"primitives": [{
        "attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2)",
        extension, R"(}]}], "accessors": [{)", view(0), R"("componentType": 5126, "type": "VEC3", "count": )",
        VERTICES, "}, {", view(1), R"("componentType": 5126, "type": "VEC3", "count": )", VERTICES, "}, {",
        view(2), R"("componentType": 5125, "type": "SCALAR", "count": )", CORNERS, R"(}], "bufferViews": [)",
        list, R"(], "buffers": [{"byteLength": )", buffer.size(), "}", more_buffers, "]}");
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const auto word = [](size_t value) {
        const auto bits = uint32_t(value);
        return std::string(reinterpret_cast<const char*>(&bits), sizeof bits);
    };
    const std::string chunks =
        word(text.size()) + "JSON" + text + word(buffer.size()) + std::string("BIN\0", 4);
    std::ofstream file(path, std::ios::binary);
    file << "glTF" << word(2) << word(12 + chunks.size() + buffer.size()) << chunks << buffer;
    if (!file.flush()) std::abort();
}

struct Cost {
    double seconds = 0.0;  // CPU.
    double mebibytes = 0.0;
};

// The least time of some runs of `action`, and the greatest memory, in a process of its own.
Cost cost_of(const std::function<void()>& action) {
    int ends[2]{};
    if (pipe(ends) != 0) std::abort();
    const pid_t child = fork();
    if (child == 0) {
        double least = 1e9;
        for (int run = 0; run < RUNS; ++run) {
            const CpuWatch watch;
            action();
            least = std::min(least, watch.seconds());
        }
        const bool written = ::write(ends[1], &least, sizeof least) == ssize_t(sizeof least);
        _exit(written ? 0 : 1);
    }
    Cost cost;
    rusage usage{};
    int status = 0;
    if (::read(ends[0], &cost.seconds, sizeof cost.seconds) != ssize_t(sizeof cost.seconds)) std::abort();
    wait4(child, &status, 0, &usage);
    close(ends[0]);
    close(ends[1]);
    cost.mebibytes = double(usage.ru_maxrss) / 1024.0;
    return cost;
}

void run(const std::filesystem::path& folder) {
    std::string draco;
    std::vector<std::string> streams;
    {
        const Torus torus;
        const std::vector<std::string> plain{bytes_of(torus.positions), bytes_of(torus.normals),
                                             bytes_of(torus.indices)};
        write_glb(folder / "plain.glb", plain, {}, true, "", "");
        draco = draco_stream(torus);
        write_glb(
            folder / "draco.glb", {draco}, {}, false,
            R"(, "extensions": {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0, "NORMAL": 1}}})",
            "");
        streams = {vertex_stream(torus.positions), vertex_stream(torus.normals), index_stream(torus.indices)};
        std::vector<std::string> views;
        for (size_t i = 0; i < 3; ++i) {
            views.push_back(concat(R"({"buffer": 1, "byteLength": )", plain[i].size(),
                                   R"(, "extensions": {"EXT_meshopt_compression": {"mode": ")",
                                   i < 2 ? "ATTRIBUTES" : "TRIANGLES", R"(", "byteStride": )", i < 2 ? 12 : 4,
                                   R"(, "count": )", i < 2 ? VERTICES : CORNERS, ", "));
        }
        write_glb(folder / "meshopt.glb", streams, views, true, "", R"(, {"byteLength": 100000000})");
    }
    const auto load = [&](const char* name) {
        return cost_of([&] {
            if (load_gltf_scene(folder / name).meshes.at(0).triangles.size() * 3 != CORNERS) std::abort();
        });
    };
    const Cost plain = load("plain.glb");
    std::printf("%-24s %8.3f s %8.0f MiB\n", "plain, loaded", plain.seconds, plain.mebibytes);
    // What the reader does until it has the bytes, which it also reads from the disk.
    const auto decode = [&](const char* name) {
        return cost_of([&] {
            const std::filesystem::path path = folder / name;
            gltf::Contents contents(path, FileReach(path), no_progress);
            gltf::File file(contents, no_progress);
            for (const Node& view : file.root().require("bufferViews").elements())
                file.view_bytes(view);
            gltf::draco_of(file, file.element("meshes", 0).require("primitives")[0]);
        });
    };
    const auto report = [&](const char* name, const char* file, const Cost& alone) {
        const Cost decoded = decode(file), loaded = load(file);
        std::printf("%-7s decoder alone    %8.3f s %8.0f MiB\n", name, alone.seconds, alone.mebibytes);
        std::printf("%-7s read and decoded %8.3f s %8.0f MiB: %.2f times the decoder\n", name,
                    decoded.seconds, decoded.mebibytes, decoded.seconds / alone.seconds);
        std::printf("%-7s loaded           %8.3f s %8.0f MiB\n", name, loaded.seconds, loaded.mebibytes);
    };
    report("draco", "draco.glb", cost_of([&] {
               draco::DecoderBuffer buffer;
               buffer.Init(draco.data(), draco.size());
               if (!draco::Decoder().DecodeMeshFromBuffer(&buffer).ok()) std::abort();
           }));
    report("meshopt", "meshopt.glb", cost_of([&] {
               std::vector<vec3> values(VERTICES);
               std::vector<uint32_t> indices(CORNERS);
               const auto bytes = [&](size_t i) {
                   return reinterpret_cast<const unsigned char*>(streams[i].data());
               };
               for (const size_t i : {0, 1})
                   meshopt_decodeVertexBuffer(values.data(), VERTICES, 12, bytes(i), streams[i].size());
               meshopt_decodeIndexBuffer(indices.data(), CORNERS, 4, bytes(2), streams[2].size());
           }));
}

}  // namespace
}  // namespace candela

int main(int argc, char** argv) {
    try {
        const std::filesystem::path folder =
            argc > 1 ? argv[1] : std::filesystem::temp_directory_path() / "compressed_meshes";
        std::filesystem::create_directories(folder);
        candela::run(folder);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "compressed_meshes: %s\n", error.what());
        return 1;
    }
}
