// From rows through polygons to a mesh.
#include "load/ply/ply.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "load/ply/ply_polygons.h"
#include "load/ply/ply_rows.h"
#include "load/ply/ply_vertex.h"
#include "load/quote.h"
#include "scene/default_view.h"
#include "scene/polygon.h"
#include "scene/scene_builder.h"

namespace candela {
namespace {

// The elements that hold indices of vertices. Models of the Stanford archive have strips.
constexpr std::string_view FACE = "face", STRIPS = "tristrips";

bool has_rows(const PlyHeader& header, std::string_view name) {
    const PlyElement* element = header.find(name);
    return element != nullptr && element->rows > 0;
}

const PlyProperty* find_indices(const PlyElement& face) {
    const PlyProperty* indices = face.find("vertex_indices");
    return indices ? indices : face.find("vertex_index");
}

// Throws Error unless the file has a mesh.
void check_header(const PlyHeader& header, const std::string& file) {
    const auto fail = [&](const PlyElement& element, const std::string& needs) {
        throw Error(file + ':' + std::to_string(element.line) + ": the element " + quote(element.name) +
                    " needs " + needs);
    };
    if (!has_rows(header, "vertex"))
        throw Error(file +
                    ": the file has no rows of the element \"vertex\"; a mesh needs vertices and faces");
    const PlyElement& vertex = *header.find("vertex");
    if (!has_rows(header, FACE) && !has_rows(header, STRIPS)) {
        throw Error(file + (vertex.find("f_dc_0") != nullptr
                                ? ": the file holds Gaussian splats, which have no surface; give a mesh"
                                : ": the file has points, but no faces; make a mesh of them, for example "
                                  "with MeshLab"));
    }
    for (const std::string_view name : {"x", "y", "z"}) {
        const PlyProperty* property = vertex.find(name);
        if (!property || property->length) fail(vertex, "the property " + quote(name) + ", a number");
    }
    for (const std::string_view name : {FACE, STRIPS}) {
        if (!has_rows(header, name)) continue;
        const PlyElement& element = *header.find(name);
        const PlyProperty* indices = find_indices(element);
        if (!indices || !indices->length || !is_integer(indices->type))
            fail(element, "the property \"vertex_indices\", a list of integers");
    }
}

template <class Rows>
class BodyReader {
  public:
    BodyReader(const PlyHeader& header, const PlyVertexFields& fields, Rows rows, PlyPosition& position)
        : header_(header), fields_(fields), rows_(rows), position_(position) {}

    PlyPolygons read(std::vector<std::string>& warnings) {
        for (const PlyElement& element : header_.elements) {
            const size_t row_size = element.min_size(header_.format);
            if (row_size > 0) read_element(element, row_size);
        }
        if (const size_t bytes = rows_.trailing_bytes()) {
            warnings.push_back(position_.file + ": ignored " + std::to_string(bytes) +
                               (bytes == 1 ? " byte" : " bytes") + " after the last row");
        }
        if (small_faces_ > 0) {
            warnings.push_back(position_.file + ": left out " + std::to_string(small_faces_) +
                               (small_faces_ == 1 ? " face" : " faces") + " of fewer than 3 corners");
        }
        return std::move(polygons_);
    }

  private:
    void read_element(const PlyElement& element, size_t row_size) {
        // Checked before memory is reserved for the rows. The last line of a text may lack its end.
        if (element.rows > (rows_.bytes_left() + 1) / row_size) {
            throw Error(position_.file + ':' + std::to_string(element.line) + ": " +
                        std::to_string(element.rows) + " rows of " + quote(element.name) +
                        " do not fit into the remaining " + std::to_string(rows_.bytes_left()) +
                        " bytes; is the file cut off?");
        }
        const bool is_vertex = element.name == "vertex", is_strip = element.name == STRIPS;
        const PlyProperty* indices = is_strip || element.name == FACE ? find_indices(element) : nullptr;
        if (is_vertex) begin_vertices(element);
        if (indices) begin_faces(element, *indices);
        position_.element = element.name;
        for (position_.row = 0; position_.row < element.rows; ++position_.row) {
            rows_.begin_row();
            if (is_vertex) {
                read_vertex(element);
            } else {
                for (const PlyProperty& property : element.properties) {
                    if (&property == indices) {
                        is_strip ? read_strips(property) : read_face(property);
                    } else {
                        skip(property);
                    }
                }
            }
            rows_.end_row();
        }
    }

