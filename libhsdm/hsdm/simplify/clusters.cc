#include "hsdm/simplify/clusters.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/disjoint_sets.hh"
#include "hsdm/core/groups.hh"
#include "hsdm/core/parallel_sort.hh"
#include "hsdm/simplify/border_vertices.hh"
#include "hsdm/simplify/divide_by_planes.hh"

#include <algorithm>
#include <atomic>
#include <span>

namespace hsdm {
namespace {

/// The items for which keep() is true, in order; keep() is called once per item, from many threads.
template <class T, class Keep>
std::vector<T> kept(const std::vector<T>& list, const Keep& keep) {
    return collected<T>(list.size(), chunks::quick,
                        [&](std::size_t i, std::size_t end, std::vector<T>& part) {
                            for (; i < end; ++i)
                                if (keep(list[i])) part.push_back(list[i]);
                        });
}

/// Builds each level of clusters from the one below. Edges and facets are dropped once all their vertices are
/// in one cluster, so their lists shrink by a factor of two or more per level.
class Gathering {
    using Edge = std::pair<Index, Index>;
    using Edges = std::vector<Edge>;

public:
    Gathering(const PolygonMesh& mesh, CellTree& tree, std::span<const Quadric> planes, double tolerance)
        : mesh_(mesh),
          tree_(tree),
          tolerance_(tolerance),
          current_(indices_below(mesh.vertex_count())),
          facets_(indices_below(mesh.facet_count())),
          planes_(planes),
          euler_(large_vector<int>(mesh.vertex_count(), 1)) {
        gather_edges();
    }

    std::vector<ClusterLevel> run() {
        std::vector<ClusterLevel> levels(tree_.levels.size());
        levels.back() = {copy_of_large(tree_.of_vertex), {}, copy_of_large(mesh_.positions)};
        for (std::size_t level = levels.size() - 1; level-- > 0;)
            levels[level] = gather(levels[level + 1], level);
        return levels;
    }

private:
    /// Lists each edge once: an interior edge from the half-edge with the lower start; edges between border
    /// vertices, which may have one half-edge only, by sorting.
    void gather_edges() {
        const std::vector<std::uint8_t> border = border_vertices(mesh_);
        std::vector<Edges> parts(chunk_count(mesh_.facet_count(), chunks::quick)), at_border(parts.size());
        for_chunks(mesh_.facet_count(), chunks::quick,
                   [&](std::size_t f, std::size_t end, std::size_t chunk) {
                       for (; f < end; ++f) {
                           const auto ring = mesh_.facet(f);
                           Index a = ring.back();
                           for (const Index b : ring) {
                               if (border[a] && border[b])
                                   at_border[chunk].emplace_back(std::minmax(a, b));
                               else if (a < b)
                                   parts[chunk].emplace_back(a, b);
                               a = b;
                           }
                       }
                   });
        edges_ = joined(parts);
        Edges beside = joined(at_border); // edges that may be at the border, some twice
        parallel_sort_unique(beside);
        append_large(edges_, beside);
    }

    /// Per cell, are all its children whole?
    std::vector<std::uint8_t> eligible_cells(std::size_t level) const {
        const CellLevel& below = tree_.levels[level + 1];
        std::vector<std::uint8_t> eligible = large_vector<std::uint8_t>(tree_.levels[level].codes.size(), 1);
        for_each_in_order(below.codes.size(), [&](std::size_t c) {
            if (!below.whole[c]) eligible[below.parent[c]] = 0;
        });
        return eligible;
    }

