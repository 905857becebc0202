// See targets.h.
#include "fuzz/targets.h"

#include <array>
#include <cstring>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <draco/compression/decode.h>
#include <nlohmann/json.hpp>

#include "base/memory_limit.h"
#include "base/text.h"
#include "cli/report_curve.h"
#include "film/checkpoint.h"
#include "film/merge.h"
#include "film/sample_range.h"
#include "fuzz/image_text.h"
#include "fuzz/memory_file.h"
#include "gpu_scene/gpu_scene.h"
#include "image/compare.h"
#include "image/image_io.h"
#include "image/texel_io.h"
#include "load/gltf/gltf.h"
#include "load/json/change.h"
#include "load/json/loader.h"
#include "load/obj/mtl.h"
#include "load/obj/obj.h"
#include "load/ply/ply.h"
#include "scene/images.h"
#include "serve/describe_parts.h"
#include "serve/describe_views.h"
#include "serve/line_reader.h"
#include "serve/message.h"
#include "serve/picture_request.h"
#include "serve/save_image.h"
#include "serve/shared_arrays.h"
#include "serve/shared_memory.h"
#include "session/adaptive.h"
#include "support/png_writer.h"
#include "views/camera_file.h"

namespace candela::fuzz {
namespace {

// Keeps a run short: more pixels are only more of the same.
const ImageLimits SMALL{.max_pixels = 1 << 14};

// The most bytes of a message.
constexpr size_t MAX_LINE = 1 << 14;

// Of the file that messages call SHARED.
constexpr size_t SHARED_BYTES = 256;

void texels(std::string_view bytes, const char* name) {
    std::vector<std::string> warnings;
    decode_texels(bytes, name, warnings, {.max_pixels = SMALL.max_pixels});
}

// A PNG file with the checksums of its chunks set right: a fuzzer does not guess them.
std::string with_checksums(std::string_view file) {
    constexpr size_t TYPE = 4, DATA = 8, AROUND_DATA = 12;
    std::string mended(file.substr(0, PNG_SIGNATURE.size()));
    file.remove_prefix(mended.size());
    while (file.size() >= AROUND_DATA) {
        uint32_t size = 0;
        for (size_t i = 0; i < TYPE; ++i)
            size = size << 8 | uint8_t(file[i]);
        if (size > file.size() - AROUND_DATA) break;
        mended += png_chunk(file.substr(TYPE, 4), file.substr(DATA, size));
        file.remove_prefix(AROUND_DATA + size);
    }
    return mended.append(file);
}

// A .glb file with the lengths of the file and of its second chunk set right: a fuzzer changes both all the
// time.
std::string with_lengths(std::string_view file) {
    constexpr size_t LENGTH = 8, FIRST = 12, CHUNK_HEADER = 8;
    std::string mended(file);
    const auto set = [&](size_t at, size_t value) {
        for (size_t i = 0; i < 4; ++i)
            mended[at + i] = char(value >> (8 * i) & 0xFFu);
    };
    if (mended.size() < FIRST + CHUNK_HEADER) return mended;
    set(LENGTH, mended.size());
    size_t text = 0;
    for (size_t i = 0; i < 4; ++i)
        text |= size_t(uint8_t(mended[FIRST + i])) << (8 * i);
    const size_t second = FIRST + CHUNK_HEADER + text;
    if (second > mended.size()) {
        set(FIRST, mended.size() - FIRST - CHUNK_HEADER);
    } else if (mended.size() - second >= CHUNK_HEADER) {
        set(second, mended.size() - second - CHUNK_HEADER);
    }
    return mended;
}

std::string little_endian(size_t word) {
    std::string bytes(4, '\0');
    for (size_t i = 0; i < 4; ++i)
        bytes[i] = char(word >> (8 * i) & 0xFFu);
    return bytes;
}

// A .glb file with this document, in which BYTES stands for the number of bytes of its buffer.
std::string glb_file(std::string text, std::string_view buffer) {
    constexpr std::string_view BYTES = "BYTES";
    for (size_t at = 0; (at = text.find(BYTES, at)) != std::string::npos;)
        text.replace(at, BYTES.size(), std::to_string(buffer.size()));
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string chunks =
        little_endian(text.size()) + "JSON" + text + little_endian(buffer.size()) + std::string("BIN\0", 4);
    chunks += buffer;
    return "glTF" + little_endian(2) + little_endian(chunks.size() + 12) + chunks;
}

// Of what targets do within a limit.
constexpr uint64_t MAX_BYTES = uint64_t(128) << 20;

// Decodes without the checks of the reader. Few bytes may say that there are as many bits as the memory
// holds, each of which takes its time.
void draco_alone(std::string_view bytes) {
    set_memory_limit(memory_in_use() + MAX_BYTES / 4);
    const LimitedMemory limited;
    ::draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    try {
        ::draco::Decoder().DecodeMeshFromBuffer(&buffer);
    } catch (const std::bad_alloc&) {  // The limit.
    }
}

// Reads a glTF file, builds its tree and packs its records, within a limit.
void within_limit(std::string_view bytes) {
    const MemoryFile file(bytes);
    set_memory_limit(memory_in_use() + MAX_BYTES);
    const LimitedMemory limited;
    const auto name = [] { return std::string("fuzz.gltf"); };
    with_memory_for("the scene", name, [&] {
        Scene scene = load_gltf_scene(file.path());
        DecodedImages decoded;
        load_images(scene, {}, no_progress, decoded);
        build_gpu_scene_freeing_images(scene);
    });
}

}  // namespace

void scene(std::string_view bytes) {
    build_gpu_scene(parse_scene(bytes, "fuzz.json"));
}

void obj(std::string_view bytes) {
    const MemoryFile file(bytes);
    std::vector<std::string> warnings;
    load_obj(file.path(), MeshNormals::file, FileReach(file.path()), warnings);
    load_obj_parts(file.path(), MeshNormals::smooth, FileReach(file.path()));
}

void mtl(std::string_view bytes) {
    const MemoryFile file(bytes);
    load_mtl(file.path(), FileReach(file.path()));
}

void ply(std::string_view bytes) {
    std::vector<std::string> warnings;
    const MemoryFile file(bytes);
    load_ply(file.path(), MeshNormals::file, FileReach(file.path()), warnings);
}

void gltf(std::string_view bytes) {
    Scene scene;
    const MemoryFile file(bytes);
    scene.reach = FileReach(file.path());
    GltfFiles files;
    add_gltf_scene(file.path(), {.animation = "all", .time = 0.5}, scene, no_progress, files);
    complete_gltf_scene("fuzz.gltf", scene);
    // Images are other targets, and are not read here.
    if (scene.images.empty()) build_gpu_scene(scene);
}

void glb(std::string_view bytes) {
    gltf(with_lengths(bytes));
}

void cost(std::string_view bytes) {
    within_limit(bytes);
}

void draco(std::string_view bytes) {
    draco_alone(bytes);
    within_limit(
        glb_file(R"({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{
        "attributes": {"COLOR_0": 0, "POSITION": 1}, "indices": 2, "extensions": {"KHR_draco_mesh_compression":
        {"bufferView": 0, "attributes": {"COLOR_0": 0, "POSITION": 1}}}}]}],
        "accessors": [{"componentType": 5121, "type": "VEC4", "count": 3000, "normalized": true},
        {"componentType": 5126, "type": "VEC3", "count": 3000},
        {"componentType": 5125, "type": "SCALAR", "count": 9000}],
        "bufferViews": [{"buffer": 0, "byteLength": BYTES}], "buffers": [{"byteLength": BYTES}]})",
                 bytes));
}

