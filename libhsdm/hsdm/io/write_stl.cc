#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/io/format_chunks.hh"
#include "hsdm/io/mesh_document.hh"
#include "hsdm/mesh/triangulate.hh"

#include <cmath>

namespace hsdm {
namespace {

Vec3 unit_normal(const std::vector<Vec3>& p, const Triangle& t) {
    Box box;
    for (Index v : t) box.add(p[v]);
    const double unit = CloudFrame(box).unit();
    const Vec3 origin = p[t[0]] / unit;
    const Vec3 n = (p[t[1]] / unit - origin) % (p[t[2]] / unit - origin);
    const double length = n.norm();
    return length > 0 && std::isfinite(length) ? n / length : Vec3(0, 0, 0);
}

/// act(corners) for all triangles of facets begin .. end - 1.
template <class Act>
void for_each_triangle(const PolygonMesh& mesh, std::size_t begin, std::size_t end, const Act& act) {
    std::vector<Triangle> cut;
    for (std::size_t f = begin; f < end; ++f) {
        cut.clear();
        append_triangles(mesh, f, cut);
        for (const Triangle& corners : cut) act(corners);
    }
}

void append_text(std::string& out, const PolygonMesh& mesh, std::size_t begin, std::size_t end) {
    const auto put = [&](const char* keyword, const Vec3& v) {
        out += keyword;
        for (double x : v) append_number(out += ' ', x);
        out += '\n';
    };
    for_each_triangle(mesh, begin, end, [&](const Triangle& t) {
        put("facet normal", unit_normal(mesh.positions, t));
        out += "outer loop\n";
        for (Index v : t) put("vertex", mesh.positions[v]);
        out += "endloop\nendfacet\n";
    });
}

void append_binary(std::string& out, const PolygonMesh& mesh, std::size_t begin, std::size_t end) {
    const auto put = [&](const Vec3& v) {
        for (double x : v) append_bytes(out, static_cast<float>(x));
    };
    for_each_triangle(mesh, begin, end, [&](const Triangle& t) {
        put(unit_normal(mesh.positions, t));
        for (Index v : t) put(mesh.positions[v]);
        append_bytes(out, std::uint16_t{0});
    });
}

std::string binary_head(const MeshCounts& counts) {
    std::string head = "binary STL by hsdm"; // must not begin with "solid": readers take that for text
    head.resize(80, ' ');
    append_bytes(head, static_cast<std::uint32_t>(counts.triangles));
    return head;
}

} // namespace

MeshDocument stl_document(const MeshCounts& counts, bool ascii) {
    MeshDocument document;
    document.head = ascii ? "solid hsdm\n" : binary_head(counts);
    document.facets = ascii ? append_text : append_binary;
    document.facets_have_places = true;
    if (ascii) document.tail = "endsolid hsdm\n";
    return document;
}

} // namespace hsdm