    ClusterLevel gather(ClusterLevel& below, std::size_t level) {
        const std::vector<std::uint8_t> eligible = eligible_cells(level);
        const auto& parent_cell = tree_.levels[level + 1].parent;
        const auto cell_of = [&](Index cluster) { return parent_cell[below.cell[cluster]]; };
        DisjointSets joined(below.size());
        for_each_index(edges_.size(), chunks::quick, [&](Index e) {
            const Index i = current_[edges_[e].first], j = current_[edges_[e].second];
            if (i != no_index && j != no_index && cell_of(i) == cell_of(j)) joined.join(i, j);
        });
        const std::vector<Index> part = divide(joined, below, eligible, level);
        ClusterLevel here;
        assign_large(below.parent, below.size(), no_index);
        for_each_in_order(below.size(), [&](std::size_t k) {
            const auto i = static_cast<Index>(k);
            if (!eligible[cell_of(i)]) return;
            if (part[i] == i) {
                below.parent[i] = static_cast<Index>(here.cell.size());
                push_large(here.cell, cell_of(i));
            } else {
                below.parent[i] = below.parent[part[i]];
            }
        });
        resize_large(here.positions, here.cell.size());
        carry_up(below, here.cell.size());
        decide(here, eligible, level);
        return here;
    }

    /// Per cluster below, the least one that joins the same cluster here: one cluster is all that the surface
    /// connects in the cell or, where no point meets its planes, the parts that divide_by_planes makes.
    std::vector<Index> divide(DisjointSets& joined, const ClusterLevel& below,
                              const std::vector<std::uint8_t>& eligible, std::size_t level) {
        const auto& parent_cell = tree_.levels[level + 1].parent;
        std::vector<Index> part = large_vector<Index>(below.size());
        for_each_index(part.size(), chunks::slow, [&](Index i) { part[i] = joined.find(i); });
        const Groups members(part, part.size());
        std::vector<std::uint8_t> missed = large_vector<std::uint8_t>(below.size());
        for_chunks(below.size(), chunks::slow, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (std::size_t i = begin; i < end; ++i) {
                const Index cell = parent_cell[below.cell[i]];
                if (part[i] != i || !eligible[cell]) continue;
                const Quadric planes = sum_of(members.of(i));
                missed[i] = planes.rms(place_in(planes, box_of(cell, level))) > tolerance_;
            }
        });
        divide_missed(missed, members, below, level, part);
        return part;
    }

    void divide_missed(const std::vector<std::uint8_t>& missed, const Groups& members,
                       const ClusterLevel& below, std::size_t level, std::vector<Index>& part) {
        std::vector<std::array<Index, 3>> sides; // piece, and two of its members that an edge connects
        const auto is_inside = [&](const Edge& edge) {
            const Index i = current_[edge.first], j = current_[edge.second];
            return i != no_index && j != no_index && i != j && part[i] == part[j] && missed[part[i]];
        };
        const Edges inside = kept(edges_, is_inside);
        resize_large(sides, inside.size());
        for_each_index(sides.size(), chunks::light, [&](Index e) {
            const Index i = current_[inside[e].first], j = current_[inside[e].second];
            sides[e] = {part[i], std::min(i, j), std::max(i, j)};
        });
        parallel_sort_unique(sides);
        std::vector<std::pair<Index, std::size_t>> pieces; // piece, and where its sides begin
        std::size_t s = 0;
        for (Index piece = 0; piece < missed.size(); ++piece) {
            if (!missed[piece]) continue;
            while (s < sides.size() && sides[s][0] < piece) ++s;
            pieces.emplace_back(piece, s);
        }
        const auto& parent_cell = tree_.levels[level + 1].parent;
        for_chunks(pieces.size(), 64, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (std::size_t p = begin; p < end; ++p) {
                const Index piece = pieces[p].first;
                divide_piece(members.of(piece), std::span(sides).subspan(pieces[p].second),
                             box_of(parent_cell[below.cell[piece]], level), part);
            }
        });
    }

    /// Divides one piece by its planes. `sides` begins with the piece's own.
    void divide_piece(std::span<const Index> own, std::span<const std::array<Index, 3>> sides, const Box& box,
                      std::vector<Index>& part) const {
        const Index piece = own.front(); // the least stands for it
        std::vector<Quadric> planes;
        for (Index member : own) planes.push_back(planes_[member]);
        const auto local = [&](Index i) {
            return static_cast<Index>(std::lower_bound(own.begin(), own.end(), i) - own.begin());
        };
        std::vector<std::pair<Index, Index>> adjacent;
        for (const auto& [of, i, j] : sides) {
            if (of != piece) break;
            adjacent.emplace_back(local(i), local(j));
        }
        const std::vector<Index> parts = divide_by_planes(planes, adjacent, box, tolerance_);
        for (std::size_t k = 0; k < parts.size(); ++k) part[own[k]] = own[parts[k]];
    }

