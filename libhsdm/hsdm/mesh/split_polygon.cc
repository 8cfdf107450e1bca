#include "hsdm/mesh/split_polygon.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/interruption.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/constants.hh"
#include "hsdm/mesh/facet_links.hh"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace hsdm {
namespace {

/// One polygon, triangulated. Its corners are numbered 0 .. n - 1, side i runs from corner i to i + 1.
class Triangulator {
public:
    Triangulator(const PolygonMesh& mesh, std::span<const Index> polygon, std::span<const Vec3> side_normals,
                 const EdgeSet& edges, double max_bend)
        : mesh_(mesh),
          vertices_(polygon.begin(), polygon.end()),
          edges_(edges),
          least_cosine_(std::cos(max_bend)),
          side_normal_(side_normals.begin(), side_normals.end()) {}

    /// False if every triangulation folds, has a flat triangle or uses an edge that exists.
    bool run() {
        while (vertices_.size() > quad_splitting::exact_edges)
            if (!cut_best_ear()) return false;
        return solve();
    }
    const std::vector<std::array<Index, 3>>& triangles() const { return triangles_; }

private:
    const Vec3& at(std::size_t i) const { return mesh_.positions[vertices_[i]]; }

    Vec3 normal(std::size_t i, std::size_t j, std::size_t k) const {
        const Vec3 n = (at(j) - at(i)) % (at(k) - at(i));
        const double longest =
            std::max({(at(j) - at(i)).sqrnorm(), (at(k) - at(j)).sqrnorm(), (at(i) - at(k)).sqrnorm()});
        return n.norm() > 1e-6 * longest ? unit(n) : Vec3(0, 0, 0);
    }

    /// Cost of a bend, to be added to the length of its edge; infinite beyond the limit.
    double bend_cost(const Vec3& a, const Vec3& b, double squared_length) const {
        const double cosine = a | b;
        return cosine < least_cosine_ ? Box::inf : quad_splitting::bend_cost * squared_length * (1 - cosine);
    }

    bool diagonal_free(std::size_t i, std::size_t j) const {
        return !edges_.contains(vertices_[i], vertices_[j]);
    }

    /// Dynamic programming: least cost of the part of the loop from corner i to corner j, closed by the
    /// diagonal between them, and the apex of the triangle on that diagonal. Bends are measured against the
    /// best triangle of either part only, so the result is not always the optimum of all triangulations.
    struct Part {
        double cost = Box::inf;
        Index apex = 0;
        Vec3 normal{0, 0, 0};
    };

    bool solve() {
        const std::size_t n = vertices_.size();
        std::vector<Part> parts(n * n);
        for (std::size_t i = 0; i + 1 < n; ++i) parts[i * n + i + 1] = {0, 0, side_normal_[i]};
        for (std::size_t span = 2; span < n; ++span)
            for (std::size_t i = 0; i + span < n; ++i) {
                const std::size_t j = i + span;
                const bool closing = span + 1 == n; // the last triangle lies on the loop's last side
                if (!closing && !diagonal_free(i, j)) continue;
                Part& best = parts[i * n + j];
                for (std::size_t k = i + 1; k < j; ++k) {
                    const Part &left = parts[i * n + k], &right = parts[k * n + j];
                    const double base = left.cost + right.cost;
                    if (base >= best.cost) continue;
                    const Vec3 own = normal(i, k, j);
                    if (own.sqrnorm() == 0) continue;
                    const double ik = (at(k) - at(i)).sqrnorm(), kj = (at(j) - at(k)).sqrnorm(),
                                 ij = (at(j) - at(i)).sqrnorm();
                    double cost = base + ik + kj + ij + bend_cost(own, left.normal, ik)
                                  + bend_cost(own, right.normal, kj);
                    if (closing) cost += bend_cost(own, side_normal_[n - 1], ij);
                    if (cost < best.cost) best = {cost, static_cast<Index>(k), own};
                }
            }
        if (!(parts[n - 1].cost < Box::inf)) return false;
        std::vector<std::pair<std::size_t, std::size_t>> todo{{0, n - 1}};
        while (!todo.empty()) {
            const auto [i, j] = todo.back();
            todo.pop_back();
            if (j - i < 2) continue;
            const std::size_t k = parts[i * n + j].apex;
            triangles_.push_back({vertices_[i], vertices_[k], vertices_[j]});
            todo.emplace_back(k, j);
            todo.emplace_back(i, k);
        }
        return true;
    }

