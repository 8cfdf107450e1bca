// glTF 2.0 in its binary form: a chunk of JSON, a chunk of numbers.

#include "hsdm/errors.hh"
#include "hsdm/io/float_precision.hh"
#include "hsdm/io/format_chunks.hh"
#include "hsdm/io/mesh_document.hh"
#include "hsdm/io/mesh_writers.hh"
#include "hsdm/io/split_mesh.hh"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hsdm {
namespace {

using Json = nlohmann::ordered_json;

// Numbers of the format's own.
constexpr int type_uint16 = 5123, type_uint32 = 5125, type_float = 5126;
constexpr int array_buffer = 34962, element_array_buffer = 34963;
constexpr std::uint32_t chunk_json = 0x4e4f534a, chunk_binary = 0x004e4942;

struct GlbMesh {
    const SplitMesh& mesh;
    Vec3 shift{0, 0, 0};
    double scale = 1; ///< metres in a unit
    std::size_t triangles = 0;
    bool has_normals = false, has_colors = false;

    std::size_t size() const { return mesh.vertices(); }
    std::array<float, 3> place(const Vec3& position) const {
        std::array<float, 3> at;
        for (unsigned k = 0; k < 3; ++k) at[k] = static_cast<float>((position[k] - shift[k]) * scale);
        return at;
    }
};

/// Red, green, blue and alpha, which may be missing.
using Colors = std::array<const VertexProperty*, 4>;

Colors colors_of(const PolygonMesh& mesh) {
    Colors colors;
    std::ranges::transform(color_properties, colors.begin(), [&](const char* name) {
        const auto found = std::ranges::find(mesh.properties, name, &VertexProperty::name);
        const bool is_color = found != mesh.properties.end() && found->type == VertexProperty::Type::uint8;
        return is_color ? &*found : nullptr;
    });
    return colors;
}

/// `positions` and `triangles`: of the mesh before it was cut.
GlbMesh prepare(const SplitMesh& mesh, std::span<const Vec3> positions, std::size_t triangles,
                LengthUnit unit) {
    GlbMesh glb{mesh};
    if (unit != LengthUnit::none) glb.scale = metres_of(unit);
    if (moved_by_floats(positions) > most_moved_by_floats) glb.shift = recentring_shift(positions);
    glb.triangles = triangles;
    mesh.show_vertices(0, 0, [&](const PolygonMesh& none, std::size_t, std::size_t) {
        const Colors colors = colors_of(none);
        glb.has_normals = mesh.has_normals();
        glb.has_colors = colors[0] && colors[1] && colors[2];
    });
    return glb;
}

/// Floats have no numbers above their range, and fewer digits the farther a mesh is below it.
void check_lengths(const GlbMesh& glb, const std::string& path) {
    using Floats = std::numeric_limits<float>;
    double largest = 0;
    for (const Vec3& p : glb.mesh.positions()) largest = std::max(largest, (p - glb.shift).max_abs());
    const double farthest = std::max(largest, glb.shift.max_abs()) * glb.scale;
    largest *= glb.scale;
    if (farthest > double{Floats::max()} || (largest > 0 && largest < double{Floats::min()}))
        throw Error(path, "cannot write: lengths beyond a float; write PLY");
}

/// Colours of a scan are those of a screen, the format's are proportional to light. In 16 bits none of the
/// 256 becomes another.
std::uint16_t light_of(double value) {
    const double s = std::clamp(value / 255, 0.0, 1.0);
    const double light = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
    return static_cast<std::uint16_t>(std::lround(light * 65535));
}

/// The arrays in the order that they stand in.
class Layout {
public:
    /// Returns the number of the accessor.
    int add(std::size_t count, std::size_t element, int target, int type, const char* shape) {
        const int view = static_cast<int>(views.size());
        views.push_back(
            {{"buffer", 0}, {"byteOffset", bytes}, {"byteLength", count * element}, {"target", target}});
        accessors.push_back(
            {{"bufferView", view}, {"componentType", type}, {"count", count}, {"type", shape}});
        bytes += count * element;
        return view;
    }

