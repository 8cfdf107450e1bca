#include "hsdm/contour/point_fit.hh"

#include "hsdm/contour/constants.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/octree/constants.hh"
#include "hsdm/spatial/eight_triangles.hh"

#include <bit>
#include <cmath>

namespace hsdm {
namespace {

/// The facets round vertices, each cut into two triangles at its first corner, the vertex. Memory is kept
/// from one use to the next: making eight triangles zero costs as much as filling them.
class Around {
public:
    void clear() { size_ = 0; }
    bool empty() const { return size_ == 0; }
    /// Of a facet that begins at a vertex.
    void add(const std::vector<Vec3>& at, Index dual, Index next, Index across, Index before) {
        if (size_ == corners_.size()) {
            corners_.resize(size_ + EightTriangles::size);
            eights_.emplace_back();
        }
        const std::size_t lane = size_ % EightTriangles::size; // an even one
        EightTriangles& eight = eights_[size_ / EightTriangles::size];
        eight.put(lane, at[dual], at[next], at[across]);
        eight.put(lane + 1, at[dual], at[across], at[before]);
        corners_[size_++] = {dual, next, across};
        corners_[size_++] = {dual, across, before};
    }
    void prepare() {
        if (const std::size_t lane = size_ % EightTriangles::size; lane > 0)
            eights_[size_ / EightTriangles::size].fill_up(lane);
        for (std::size_t e = 0; e < eights(); ++e) lanes_.prepare(eights_[e]);
    }

