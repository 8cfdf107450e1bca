#include "hsdm/io/split_mesh.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/mesh/split_creases.hh"

#include <algorithm>

namespace hsdm {
namespace {

/// Where a value stands in an ascending list that has it.
Index place_of(const std::vector<Index>& list, Index value) {
    return static_cast<Index>(std::lower_bound(list.begin(), list.end(), value) - list.begin());
}

/// All facets round some vertices, as a mesh of their own in the order of the whole, so that what is added up
/// at these vertices is so in the same order.
struct Surrounding {
    PolygonMesh mesh;
    std::vector<Index> vertices, facets; ///< of the whole, ascending
};

Surrounding surrounding(const LinkedMesh& whole, std::span<const Index> vertices) {
    Surrounding part;
    for (const Index v : vertices)
        whole.for_sides_from(v, [&](Index side) { part.facets.push_back(whole.links.facet[side]); });
    sort_unique(part.facets);
    for (const Index f : part.facets)
        for (const Index v : whole.facets.facet(f)) part.vertices.push_back(v);
    sort_unique(part.vertices);

    PolygonMesh& mesh = part.mesh;
    for (const Index v : part.vertices) mesh.positions.push_back(whole.facets.positions[v]);
    if (whole.rows.normals) mesh.normals.resize(mesh.vertex_count(), Vec3(0, 0, 0));
    for (const auto& [name, type] : whole.rows.columns)
        mesh.properties.push_back({name, type, std::vector<double>(mesh.vertex_count())});
    for (const Index f : part.facets) {
        const std::size_t begin = mesh.corners.size();
        for (const Index v : whole.facets.facet(f)) mesh.corners.push_back(place_of(part.vertices, v));
        mesh.first.push_back(static_cast<Index>(mesh.corners.size()));
        for (std::size_t c = begin; c < mesh.corners.size(); ++c) {
            if (!whole.is_sharp(whole.facets.first[f] + (c - begin))) continue;
            const Index from = mesh.corners[c];
            const Index to = mesh.corners[c + 1 == mesh.corners.size() ? begin : c + 1];
            mesh.sharp_edges.push_back({std::min(from, to), std::max(from, to)});
        }
    }
    return part;
}

/// Its loops are within a task.
PolygonMesh cut(const Surrounding& part) {
    PolygonMesh split;
    isolated([&] { split = split_creases(part.mesh); });
    return split;
}

/// The normals and properties of vertices begin .. end - 1, which all are in the part; others need none.
void fill_rows(const VertexRows& rows, std::size_t begin, std::size_t end, Surrounding& part) {
    if (!rows.fill || begin == end) return;
    std::vector<Vec3> normals;
    std::vector<double> values;
    rows.fill(begin, end, normals, values);
    const std::size_t place = place_of(part.vertices, static_cast<Index>(begin));
    for (std::size_t v = 0; v < end - begin; ++v) {
        if (rows.normals) part.mesh.normals[place + v] = normals[v];
        for (std::size_t k = 0; k < rows.columns.size(); ++k)
            part.mesh.properties[k].values[place + v] = values[v * rows.columns.size() + k];
    }
}

std::vector<Index> range(std::size_t begin, std::size_t end) {
    std::vector<Index> all(end - begin);
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<Index>(begin + i);
    return all;
}

/// The first vertex of the cut part that comes from its vertex `origin` or from one behind it.
std::size_t first_from(const PolygonMesh& split, Index origin) {
    return static_cast<std::size_t>(std::lower_bound(split.origin.begin(), split.origin.end(), origin)
                                    - split.origin.begin());
}

} // namespace

WholeSplitMesh::WholeSplitMesh(const PolygonMesh& mesh) : mesh_(split_creases(mesh)) {}

void WholeSplitMesh::append_triangles(std::size_t begin, std::size_t end, std::vector<Triangle>& out) const {
    for (std::size_t f = begin; f < end; ++f) hsdm::append_triangles(mesh_, f, out);
}

SplitStretches::SplitStretches(const LinkedMesh& mesh) : mesh_(mesh) {
    assign_large(number_, elements() + 1, 0);
    for_chunks(elements(), chunks::quick, [&](std::size_t begin, std::size_t end, std::size_t) {
        const Surrounding part = surrounding(mesh_, range(begin, end));
        for (const Index own : cut(part).origin)
            if (const Index v = part.vertices[own]; v >= begin && v < end) ++number_[v + 1];
    });
    for_each_in_order(elements(), [&](std::size_t v) { number_[v + 1] += number_[v]; });
}

void SplitStretches::show_vertices(std::size_t begin, std::size_t end, const Visit& visit) const {
    Surrounding part = surrounding(mesh_, range(begin, end));
    fill_rows(mesh_.rows, begin, end, part);
    const PolygonMesh split = cut(part);
    const std::size_t place =
        begin == end ? 0 : place_of(part.vertices, static_cast<Index>(begin)); // all of them are there
    visit(split, first_from(split, static_cast<Index>(place)),
          first_from(split, static_cast<Index>(place + (end - begin))));
}

void SplitStretches::append_triangles(std::size_t begin, std::size_t end, std::vector<Triangle>& out) const {
    std::vector<Index> corners;
    for (std::size_t f = begin; f < end; ++f)
        for (const Index v : mesh_.facets.facet(f)) corners.push_back(v);
    sort_unique(corners);
    const Surrounding part = surrounding(mesh_, corners);
    const PolygonMesh split = cut(part);
    const auto number = [&](Index v) {
        const Index own = split.origin[v];
        return static_cast<Index>(number_[part.vertices[own]] + (v - first_from(split, own)));
    };
    const std::size_t before = out.size(), first = place_of(part.facets, static_cast<Index>(begin));
    for (std::size_t f = first; f < first + (end - begin); ++f) hsdm::append_triangles(split, f, out);
    for (std::size_t t = before; t < out.size(); ++t)
        for (Index& v : out[t]) v = number(v);
}

} // namespace hsdm
