#include "hsdm/contour/sheet_features.hh"

#include "hsdm/contour/blunt_creases.hh"
#include "hsdm/contour/constants.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/facet_normal.hh"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hsdm {
namespace {

/// The angle at an edge, measured in the plane across it from one sheet's normal to the other's.
struct Fold {
    Vec3 from, to;
    double angle;

    Fold(const Vec3& a, const Vec3& b) : from(a), to(b), angle(angle_between(a, b)) {}
};

/// The points around a fold, projected along it: at a crease their normals have two directions, on a bend all
/// in between.
class FoldPoints {
public:
    FoldPoints(const Octree& octree, const OctreeLevel& level) : octree_(octree), level_(level) {}

    void gather(const Fold& fold, std::span<const Index> voxels, const Vec3& a, const Vec3& b) {
        points_.clear();
        angle_ = fold.angle;
        const Vec3 axis = unit(fold.from % fold.to), along = axis % fold.from;
        const double length = (b - a).norm();
        const Vec3 edge = unit(b - a);
        for (Index v : voxels)
            for (Index i = level_.first_point[v]; i < level_.first_point[v + 1]; ++i) {
                const Vec3& n = octree_.normals[i];
                if (n.sqrnorm() < 0.5 || std::abs(n | axis) > edge_hints::off_fold_sine) continue;
                const double direction = std::atan2(n | along, n | fold.from);
                if (direction < -0.5 * angle_ || direction > 1.5 * angle_) continue;
                const Vec3 arm = octree_.positions[i] - a;
                const Vec3 off_edge = arm - edge * std::clamp(arm | edge, 0.0, length);
                points_.push_back({arm | along, arm | fold.from, direction,
                                   off_edge.norm() <= edge_hints::nearby * level_.voxel_size});
            }
    }

    bool empty() const { return points_.empty(); }

    /// Is the fold a crease: normals of both sheets and hardly any in between, both near the edge and among
    /// all points?
    bool crease() const {
        double low = 0, high = 0, middle = 0, near = 0, near_middle = 0;
        for (const Point& p : points_) {
            const bool is_middle = between(p);
            (is_middle ? middle : 2 * p.direction < angle_ ? low : high) += 1;
            near += p.near;
            near_middle += p.near && is_middle;
        }
        const auto all = static_cast<double>(points_.size());
        // Each sheet is there: it has half as many as may lie between at least.
        return std::min(low, high) > edge_hints::most_between / 2 * all
               && middle <= edge_hints::most_between * all && near_middle <= edge_hints::most_between * near;
    }

    /// Counts the points with normals in between, and those of them whose normals contradict the chords to
    /// the points close by. On a smooth arc a chord is perpendicular to the sum of the normals at its ends;
    /// if normals are smeared across a crease, they turn while the points run straight on. Of many points
    /// some are looked at, evenly taken.
    void count_tilted(std::size_t& middle, std::size_t& tilted) const {
        const std::size_t stride = stride_for(edge_hints::most_compared);
        for (std::size_t i = 0; i < points_.size(); i += stride) {
            const Point& p = points_[i];
            if (!between(p)) continue;
            middle += stride; // speaks for those between it and the next one
            if (std::abs(tilt(p)) > edge_hints::end_band / 2 * angle_) tilted += stride;
        }
    }

private:
    struct Point {
        double x, y;      // along the second and the first axis of the fold's plane
        double direction; // of its normal, from the fold's first
        bool near;
    };

    /// So that at most so many are taken of the points.
    std::size_t stride_for(std::size_t most) const { return (points_.size() + most - 1) / most; }

    bool between(const Point& p) const {
        return p.direction >= edge_hints::end_band * angle_
               && p.direction <= (1 - edge_hints::end_band) * angle_;
    }

    double tilt(const Point& p) const {
        double rise = 0, run = 0;
        const std::size_t stride = stride_for(edge_hints::most_chords);
        for (std::size_t i = 0; i < points_.size(); i += stride) {
            const Point& q = points_[i];
            const double dx = q.x - p.x, dy = q.y - p.y, mean = 0.5 * (p.direction + q.direction);
            if (dx * dx + dy * dy
                > edge_hints::chord * edge_hints::chord * level_.voxel_size * level_.voxel_size)
                continue;
            const double forward = dx * std::cos(mean) - dy * std::sin(mean);
            const double up = dx * std::sin(mean) + dy * std::cos(mean);
            rise += forward >= 0 ? up : -up;
            run += std::abs(forward);
        }
        return std::atan2(rise, run);
    }

