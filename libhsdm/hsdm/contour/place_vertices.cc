#include "hsdm/contour/place_vertices.hh"

#include "hsdm/contour/blunt_creases.hh"
#include "hsdm/contour/constants.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/large_vector.hh"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace hsdm {
namespace {

struct WeightedPlane {
    Vec3 normal;
    Vec3 point;
    double weight;
};

/// The QEF of one vertex, and the box it must stay in.
struct Problem {
    std::vector<WeightedPlane> planes;
    Vec3 mean; // mean of the crossings, which lie on the box's surface: inside the box
    Vec3 lo;   // of the box
    Vec3 extent;
    VoxelCoord voxel; // what the box is, if no crossing lies outside
    double size = 0;  // of that
};

/// One normal per sheet that the planes belong to, at most three: each that of the plane which the others
/// left agree with most, so that it lies amid its sheet.
struct SheetNormals {
    std::array<Vec3, 3> normals;
    int count = 0;

    explicit SheetNormals(const Vec3& normal) : normals{normal}, count(1) {}
    explicit SheetNormals(const std::vector<WeightedPlane>& planes) {
        while (count < 3) {
            const WeightedPlane* best = nullptr;
            double most = -1;
            for (const WeightedPlane& plane : planes) {
                if (is_covered(plane.normal)) continue;
                double sum = 0;
                for (const WeightedPlane& other : planes)
                    if (!is_covered(other.normal)) sum += std::max(0.0, plane.normal | other.normal);
                if (sum > most) best = &plane, most = sum;
            }
            if (!best) return;
            normals[static_cast<std::size_t>(count++)] = best->normal;
        }
    }

private:
    bool is_covered(const Vec3& normal) const {
        return std::any_of(normals.begin(), normals.begin() + count,
                           [&](const Vec3& n) { return (n | normal) > angles::one_sheet; });
    }
};

struct Solution {
    Vec3 position;
    int rank = 0; // directions the planes determine
    Vec3 steep;   // rank 1: the common normal, of either sign
    Vec3 free;    // rank 2: along the crease
    // The energy x A x - 2 b x that the position minimises, x relative to the mean; a small term holds
    // directions that the planes leave open.
    Eigen::Matrix3d a;
    Eigen::Vector3d b;
};

/// Minimises sum w (n . (x - p))^2; stays at the mean in the directions the planes leave open, and in all but
/// the `most_rank` steepest.
Solution least_squares(const Problem& problem, int most_rank) {
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (const WeightedPlane& plane : problem.planes) {
        const Eigen::Vector3d n(plane.normal[0], plane.normal[1], plane.normal[2]);
        a += plane.weight * n * n.transpose();
        b += plane.weight * (plane.normal | (plane.point - problem.mean)) * n;
    }
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
    eigen.computeDirect(a);
    const Eigen::Vector3d values = eigen.eigenvalues(); // ascending
    Solution solution;
    solution.a = placement::hold * values[2] * Eigen::Matrix3d::Identity();
    solution.b.setZero();
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    for (int k = 2; k >= 0 && solution.rank < most_rank; --k) {
        if (values[k] < placement::least_singular * values[2] || values[k] <= 0) break;
        const Eigen::Vector3d v = eigen.eigenvectors().col(k);
        x += v * (v.dot(b) / values[k]);
        solution.a += values[k] * v * v.transpose();
        solution.b += v.dot(b) * v;
        ++solution.rank;
    }
    const Eigen::Vector3d free = eigen.eigenvectors().col(0);
    solution.position = problem.mean + Vec3(x[0], x[1], x[2]);
    const Eigen::Vector3d steep = eigen.eigenvectors().col(2);
    solution.free = Vec3(free[0], free[1], free[2]);
    solution.steep = Vec3(steep[0], steep[1], steep[2]);
    return solution;
}

/// Root mean square distance of a point from the planes.
double misfit(const Vec3& p, const Problem& problem) {
    double sum = 0, weight = 0;
    for (const WeightedPlane& plane : problem.planes) {
        const double d = plane.normal | (p - plane.point);
        sum += plane.weight * d * d;
        weight += plane.weight;
    }
    return std::sqrt(sum / weight);
}

/// Is a point inside the box by at least `slack` voxels, or, if negative, outside by at most that?
bool is_inside(const Vec3& p, const Problem& problem, double slack = placement::margin) {
    for (unsigned k = 0; k < 3; ++k) {
        const double at = (p[k] - problem.lo[k]) / problem.size;
        if (at < slack || at > problem.extent[k] / problem.size - slack) return false;
    }
    return true;
}

Vec3 clamped(Vec3 p, const Problem& problem) {
    const double slack = placement::margin * problem.size;
    for (unsigned k = 0; k < 3; ++k)
        p[k] = std::clamp(p[k], problem.lo[k] + slack, problem.lo[k] + problem.extent[k] - slack);
    return p;
}

/// The point of the box with the least energy: the best of the minimisers inside the box, on each face, edge
/// and corner, each from a linear system for the coordinates that are not at a bound.
Vec3 least_in_box(const Solution& solution, const Problem& problem) {
    const double slack = placement::margin * problem.size;
    Eigen::Vector3d lo, hi;
    for (unsigned k = 0; k < 3; ++k) {
        lo[k] = problem.lo[k] + slack - problem.mean[k];
        hi[k] = problem.lo[k] + problem.extent[k] - slack - problem.mean[k];
    }
    Eigen::Vector3d best = Eigen::Vector3d::Zero();
    double least = std::numeric_limits<double>::infinity();
    for (int way = 1; way < 27; ++way) { // per axis: free, at the lower, at the upper bound
        const std::array<int, 3> held{way % 3, way / 3 % 3, way / 9};
        Eigen::Matrix3d a = solution.a;
        Eigen::Vector3d b = solution.b;
        for (int k = 0; k < 3; ++k) {
            const auto axis = static_cast<std::size_t>(k);
            if (held[axis] == 0) continue;
            a.row(k).setZero();
            a(k, k) = 1;
            b[k] = held[axis] == 1 ? lo[k] : hi[k];
        }
        Eigen::Vector3d x = a.partialPivLu().solve(b);
        if (((x - lo).array() < -1e-9 * problem.size).any()
            || ((hi - x).array() < -1e-9 * problem.size).any())
            continue;
        const double energy = x.dot(solution.a * x) - 2 * solution.b.dot(x);
        if (energy < least) least = energy, best = x;
    }
    return clamped(problem.mean + Vec3(best[0], best[1], best[2]), problem);
}

/// Per set, does its sheet cross an edge of the set's own voxel? Noted when the voxel's vertices are placed.
struct Crossers {
    std::vector<std::uint8_t> of_set;
    bool known = false; // have all vertices been looked at?

