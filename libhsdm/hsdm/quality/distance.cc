#include "hsdm/quality/distance.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/quality/distance_to_surface.hh"
#include "hsdm/spatial/cell_search.hh"
#include "hsdm/spatial/mesh_distance.hh"
#include "hsdm/spatial/surface_walk.hh"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hsdm {
namespace {

constexpr std::size_t packet = 32;  // most points of a packet, which lie close together
constexpr std::size_t fewest = 6;   // fewest points for which a packet is worth a descent of the tree
constexpr double packet_size = 0.8; // largest diagonal of a packet, in mean sizes of the tree's blocks
// in a packet's radii: a distance up to this is good enough as a bound for the packet
constexpr double near_enough = 0.1;

/// Nearest triangles of points in list order, fast if neighbours in the list are neighbours in space: a
/// packet of such points descends the tree once, and their own searches look only at the few blocks found
/// there.
class Packets {
public:
    Packets(const TriangleTree& tree, std::span<const Vec3> points) : tree_(tree), points_(points) {}

    /// To be called for one point after the other.
    TriangleTree::Nearest operator()(std::size_t i) {
        if (i >= end_) begin_at(i);
        const TriangleTree::Nearest nearest =
            has_part_ ? tree_.nearest(part_, points_[i]) : tree_.nearest(points_[i], hint_);
        hint_ = nearest.triangle;
        return nearest;
    }

private:
    void begin_at(std::size_t first) {
        const double most = packet_size * tree_.block_size();
        Box box, wider;
        for (end_ = first; end_ < std::min(points_.size(), first + packet); ++end_, box = wider) {
            wider.add(points_[end_]);
            if (end_ > first && wider.diagonal() > most) break;
        }
        if (end_ - first >= fewest)
            go_down(points_.subspan(first, end_ - first), box);
        else
            has_part_ = false;
    }

    /// Finds the blocks for a packet. By the triangle inequality no point is farther from its nearest
    /// triangle than from that of the packet's middle point.
    void go_down(std::span<const Vec3> points, const Box& box) {
        const Vec3 centre = 0.5 * (box.lo + box.hi);
        const Vec3& middle =
            *std::min_element(points.begin(), points.end(), [&](const Vec3& p, const Vec3& q) {
                return (p - centre).sqrnorm() < (q - centre).sqrnorm();
            });
        double radius = 0;
        for (const Vec3& p : points) radius = std::max(radius, (p - middle).norm());
        double off = has_part_ ? std::sqrt(tree_.nearest(part_, middle).squared) : Box::inf;
        if (off > near_enough * radius) off = std::sqrt(tree_.nearest(middle, hint_).squared);
        has_part_ = off <= tree_.block_size() && tree_.find_part({box, middle, radius, off}, part_);
    }

    const TriangleTree& tree_;
    std::span<const Vec3> points_;
    std::size_t end_ = 0; // end of the current packet
    Index hint_ = no_index;
    bool has_part_ = false;
    TriangleTree::Part part_;
};

struct Sums {
    double max = -1, sum = 0, squares = 0;
    std::size_t farthest = 0, beyond = 0, first_beyond = 0;
};

/// Sums up distances, chunk by chunk, so that their rounding does not depend on the number of threads.
/// squares() is called once per chunk and returns a function from a point's index to its squared distance.
template <class Squares>
Distance sum_up(std::size_t points, double beyond, Squares squares) {
    if (points == 0) return {};
    std::vector<Sums> chunks(chunk_count(points, chunks::usual));
    for_chunks(points, chunks::usual, [&](std::size_t begin, std::size_t end, std::size_t c) {
        auto squared = squares();
        Sums sums;
        for (std::size_t i = begin; i < end; ++i) {
            const double s = squared(i), d = std::sqrt(s);
            sums.sum += d;
            sums.squares += s;
            if (d > sums.max) sums.max = d, sums.farthest = i;
            if (d > beyond && sums.beyond++ == 0) sums.first_beyond = i;
        }
        chunks[c] = sums;
    });
    Sums total;
    for (const Sums& sums : chunks) {
        total.sum += sums.sum;
        total.squares += sums.squares;
        if (sums.max > total.max) total.max = sums.max, total.farthest = sums.farthest;
        if (total.beyond == 0) total.first_beyond = sums.first_beyond;
        total.beyond += sums.beyond;
    }
    const auto n = static_cast<double>(points);
    return {total.max,      total.sum / n, std::sqrt(total.squares / n),
            total.farthest, total.beyond,  total.first_beyond};
}

} // namespace

Distance points_to_mesh(std::span<const Vec3> points, const MeshDistance& mesh, double beyond) {
    return sum_up(points.size(), beyond, [&] {
        return [packets = Packets(mesh.tree(), points)](std::size_t i) mutable { return packets(i).squared; };
    });
}

Distance points_to_surface(std::span<const Vec3> points, const SurfaceWalk& surface,
                           const DistanceOptions& options) {
    return sum_up(points.size(), options.beyond, [&] {
        return [&, hint = no_index](std::size_t i) mutable {
            return square(surface.distance(points[i], hint, options.enough));
        };
    });
}

