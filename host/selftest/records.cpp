// A kernel reads the records that the host packs, field by field, bit for bit.
#include "selftest/records.h"

#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <vector>

#include "base/text.h"
#include "gpu_scene/append.h"
#include "probe/probe.h"
#include "probe/probes.h"
#include "probe/random.h"
#include "shared/bvh_node.h"
#include "shared/light.h"
#include "shared/light_tree.h"
#include "shared/material.h"
#include "shared/primitive.h"
#include "shared/principled.h"
#include "shared/texture.h"

namespace candela {
namespace {

// The fields of the records in the order in which records.comp.glsl writes them. Each field gets different
// bits.
class Fields {
  public:
    uint u() { return keep(0xA0000001u + uint(words.size()) * 0x00010203u); }
    float f() { return std::bit_cast<float>(keep(0x3F800001u + uint(words.size()) * 0x00001357u)); }
    uvec2 u2() {
        const uint x = u();
        return {x, u()};
    }
    uvec3 u3() {
        const uvec2 xy = u2();
        return {xy.x, xy.y, u()};
    }
    uvec4 u4() {
        const uvec3 xyz = u3();
        return {xyz.x, xyz.y, xyz.z, u()};
    }
    // The next field, of 24 bits.
    uint u24() { return keep(0x00A00001u + uint(words.size()) * 0x00000203u); }
    uvec3 u24_3() {
        const uint x = u24();
        const uint y = u24();
        return {x, y, u24()};
    }
    vec2 f2() {
        const float x = f();
        return {x, f()};
    }
    vec3 f3() {
        const float x = f();
        const float y = f();
        return {x, y, f()};
    }
    vec4 f4() {
        const vec3 xyz = f3();
        return vec4(xyz.x, xyz.y, xyz.z, f());
    }
    uint keep(uint word) {
        words.push_back(word);
        return word;
    }