    void note(Index s) { std::atomic_ref(of_set[s]).store(1, std::memory_order_relaxed); }
};

class Placer {
public:
    Placer(const DualMesh& mesh, const NormalSets& sets, const RelationTest& related, Crossers& crosses)
        : mesh_(mesh),
          sets_(sets),
          related_(related),
          crosses_(crosses),
          half_sheet_cosine_(std::sqrt((1 + angles::one_sheet) / 2) + 1e-9) {}

    std::vector<PlacedVertices::Beyond> beyond;
    std::vector<PlacedVertices::OnCrease> on_creases;

    /// False, and nothing is done but to note the sets that cross, if all of these must be known before.
    bool place(Index dual, PlacedVertices& result) {
        if (!gather(dual)) return false;
        const auto corners = mesh_.duals.corners_of(dual);
        const FacetCorner first = std::min(corners.front(), corners.back());
        const Index nearest = sets_.sets[mesh_.crossings.of(first).set].voxel;
        result.voxel[dual] = voxel_ != no_index ? voxel_ : nearest;
        SheetNormals faces = by_crease_       ? faces_that_meet()
                             : is_one_sheet() ? SheetNormals(problem_.planes[0].normal)
                                              : SheetNormals(problem_.planes);
        Solution solution = least_squares(problem_, faces.count);
        if (faces.count == 2 && solution.rank == 2 && add_corner_plane(dual)) {
            faces.normals[2] = problem_.planes.back().normal;
            faces.count = 3;
            solution = least_squares(problem_, faces.count);
        }
        if (!is_inside(solution.position, problem_) && !may_leave(solution.position)) {
            note_corner(dual, solution, faces);
            const Vec3 unclamped = solution.position;
            result.is_clamped[dual] = keep_inside(solution);
            if (result.is_clamped[dual] && faces.count == 2
                && meet(2, solution, unclamped, placement::farthest_out / 2, placement::clear_crease)) {
                on_creases.push_back({dual, unclamped, {faces.normals[0], faces.normals[1]}});
            }
        }
        result.positions[dual] = solution.position;
        const bool upward = (solution.steep | problem_.planes[0].normal) > 0;
        result.directions[dual] =
            solution.rank > 1 && faces.count > 1 ? solution.free : solution.steep * (upward ? 1.0 : -1.0);
        result.classes[dual] = faces.count == 1 || solution.rank < 2 ? VertexClass::smooth
                               : solution.rank == 2                  ? VertexClass::edge
                                                                     : VertexClass::corner;
        return true;
    }

private:
    /// Are all normals so near the first one that any two of them are of one sheet?
    bool is_one_sheet() const {
        const Vec3& first = problem_.planes[0].normal;
        return std::ranges::all_of(problem_.planes, [&](const WeightedPlane& plane) {
            return (plane.normal | first) > half_sheet_cosine_;
        });
    }