    const Octree& octree_;
    const OctreeLevel& level_;
    std::vector<Point> points_;
    double angle_ = 0;
};

/// Counts of one chunk of sides.
struct Tally {
    std::size_t sharp = 0, smooth = 0, middle = 0, tilted = 0;
};

/// The facets of a mesh, oriented as the points' normals are.
class SheetFacets {
public:
    SheetFacets(const OctreeLevel& level, const NormalSets& sets, const PolygonMesh& mesh,
                std::span<const Index> voxel, bool turned)
        : level_(level), sets_(sets), mesh_(mesh), voxel_(voxel), normals_(mesh.facet_count()) {
        for_each_index(normals_.size(), chunks::slow, [&](Index f) {
            normals_[f] = unit(area_vector(mesh, mesh.facet(f))) * (turned ? -1 : 1);
        });
    }

    const Vec3& normal(Index f) const { return normals_[f]; }
    /// The set whose sheet a facet is part of: among the sets in its vertices' voxels the one whose plane is
    /// nearest in direction and position; no_index if none is within 60 degrees of the facet's normal.
    Index set(Index f) const;
    const Vec3& sheet_normal(Index of_set, const Vec3& otherwise) const {
        return of_set != no_index ? sets_.sets[of_set].normal : otherwise;
    }
    /// Are two sheets flat, if there are, rather than parts of a round surface that makes the fold?
    bool are_flat(Index one, Index other, const Fold& fold, std::span<const Index> voxels) const {
        if (one == other || one == no_index || other == no_index) return true;
        const NormalSet &a = sets_.sets[one], &b = sets_.sets[other];
        const Vec3 way = b.centroid - a.centroid;
        return is_flat(a, fold, way, voxels) && is_flat(b, fold, way, voxels);
    }
    /// Voxels of the vertices of two facets, ascending, each once.
    void voxels_of(Index f, Index g, std::vector<Index>& voxels) const {
        voxels.clear();
        for (Index facet : {f, g})
            for (Index v : mesh_.facet(facet)) voxels.push_back(voxel_[v]);
        sort_unique(voxels);
    }

private:
    /// Is the set, or with noise what has its normal in these voxels, rather flat than round?
    bool is_flat(const NormalSet& one, const Fold& fold, const Vec3& from_one_to_other,
                 std::span<const Index> voxels) const {
        const Vec3 bend = fold.to - fold.from;
        const double way = from_one_to_other | bend;
        if (is_nearer_to_flat(one.turn, one.spread.along(bend), way)) return true;
        const double near = 1 - 0.5 * edge_hints::end_band * edge_hints::end_band * bend.sqrnorm();
        double turn = 0, extent = 0;
        for (const Index v : voxels)
            for (const NormalSet& set : sets_.of_voxel(v)) {
                if ((set.normal | one.normal) < near) continue;
                turn += set.count * set.turn;
                extent += set.count * set.spread.along(bend);
            }
        return is_nearer_to_flat(turn, extent, way);
    }

    const OctreeLevel& level_;
    const NormalSets& sets_;
    const PolygonMesh& mesh_;
    std::span<const Index> voxel_;
    std::vector<Vec3> normals_;
};

Index SheetFacets::set(Index f) const {
    const auto facet = mesh_.facet(f);
    const Vec3 centre = centroid(mesh_, facet);
    Index best = no_index;
    double least = std::numeric_limits<double>::infinity();
    for (Index v : facet)
        for (Index s = sets_.first[voxel_[v]]; s < sets_.first[voxel_[v] + 1]; ++s) {
            const NormalSet& set = sets_.sets[s];
            const Vec3 arm = (centre - set.centroid) / level_.voxel_size;
            const double cosine = set.normal | normals_[f];
            if (cosine < angles::facing) continue;
            // The arm's small weight (a twentieth) chooses the nearest of one sheet's sets and sways nothing
            // else.
            const double cost = 1 - cosine + std::abs(set.normal | arm) + edge_hints::arm_weight * arm.norm();
            if (cost < least || (cost == least && s < best)) least = cost, best = s;
        }
    return best;
}

class EdgeJudge {
public:
    EdgeJudge(const Octree& octree, const OctreeLevel& level, const SheetFacets& facets, double crease_angle)
        : facets_(facets),
          crease_angle_(crease_angle),
          flat_(std::cos(edge_hints::least_fold * crease_angle)
                + 1e-9), // slack: only the exact test below decides
          points_(octree, level) {}

