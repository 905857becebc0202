// Ref: Khronos, "KHR_draco_mesh_compression".
#include "load/gltf/draco.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <utility>

#include <draco/compression/decode.h>

#include "base/memory_budget.h"
#include "base/text.h"
#include "load/gltf/draco_header.h"
#include "load/quote.h"

namespace candela::gltf {
namespace {

constexpr const char* DAMAGED = "; copy or export the file again";

// The densest data hold regular grids of flat triangles: a million of them take 37 kB.
constexpr uint64_t MOST_TRIANGLES_PER_BYTE = 512;

// What decoding may allocate: for each vertex and each triangle, for the mesh and as much for each attribute
// (a third of this is used), and beside them. Draco runs some loops as often as the data say, but only after
// it has made room for a bit of each turn: so this bounds the time, too.
constexpr uint64_t BYTES_PER_ELEMENT = 64;
constexpr uint64_t BYTES_BESIDE = uint64_t(1) << 20;

// Draco makes room for as much as the header states before it reads further.
void check_counts(const Node& place, uint32_t vertices, uint32_t triangles, const DracoLimits& limits) {
    if (vertices <= limits.vertices && triangles <= limits.triangles) return;
    place.fail(concat("the data hold ", vertices, " vertices and ", triangles,
                      " triangles, but the primitive's accessors only ", limits.vertices, " and ",
                      limits.triangles, DAMAGED));
}

DracoHeader checked_header(const Node& place, std::span<const std::byte> bytes, const DracoLimits& limits) {
    std::string problem;
    const auto header = read_draco_header(bytes, problem);
    if (!header) place.fail(problem + DAMAGED);
    check_counts(place, header->vertices, header->faces, limits);
    if (header->faces > MOST_TRIANGLES_PER_BYTE * bytes.size()) {
        place.fail(
            concat(bytes.size(), " compressed bytes cannot hold ", header->faces, " triangles", DAMAGED));
    }
    return *header;
}

std::unique_ptr<draco::Mesh> decode_mesh(const Node& place, std::span<const std::byte> bytes,
                                         uint64_t budget) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    std::string problem;
    try {
        const MemoryBudget limited(budget);
        auto mesh = draco::Decoder().DecodeMeshFromBuffer(&buffer);
        if (mesh.ok()) return std::move(mesh).value();
        problem = mesh.status().error_msg_string();
    } catch (const BudgetExceeded&) {
        place.fail(std::string("Draco needs more memory for the data than such a mesh takes") + DAMAGED);
    }
    place.fail(concat("Draco cannot decode the data (", quote(problem), ")", DAMAGED));
}

std::vector<uint32_t> corners_of(const Node& place, const draco::Mesh& mesh) {
    std::vector<uint32_t> corners;
    corners.reserve(size_t(mesh.num_faces()) * 3);
    bool valid = true;
    for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face) {
        for (const draco::PointIndex& point : mesh.face(face)) {
            valid = valid && point.value() < mesh.num_points();
            corners.push_back(point.value());
        }
    }
    if (!valid) place.fail(std::string("a triangle has a vertex that is none of the mesh's") + DAMAGED);
    return corners;
}

draco::DataType draco_type(Component component) {
    switch (component) {
        case Component::int8:
            return draco::DT_INT8;
        case Component::uint8:
            return draco::DT_UINT8;
        case Component::int16:
            return draco::DT_INT16;
        case Component::uint16:
            return draco::DT_UINT16;
        case Component::uint32:
            return draco::DT_UINT32;
        case Component::float32:
            return draco::DT_FLOAT32;
    }
    return draco::DT_INVALID;
}

// The vertices' values of an attribute, with numbers of that type.
class Elements {
  public:
    Elements(const Node& place, const draco::Mesh& mesh, const DracoAttribute& wanted,
             const draco::PointAttribute& attribute)
        : place_(place), mesh_(mesh), wanted_(wanted), attribute_(attribute) {}