void meshopt(std::string_view bytes) {
    constexpr size_t HEADER = 3;
    constexpr std::array<const char*, 4> MODES{"ATTRIBUTES", "ATTRIBUTES", "TRIANGLES", "INDICES"};
    constexpr std::array<const char*, 4> FILTERS{"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};
    if (bytes.size() <= HEADER) return;
    const auto choice = size_t(uint8_t(bytes[0]));
    const size_t count = 1 + uint8_t(bytes[1]) + 256 * size_t(uint8_t(bytes[2]));
    const bool is_index = (choice & 3u) > 1;
    const size_t stride = is_index ? 2 << (choice >> 4 & 1u) : 4 * (1 + (choice >> 4));
    // Colours of vertices at the origin, or its indices.
    const std::string number = is_index ? (stride == 2 ? "5123" : "5125") : "5121";
    within_limit(glb_file(
        concat(R"({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{
        "attributes": {"POSITION": 0)",
               is_index ? R"(}, "indices": 1)" : R"(, "COLOR_0": 1})",
               R"(}]}], "accessors": [{"componentType": 5126, "type": "VEC3", "count": )",
               is_index ? 1 : count, R"(}, {"bufferView": 0, "componentType": )", number, R"(, "type": ")",
               is_index ? "SCALAR" : "VEC4", R"(", "normalized": )", is_index ? "false" : "true",
               R"(, "count": )", count, R"(}], "bufferViews": [{"buffer": 1, "byteLength": )", count * stride,
               is_index ? "" : concat(R"(, "byteStride": )", stride),
               R"(, "extensions": {"EXT_meshopt_compression": {"buffer": 0, "byteOffset": 3, "byteLength": )",
               bytes.size() - HEADER, R"(, "byteStride": )", stride, R"(, "count": )", count,
               R"(, "mode": ")", MODES[choice & 3u], R"(", "filter": ")", FILTERS[choice >> 2 & 3u],
               R"("}}}], "buffers": [{"byteLength": BYTES}, {"byteLength": 16777216}]})"),
        bytes));
}

