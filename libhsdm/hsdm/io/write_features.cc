#include "hsdm/io/write_features.hh"

#include "hsdm/features/features.hh"
#include "hsdm/io/format_chunks.hh"
#include "hsdm/io/text.hh"
#include "hsdm/mesh/vertex_normals.hh"

#include <utility>

namespace hsdm {
namespace {

using Segment = std::pair<Vec3, Vec3>;

struct Features {
    std::vector<Segment> edges;
    std::vector<Vec3> corners;
};

/// In the mesh's order, as feature_lines().
Features features_of(const PolyMesh& mesh, const Vec3& shift) {
    Features found;
    for (const auto e : mesh.edges())
        if (mesh.status(e).feature())
            found.edges.emplace_back(mesh.point(e.v0()) - shift, mesh.point(e.v1()) - shift);
    OpenMesh::VPropHandleT<std::uint8_t> classes;
    if (!mesh.get_property_handle(classes, vertex_class_property)) return found;
    for (const auto v : mesh.vertices())
        if (mesh.property(classes, v) == static_cast<std::uint8_t>(VertexClass::corner))
            found.corners.push_back(mesh.point(v) - shift);
    return found;
}

void append_place(const Vec3& p, std::string& text) {
    for (const double x : p) {
        append_number(text, x);
        text += ' ';
    }
}

std::string as_obj(const Features& features) {
    std::string vertices = "# hsdm: sharp edges as lines, corners as points\n", elements = "g sharp_edges\n";
    std::size_t count = 0;
    const auto add = [&](const Vec3& p) {
        vertices += "v ";
        append_place(p, vertices);
        vertices.back() = '\n';
        return std::to_string(++count);
    };
    for (const auto& [from, to] : features.edges) {
        const std::string first = add(from);
        elements += "l " + first + ' ' + add(to) + '\n';
    }
    if (!features.corners.empty()) elements += "g corners\n";
    for (const Vec3& corner : features.corners) elements += "p " + add(corner) + '\n';
    return vertices + elements;
}

/// Pairs of lines, a code and its value.
class DxfText {
public:
    void put(int code, const std::string& value) { text_ += std::to_string(code) + '\n' + value + '\n'; }
    /// Codes 10, 20 and 30, or those of another place.
    void put(int first_code, const Vec3& place) {
        for (unsigned k = 0; k < 3; ++k) {
            std::string number;
            append_number(number, place[k]);
            put(first_code + 10 * static_cast<int>(k), number);
        }
    }
    void begin_section(const char* name) {
        put(0, "SECTION");
        put(2, name);
    }
    void put_layer(const char* name, int color) {
        put(0, "LAYER");
        put(2, name);
        put(70, "0");
        put(62, std::to_string(color));
        put(6, "CONTINUOUS");
    }
    std::string take() && { return std::move(text_); }

private:
    std::string text_;
};

constexpr const char *edge_layer = "SHARP_EDGES", *corner_layer = "CORNERS";

std::string as_dxf(const Features& features, LengthUnit unit) {
    DxfText dxf;
    dxf.put(999, "hsdm: sharp edges and corners, units: "
                     + std::string(unit == LengthUnit::none ? "those of the scan" : name_of(unit)));
    dxf.begin_section("HEADER");
    dxf.put(9, "$ACADVER");
    dxf.put(1, "AC1009");
    dxf.put(0, "ENDSEC");
    dxf.begin_section("TABLES");
    dxf.put(0, "TABLE");
    dxf.put(2, "LAYER");
    dxf.put(70, "2");
    dxf.put_layer(edge_layer, 1);
    dxf.put_layer(corner_layer, 5);
    dxf.put(0, "ENDTAB");
    dxf.put(0, "ENDSEC");
    dxf.begin_section("ENTITIES");
    for (const auto& [from, to] : features.edges) {
        dxf.put(0, "LINE");
        dxf.put(8, edge_layer);
        dxf.put(10, from);
        dxf.put(11, to);
    }
    for (const Vec3& corner : features.corners) {
        dxf.put(0, "POINT");
        dxf.put(8, corner_layer);
        dxf.put(10, corner);
    }
    dxf.put(0, "ENDSEC");
    dxf.put(0, "EOF");
    return std::move(dxf).take();
}

} // namespace

FeatureFormat feature_format(const std::string& path) {
    const std::string name = io::lower(path);
    if (name.ends_with(".obj")) return FeatureFormat::obj;
    return name.ends_with(".dxf") ? FeatureFormat::dxf : FeatureFormat::text;
}

void write_features(const std::string& path, const PolyMesh& mesh, FeatureFormat format, LengthUnit unit,
                    const Vec3& shift) {
    if (format == FeatureFormat::text) return write_text(path, feature_lines(mesh, shift));
    const Features features = features_of(mesh, shift);
    write_text(path, format == FeatureFormat::obj ? as_obj(features) : as_dxf(features, unit));
}

} // namespace hsdm