Distance points_to_mesh(std::span<const Vec3> points, const PolygonMesh& mesh,
                        const DistanceOptions& options) {
    if (!(options.enough > 0)) return points_to_mesh(points, MeshDistance(mesh), options.beyond);
    return points_to_surface(points, SurfaceWalk(mesh, triangulate(mesh), TriangleTree::Order::given),
                             options);
}

/// Points with no facet in the cells around theirs are searched in the tree, which is rarely built.
std::vector<double> squared_distances_by_cells(std::span<const Vec3> points, const PolygonMesh& mesh,
                                               const FacetCells& cells) {
    if (!cells.usable()) return squared_distances(points, MeshDistance(mesh));
    const Triangulation cut = triangulate(mesh);
    std::vector<double> squared = unwritten_vector<double>(points.size());
    for_chunks(points.size(), chunks::usual, [&](std::size_t begin, std::size_t end, std::size_t) {
        CellSearch search(mesh, cut, cells);
        for (std::size_t i = begin; i < end; ++i) squared[i] = search.squared_distance(points[i]);
    });
    const std::vector<Index> far =
        indices_where(points.size(), chunks::usual, [&](Index i) { return squared[i] == Box::inf; });
    if (!far.empty()) {
        const MeshDistance by_tree(mesh, cut);
        for_chunks(far.size(), chunks::usual, [&](std::size_t begin, std::size_t end, std::size_t) {
            Index hint = no_index;
            for (std::size_t i = begin; i < end; ++i) {
                const double d = by_tree(points[far[i]], hint);
                squared[far[i]] = d * d;
            }
        });
    }
    return squared;
}

Distance points_to_mesh_by_cells(std::span<const Vec3> points, const PolygonMesh& mesh,
                                 const FacetCells& cells, double beyond) {
    if (!cells.usable()) return points_to_mesh(points, MeshDistance(mesh), beyond);
    return summary_of(squared_distances_by_cells(points, mesh, cells), beyond);
}

void DistanceSums::join(const Sums& sums, Sums& total) {
    total.sum += sums.sum;
    total.squares += sums.squares;
    total.max = std::max(total.max, sums.max);
}

void DistanceSums::add(std::span<const double> squared) {
    for_each_in_order(squared.size(), [&](std::size_t k) {
        const std::size_t i = count_++;
        if (i > 0 && i % chunks::usual == 0) join(std::exchange(chunk_, {}), total_);
        const double s = squared[k], d = std::sqrt(s);
        chunk_.sum += d;
        chunk_.squares += s;
        if (d > std::max(total_.max, chunk_.max)) found_.farthest = i;
        chunk_.max = std::max(chunk_.max, d);
        if (d > beyond_ && found_.beyond++ == 0) found_.first_beyond = i;
    });
}

Distance DistanceSums::result() const {
    if (count_ == 0) return {};
    Sums total = total_;
    join(chunk_, total);
    const auto n = static_cast<double>(count_);
    Distance result = found_;
    result.max = total.max, result.mean = total.sum / n, result.rms = std::sqrt(total.squares / n);
    return result;
}

std::vector<double> squared_distances(std::span<const Vec3> points, const MeshDistance& mesh) {
    std::vector<double> squared = unwritten_vector<double>(points.size());
    for_chunks(points.size(), chunks::usual, [&](std::size_t begin, std::size_t end, std::size_t) {
        Packets packets(mesh.tree(), points);
        for (std::size_t i = begin; i < end; ++i) squared[i] = packets(i).squared;
    });
    return squared;
}

Distance summary_of(std::span<const double> squared, double beyond) {
    return sum_up(squared.size(), beyond, [&] { return [&](std::size_t i) { return squared[i]; }; });
}

std::vector<Vec3> sample_surface(const PolygonMesh& mesh, std::size_t count) {
    const Triangulation cut = triangulate(mesh);
    const std::vector<Vec3>& p = mesh.positions;
    std::vector<double> area(cut.size() + 1, 0.0); // running sum
    for (std::size_t t = 0; t < cut.size(); ++t) {
        const auto& [a, b, c] = cut.triangles[t];
        area[t + 1] = area[t] + ((p[b] - p[a]) % (p[c] - p[a])).norm() / 2;
    }
    std::vector<Vec3> samples;
    if (!(area.back() > 0)) return samples;
    samples.resize(count);
    for_chunks(count, chunks::quick, [&](std::size_t i, std::size_t end, std::size_t) {
        for (; i < end; ++i) {
            // Evenly spaced along the running area; inside the triangle the additive recurrence of the two
            // generalised golden ratios of the plane, folded into the triangle.
            const auto n = static_cast<double>(i);
            const double at = (n + 0.5) / static_cast<double>(count) * area.back();
            const auto next = std::upper_bound(area.begin() + 1, area.end() - 1, at);
            const auto& [ia, ib, ic] = cut.triangles[static_cast<std::size_t>(next - area.begin()) - 1];
            double s = std::fmod(0.5 + 0.7548776662466927 * n, 1.0);
            double t = std::fmod(0.5 + 0.5698402909980532 * n, 1.0);
            if (s + t > 1) s = 1 - s, t = 1 - t;
            samples[i] = p[ia] + (p[ib] - p[ia]) * s + (p[ic] - p[ia]) * t;
        }
    });
    return samples;
}

} // namespace hsdm