    Json views = Json::array(), accessors = Json::array();
    std::size_t bytes = 0; ///< each array's is a multiple of four
};

/// The bounds that the format asks for, of the floats as they are stored.
void add_bounds(const GlbMesh& glb, Json& accessor) {
    std::array<float, 3> least, most;
    least.fill(std::numeric_limits<float>::max());
    most.fill(std::numeric_limits<float>::lowest());
    for (const Vec3& p : glb.mesh.positions()) {
        const auto at = glb.place(p);
        for (unsigned k = 0; k < 3; ++k) {
            least[k] = std::min(least[k], at[k]);
            most[k] = std::max(most[k], at[k]);
        }
    }
    accessor["min"] = std::array<double, 3>{least[0], least[1], least[2]};
    accessor["max"] = std::array<double, 3>{most[0], most[1], most[2]};
}

Json json_of(const GlbMesh& glb, std::size_t& bytes) {
    Layout layout;
    Json attributes;
    attributes["POSITION"] = layout.add(glb.size(), 12, array_buffer, type_float, "VEC3");
    add_bounds(glb, layout.accessors[0]);
    if (glb.has_normals) attributes["NORMAL"] = layout.add(glb.size(), 12, array_buffer, type_float, "VEC3");
    if (glb.has_colors) {
        attributes["COLOR_0"] = layout.add(glb.size(), 8, array_buffer, type_uint16, "VEC4");
        layout.accessors.back()["normalized"] = true;
    }
    const int indices = layout.add(3 * glb.triangles, 4, element_array_buffer, type_uint32, "SCALAR");
    bytes = layout.bytes;

    // The format's y points up, a scan's z: the outer node turns one into the other, by a quarter about x.
    Json part = {{"name", "part"}, {"mesh", 0}};
    if (glb.shift != Vec3(0, 0, 0))
        part["translation"] = {glb.shift[0] * glb.scale, glb.shift[1] * glb.scale, glb.shift[2] * glb.scale};
    const double half = std::sqrt(0.5);
    const Json up = {{"name", "z up"}, {"rotation", {-half, 0.0, 0.0, half}}, {"children", {1}}};
    const Json material = {{"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 0.6}}},
                           {"doubleSided", true}};
    const Json primitive = {{"attributes", attributes}, {"indices", indices}, {"material", 0}, {"mode", 4}};
    return {{"asset", {{"version", "2.0"}, {"generator", "hsdm"}}},
            {"scene", 0},
            {"scenes", Json::array({{{"nodes", {0}}}})},
            {"nodes", Json::array({up, part})},
            {"meshes", Json::array({{{"primitives", Json::array({primitive})}}})},
            {"materials", Json::array({material})},
            {"accessors", layout.accessors},
            {"bufferViews", layout.views},
            {"buffers", Json::array({{{"byteLength", layout.bytes}}})}};
}

void write_arrays(AtomicFile& file, const GlbMesh& glb) {
    const auto write_vertices = [&](auto put) {
        write_chunks(file, glb.mesh.elements(), [&](std::string& out, std::size_t begin, std::size_t end) {
            glb.mesh.show_vertices(begin, end,
                                   [&](const PolygonMesh& mesh, std::size_t first, std::size_t last) {
                                       const Colors colors = colors_of(mesh);
                                       for (std::size_t v = first; v < last; ++v) put(out, mesh, colors, v);
                                   });
        });
    };
    write_vertices([&](std::string& out, const PolygonMesh& mesh, const Colors&, std::size_t v) {
        for (const float x : glb.place(mesh.positions[v])) append_bytes(out, x);
    });
    if (glb.has_normals)
        write_vertices([](std::string& out, const PolygonMesh& mesh, const Colors&, std::size_t v) {
            for (const double x : mesh.normals[v]) append_bytes(out, static_cast<float>(x));
        });
    if (glb.has_colors)
        write_vertices([](std::string& out, const PolygonMesh&, const Colors& colors, std::size_t v) {
            for (std::size_t i = 0; i < 3; ++i) append_bytes(out, light_of(colors[i]->values[v]));
            const double alpha = colors[3] ? colors[3]->values[v] : 255;
            append_bytes(out, static_cast<std::uint16_t>(std::lround(alpha * 257)));
        });
    write_chunks(file, glb.mesh.facets(), [&](std::string& out, std::size_t begin, std::size_t end) {
        std::vector<Triangle> triangles;
        glb.mesh.append_triangles(begin, end, triangles);
        for (const Triangle& corners : triangles)
            for (const Index v : corners) append_bytes(out, v);
    });
}

void write_split(AtomicFile& file, const std::string& path, const GlbMesh& glb) {
    check_lengths(glb, path);
    std::size_t bytes = 0;
    std::string json = json_of(glb, bytes).dump();
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::size_t total = 12 + 8 + json.size() + 8 + bytes;
    if (total > std::numeric_limits<std::uint32_t>::max())
        throw Error(path, "cannot write: GLB files have less than 4 GiB, this one would have "
                              + std::to_string(total) + " bytes; write PLY");
    std::string head = "glTF";
    append_bytes(head, std::uint32_t{2});
    append_bytes(head, static_cast<std::uint32_t>(total));
    append_bytes(head, static_cast<std::uint32_t>(json.size()));
    append_bytes(head, chunk_json);
    head += json;
    append_bytes(head, static_cast<std::uint32_t>(bytes));
    append_bytes(head, chunk_binary);
    file.write(head);
    write_arrays(file, glb);
}

} // namespace

void write_glb(AtomicFile& file, const std::string& path, const PolygonMesh& mesh, LengthUnit unit) {
    const WholeSplitMesh split(mesh);
    write_split(file, path, prepare(split, mesh.positions, counts_of(mesh).triangles, unit));
}

void write_glb(AtomicFile& file, const std::string& path, const LinkedMesh& mesh, LengthUnit unit) {
    const SplitStretches split(mesh);
    write_split(file, path, prepare(split, mesh.facets.positions, counts_of(mesh.facets).triangles, unit));
}

} // namespace hsdm