void hdr(std::string_view bytes) {
    read_hdr(MemoryFile(bytes).path(), SMALL);
}

void exr(std::string_view bytes) {
    decode_exr(bytes, "fuzz.exr", SMALL);
}

void png(std::string_view bytes) {
    texels(with_checksums(bytes), "fuzz.png");
}

void jpeg(std::string_view bytes) {
    texels(bytes, "fuzz.jpg");
}

void webp(std::string_view bytes) {
    texels(bytes, "fuzz.webp");
}

void ktx(std::string_view bytes) {
    if (reads_ktx_texels()) texels(bytes, "fuzz.ktx2");
}

void targa(std::string_view bytes) {
    texels(bytes, "fuzz.tga");
}

void bmp(std::string_view bytes) {
    texels(bytes, "fuzz.bmp");
}

void checkpoint(std::string_view bytes) {
    for (const Image& image : parse_images(bytes)) {
        Checkpoint checkpoint = checkpoint_of(image, "fuzz.exr", false);
        std::vector<Accumulation>& states = checkpoint.states;
        if (count_samples(states).total == 0) continue;
        make_image(states, {.albedo = states.front().layer_count == LAYER_COUNT_AOVS}, {});
        if (states.size() != 4) continue;
        const uint32_t half = next_pass_end(samples_per_pixel(states), MAX_SPP) / 2;
        plan_extra_samples(states[2], even_samples(half), half, states[1]);
    }
}

void merge(std::string_view bytes) {
    const std::vector<Image> images = parse_images(bytes);
    if (images.empty()) return;
    std::vector<std::filesystem::path> names;
    for (size_t i = 0; i < images.size(); ++i)
        names.emplace_back(std::to_string(i));
    const auto header = [&](const std::filesystem::path& name) { return images[std::stoul(name)]; };
    merge_files(names, {.header = header, .image = [&](const auto& name, auto) { return header(name); }});
}

void compare(std::string_view bytes) {
    const std::vector<Image> images = parse_images(bytes);
    for (const Image& image : images) {
        candela::compare(image, images.back());
        heatmap(image, images.back());
    }
}