    std::vector<uint> words;
};

// One record of every kind.
struct Records {
    Parameters parameters;
    BvhNode node;
    Primitive triangles, disk;
    Surface surface;
    std::array<uvec4, NORMALS_WORDS> normals;
    MaterialRecord material;
    MediumRecord medium;
    LightRecord light;
    LampRecord lamp;
    AliasEntry light_even, light_odd;
    LightTreeChild light_tree;
    uvec4 light_trails;
    EnvironmentTexel texel;
    CdfEntry texel_even, texel_odd;
    MaterialTextures material_textures;
    LightTextures light_textures;
    TextureRecord texture;
    uvec4 texels;
    std::array<uvec4, 7> attributes;  // Words of all kinds: attribute_words(ATTRIBUTES_ALL).
    PrincipledRecord principled;
    PrincipledImage principled_image;
};

struct Item {
    uvec4 unused{0};
};

// The kernel's result.
struct Result {
    std::array<uint, 269> words;
};

// Records filled from `fields`, in the order in which the kernel writes them; the scales of a node must be
// powers of two.
Records filled(Fields& fields) {
    Records r{};
    r.parameters = {.position = fields.f3(),
                    .right = fields.f3(),
                    .up = fields.f3(),
                    .forward = fields.f3(),
                    .full_size = fields.u2(),
                    .principal_point = fields.f2(),
                    .crop = fields.u2(),
                    .seed = fields.u(),
                    .max_depth = fields.u(),
                    .rr_depth = fields.u(),
                    .lights = {.placed = fields.u(),
                               .suns = fields.u(),
                               .sun_fraction = fields.u(),
                               .sky_fraction = fields.u(),
                               .sun_flux = fields.f4(),
                               .sky_flux = fields.f4()},
                    .environment_size = fields.u2(),
                    .environment_turn = fields.f2(),
                    .lens_x = fields.f3(),
                    .lens_y = fields.f3(),
                    .focal_distance = fields.f(),
                    .blades = fields.u(),
                    .first_sample = fields.u(),
                    .camera_media = fields.u2(),
                    .fisheye_edge = fields.f()};
    r.node.origin = fields.f3();
    r.node.scale = vec3(0x1p-30f, 0x1p7f, 0x1p-126f);
    for (const int axis : {0, 1, 2})
        fields.keep(floatBitsToUint(r.node.scale[axis]));
    r.node.q_lo[0] = fields.u3();
    r.node.q_lo[1] = fields.u24_3();
    r.node.q_hi[0] = fields.u3();
    r.node.q_hi[1] = fields.u24_3();
    r.node.children.x = fields.u24();
    r.node.children.y = fields.u();
    r.triangles = {.kind = fields.keep(PRIMITIVE_TRIANGLES),
                   .a = fields.f3(),
                   .b = fields.f3(),
                   .c = fields.f3(),
                   .d = fields.f3()};
    r.disk = {.kind = fields.keep(PRIMITIVE_DISK),
              .a = fields.f3(),
              .b = fields.f3(),
              .c = fields.f3(),
              .d = vec3(0)};
    r.surface = {.id = fields.u2(),
                 .material = fields.keep(0x2AAAA5u),
                 .has_normals = fields.keep(1u),
                 .light = fields.u(),
                 .error = std::bit_cast<float>(fields.keep(floatBitsToUint(0x1p-21f))),
                 .passable = fields.keep(1u)};
    r.normals = pack_normals(vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, -1), vec3(0, -1, 0));
    for (const int i : {0, 1, 2, 3})
        fields.keep(r.normals[0][i]);
    r.material = {.model = fields.keep(0xA5u),
                  .medium = fields.keep(0xABCDEFu),
                  .base = fields.f3(),
                  .specular = fields.f3(),
                  .parameter = fields.f()};
    r.medium = {.absorption = fields.f3(), .ior = fields.f(), .scattering = fields.f3(), .g = fields.f()};
    r.light = {.kind = fields.keep(21u),
               .p = fields.f3(),
               .e1 = fields.f3(),
               .e2 = fields.f3(),
               .radiance = fields.f3(),
               .spread = std::bit_cast<float>(fields.keep(floatBitsToUint(0x1p-9f))),
               .two_sided = fields.keep(1u),
               .pdf_area = fields.f(),
               .pmf = fields.f(),
               .error = fields.f()};
    r.lamp = {.node = fields.u(),
              .root = fields.u(),
              .first = fields.u(),
              .count = fields.u(),
              .alias = fields.u(),
              .mirrored = fields.u(),
              .area = fields.f(),
              .pmf = fields.f()};
    const auto entry = [&] { return AliasEntry{.threshold = fields.u(), .alias = fields.u()}; };
    r.light_even = entry();
    r.light_odd = entry();
    r.light_tree = {.centre = fields.f3(),
                    .radius = fields.f(),
                    .strength = fields.f(),
                    .axis = fields.u(),
                    .cone = fields.u(),
                    .at = fields.u()};
    r.light_trails = fields.u4();
    r.texel = {.radiance = fields.f3(), .pdf = fields.f()};
    r.texel_even = {.last_word = fields.u(), .range = fields.u()};
    r.texel_odd = {.last_word = fields.u(), .range = fields.u()};
    r.material_textures = {.base = fields.keep(0x2BCDEF01u),
                           .specular = fields.keep(0x3C4D5E6Fu),
                           .parameter = fields.keep(0x5E6F7081u),
                           .normal = fields.keep(0x4D3C2B1Au),
                           .bump = fields.keep(1u),
                           .normal_scale = fields.f(),
                           .opacity_texture = fields.keep(0x6F708192u),
                           .opacity = fields.f(),
                           .cutoff = fields.f(),
                           .vertex_colors = fields.keep(1u),
                           .culled = fields.keep(1u),
                           .catcher = fields.keep(CATCHER_REFLECTIONS),
                           .hidden = fields.keep(1u)};
    r.light_textures = {.primitive = fields.u(), .emission = fields.u(), .material = fields.u()};
    r.texture = {.first = fields.u(),
                 .size = {fields.keep(0xABCDu), fields.keep(0xFEDCu)},
                 .traits = fields.u(),
                 .row_u = fields.f3(),
                 .row_v = fields.f3()};
    r.texels = fields.u4();
    for (uvec4& word : r.attributes)
        word = fields.u4();
#define FLOAT(name, word, place) r.principled.name = fields.f();
#define VEC2(name, word) r.principled.name = fields.f2();
#define VEC3(name, word) r.principled.name = fields.f3();
#define UINT(name, word, place) r.principled.name = fields.u();
#include "shared/principled_record.inc"
    r.principled_image = {.texture = fields.u(), .values = fields.u(), .channels = fields.u2()};
    return r;
}

// Appends a record of 0xFF, so that a wrong stride shows, and then `record`.
template <size_t N>
void append_second(std::vector<uvec4>& out, const std::array<uvec4, N>& record) {
    out.insert(out.end(), N, uvec4(0xFFFFFFFFu));
    out.insert(out.end(), record.begin(), record.end());
}

GpuScene packed(const Records& r) {
    std::array<std::vector<uvec4>, ARRAY_COUNT> arrays;
    const auto array = [&](uint number) -> std::vector<uvec4>& { return arrays[number]; };
    append_second(array(ARRAY_NODES), pack(r.node));
    append_second(array(ARRAY_PRIMITIVES), pack(r.triangles));
    const auto disk = pack(r.disk);
    array(ARRAY_PRIMITIVES).insert(array(ARRAY_PRIMITIVES).end(), disk.begin(), disk.end());
    append_second(array(ARRAY_SURFACES), pack(r.surface));
    append_second(array(ARRAY_NORMALS), r.normals);
    append_second(array(ARRAY_MATERIALS), pack(r.material));
    append_second(array(ARRAY_MATERIALS), pack(r.principled));
    array(ARRAY_MATERIALS).push_back(pack(r.principled_image));
    append_second(array(ARRAY_MEDIA), pack(r.medium));
    append_second(array(ARRAY_LIGHTS), pack(r.light));
    append(array(ARRAY_LIGHTS), pack(r.lamp));
    append_second(array(ARRAY_LIGHT_ALIAS), pack(r.light_even, r.light_odd));
    append_second(array(ARRAY_LIGHT_TREE), pack(r.light_tree));
    append_second(array(ARRAY_LIGHT_TRAILS), std::array{r.light_trails});
    append_second(array(ARRAY_ENVIRONMENT), pack(r.texel));
    append_second(array(ARRAY_ENVIRONMENT_CDF), pack(r.texel_even, r.texel_odd));
    append_second(array(ARRAY_MATERIAL_TEXTURES), pack(r.material_textures));
    append_second(array(ARRAY_LIGHT_TEXTURES), pack(r.light_textures));
    append_second(array(ARRAY_TEXTURES), pack(r.texture));
    append_second(array(ARRAY_TEXELS), std::array{r.texels});
    append_second(array(ARRAY_ATTRIBUTES), r.attributes);
    GpuScene scene;
    std::ranges::move(arrays, scene.arrays.begin());
    return scene;
}

// Axes, the fold of the octahedron (z = 0), its edges (x = 0, y = 0) from both sides, and 100 000 random
// vectors.
std::vector<vec3> unit_vectors() {
    std::vector<vec3> vectors;
    for (const float x : {-1.0f, -1e-4f, -0.0f, 0.0f, 1e-4f, 1.0f}) {
        for (const float y : {-1.0f, -1e-4f, -0.0f, 0.0f, 1e-4f, 1.0f}) {
            for (const float z : {-1.0f, -1e-4f, -0.0f, 0.0f, 1e-4f, 1.0f}) {
                if (length(vec3(x, y, z)) > 0.5f) vectors.push_back(normalize(vec3(x, y, z)));
            }
        }
    }
    Random random(1);
    for (int i = 0; i < 100000; ++i)
        vectors.push_back(random.direction());
    return vectors;
}

}  // namespace

