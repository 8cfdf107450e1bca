#include "hsdm/facets/fill_holes.hh"

#include "hsdm/facets/facet_links.hh"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

namespace hsdm {
namespace {

constexpr std::size_t exact_edges = 128;
constexpr double quad_bend = 1.05; // two triangles that bend more stay two (60 degrees)
constexpr double infinite = Box::inf;

Vec3 area_vector(const PolygonMesh& mesh, std::span<const Index> facet) {
    const Vec3& origin = mesh.positions[facet[0]];
    Vec3 sum(0, 0, 0);
    for (std::size_t i = 1; i + 1 < facet.size(); ++i)
        sum += (mesh.positions[facet[i]] - origin) % (mesh.positions[facet[i + 1]] - origin);
    return sum;
}

Vec3 unit(const Vec3& v) {
    const double length = v.norm();
    return length > 0 ? v / length : v;
}

/// Edges of the mesh between vertices of its boundary: diagonals that must not be used again.
class BoundaryChords {
public:
    BoundaryChords(const PolygonMesh& mesh, const BoundaryLoops& loops) {
        std::vector<std::uint8_t> open(mesh.vertex_count(), 0);
        shared_.assign(mesh.vertex_count(), 0);
        for (Index v : loops.vertices) {
            shared_[v] = open[v];
            open[v] = 1;
        }
        for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
            const auto facet = mesh.facet(f);
            for (std::size_t i = 0; i < facet.size(); ++i) {
                const Index a = facet[i], b = facet[i + 1 < facet.size() ? i + 1 : 0];
                if (open[a] && open[b]) edges_.push_back(std::minmax({a, b}));
            }
        }
        std::sort(edges_.begin(), edges_.end());
    }
    bool contains(Index a, Index b) const {
        const std::pair<Index, Index> edge = std::minmax({a, b});
        return std::binary_search(edges_.begin(), edges_.end(), edge)
               || std::find(added_.begin(), added_.end(), edge) != added_.end();
    }
    /// Diagonals of a new facet between vertices that other loops pass too.
    void add(std::span<const Index> facet) {
        for (std::size_t i = 0; i < facet.size(); ++i) {
            const Index a = facet[i], b = facet[i + 1 < facet.size() ? i + 1 : 0];
            if (shared_[a] && shared_[b]) added_.push_back(std::minmax({a, b}));
        }
    }

private:
    std::vector<std::pair<Index, Index>> edges_, added_;
    std::vector<std::uint8_t> shared_; ///< vertices on several loops: few
};

/// One loop, triangulated. Corners are numbered 0 .. n - 1 along the loop, side i runs from corner i to i
/// + 1.
class LoopTriangulation {
public:
    LoopTriangulation(const PolygonMesh& mesh, std::span<const Index> vertices, std::span<const Index> facets,
                      const BoundaryChords& chords, double max_bend)
        : mesh_(mesh),
          vertices_(vertices.begin(), vertices.end()),
          chords_(chords),
          least_cosine_(std::cos(max_bend)) {
        for (Index f : facets) side_normal_.push_back(unit(area_vector(mesh, mesh.facet(f))));
    }