    std::vector<std::byte> read() const {
        switch (wanted_.component) {
            case Component::int8:
                return as<int8_t>();
            case Component::uint8:
                return as<uint8_t>();
            case Component::int16:
                return as<int16_t>();
            case Component::uint16:
                return as<uint16_t>();
            case Component::uint32:
                return as<uint32_t>();
            case Component::float32:
                return as<float>();
        }
        return {};
    }

  private:
    [[noreturn]] void fail(const char* what) const {
        place_.fail(concat("the attribute ", quote(wanted_.name), " ", what, DAMAGED));
    }

    // Where the value of a vertex is.
    draco::AttributeValueIndex value_of(uint32_t vertex) const {
        const auto value = attribute_.mapped_index(draco::PointIndex(vertex));
        if (value.value() >= attribute_.size()) fail("lacks the value of a vertex");
        return value;
    }

    template <class T>
    std::vector<std::byte> as() const {
        const size_t size = sizeof(T) * wanted_.width;
        std::vector<std::byte> result(size * mesh_.num_points());
        if (!attribute_.is_mapping_identity() && attribute_.indices_map_size() < mesh_.num_points())
            fail("lacks the value of a vertex");
        if (attribute_.data_type() == draco_type(wanted_.component)) {
            copy(size, result);
            return result;
        }
        std::array<T, 4> numbers{};
        for (uint32_t i = 0; i < mesh_.num_points(); ++i) {
            if (!attribute_.ConvertValue(value_of(i), int8_t(wanted_.width), numbers.data()))
                fail("has numbers that do not fit into its accessor's type");
            std::memcpy(&result[i * size], numbers.data(), size);
        }
        return result;
    }

    void copy(size_t size, std::vector<std::byte>& result) const {
        const draco::DataBuffer& buffer = *attribute_.buffer();
        const auto stride = uint64_t(attribute_.byte_stride());
        const auto first = uint64_t(attribute_.byte_offset());
        for (uint32_t i = 0; i < mesh_.num_points(); ++i) {
            const uint64_t begin = first + stride * value_of(i).value();
            if (begin + size > buffer.data_size()) fail("lacks the value of a vertex");
            std::memcpy(&result[i * size], buffer.data() + begin, size);
        }
    }

    const Node& place_;
    const draco::Mesh& mesh_;
    const DracoAttribute& wanted_;
    const draco::PointAttribute& attribute_;
};

std::vector<std::byte> elements_of(const Node& place, const draco::Mesh& mesh, const DracoAttribute& wanted) {
    const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(wanted.id);
    if (attribute == nullptr || attribute->buffer() == nullptr) {
        place.fail(concat("the data have no attribute ", wanted.id, " for ", quote(wanted.name), DAMAGED));
    }
    if (attribute->num_components() != wanted.width) {
        place.fail(concat("the attribute ", quote(wanted.name), " has ", int(attribute->num_components()),
                          " numbers for a vertex, but its accessor ", wanted.width, DAMAGED));
    }
    return Elements(place, mesh, wanted, *attribute).read();
}

}  // namespace

DracoMesh decode_draco(const Node& place, std::span<const std::byte> bytes, const DracoLimits& limits,
                       const std::vector<DracoAttribute>& attributes) {
    const DracoHeader header = checked_header(place, bytes, limits);
    const uint64_t faces = header.faces, elements = faces + std::min<uint64_t>(limits.vertices, 3 * faces);
    const uint64_t budget =
        BYTES_BESIDE + 8 * bytes.size() + BYTES_PER_ELEMENT * elements * (2 + attributes.size());
    const std::unique_ptr<draco::Mesh> mesh = decode_mesh(place, bytes, budget);
    check_counts(place, mesh->num_points(), mesh->num_faces(), limits);
    DracoMesh result{.vertices = mesh->num_points(), .corners = corners_of(place, *mesh)};
    for (const DracoAttribute& attribute : attributes)
        result.attributes.emplace(attribute.name, elements_of(place, *mesh, attribute));
    return result;
}

}  // namespace candela::gltf