Evidence test_records(const vk::Device& device, SceneAccess access) {
    Fields fields;
    const Records records = filled(fields);
    assert(fields.words.size() == Result{}.words.size());
    const DeviceScene on_device(device, packed(records), access, records.parameters);
    KernelConstants constants;
    constants[CONSTANT_ATTRIBUTES] = ATTRIBUTES_ALL;
    constants[CONSTANT_TEXTURED] = TEXTURED_HIDDEN;
    const Result read =
        probe<Result>(device, kernels::records, std::vector<Item>(1), constants, &on_device)[0];
    Evidence evidence;
    for (size_t i = 0; i < fields.words.size(); ++i) {
        evidence.expect(read.words[i] == fields.words[i], [&] {
            return concat("word ", i, ", buffers: ", to_text(on_device.buffers().map()), ": ", read.words[i],
                          " instead of ", fields.words[i]);
        });
    }
    return evidence;
}

// A component of the octahedral map is off by h = 0.5 / 32767 at most, so z by 2 h, and the point on the
// octahedron by sqrt(6) h. That point is at least 1/sqrt(3) away from the centre: an angle of sqrt(18) h. The
// roundings of both sides, some 8 of 2^-24 each, are multiplied by sqrt(18) as well.
Evidence test_octahedral_normals(const vk::Device& device) {
    const std::vector<vec3> vectors = unit_vectors();
    std::vector<uvec4> items;
    for (const vec3 v : vectors)
        items.emplace_back(pack_octahedral(v), 0, 0, 0);
    const std::vector<vec3> decoded = probe<vec3>(device, kernels::octahedral, items);

    const double bound = std::sqrt(18.0) * (0.5 / 32767.0 + 8 * 0x1p-24);
    Evidence evidence;
    for (size_t i = 0; i < vectors.size(); ++i) {
        const glm::dvec3 a(normalize(glm::dvec3(vectors[i]))), b(decoded[i]);
        const double angle = std::atan2(length(cross(a, b)), dot(a, b));
        evidence.expect(angle <= bound && std::abs(length(b) - 1.0) <= 0x1p-20, [&] {
            return concat("normal ", a.x, ' ', a.y, ' ', a.z, " became ", b.x, ' ', b.y, ' ', b.z);
        });
    }
    return evidence;
}

}  // namespace candela