    /// False if every triangulation folds, has a flat triangle or uses an edge that exists.
    bool run() {
        while (vertices_.size() > exact_edges)
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

    /// What a bend costs beside the length of its edge; infinite beyond the limit.
    double bend_cost(const Vec3& a, const Vec3& b, double squared_length) const {
        const double cosine = a | b;
        return cosine < least_cosine_ ? infinite : 4 * squared_length * (1 - cosine);
    }

    bool diagonal_free(std::size_t i, std::size_t j) const {
        return !chords_.contains(vertices_[i], vertices_[j]);
    }

    /// Least cost of the part of the loop from corner i to corner j, closed by the diagonal between them, and
    /// the apex of the triangle on that diagonal. Bends are measured against the best triangle of either
    /// part, which is why the optimum is one of the principle's, not of all triangulations.
    struct Part {
        double cost = infinite;
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
        if (!(parts[n - 1].cost < infinite)) return false;
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
        double least = infinite;
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
        if (!(least < infinite)) return false;
        const std::size_t i = (best + n - 1) % n, k = (best + 1) % n;
        triangles_.push_back({vertices_[i], vertices_[best], vertices_[k]});
        side_normal_[i] = normal(i, best, k);
        vertices_.erase(vertices_.begin() + static_cast<std::ptrdiff_t>(best));
        side_normal_.erase(side_normal_.begin() + static_cast<std::ptrdiff_t>(best));
        return true;
    }

    const PolygonMesh& mesh_;
    std::vector<Index> vertices_;
    const BoundaryChords& chords_;
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
        if (cosine < std::cos(quad_bend)) continue;
        const std::array<Index, 4> quad{a[sides[s].corner], b[(sides[s + 1].corner + 2) % 3],
                                        a[(sides[s].corner + 1) % 3], a[(sides[s].corner + 2) % 3]};
        const double quality = quad_quality(mesh, quad);
        if (quality > 0.2) merges.push_back({quality, sides[s].triangle, sides[s + 1].triangle, quad});
    }
    std::stable_sort(merges.begin(), merges.end(),
                     [](const Merge& a, const Merge& b) { return a.quality > b.quality; });
    return merges;
}

std::size_t add_facets(PolygonMesh& mesh, const std::vector<std::array<Index, 3>>& triangles, bool quads) {
    const std::size_t before = mesh.facet_count();
    std::vector<std::uint8_t> used(triangles.size(), 0);
    if (quads)
        for (const Merge& merge : possible_quads(mesh, triangles)) {
            if (used[merge.a] || used[merge.b]) continue;
            used[merge.a] = used[merge.b] = 1;
            mesh.add_facet(merge.quad);
        }
    for (std::size_t t = 0; t < triangles.size(); ++t)
        if (!used[t]) mesh.add_facet(triangles[t]);
    return mesh.facet_count() - before;
}

/// A loop around a single facet: closing it would lay a second facet over the same vertices.
bool is_lone_facet(const PolygonMesh& mesh, std::span<const Index> facets) {
    return std::all_of(facets.begin(), facets.end(), [&](Index f) { return f == facets[0]; })
           && mesh.facet(facets[0]).size() == facets.size();
}

double diameter(const PolygonMesh& mesh, std::span<const Index> loop) {
    Box box;
    for (Index v : loop) box.add(mesh.positions[v]);
    return box.diagonal();
}

/// Which side without twin follows which around a hole: succ of a side from a to b is one that ends in a.
class HoleTracer {
public:
    explicit HoleTracer(const PolygonMesh& mesh) : mesh_(mesh), links_(link_facets(mesh)) {
        list_fans();
        next_.assign(mesh.corners.size(), no_index);
        for (Index c = 0; c < mesh.corners.size(); ++c)
            if (links_.accepted[links_.facet[c]] && links_.twin[c] == no_index)
                next_[c] = links_.open_in[links_.vertex[c]];
        for (std::size_t begin = 0, end = 0; begin < shared_.size(); begin = end) {
            while (end < shared_.size() && shared_[end].vertex == shared_[begin].vertex) ++end;
            join_fans({shared_.data() + begin, end - begin});
        }
    }

    BoundaryLoops trace() {
        BoundaryLoops loops;
        for (Index c = 0; c < mesh_.corners.size(); ++c) {
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

    Index end(Index side) const { return mesh_.corners[next_side(mesh_, links_.facet[side], side)]; }

    void list_fans() {
        std::vector<std::uint8_t> fans(mesh_.vertex_count(), 0);
        for (Index source : links_.source)
            fans[source] = static_cast<std::uint8_t>(std::min(fans[source] + 1, 2));
        for (Index c = 0; c < mesh_.corners.size(); ++c)
            if (links_.accepted[links_.facet[c]] && links_.twin[c] == no_index && fans[mesh_.corners[c]] > 1)
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

    /// A loop that comes by a vertex twice is cut into loops there.
    void add_simple_loops(BoundaryLoops& loops) {
        std::vector<Index> open;
        for (Index side : path_) {
            const Index v = end(side);
            const auto seen = std::find_if(open.begin(), open.end(), [&](Index s) { return end(s) == v; });
            if (seen != open.end()) {
                add_loop({seen, open.end()}, loops);
                open.erase(seen, open.end());
            }
            open.push_back(side);
        }
        add_loop(open, loops);
    }

    void add_loop(std::span<const Index> sides, BoundaryLoops& loops) const {
        for (Index side : sides) {
            loops.vertices.push_back(end(side));
            loops.facets.push_back(links_.facet[side]);
        }
        loops.begin.push_back(static_cast<Index>(loops.vertices.size()));
    }

    const PolygonMesh& mesh_;
    FacetLinks links_;
    std::vector<Fan> shared_;
    std::vector<Index> next_; ///< per side without twin; cleared as loops are traced
    std::vector<Index> path_;
};

} // namespace

BoundaryLoops boundary_loops(const PolygonMesh& mesh) {
    return HoleTracer(mesh).trace();
}

FillHolesCounts fill_holes(PolygonMesh& mesh, const FillHolesOptions& options) {
    const BoundaryLoops loops = boundary_loops(mesh);
    FillHolesCounts counts;
    counts.loops = loops.size();
    if (loops.size() == 0) return counts;
    BoundaryChords chords(mesh, loops);
    for (std::size_t i = 0; i < loops.size(); ++i) {
        const auto loop = loops[i];
        if (loop.size() > static_cast<std::size_t>(options.max_edges)
            || diameter(mesh, loop) > options.max_diameter)
            continue;
        const std::span<const Index> facets{loops.facets.data() + loops.begin[i], loop.size()};
        LoopTriangulation triangulation(mesh, loop, facets, chords, options.max_bend);
        if (loop.size() < 3 || is_lone_facet(mesh, facets) || !triangulation.run()) {
            ++counts.refused;
            continue;
        }
        const std::size_t before = mesh.facet_count();
        counts.facets += add_facets(mesh, triangulation.triangles(), options.quads);
        for (std::size_t f = before; f < mesh.facet_count(); ++f) chords.add(mesh.facet(f));
        ++counts.closed;
    }
    return counts;
}

} // namespace hsdm
