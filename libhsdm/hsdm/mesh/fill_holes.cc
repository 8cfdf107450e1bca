#include "hsdm/mesh/fill_holes.hh"

#include "hsdm/core/check_option.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/split_polygon.hh"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

namespace hsdm {
namespace {

/// A loop around a single facet: closing it would lay a second facet over the same vertices.
bool is_lone_facet(const PolygonMesh& mesh, std::span<const Index> facets) {
    return std::all_of(facets.begin(), facets.end(), [&](Index f) { return f == facets[0]; })
           && mesh.facet(facets[0]).size() == facets.size();
}

/// Finds which side without twin follows which around a hole: the side after one from a to b ends in a.
class HoleTracer {
public:
    HoleTracer(const PolygonMesh& mesh, const FacetLinks& links)
        : mesh_(mesh), links_(links), open_(sides_without_twin()) {
        if (open_.empty()) return;
        list_fans();
        next_.assign(mesh.corners.size(), no_index);
        place_.assign(mesh.vertex_count(), no_index);
        for (Index c : open_) next_[c] = links_.open_in[links_.vertex[c]];
        for (std::size_t begin = 0, end = 0; begin < shared_.size(); begin = end) {
            while (end < shared_.size() && shared_[end].vertex == shared_[begin].vertex) ++end;
            join_fans({shared_.data() + begin, end - begin});
        }
    }

    BoundaryLoops trace() {
        BoundaryLoops loops;
        for (Index c : open_) {
            path_.clear();
            for (Index at = c; next_[at] != no_index;) {
                path_.push_back(at);
                at = std::exchange(next_[at], no_index);
            }
            if (!path_.empty()) add_simple_loops(loops);
        }
        return loops;
    }

private:
    /// An open fan of a vertex that has several: it begins with side `out` and ends, counterclockwise, with
    /// side `in`.
    struct Fan {
        Index vertex, out, in;
        double angle;
    };

    std::vector<Index> sides_without_twin() const {
        return indices_where(mesh_.corners.size(), chunks::light, [&](Index side) {
            return links_.twin[side] == no_index && links_.accepted[links_.facet[side]];
        });
    }

    Index end(Index side) const { return mesh_.corners[next_side(mesh_, links_.facet[side], side)]; }

    void list_fans() {
        std::vector<std::uint8_t> fans(mesh_.vertex_count(), 0);
        for (Index source : links_.source)
            fans[source] = static_cast<std::uint8_t>(std::min(fans[source] + 1, 2));
        for (Index c : open_)
            if (fans[mesh_.corners[c]] > 1)
                shared_.push_back({mesh_.corners[c], c, links_.open_in[links_.vertex[c]], 0});
        std::stable_sort(shared_.begin(), shared_.end(),
                         [](const Fan& a, const Fan& b) { return a.vertex < b.vertex; });
    }

    Vec3 normal(const Fan& fan) const {
        return unit(area_vector(mesh_, mesh_.facet(links_.facet[fan.out]))
                    + area_vector(mesh_, mesh_.facet(links_.facet[fan.in])));
    }

    /// Fans of one surface around a vertex leave a hole between each and the next: the hole clockwise of a
    /// fan's first side ends at the last side of the fan before. Fans that face different ways are sheets
    /// that touch by chance and keep their holes to themselves.
    void join_fans(std::span<Fan> fans) {
        Vec3 sum(0, 0, 0);
        for (const Fan& fan : fans) sum += normal(fan);
        for (const Fan& fan : fans)
            if ((normal(fan) | sum) <= 0) return;
        const Vec3 z = unit(sum), origin = mesh_.positions[fans[0].vertex];
        const Vec3 x = mesh_.positions[end(fans[0].out)] - origin, y = z % x;
        for (Fan& fan : fans) {
            const Vec3 d = mesh_.positions[end(fan.out)] - origin;
            fan.angle = std::atan2(d | y, d | x);
        }
        std::stable_sort(fans.begin(), fans.end(),
                         [](const Fan& a, const Fan& b) { return a.angle < b.angle; });
        for (std::size_t i = 0; i < fans.size(); ++i)
            next_[fans[i].out] = fans[(i + fans.size() - 1) % fans.size()].in;
    }

    /// Adds the traced loop; one that visits a vertex twice is cut into loops there.
    void add_simple_loops(BoundaryLoops& loops) {
        std::vector<Index> open;
        const auto forget_from = [&](std::size_t first) {
            for (std::size_t i = first; i < open.size(); ++i) place_[end(open[i])] = no_index;
            open.resize(first);
        };
        for_each_in_order(path_.size(), [&](std::size_t i) {
            const Index side = path_[i], v = end(side);
            if (const Index seen = place_[v]; seen != no_index) {
                add_loop({open.begin() + seen, open.end()}, loops);
                forget_from(seen);
            }
            place_[v] = static_cast<Index>(open.size());
            open.push_back(side);
        });
        add_loop(open, loops);
        forget_from(0);
    }

