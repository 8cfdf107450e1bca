#include "hsdm/mesh/split_creases.hh"

#include "hsdm/core/disjoint_sets.hh"
#include "hsdm/mesh/edge_table.hh"
#include "hsdm/mesh/facet_normal.hh"
#include "hsdm/mesh/vertex_normals.hh"

#include <algorithm>
#include <array>
#include <cmath>

namespace hsdm {
namespace {

/// Corners of a vertex that no sharp edge parts are one set. Without normals all are.
DisjointSets join_corners(const PolygonMesh& mesh) {
    DisjointSets parts(mesh.corners.size());
    std::vector<std::array<Index, 2>> sharp = mesh.sharp_edges;
    std::sort(sharp.begin(), sharp.end());
    const std::vector<Index> next = next_sides(mesh);
    EdgeTable(mesh).for_edges([&](Index lower, std::span<const EdgeSide> edge, std::size_t) {
        if (edge.size() != 2
            || std::binary_search(sharp.begin(), sharp.end(), std::array<Index, 2>{lower, edge[0].upper}))
            return;
        const auto corner_at = [&](Index vertex, Index side) {
            return mesh.corners[side] == vertex ? side : next[side];
        };
        for (const Index vertex : {lower, edge[0].upper})
            parts.join(corner_at(vertex, edge[0].side), corner_at(vertex, edge[1].side));
    });
    return parts;
}

/// The normals that a vertex has in the properties, or none.
class VertexNormalProperties {
public:
    explicit VertexNormalProperties(const PolygonMesh& mesh) {
        for (std::size_t i = 0; i < components_.size(); ++i) {
            const auto found =
                std::ranges::find(mesh.properties, vertex_normal_component(i), &VertexProperty::name);
            components_[i] = found == mesh.properties.end() ? nullptr : &*found;
        }
    }

    /// The one nearest to a direction, or that itself if none is within 45 degrees: the vertex then has no
    /// normal for this side.
    Vec3 nearest(Index vertex, const Vec3& direction) const {
        if (std::ranges::find(components_, nullptr) != components_.end()) return direction;
        Vec3 best = direction;
        double most = std::sqrt(0.5);
        for (std::size_t n = 0; n < 3; ++n) {
            Vec3 normal;
            for (unsigned k = 0; k < 3; ++k) normal[k] = components_[3 * n + k]->values[vertex];
            if (const double cosine = normal | direction; cosine > most) {
                most = cosine;
                best = unit_or_zero(normal);
            }
        }
        return best;
    }

private:
    std::array<const VertexProperty*, 9> components_;
};

/// Per corner, its facet's unit normal times its angle.
std::vector<Vec3> weighted_normals(const PolygonMesh& mesh) {
    std::vector<Vec3> normals(mesh.corners.size());
    for_each_index(mesh.facet_count(), chunks::quick, [&](Index f) {
        const auto facet = mesh.facet(f);
        AreaVector area(mesh.positions[facet[0]]);
        for (const Index v : facet.subspan(1)) area.add(mesh.positions[v]);
        const Vec3 normal = unit_or_zero(*area);
        for (std::size_t i = 0; i < facet.size(); ++i) {
            const Vec3& p = mesh.positions[facet[i]];
            const Vec3& before = mesh.positions[facet[(i + facet.size() - 1) % facet.size()]];
            const Vec3& after = mesh.positions[facet[(i + 1) % facet.size()]];
            normals[mesh.first[f] + i] = normal * angle_between(before - p, after - p);
        }
    });
    return normals;
}

/// The first corner of each part, by vertex.
std::vector<Index> part_corners(const PolygonMesh& mesh, DisjointSets& parts) {
    std::vector<Index> roots;
    std::vector<Index> first_of_vertex(mesh.vertex_count(), no_index);
    const bool whole = mesh.normals.empty();
    for (Index c = 0; c < mesh.corners.size(); ++c) {
        Index& first = first_of_vertex[mesh.corners[c]];
        if (whole && first != no_index) parts.join(first, c);
        if (first == no_index) first = c;
        if (parts.find(c) == c) roots.push_back(c);
    }
    std::sort(roots.begin(), roots.end(), [&](Index a, Index b) {
        return std::pair(mesh.corners[a], a) < std::pair(mesh.corners[b], b);
    });
    return roots;
}

void set_normals(const PolygonMesh& mesh, PolygonMesh& split) {
    std::vector<Vec3> sums(split.vertex_count(), Vec3(0, 0, 0));
    const std::vector<Vec3> weighted = weighted_normals(mesh);
    for (std::size_t c = 0; c < weighted.size(); ++c) sums[split.corners[c]] += weighted[c];
    const VertexNormalProperties known(mesh);
    split.normals.resize(split.vertex_count());
    for (std::size_t v = 0; v < split.vertex_count(); ++v) {
        const Index own = split.origin[v];
        const bool alone = (v == 0 || split.origin[v - 1] != own)
                           && (v + 1 == split.vertex_count() || split.origin[v + 1] != own);
        split.normals[v] = alone ? mesh.normals[own] : known.nearest(own, unit_or_zero(sums[v]));
    }
}

} // namespace

PolygonMesh split_creases(const PolygonMesh& mesh) {
    DisjointSets parts = join_corners(mesh);
    const std::vector<Index> roots = part_corners(mesh, parts);
    std::vector<Index> number(mesh.corners.size());
    PolygonMesh split;
    for (std::size_t v = 0; v < roots.size(); ++v) {
        number[roots[v]] = static_cast<Index>(v);
        split.origin.push_back(mesh.corners[roots[v]]);
        split.positions.push_back(mesh.positions[split.origin.back()]);
    }
    split.first = mesh.first;
    split.corners.resize(mesh.corners.size());
    for (Index c = 0; c < mesh.corners.size(); ++c) split.corners[c] = number[parts.find(c)];
    for (const VertexProperty& property : mesh.properties) {
        VertexProperty& copy = split.properties.emplace_back();
        copy.name = property.name;
        copy.type = property.type;
        for (const Index own : split.origin) copy.values.push_back(property.values[own]);
    }
    if (!mesh.normals.empty()) set_normals(mesh, split);
    return split;
}

} // namespace hsdm
