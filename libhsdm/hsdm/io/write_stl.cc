#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/io/format_chunks.hh"
#include "hsdm/io/mesh_writers.hh"
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

void write_ascii(AtomicFile& file, const PolygonMesh& mesh, const Triangulation& cut) {
    file.write("solid hsdm\n");
    write_chunks(file, cut.size(), [&](std::string& out, std::size_t begin, std::size_t end) {
        auto put = [&](const char* keyword, const Vec3& v) {
            out += keyword;
            for (double x : v) append_number(out += ' ', x);
            out += '\n';
        };
        for (std::size_t t = begin; t < end; ++t) {
            put("facet normal", unit_normal(mesh.positions, cut.triangles[t]));
            out += "outer loop\n";
            for (Index v : cut.triangles[t]) put("vertex", mesh.positions[v]);
            out += "endloop\nendfacet\n";
        }
    });
    file.write("endsolid hsdm\n");
}

void write_binary(AtomicFile& file, const PolygonMesh& mesh, const Triangulation& cut) {
    std::string header = "binary STL by hsdm"; // must not begin with "solid": readers take that for text
    header.resize(80, ' ');
    append_bytes(header, static_cast<std::uint32_t>(cut.size()));
    file.write(header);
    write_chunks(file, cut.size(), [&](std::string& out, std::size_t begin, std::size_t end) {
        auto put = [&](const Vec3& v) {
            for (double x : v) append_bytes(out, static_cast<float>(x));
        };
        for (std::size_t t = begin; t < end; ++t) {
            put(unit_normal(mesh.positions, cut.triangles[t]));
            for (Index v : cut.triangles[t]) put(mesh.positions[v]);
            append_bytes(out, std::uint16_t{0});
        }
    });
}

} // namespace

void write_stl(AtomicFile& file, const PolygonMesh& mesh, bool ascii) {
    const Triangulation cut = triangulate(mesh);
    if (ascii)
        write_ascii(file, mesh, cut);
    else
        write_binary(file, mesh, cut);
}

} // namespace hsdm
