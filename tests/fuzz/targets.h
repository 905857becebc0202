// The program's inputs from outside, as functions of bytes. Each may throw Error; nothing else may happen.
#pragma once

#include <array>
#include <string_view>

namespace candela::fuzz {

void scene(std::string_view bytes);  // A scene file, its tree and its records.
void obj(std::string_view bytes);
void mtl(std::string_view bytes);
void ply(std::string_view bytes);
// Posed at a moment; their tree and their records.
void gltf(std::string_view bytes);
void glb(std::string_view bytes);  // With lengths corrected.
// A glTF file with its images, its tree and its records, within 128 MiB; more is an Error.
void cost(std::string_view bytes);
// What Draco has compressed: by the library alone, and as a primitive of a glTF file, within the same limit.
void draco(std::string_view bytes);
// What meshopt has compressed, as a view of a glTF file. The first byte is the mode, the filter and the
// stride, the next two are the number of elements.
void meshopt(std::string_view bytes);
void hdr(std::string_view bytes);
void exr(std::string_view bytes);
// Images of textures.
void png(std::string_view bytes);  // With checksums corrected.
void jpeg(std::string_view bytes);
void webp(std::string_view bytes);
void ktx(std::string_view bytes);  // Does nothing without a decoder.
void targa(std::string_view bytes);
void bmp(std::string_view bytes);
// Images as text, see parse_images(): what the commands do with images that OpenEXR has read without
// complaint.
void checkpoint(std::string_view bytes);  // Whatever its checksum says, and what is done with it.
void merge(std::string_view bytes);
void compare(std::string_view bytes);  // The last image with each.
void plot(std::string_view bytes);     // A report.
void cameras(std::string_view bytes);  // A file of cameras, and as it is written in both conventions.
// Lines for candela serve, and what they ask of a scene, but for its rendering and for files.
void messages(std::string_view bytes);

struct Target {
    std::string_view name;  // Its inputs are in corpora/NAME.
    void (*run)(std::string_view bytes);
};
inline constexpr std::array<Target, 23> TARGETS{
    {{"scene", scene},     {"gltf", gltf},        {"glb", glb},
     {"cost", cost},       {"draco", draco},      {"meshopt", meshopt},
     {"obj", obj},         {"mtl", mtl},          {"ply", ply},
     {"hdr", hdr},         {"exr", exr},          {"png", png},
     {"jpeg", jpeg},       {"webp", webp},        {"ktx", ktx},
     {"targa", targa},     {"bmp", bmp},          {"checkpoint", checkpoint},
     {"merge", merge},     {"compare", compare},  {"plot", plot},
     {"cameras", cameras}, {"messages", messages}}};

}  // namespace candela::fuzz