    /// One normal per sheet, but two for a sheet whose two faces meet in a blunt crease in the voxel.
    SheetNormals faces_that_meet() {
        const SheetNormals sheets(problem_.planes);
        SheetNormals faces = sheets;
        for (int k = 0; k < sheets.count && faces.count < 3; ++k) {
            const Vec3& sheet = sheets.normals[static_cast<std::size_t>(k)];
            samples_.clear();
            for (const WeightedPlane& plane : problem_.planes)
                if ((plane.normal | sheet) > angles::one_sheet)
                    samples_.push_back({plane.point, plane.normal, plane.weight});
            face_.resize(samples_.size());
            BluntCrease crease;
            if (!find_blunt_crease(samples_, 0, face_, crease)) continue;
            faces.normals[static_cast<std::size_t>(k)] = crease.normals[0];
            faces.normals[static_cast<std::size_t>(faces.count++)] = crease.normals[1];
        }
        const Vec3 meeting = least_squares(problem_, faces.count).position;
        return is_inside(meeting, problem_, -placement::farthest_out / 2) ? faces : sheets;
    }

    bool gather(Index dual) {
        problem_.planes.clear();
        by_crease_ = false;
        problem_.size = mesh_.voxel_size;
        const auto corners = mesh_.duals.corners_of(dual);
        const CornerVoxel& at = mesh_.duals.voxels[dual];
        voxel_ = at.voxel;
        problem_.voxel = at.coord;
        for (unsigned k = 0; k < 3; ++k) problem_.lo[k] = at.coord[k] * mesh_.voxel_size;
        problem_.extent = Vec3(1, 1, 1) * mesh_.voxel_size;
        problem_.mean = Vec3(0, 0, 0);
        mesh_.duals.for_each_corner(dual, [&](FacetCorner corner) {
            const Vec3 p = mesh_.crossing_position_of(corner, dual);
            problem_.planes.push_back({mesh_.crossings.of(corner).normal, p, 1});
            by_crease_ |= mesh_.crossings.of(corner).by_crease;
            problem_.mean += p;
        });
        is_moved_ = mesh_.is_moved(dual);
        if (is_moved_) {
            Vec3 hi = problem_.lo + problem_.extent;
            mesh_.include_crossings(dual, problem_.lo, hi);
            problem_.extent = hi - problem_.lo;
        }
        std::ranges::reverse(problem_.planes); // either order would do, and must not turn with the normals
        problem_.mean /= static_cast<double>(corners.size());
        return voxel_ == no_index || add_own_sets(corners);
    }