    void begin_vertices(const PlyElement& vertex) {
        polygons_.positions.reserve(vertex.rows);
        if (fields_.has_normals) polygons_.normals.reserve(vertex.rows);
        if (fields_.has_uvs) polygons_.uvs.reserve(vertex.rows);
        if (fields_.has_colors) polygons_.colors.reserve(vertex.rows);
    }

    // Reserves memory for this many triangles, or for as many as the rest of the file can hold.
    void begin_faces(const PlyElement& face, const PlyProperty& indices) {
        const size_t min_size = header_.format == PlyFormat::ascii ? 2 : size_of(indices.type);
        const size_t max = rows_.bytes_left() / min_size;
        polygons_.corners.reserve(std::min<size_t>(3 * face.rows, max));
        polygons_.sizes.reserve(std::min<size_t>(face.rows, max / 3));
    }

    void read_vertex(const PlyElement& vertex) {
        PlyVertex v{};
        v[PLY_ALPHA] = 1.0;
        for (size_t i = 0; i < fields_.fields.size(); ++i) {
            const PlyProperty& property = vertex.properties[i];
            const size_t field = fields_.fields[i];
            if (field == PLY_SKIPPED) {
                skip(property);
            } else {
                v[field] = vertex_number(property.type, field, rows_.next(property.type));
            }
        }
        const auto three = [&](size_t first) { return dvec3(v[first], v[first + 1], v[first + 2]); };
        polygons_.positions.push_back(three(PLY_X));
        if (fields_.has_normals) polygons_.normals.emplace_back(three(PLY_NX));
        if (fields_.has_uvs) polygons_.uvs.emplace_back(v[PLY_U], v[PLY_U + 1]);
        if (fields_.has_colors) polygons_.colors.emplace_back(vec3(three(PLY_RED)), float(v[PLY_ALPHA]));
    }

    void read_face(const PlyProperty& indices) {
        const double corners = read_length(indices);
        if (corners > double(MAX_CORNERS)) {
            position_.fail("has " + shown(number_text(corners, 10)) + " corners, but at most " +
                           std::to_string(MAX_CORNERS) + " are read; cut it into triangles");
        }
        for (double i = 0.0; i < corners; ++i)
            polygons_.corners.push_back(vertex_at(rows_.next(indices.type)));
        if (corners < 3.0) {
            polygons_.corners.resize(polygons_.corners.size() - size_t(corners));
            ++small_faces_;
        } else {
            polygons_.sizes.push_back(uint32_t(corners));
        }
    }