    void add_loop(std::span<const Index> sides, BoundaryLoops& loops) const {
        for (Index side : sides) {
            loops.vertices.push_back(end(side));
            loops.facets.push_back(links_.facet[side]);
        }
        loops.begin.push_back(static_cast<Index>(loops.vertices.size()));
    }

    const PolygonMesh& mesh_;
    const FacetLinks& links_;
    std::vector<Index> open_; ///< sides without twin
    std::vector<Fan> shared_;
    std::vector<Index> next_; ///< per side without twin; cleared as loops are traced
    std::vector<Index> path_;
    std::vector<Index>
        place_; ///< per vertex, where in the open part of a path a side ends there; or no_index
};

/// A new vertex at the mean of a loop's, with their mean normal and origin and properties of the first.
Index add_middle(PolygonMesh& mesh, std::span<const Index> loop) {
    mesh.positions.push_back(centroid(mesh, loop));
    if (!mesh.normals.empty()) {
        Vec3 normal(0, 0, 0);
        for (Index v : loop) normal += mesh.normals[v];
        mesh.normals.push_back(unit(normal));
    }
    const auto as_first = [&](auto& values) {
        const auto value = values[loop[0]];
        values.push_back(value);
    };
    if (!mesh.origin.empty()) as_first(mesh.origin);
    for (VertexProperty& property : mesh.properties) as_first(property.values);
    return static_cast<Index>(mesh.vertex_count() - 1);
}

Pieces triangles_around(Index middle, std::span<const Index> loop) {
    Pieces pieces;
    for (std::size_t i = 0; i < loop.size(); ++i)
        pieces.push_back({loop[i], loop[(i + 1) % loop.size()], middle});
    return pieces;
}

} // namespace

void validate(const FillHolesOptions& options) {
    check_option(options.max_edges >= 3, "max_edges", options.max_edges, "be 3 or more");
    check_option(options.max_diameter > 0, "max_diameter", options.max_diameter, "be above 0");
    check_option(options.max_bend > 0 && options.max_bend <= std::numbers::pi, "max_bend", options.max_bend,
                 "lie in (0, pi], in radians");
}

BoundaryLoops boundary_loops(const PolygonMesh& mesh) {
    return boundary_loops(mesh, link_facets(mesh));
}

double diameter_of(const PolygonMesh& mesh, std::span<const Index> loop) {
    Box box;
    for (Index v : loop) box.add(mesh.positions[v]);
    return box.diagonal();
}

BoundaryLoops boundary_loops(const PolygonMesh& mesh, const FacetLinks& links) {
    return HoleTracer(mesh, links).trace();
}

FillHolesCounts fill_holes(PolygonMesh& mesh, const FillHolesOptions& options) {
    return fill_holes(mesh, link_facets(mesh), options);
}

FillHolesCounts fill_holes(PolygonMesh& mesh, const FacetLinks& links, const FillHolesOptions& options) {
    const BoundaryLoops loops = boundary_loops(mesh, links);
    FillHolesCounts counts;
    counts.loops = loops.size();
    if (loops.size() == 0) return counts;
    EdgeSet edges(mesh, loops.vertices);
    const SplitPolygonOptions split{options.max_bend, options.quads};
    for (std::size_t i = 0; i < loops.size(); ++i) {
        const auto loop = loops[i];
        if (loop.size() > static_cast<std::size_t>(options.max_edges)
            || diameter_of(mesh, loop) > options.max_diameter
            || (options.stays_open && options.stays_open(loop)))
            continue;
        const std::span<const Index> facets{loops.facets.data() + loops.begin[i], loop.size()};
        Pieces pieces;
        if (loop.size() >= 3 && !is_lone_facet(mesh, facets)) {
            std::vector<Vec3> normals;
            for (Index f : facets) normals.push_back(unit(area_vector(mesh, mesh.facet(f))));
            pieces = split_polygon(mesh, loop, normals, edges, split);
        }
        if (pieces.empty() && options.insist && loop.size() >= 3) {
            pieces = triangles_around(add_middle(mesh, loop), loop);
            ++counts.vertices;
        }
        if (pieces.empty()) {
            ++counts.refused;
            continue;
        }
        for (const auto& piece : pieces) {
            mesh.add_facet(piece);
            edges.add(piece);
        }
        counts.facets += pieces.size();
        ++counts.closed;
    }
    return counts;
}

} // namespace hsdm