    /// Sums up quadrics and Euler characteristics of the clusters below, and drops edges and facets that now
    /// lie in one cluster (counted) or touch a vertex without a cluster.
    void carry_up(const ClusterLevel& below, std::size_t count) {
        const Groups members(below.parent, count);
        std::vector<Quadric> sums = large_vector<Quadric>(count);
        std::vector<int> euler = large_vector<int>(count);
        for_each_index(count, chunks::slow, [&](Index i) {
            sums[i] = sum_of(members.of(i));
            for (Index member : members.of(i)) euler[i] += euler_[member];
        });
        const auto change = [&](Index cluster, int by) {
            std::atomic_ref(euler[cluster]).fetch_add(by, std::memory_order_relaxed);
        };
        for_each_index(current_.size(), chunks::slow, [&](Index v) {
            if (current_[v] != no_index) current_[v] = below.parent[current_[v]];
        });
        edges_ = kept(edges_, [&](const Edge& edge) {
            const Index i = current_[edge.first], j = current_[edge.second];
            if (i != no_index && i == j) change(i, -1);
            return i != no_index && j != no_index && i != j;
        });
        facets_ = kept(facets_, [&](Index f) {
            const auto ring = mesh_.facet(f);
            const Index first = current_[ring[0]];
            bool one = true, any_lost = false;
            for (Index v : ring) {
                one = one && current_[v] == first;
                any_lost = any_lost || current_[v] == no_index;
            }
            if (one && !any_lost) change(first, 1);
            return !one && !any_lost;
        });
        sums_ = std::move(sums);
        planes_ = sums_;
        euler_ = std::move(euler);
    }

    Quadric sum_of(std::span<const Index> members) const {
        Quadric sum;
        for (Index member : members) sum += planes_[member];
        return sum;
    }

    void decide(ClusterLevel& here, const std::vector<std::uint8_t>& eligible, std::size_t level) {
        CellLevel& cells = tree_.levels[level];
        std::vector<std::uint8_t> fits = large_vector<std::uint8_t>(here.size());
        for_each_index(here.size(), chunks::slow, [&](Index i) {
            here.positions[i] = place_in(planes_[i], box_of(here.cell[i], level));
            fits[i] = euler_[i] == 1 && planes_[i].rms(here.positions[i]) <= tolerance_;
        });
        cells.whole = eligible;
        for_each_in_order(here.size(), [&](std::size_t i) {
            if (!fits[i]) cells.whole[here.cell[i]] = 0;
        });
    }

    Box box_of(Index cell, std::size_t level) const {
        const double size = tree_.extent / static_cast<double>(1u << level);
        const double slack = 2 * CellTree::rounding * tree_.extent / static_cast<double>(1u << tree_.depth());
        const VoxelCoord c = morton_decode(tree_.levels[level].codes[cell]);
        Box box;
        for (unsigned k = 0; k < 3; ++k) {
            box.lo[k] = c[k] * size - tree_.extent - slack; // codes are shifted by a cube
            box.hi[k] = c[k] * size - tree_.extent + size + slack;
        }
        return box;
    }

    const PolygonMesh& mesh_;
    CellTree& tree_;
    double tolerance_;
    std::vector<Index> current_; // per vertex, its cluster on the current level, or no_index
    Edges edges_;
    std::vector<Index> facets_;
    std::span<const Quadric> planes_; // per cluster of the current level
    std::vector<Quadric> sums_;       // storage of planes_ above the deepest level
    std::vector<int> euler_;          // Euler characteristic of the surface inside each cluster
};

} // namespace

std::vector<ClusterLevel> build_clusters(const PolygonMesh& mesh, CellTree& tree,
                                         std::span<const Quadric> planes, double tolerance) {
    return Gathering(mesh, tree, planes, tolerance).run();
}

} // namespace hsdm