void plot(std::string_view bytes) {
    draw_curves({curve_of_report(bytes, "fuzz.json")});
}

void cameras(std::string_view bytes) {
    const MemoryFile file(bytes);
    std::vector<PictureCamera> pictures;
    for (const Camera& camera : read_camera_file(file.path(), uvec2(64, 48)))
        pictures.push_back({camera, camera.film_size.value(), camera.name});
    camera_file_text("fuzz.json", pictures);
    camera_file_text("opencv.json", pictures);
}

// Reads the scene of a message whose arrays are in a file that it calls SHARED.
void load_message(const Node& parameters) {
    const serve::SharedArrays arrays(parameters.require("arrays"));
    GltfFiles files;
    Scene scene = parse_json_scene(parameters.require("text").string(), "/none/scene", {}, no_progress, {},
                                   files, &arrays)
                      .scene;
    DecodedImages decoded;
    load_images(scene, {}, no_progress, decoded);
    build_gpu_scene(scene);
}

// The same line with the name of a file of 256 bytes: counting numbers of every type, some of them good.
std::string with_shared_file(std::string line) {
    static const SharedMemory memory(SHARED_BYTES);
    static const bool filled = [] {
        constexpr float POINTS[]{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
        constexpr int32_t FACES[]{0, 1, 2, 0, 1, 3, 1, 2, 3, 0, 2, 3};
        std::memcpy(memory.bytes().data(), POINTS, sizeof POINTS);
        std::memcpy(memory.bytes().data() + SHARED_BYTES / 4, FACES, sizeof FACES);
        for (size_t i = SHARED_BYTES / 2; i < SHARED_BYTES; ++i)
            memory.bytes()[i] = std::byte(i);
        return true;
    }();
    constexpr std::string_view NAME = "SHARED";
    for (size_t at = 0; filled && (at = line.find(NAME, at)) != std::string::npos;)
        line.replace(at, NAME.size(), memory.path().string());
    return line;
}

void messages(std::string_view bytes) {
    static const Scene scene =
        parse_scene(R"({"cameras": {"main": {"position": [0, 0, 3], "look_at": [0, 0, 0],
        "vertical_fov": 40}}, "materials": {"clay": {"type": "diffuse", "reflectance": 0.5},
        "glaze": {"type": "principled", "coat": 1}}, "objects": {"set": [{"type": "box", "min": [0, 0, 0],
        "max": [1, 1, 1], "material": "glaze"}, {"type": "mesh", "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
        "triangles": [[0, 1, 2]], "material": "clay"}]},
        "shapes": [{"type": "sphere", "radius": 1, "material": "clay", "name": "ball"},
        {"type": "instance", "object": "set", "transforms": [[], [{"translate": [1, 0, 0]}]]}]})",
                    "fuzz.json");
    serve::LineReader lines(MAX_LINE);
    lines.add(bytes);
    while (true) {
        std::optional<std::string> id;
        try {
            const std::optional<std::string> line = lines.next();
            if (!line) break;
            const serve::Request request = serve::parse_request(with_shared_file(*line), id);
            const Node parameters = request.parameters();
            if (request.method == "render") serve::read_job(parameters, scene);
            if (request.method == "load") load_message(parameters);
            if (request.method == "object") serve::describe_object(parameters.require("object"), scene);
            if (request.method == "material") serve::describe_material(parameters.require("material"), scene);
            if (request.method == "views") serve::describe_views(parameters, scene);
            if (request.method == "save") serve::read_save(parameters);
            if (request.method == "set") {
                Scene changed = scene;
                SceneEdits edits;
                change_scene(changed, parameters.require("change").text(), "change", {}, edits);
                build_gpu_scene(changed);
            }
            serve::result_line(id.value_or("null"), {{"line", *line}});
        } catch (const Error& error) {
            serve::error_line(id, error);
        }
    }
    lines.finish();
}

}  // namespace candela::fuzz