    /// The voxel's own sets: those of the dual vertex's sheets, and those in a crease with them that cross no
    /// edge of the voxel (a narrow rim). False if it must be known first whether a set does.
    bool add_own_sets(std::span<const FacetCorner> corners) {
        near_.clear();
        for (FacetCorner corner : corners) near_.push_back(mesh_.crossings.of(corner).set);
        sort_unique(near_);
        const std::size_t crossing_sets = near_.size();
        for (Index s = sets_.first[voxel_]; s < sets_.first[voxel_ + 1]; ++s) {
            const bool same =
                std::any_of(near_.begin(), near_.begin() + static_cast<std::ptrdiff_t>(crossing_sets),
                            [&](Index t) { return s == t || related_.smooth(sets_.sets[s], sets_.sets[t]); });
            if (!same) continue;
            if (!crosses_.known) crosses_.note(s);
            add_plane(s);
            near_.push_back(s);
        }
        if (near_.size() - crossing_sets == sets_.first[voxel_ + 1] - sets_.first[voxel_]) return true;
        if (!crosses_.known) return false;
        for (Index s = sets_.first[voxel_]; s < sets_.first[voxel_ + 1]; ++s) {
            if (crosses_.of_set[s] || std::find(near_.begin(), near_.end(), s) != near_.end()) continue;
            const bool crease = std::any_of(near_.begin(), near_.end(), [&](Index t) {
                const Relation r = related_(sets_.sets[s], sets_.sets[t]);
                return r == Relation::convex || r == Relation::concave;
            });
            if (crease) add_plane(s);
        }
        return true;
    }

    /// The tip of a corner may reach into a voxel that holds no point of the third sheet. Adds the plane of a
    /// set from the voxels around that makes a crease with both of the dual vertex's sheets and cuts their
    /// crease in this voxel; of several, the one whose centroid is nearest to that point.
    bool add_corner_plane(Index dual) {
        const auto corners = mesh_.duals.corners_of(dual);
        Index best = no_index;
        double nearest = std::numeric_limits<double>::infinity();
        const std::size_t planes = problem_.planes.size();
        for (FacetCorner corner : corners)
            for (Index voxel : mesh_.grid.voxels[mesh_.crossings.of(corner).edge / 3]) {
                if (voxel == no_index || voxel == voxel_) continue;
                for (Index s = sets_.first[voxel]; s < sets_.first[voxel + 1]; ++s) {
                    if (s == best || !creases_with_all(s, corners)) continue;
                    add_plane(s);
                    const Solution apex = least_squares(problem_, 3);
                    problem_.planes.resize(planes);
                    const double d = (apex.position - sets_.sets[s].centroid).sqrnorm();
                    if (apex.rank == 3 && is_inside(apex.position, problem_, -placement::margin)
                        && (d < nearest || (d == nearest && s < best)))
                        nearest = d, best = s;
                }
            }
        if (best != no_index) add_plane(best);
        return best != no_index;
    }

    bool creases_with_all(Index s, std::span<const FacetCorner> corners) const {
        return std::all_of(corners.begin(), corners.end(), [&](FacetCorner corner) {
            const Relation r = related_(sets_.sets[s], sets_.sets[mesh_.crossings.of(corner).set]);
            return r == Relation::convex || r == Relation::concave;
        });
    }

    void add_plane(Index s) {
        const NormalSet& set = sets_.sets[s];
        problem_.planes.push_back(
            {set.normal, set.centroid,
             placement::point_weight * std::min<double>(set.count, placement::most_points)});
    }