    /// For loops too long to be solved exactly: cuts off the corner whose triangle costs least.
    bool cut_best_ear() {
        const std::size_t n = vertices_.size();
        double least = Box::inf;
        std::size_t best = 0;
        for (std::size_t j = 0; j < n; ++j) {
            const std::size_t i = (j + n - 1) % n, k = (j + 1) % n;
            const double chord = (at(k) - at(i)).sqrnorm();
            if (chord >= least || !diagonal_free(i, k)) continue;
            const Vec3 own = normal(i, j, k);
            if (own.sqrnorm() == 0) continue;
            const double cost = chord + bend_cost(own, side_normal_[i], (at(j) - at(i)).sqrnorm())
                                + bend_cost(own, side_normal_[j], (at(k) - at(j)).sqrnorm());
            if (cost >= least) continue;
            least = cost;
            best = j;
        }
        if (!(least < Box::inf)) return false;
        const std::size_t i = (best + n - 1) % n, k = (best + 1) % n;
        triangles_.push_back({vertices_[i], vertices_[best], vertices_[k]});
        side_normal_[i] = normal(i, best, k);
        vertices_.erase(vertices_.begin() + static_cast<std::ptrdiff_t>(best));
        side_normal_.erase(side_normal_.begin() + static_cast<std::ptrdiff_t>(best));
        return true;
    }

    const PolygonMesh& mesh_;
    std::vector<Index> vertices_;
    const EdgeSet& edges_;
    double least_cosine_;
    std::vector<Vec3> side_normal_; ///< per side, of the facet or triangle beyond it
    std::vector<std::array<Index, 3>> triangles_;
};

/// Whether a quad is convex seen along its area, and how near its corners are to right angles (0 .. 1).
double quad_quality(const PolygonMesh& mesh, const std::array<Index, 4>& quad) {
    const Vec3 normal = unit(area_vector(mesh, quad));
    double least = 1;
    for (unsigned i = 0; i < 4; ++i) {
        const Vec3& p = mesh.positions[quad[i]];
        const Vec3 a = unit(mesh.positions[quad[(i + 1) % 4]] - p),
                   b = unit(mesh.positions[quad[(i + 3) % 4]] - p);
        least = std::min(least, (a % b) | normal);
    }
    return least;
}

/// Two triangles that share a diagonal, as the quad they make; empty quality if none.
struct Merge {
    double quality;
    std::size_t a, b;
    std::array<Index, 4> quad;
};

/// Possible quads of a loop's triangles, best first.
std::vector<Merge> possible_quads(const PolygonMesh& mesh,
                                  const std::vector<std::array<Index, 3>>& triangles) {
    struct Side {
        std::pair<Index, Index> edge;
        std::size_t triangle;
        unsigned corner;
    };
    std::vector<Side> sides;
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (unsigned i = 0; i < 3; ++i)
            sides.push_back({std::minmax({triangles[t][i], triangles[t][(i + 1) % 3]}), t, i});
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.edge, a.triangle) < std::tie(b.edge, b.triangle);
    });
    std::vector<Merge> merges;
    for (std::size_t s = 0; s + 1 < sides.size(); ++s) {
        if (sides[s].edge != sides[s + 1].edge) continue;
        const auto &a = triangles[sides[s].triangle], &b = triangles[sides[s + 1].triangle];
        const double cosine = unit(area_vector(mesh, a)) | unit(area_vector(mesh, b));
        if (cosine < std::cos(quad_splitting::quad_bend)) continue;
        const std::array<Index, 4> quad{a[sides[s].corner], b[(sides[s + 1].corner + 2) % 3],
                                        a[(sides[s].corner + 1) % 3], a[(sides[s].corner + 2) % 3]};
        const double quality = quad_quality(mesh, quad);
        if (quality > quad_splitting::least_corner)
            merges.push_back({quality, sides[s].triangle, sides[s + 1].triangle, quad});
    }
    std::stable_sort(merges.begin(), merges.end(),
                     [](const Merge& a, const Merge& b) { return a.quality > b.quality; });
    return merges;
}

/// A hexagon as two quads, by the diagonal that gives the better shapes; empty if neither half is convex.
/// Triangles joined in pairs often miss this: the shortest diagonals of a hexagon cut out a triangle.
Pieces halve_hexagon(const PolygonMesh& mesh, std::span<const Index> p, const EdgeSet& edges) {
    Pieces best;
    double best_quality = quad_splitting::least_corner;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::array<Index, 4> a{p[i], p[i + 1], p[i + 2], p[i + 3]},
            b{p[i + 3], p[(i + 4) % 6], p[(i + 5) % 6], p[i]};
        const double quality = std::min(quad_quality(mesh, a), quad_quality(mesh, b));
        const double cosine = unit(area_vector(mesh, a)) | unit(area_vector(mesh, b));
        if (quality <= best_quality || cosine < std::cos(quad_splitting::quad_bend)
            || edges.contains(p[i], p[i + 3]))
            continue;
        best = {{a.begin(), a.end()}, {b.begin(), b.end()}};
        best_quality = quality;
    }
    return best;
}