    // Strips of triangles, with -1 between two of them. Every second triangle of a strip runs clockwise.
    void read_strips(const PlyProperty& indices) {
        const double numbers = read_length(indices);
        std::array<uint32_t, 3> t{};  // The last corners.
        size_t corners = 0;           // Corners of the strip so far.
        for (double i = 0.0; i < numbers; ++i) {
            const double index = rows_.next(indices.type);
            if (index == -1.0) {
                corners = 0;
                continue;
            }
            t = {t[1], t[2], vertex_at(index)};
            // Repeated corners turn a strip around.
            if (++corners < 3 || t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
            polygons_.sizes.push_back(3);
            for (const size_t corner : corners % 2 == 1 ? std::array{0, 1, 2} : std::array{1, 0, 2})
                polygons_.corners.push_back(t[corner]);
        }
    }

    double read_length(const PlyProperty& list) {
        const double length = rows_.next(*list.length);
        if (length < 0.0) position_.fail("has a list of " + shown(number_text(length, 10)) + " numbers");
        return length;
    }

    uint32_t vertex_at(double index) const {
        if (index >= 0.0 && index < double(vertices_)) return uint32_t(index);
        position_.fail("uses vertex " + shown(number_text(index, 10)) + ", but the vertices are 0 to " +
                       std::to_string(vertices_ - 1));
    }

    void skip(const PlyProperty& property) {
        const double numbers = property.length ? read_length(property) : 1.0;
        for (double i = 0.0; i < numbers; ++i)
            rows_.next(property.type);
    }

    const PlyHeader& header_;
    uint64_t vertices_ = header_.find("vertex")->rows;
    const PlyVertexFields& fields_;
    Rows rows_;
    PlyPosition& position_;
    PlyPolygons polygons_;
    size_t small_faces_ = 0;  // Faces of fewer than 3 corners.
};

// Warns of appearance that is not read: colours and texture coordinates of faces, and textures.
void warn_of_looks(const PlyHeader& header, const std::string& file, std::vector<std::string>& warnings) {
    const PlyElement* face = header.find(FACE);
    const auto has = [&](const char* name) { return face != nullptr && face->find(name) != nullptr; };
    if (has("red") && has("green") && has("blue"))
        warnings.push_back(file + ": ignored the colours of faces; save them as those of vertices");
    if (has("texcoord")) {
        warnings.push_back(file +
                           ": ignored the texture coordinates of faces (texcoord); save them as those of "
                           "vertices");
    }
    if (!header.textures.empty()) {
        warnings.push_back(file + ": ignored the texture " + shown(quote(header.textures.front())) +
                           (header.textures.size() == 1 ? "" : " and others") +
                           "; name it in a material of a scene file");
    }
}

TriangleMesh mesh_of(PlyPolygons polygons) {
    TriangleMesh mesh{.normals = std::move(polygons.normals),
                      .uv0 = std::move(polygons.uvs),
                      .colors = std::move(polygons.colors)};
    set_positions(mesh, std::move(polygons.positions));
    mesh.triangles.reserve(polygons.corners.size() - 2 * polygons.sizes.size());
    std::span<const uint32_t> rest = polygons.corners;
    for (const uint32_t size : polygons.sizes) {
        add_polygon(mesh, rest.first(size));
        rest = rest.subspan(size);
    }
    return mesh;
}

}  // namespace

TriangleMesh load_ply(const std::filesystem::path& file, MeshNormals normals, const FileReach& reach,
                      std::vector<std::string>& warnings) {
    const std::string bytes = reach.read(file);
    PlyPosition position{file.string(), 0, "", 0};
    const PlyHeader header = read_ply_header(bytes, position.file);
    check_header(header, position.file);
    warn_of_looks(header, position.file, warnings);
    const PlyElement& vertex = *header.find("vertex");
    const PlyVertexFields fields =
        find_vertex_fields(vertex, normals == MeshNormals::file, position.file, warnings);
    const std::string_view body = std::string_view(bytes).substr(header.size);
    const auto read = [&](auto rows) { return BodyReader(header, fields, rows, position).read(warnings); };
    if (header.format == PlyFormat::ascii) position.line = header.lines;
    PlyPolygons polygons = header.format == PlyFormat::ascii
                               ? read(PlyAsciiRows(body, position))
                               : read(PlyBinaryRows(body, header.format, position));
    finish_vertices(polygons, position.file, warnings);
    TriangleMesh mesh = mesh_of(std::move(polygons));
    if (normals == MeshNormals::smooth) smooth_normals(mesh);
    const size_t coarse = vertex.find("x")->type == PlyType::float32 ? count_coarse_triangles(mesh) : 0;
    if (is_too_coarse(coarse, mesh.triangles.size())) {
        warnings.push_back(
            file.string() + ": " + std::to_string(coarse) + " of " + std::to_string(mesh.triangles.size()) +
            " triangles are smaller than 16 steps of the file's 32-bit coordinates; write x, y "
            "and z as doubles, or nearer to 0");
    }
    return mesh;
}

Scene load_ply_scene(const std::filesystem::path& file) {
    Scene scene;
    SceneBuilder builder(scene);
    TriangleMesh mesh = load_ply(file, MeshNormals::file, FileReach(file), scene.warnings);
    const std::string name = file.filename().string();
    builder.add_file_appearance(name, default_material(!mesh.colors.empty()), std::nullopt);
    builder.begin_object(file.stem().string());
    builder.add_mesh(file.string(), *builder.find_file_appearance(name), Transform(), std::move(mesh));
    scene.files.push_back(file);
    add_default_view(scene);
    return scene;
}

}  // namespace candela