    /// The edge of facets f and g from a to b.
    EdgeHint judge(Index f, Index g, const Vec3& a, const Vec3& b, Tally& tally) {
        if ((facets_.normal(f) | facets_.normal(g)) > flat_) return EdgeHint::none;
        const Fold facets(facets_.normal(f), facets_.normal(g));
        if (!(facets.angle >= edge_hints::least_fold * crease_angle_)) return EdgeHint::none;
        const Index one = facets_.set(f), other = facets_.set(g);
        Fold fold = one != other
                        ? Fold(facets_.sheet_normal(one, facets.from), facets_.sheet_normal(other, facets.to))
                        : facets;
        if (fold.angle < crease_angle_) fold = facets;
        if (fold.angle < crease_angle_) return EdgeHint::none;
        facets_.voxels_of(f, g, voxels_);
        points_.gather(fold, voxels_, a, b);
        if (points_.empty()) return EdgeHint::none;
        const bool crease = points_.crease() && facets_.are_flat(one, other, fold, voxels_);
        ++(crease ? tally.sharp : tally.smooth);
        if (!crease) points_.count_tilted(tally.middle, tally.tilted);
        return crease ? EdgeHint::sharp : EdgeHint::smooth;
    }

private:
    const SheetFacets& facets_;
    double crease_angle_, flat_;
    FoldPoints points_;
    std::vector<Index> voxels_;
};

} // namespace

SheetFeatures judge_edges(const Octree& octree, const OctreeLevel& level, const NormalSets& sets,
                          const PolygonMesh& mesh, const FacetLinks& links, std::span<const Index> voxel,
                          double crease_angle, bool turned, std::span<const std::uint8_t> counted) {
    SheetFeatures result;
    auto& sides = result.hints.sides;
    assign_large(sides, mesh.corners.size(), EdgeHint::none);
    const SheetFacets facets(level, sets, mesh, voxel, turned);
    std::vector<Tally> tallies(chunk_count(sides.size(), 4 * chunks::slow));
    for_chunks(sides.size(), 4 * chunks::slow, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
        EdgeJudge judge(octree, level, facets, crease_angle);
        Tally others;
        for (std::size_t c = begin; c < end; ++c) {
            const Index twin = links.twin[c], facet = links.facet[c];
            if (twin == no_index || twin < c) continue;
            const bool counts = counted.empty() || counted[facet] != 0;
            sides[c] = sides[twin] =
                judge.judge(facet, links.facet[twin], mesh.positions[mesh.corners[c]],
                            mesh.positions[mesh.corners[twin]], counts ? tallies[chunk] : others);
        }
    });
    for (const Tally& t : tallies) {
        result.sharp += t.sharp;
        result.smooth += t.smooth;
        result.middle += t.middle;
        result.tilted += t.tilted;
    }
    return result;
}

void judge_normals(SheetFeatures& features) {
    if (static_cast<double>(features.tilted)
        <= edge_hints::most_tilted * static_cast<double>(features.middle))
        return;
    auto& sides = features.hints.sides;
    std::replace(sides.begin(), sides.end(), EdgeHint::smooth, EdgeHint::none);
    features.doubtful = std::exchange(features.smooth, 0);
}

SheetFeatures sheet_features(const Octree& octree, const OctreeLevel& level, const NormalSets& sets,
                             const PolygonMesh& mesh, const FacetLinks& links, std::span<const Index> voxel,
                             double crease_angle, bool turned) {
    SheetFeatures result = judge_edges(octree, level, sets, mesh, links, voxel, crease_angle, turned);
    judge_normals(result);
    return result;
}

} // namespace hsdm