/// The facets beyond a facet's sides, as normals.
std::vector<Vec3> normals_around(const PolygonMesh& mesh, const FacetLinks& links, Index f) {
    std::vector<Vec3> normals;
    for (Index c = mesh.first[f]; c < mesh.first[f + 1]; ++c)
        normals.push_back(links.twin[c] == no_index
                              ? Vec3(0, 0, 0)
                              : unit(area_vector(mesh, mesh.facet(links.facet[links.twin[c]]))));
    return normals;
}

/// Whether the pieces of a polygon use an edge that is taken by now, other than the polygon's own sides.
bool collides(const Pieces& pieces, std::span<const Index> polygon, const EdgeSet& edges) {
    const std::size_t n = polygon.size();
    auto is_side = [&](Index a, Index b) {
        const auto i =
            static_cast<std::size_t>(std::find(polygon.begin(), polygon.end(), a) - polygon.begin());
        return polygon[(i + 1) % n] == b || polygon[(i + n - 1) % n] == b;
    };
    for (const auto& piece : pieces)
        for (std::size_t i = 0; i < piece.size(); ++i) {
            const Index a = piece[i], b = piece[(i + 1) % piece.size()];
            if (!is_side(a, b) && edges.contains(a, b)) return true;
        }
    return false;
}

} // namespace

Pieces split_polygon(const PolygonMesh& mesh, std::span<const Index> polygon,
                     std::span<const Vec3> side_normals, const EdgeSet& edges,
                     const SplitPolygonOptions& options) {
    Pieces pieces;
    if (options.quads && polygon.size() == 6) pieces = halve_hexagon(mesh, polygon, edges);
    if (!pieces.empty()) return pieces;
    Triangulator triangulator(mesh, polygon, side_normals, edges, options.max_bend);
    if (polygon.size() < 3 || !triangulator.run()) return pieces;
    const auto& triangles = triangulator.triangles();
    std::vector<std::uint8_t> used(triangles.size(), 0);
    if (options.quads)
        for (const Merge& merge : possible_quads(mesh, triangles)) {
            if (used[merge.a] || used[merge.b]) continue;
            used[merge.a] = used[merge.b] = 1;
            pieces.emplace_back(merge.quad.begin(), merge.quad.end());
        }
    for (std::size_t t = 0; t < triangles.size(); ++t)
        if (!used[t]) pieces.emplace_back(triangles[t].begin(), triangles[t].end());
    return pieces;
}

std::size_t split_large_facets(PolygonMesh& mesh) {
    std::vector<Index> large, corners;
    for_each_in_order(mesh.facet_count(), [&](std::size_t f) {
        const auto facet = mesh.facet(f);
        if (facet.size() <= 4) return;
        large.push_back(static_cast<Index>(f));
        corners.insert(corners.end(), facet.begin(), facet.end());
    });
    if (large.empty()) return 0;
    const FacetLinks links = link_facets(mesh);
    EdgeSet edges(mesh, corners);
    std::vector<Pieces> pieces(large.size());
    const auto split = [&](std::size_t i) {
        pieces[i] = split_polygon(mesh, mesh.facet(large[i]), normals_around(mesh, links, large[i]), edges);
    };
    for_each_index(large.size(), 256, [&](Index i) { split(i); });

    // Two polygons may both want a diagonal between vertices they share: the later one is split again
    // without.
    PolygonMesh out;
    reserve_large(out.corners, mesh.corners.size() + 2 * corners.size());
    reserve_large(out.first, mesh.first.size() + corners.size());
    std::size_t next = 0, count = 0;
    for_each_in_order(mesh.facet_count(), [&](std::size_t f) {
        if (next == large.size() || large[next] != f) {
            out.add_facet(mesh.facet(f));
            return;
        }
        if (collides(pieces[next], mesh.facet(f), edges)) split(next);
        const Pieces& parts = pieces[next++];
        if (parts.empty()) out.add_facet(mesh.facet(f));
        count += !parts.empty();
        for (const auto& piece : parts) {
            out.add_facet(piece);
            edges.add(piece);
        }
    });
    mesh.corners.swap(out.corners);
    mesh.first.swap(out.first);
    return count;
}

} // namespace hsdm