    /// May the vertex lie outside its voxel? A bulge, crease or corner may reach through a face of the voxel
    /// without crossing an edge of the next one. If none of the vertex's sheets crosses an edge of that
    /// voxel, it has no vertex on them. Beyond an edge or corner of the voxel this must hold for all voxels
    /// between.
    bool may_leave(const Vec3& position) const {
        if (!is_inside(position, problem_, -placement::farthest_out) || !is_near(position)) return false;
        const VoxelCoord step = step_to(position);
        for (unsigned way = 1; way < 8; ++way)
            if (is_crossed(step, way)) return false;
        return true;
    }

    /// Do the planes of `sheets` sheets determine the position, at most `out` voxels outside, and pass it
    /// within `clear` voxels?
    bool meet(int sheets, const Solution& solution, const Vec3& position, double out, double clear) const {
        return solution.rank == sheets && is_inside(position, problem_, -out)
               && misfit(position, problem_) <= clear * problem_.size;
    }

    /// Records a corner outside, which the vertex of another voxel may take over (shared_corners).
    void note_corner(Index dual, const Solution& solution, const SheetNormals& faces) {
        if (!meet(3, solution, solution.position, placement::farthest_out, placement::clear_corner)) return;
        if (faces.count < 3 || !is_near(solution.position)) return;
        const VoxelCoord step = step_to(solution.position);
        unsigned crossed = 0;
        for (unsigned way = 1; way < 8; ++way) crossed |= unsigned{is_crossed(step, way)} << way;
        beyond.push_back({dual, solution.position, faces.normals, step, static_cast<std::uint8_t>(crossed)});
    }

    /// Less than a voxel away from this one? Only boxes that crossings made larger reach farther.
    bool is_near(const Vec3& position) const {
        for (unsigned k = 0; is_moved_ && k < 3; ++k) {
            const double at = position[k] / problem_.size - problem_.voxel[k];
            if (!(at > -1 && at < 2)) return false;
        }
        return true;
    }

    /// Step from this voxel to the one that holds a position less than a voxel away.
    VoxelCoord step_to(const Vec3& position) const {
        VoxelCoord step;
        for (unsigned k = 0; k < 3; ++k) {
            const double at = (position[k] - problem_.voxel[k] * problem_.size) / problem_.size;
            step[k] = (at > 1 - placement::margin) - (at < placement::margin);
        }
        return step;
    }

    /// Take the part of `step` along the axes in mask `way`: does one of the vertex's sheets cross an edge of
    /// that voxel? False if `step` is 0 along one of them.
    bool is_crossed(const VoxelCoord& step, unsigned way) const {
        VoxelCoord beside;
        for (unsigned k = 0; k < 3; ++k) {
            beside[k] = problem_.voxel[k];
            if (!(way >> k & 1u)) continue;
            if (step[k] == 0) return false;
            beside[k] += step[k];
        }
        return is_crossed(beside);
    }

    /// Does one of the vertex's sheets cross an edge of this voxel?
    bool is_crossed(const VoxelCoord& voxel) const {
        for (unsigned corner = 0; corner < 8; ++corner) {
            VoxelCoord c = voxel;
            for (unsigned k = 0; k < 3; ++k) c[k] += static_cast<int>(corner >> k & 1u);
            const Index lower = mesh_.grid.find(GridPoints::code(c));
            if (lower == no_index) continue;
            for (unsigned axis = 0; axis < 3; ++axis) {
                if (corner >> axis & 1u) continue;
                for (const Crossing& x : mesh_.crossings.on_edge(3 * lower + axis))
                    if (has_sheet(x.normal)) return true;
            }
        }
        return false;
    }

    bool has_sheet(const Vec3& normal) const {
        return std::any_of(problem_.planes.begin(), problem_.planes.end(), [&](const WeightedPlane& plane) {
            return (plane.normal | normal) > angles::one_sheet;
        });
    }