    std::span<const std::array<Index, 3>> corners() const { return {corners_.data(), size_}; }
    std::size_t eights() const { return chunk_count(size_, EightTriangles::size); }
    /// Sets for each eight the bits of the triangles that have the foot of p inside; returns what follows.
    unsigned* set_feet_inside(const Vec3& p, unsigned* within) const {
        for (std::size_t e = 0; e < eights(); ++e) *within++ = lanes_.feet_inside(eights_[e], p);
        return within;
    }
    NearestOfTriangle foot(std::size_t triangle, const Vec3& p) const {
        return eights_[triangle / EightTriangles::size].foot(triangle % EightTriangles::size, p);
    }

private:
    std::vector<std::array<Index, 3>> corners_; // of the triangles
    std::vector<EightTriangles> eights_;
    std::size_t size_ = 0;
    const TriangleLanes& lanes_ = triangle_lanes().front();
};

/// The point of the facets nearest to a given one, and the vertices of its triangle.
struct Foot {
    std::array<Index, 3> corners{};
    NearestOfTriangle nearest{Vec3(0, 0, 0), std::numeric_limits<double>::infinity(), {}};
};

/// Appends the facets round a vertex.
void list_facets(Index dual, const DualVertices& duals, const std::vector<Vec3>& at, Around& around) {
    duals.for_each_corner(dual, [&](FacetCorner corner) {
        around.add(at, dual, duals.to(corner), duals.from(corner.opposite()), duals.from(corner.previous()));
    });
}

/// The foot of p: the nearest perpendicular foot inside a triangle, or, if there is none, the nearest point
/// of any triangle.
Foot find_foot(const Vec3& p, const Around& around, const unsigned* feet_inside,
               const std::vector<Vec3>& at) {
    Foot best;
    std::size_t nearest = around.corners().size(); // of the triangles
    for (std::size_t e = 0; e < around.eights(); ++e)
        for (unsigned within = feet_inside[e]; within != 0; within &= within - 1) {
            const std::size_t t =
                e * EightTriangles::size + static_cast<std::size_t>(std::countr_zero(within));
            const NearestOfTriangle foot = around.foot(t, p);
            if (foot.squared_distance < best.nearest.squared_distance) best.nearest = foot, nearest = t;
        }
    if (nearest < around.corners().size()) {
        best.corners = around.corners()[nearest];
        return best;
    }
    for (const std::array<Index, 3>& corners : around.corners()) {
        const PreparedTriangle triangle(at[corners[0]], at[corners[1]], at[corners[2]]);
        const NearestOfTriangle foot = triangle.nearest(p);
        if (foot.squared_distance < best.nearest.squared_distance) best = {corners, foot};
    }
    return best;
}

/// Where blocks of 16 x 16 x 16 voxels begin, and the number of voxels.
std::vector<Index> blocks_of(const OctreeLevel& level) {
    constexpr int block_bits = 3 * 4; // bits of a code
    std::vector<Index> first = indices_where(level.size(), chunks::light, [&](Index v) {
        return v == 0 || level.codes[v] >> block_bits != level.codes[v - 1] >> block_bits;
    });
    first.push_back(static_cast<Index>(level.size()));
    return first;
}

} // namespace

std::size_t sample_stride(std::size_t points) {
    return chunk_count(points, static_cast<std::size_t>(spacings::points_per_voxel));
}

double PointFit::Heights::variance() const {
    if (!(weight > 0)) return 0;
    const double m = mean(), squares = height2 - 2 * m * weight2_height + m * m * weight2;
    // weight^2 / weight2 is the effective number of points.
    const double freedom = weight * weight - weight2;
    return freedom > 1e-12 * weight * weight ? std::max(squares, 0.0) / freedom : m * m;
}

PointFit::PointFit(const Octree& octree, const OctreeLevel& level, const DualVertices& duals,
                   const PlacedVertices& vertices)
    : octree_(octree),
      level_(level),
      duals_(duals),
      vertices_(vertices),
      of_voxel_(std::span(vertices.voxel).first(duals.size()), level.size()),
      rises_(unwritten_vector<std::uint8_t>(duals.size())) {
    for_each_index(duals.size(), chunks::light, [&](Index v) {
        rises_[v] = vertices.classes[v] == VertexClass::smooth && !duals.open[v];
    });
}

PointFit::ForeignHeights::ForeignHeights(const std::array<std::vector<Foreign>, ranges>& by_range) {
    std::size_t size = 0;
    for (const std::vector<Foreign>& of_range : by_range) size += of_range.size();
    all.reserve(size);
    for (std::size_t r = 0; r < ranges; ++r) {
        all.insert(all.end(), by_range[r].begin(), by_range[r].end());
        first[r + 1] = static_cast<Index>(all.size());
    }
}

void PointFit::gather_beside(Index voxel, std::vector<Index>& duals) const {
    duals.clear();
    const VoxelCoord at = level_.coord(voxel);
    for (std::size_t k = 0; k < 6; ++k) { // the first six offsets are those across faces
        const VoxelCoord& d = neighbor_offsets[k];
        const Index x = level_.find({at[0] + d[0], at[1] + d[1], at[2] + d[2]});
        if (x != no_index) duals.insert(duals.end(), of_voxel_.of(x).begin(), of_voxel_.of(x).end());
    }
}

PointFit::Measure PointFit::measure(const std::vector<Vec3>& positions) const {
    Measure result{large_vector<double>(level_.size(), 0), {}, large_vector<Heights>(duals_.size())};
    std::vector<double> farthest_of = large_vector<double>(level_.size(), 0);
    // Contributions to vertices in other blocks' voxels are added afterwards, in the order of the blocks:
    // places in space, so that sums come out the same where only part of the level is known. They are kept by
    // ranges of vertices, to which they are added in parallel.
    const std::vector<Index> blocks = blocks_of(level_);
    std::vector<ForeignHeights> foreign(blocks.size() - 1);
    const auto per_range = static_cast<Index>(chunk_count(duals_.size(), ranges));
    const Vec3* const upward = vertices_.directions.data();
    const std::uint8_t* const is_asked = rises_.data();
    const Index* const voxel_of = vertices_.voxel.data();
    Heights* const heights = result.heights.data();
    for_each_task(foreign.size(), [&](std::size_t chunk) {
        const std::size_t begin = blocks[chunk], end = blocks[chunk + 1];
        std::vector<Index> beside;
        Around around;
        std::vector<unsigned> inside;
        std::array<std::vector<Foreign>, ranges> elsewhere;
        for (std::size_t x = begin; x < end; ++x) {
            if (of_voxel_.of(x).empty()) gather_beside(static_cast<Index>(x), beside);
            const std::span<const Index> near = of_voxel_.of(x).empty() ? beside : of_voxel_.of(x);
            around.clear();
            for (Index dual : near) list_facets(dual, duals_, positions, around);
            if (around.empty()) continue;
            around.prepare();
            const std::size_t first = level_.first_point[x], last = level_.first_point[x + 1];
            const std::size_t stride = sample_stride(last - first);
            // Of all points first: what follows waits for it where branches are guessed wrong.
            inside.resize(std::max(inside.size(), around.eights() * chunk_count(last - first, stride)));
            unsigned* end_of_inside = inside.data();
            for (std::size_t i = first; i < last; i += stride)
                end_of_inside = around.set_feet_inside(octree_.positions[i], end_of_inside);
            const unsigned* of_point = inside.data();
            double misfit = 0, farthest = 0;
            for (std::size_t i = first; i < last; i += stride, of_point += around.eights()) {
                const Foot foot = find_foot(octree_.positions[i], around, of_point, positions);
                const double distance = std::sqrt(foot.nearest.squared_distance);
                misfit += distance;
                farthest = std::max(farthest, distance);
                const Vec3 way = octree_.positions[i] - foot.nearest.point, normal = octree_.normals[i];
                const double least = angles::one_sheet * distance;
                for (std::size_t k = 0; k < 3; ++k) {
                    const Index v = foot.corners[k], voxel = voxel_of[v];
                    if (!is_asked[v]) continue;
                    const Vec3& up = upward[v];
                    const double height = up | way;
                    if ((normal | up) < angles::one_sheet
                        || std::abs(height) < least) // the point lies beside the facets, not above
                        continue;
                    if (voxel >= begin && voxel < end)
                        heights[v].add(foot.nearest.weights[k], height);
                    else
                        elsewhere[v / per_range].push_back({v, foot.nearest.weights[k], height});
                }
            }
            result.misfit[x] = misfit;
            farthest_of[x] = farthest;
        }
        foreign[chunk] = ForeignHeights(elsewhere);
    });
    for_each_task(ranges, [&](std::size_t range) {
        for (const ForeignHeights& of_block : foreign)
            for (Index k = of_block.first[range]; k < of_block.first[range + 1]; ++k)
                heights[of_block.all[k].dual].add(of_block.all[k].weight, of_block.all[k].height);
    });
    foreign = {};
    result.standing_out = standing_out(farthest_of, result.misfit);
    return result;
}

std::vector<Index> PointFit::standing_out(const std::vector<double>& farthest,
                                          const std::vector<double>& misfit) const {
    return indices_where(level_.size(), chunks::light, [&](Index x) {
        if (!(farthest[x] > relations::smooth_gap * level_.voxel_size)) return false;
        double sum = 0;
        std::size_t count = 0;
        for_neighbors(level_, x, [&](Index v) {
            if (!(misfit[v] > 0)) return; // there are no facets near it, or all points lie on them
            const std::size_t points = level_.first_point[v + 1] - level_.first_point[v];
            sum += misfit[v], count += chunk_count(points, sample_stride(points));
        });
        return count == 0 || farthest[x] * static_cast<double>(count) > reach::means * sum;
    });
}

std::vector<double> PointFit::rises(const std::vector<Heights>& heights) const {
    struct Moments {
        double square, variance; // of the mean
    };
    std::vector<Moments> of_mean = unwritten_vector<Moments>(duals_.size());
    for_each_index(duals_.size(), 2 * chunks::heavy, [&](Index v) {
        of_mean[v] = {heights[v].mean() * heights[v].mean(), heights[v].variance()};
    });
    std::vector<double> rises = large_vector<double>(duals_.size(), 0);
    for_each_index(duals_.size(), 2 * chunks::heavy, [&](Index v) {
        Moments sum{0, 0};
        duals_.for_each_corner(v, [&](FacetCorner corner) {
            for (const FacetCorner beside : corners_of_facet(corner.crossing())) {
                const Moments& other = of_mean[duals_.from(beside)];
                sum.square += other.square;
                sum.variance += other.variance;
            }
        });
        if (sum.square > relaxation::doubt * sum.variance)
            rises[v] = heights[v].mean() * (1 - relaxation::doubt * sum.variance / sum.square);
    });
    return rises;
}

} // namespace hsdm