    /// Moves the solution into the voxel. False if the steepest direction alone puts it there; true if it had
    /// to be clamped.
    bool keep_inside(Solution& solution) const {
        if ((solution.position - clamped(solution.position, problem_)).norm()
                > placement::farthest_out * problem_.size
            && solution.rank > 1) {
            // Planes that meet far away say nothing about this voxel: use the steepest direction alone.
            solution = least_squares(problem_, 1);
            if (is_inside(solution.position, problem_)) return false;
        }
        solution.position = least_in_box(solution, problem_);
        return true;
    }

    const DualMesh& mesh_;
    const NormalSets& sets_;
    const RelationTest& related_;
    Crossers& crosses_;
    double half_sheet_cosine_; // of half the angle that normals of one sheet may make
    Problem problem_;
    std::vector<Index> near_;
    std::vector<CreaseSample> samples_;
    std::vector<std::uint8_t> face_;
    bool by_crease_ = false; // is a crossing on one face of a blunt crease?
    bool is_moved_ = false;  // is a corner of the voxel off its place?
    Index voxel_ = no_index;
};

} // namespace

void separate_sides(const DualMesh& mesh, std::vector<Vec3>& positions) {
    const double gap = placement::side_gap * mesh.voxel_size;
    const auto outward = [&](Index v) {
        Vec3 sum(0, 0, 0);
        for (FacetCorner corner : mesh.duals.corners_of(v)) sum += mesh.crossings.of(corner).normal;
        const double length = sum.norm();
        return length > 0 ? sum / length : Vec3(0, 0, 1);
    };
    for (Index v : mesh.duals.after_cut) {
        const Vec3 d = positions[v] - positions[v - 1], one = outward(v - 1), other = outward(v);
        if ((one | other) > 0) continue; // beside a narrow face, on one surface
        if (std::max(std::abs(d | one), std::abs(d | other)) > 2 * placement::side_gap * mesh.voxel_size)
            continue;
        positions[v - 1] += one * gap;
        positions[v] += other * gap;
    }
}

PlacedVertices place_vertices(const DualMesh& mesh, const NormalSets& sets, const RelationTest& related) {
    PlacedVertices result;
    const std::size_t count = mesh.duals.size();
    resize_large(result.positions, count);
    resize_large(result.classes, count);
    resize_large(result.directions, count);
    resize_large(result.voxel, count);
    resize_large(result.is_clamped, count);
    Crossers crosses{large_vector<std::uint8_t>(sets.sets.size())};
    // Places the vertices but those that have to wait; returns these.
    const auto place = [&](std::size_t n, const auto& vertex) {
        std::vector<std::vector<PlacedVertices::Beyond>> beyond(chunk_count(n, chunks::slow));
        std::vector<std::vector<PlacedVertices::OnCrease>> on_creases(beyond.size());
        std::vector<std::vector<Index>> waiting(beyond.size());
        for_chunks(n, chunks::slow, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
            Placer placer(mesh, sets, related, crosses);
            for (std::size_t i = begin; i < end; ++i)
                if (!placer.place(vertex(i), result)) waiting[chunk].push_back(vertex(i));
            beyond[chunk] = std::move(placer.beyond);
            on_creases[chunk] = std::move(placer.on_creases);
        });
        append_large(result.beyond, joined(beyond));
        append_large(result.on_creases, joined(on_creases));
        return joined(waiting);
    };
    const std::vector<Index> waiting = place(count, [](std::size_t i) { return static_cast<Index>(i); });
    crosses.known = true;
    place(waiting.size(), [&](std::size_t i) { return waiting[i]; });
    std::ranges::sort(result.beyond, {}, &PlacedVertices::Beyond::dual);
    std::ranges::sort(result.on_creases, {}, &PlacedVertices::OnCrease::dual);
    result.clamped = static_cast<std::size_t>(std::ranges::count(result.is_clamped, 1));
    return result;
}

} // namespace hsdm
