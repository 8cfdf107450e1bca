#include "hsdm/contour/relax_vertices.hh"

#include "hsdm/contour/constants.hh"
#include "hsdm/contour/point_fit.hh"
#include "hsdm/core/check_option.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/mesh/area_vector.hh"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hsdm {
namespace {

/// The point on the way from `from` to `to` where it leaves the dual vertex's voxel, or `to`.
Vec3 within_voxel(const DualMesh& mesh, Index dual, const Vec3& from, const Vec3& to) {
    const VoxelCoord& voxel = mesh.voxel_of(dual);
    const double h = mesh.voxel_size;
    const Vec3 way = to - from;
    Vec3 least, most;
    bool stays = true; // as nearly always, though which bounds it moves towards is hard to guess
    for (unsigned k = 0; k < 3; ++k) {
        least[k] = (voxel[k] + placement::margin) * h;
        most[k] = least[k] + (1 - 2 * placement::margin) * h;
        stays &= to[k] >= least[k];
        stays &= to[k] <= most[k];
    }
    if (stays) return from + way;
    if (mesh.is_moved(dual)) mesh.include_crossings(dual, least, most);
    double share = 1;
    for (unsigned k = 0; k < 3; ++k) {
        const double lo = least[k], hi = most[k];
        if (way[k] > 0 && to[k] > hi) share = std::min(share, (hi - from[k]) / way[k]);
        if (way[k] < 0 && to[k] < lo) share = std::min(share, (lo - from[k]) / way[k]);
    }
    return from + way * std::max(share, 0.0);
}

/// Of all, or of the marked ones.
double sum_of(const std::vector<double>& all, std::span<const std::uint8_t> marked) {
    double sum = 0;
    for_each_in_order(all.size(), [&](std::size_t i) {
        if (marked.empty() || marked[i]) sum += all[i];
    });
    return sum;
}

class Relaxation {
public:
    Relaxation(const DualMesh& mesh, PlacedVertices& vertices)
        : mesh_(mesh), duals_(mesh.duals), vertices_(vertices), placed_(copy_of_large(vertices.positions)) {}

    /// Moves vertices within their sheet. Frees what that alone needs.
    void move(int rounds, double step) {
        list_neighbours();
        for (int k = 0; k < rounds; ++k) round(step);
        next_ = std::vector<Vec3>();
        neighbours_ = std::vector<Neighbour>();
        neighbour_count_ = std::vector<Index>();
    }

    /// Moves smooth vertices up or down until the facets, not the vertices alone, lie amid the points. Where
    /// a voxel's points are then farther off than from the facets as placed, its vertices go back to where
    /// they were placed; all do if the sum over all points grew.
    void fit(const PointFit& fit, std::span<const std::uint8_t> part, bool go_back) {
        // Heights are freed before others are measured.
        PointFit::Measure before = fit.measure(placed_);
        rise(fit.rises(std::exchange(before.heights, {})));
        PointFit::Measure after = fit.measure(vertices_.positions);
        const double placed = sum_of(before.misfit, part), moved = sum_of(after.misfit, part);
        if (!part.empty()) vertices_.misfit_placed = placed, vertices_.misfit_moved = moved;
        if (part.empty() ? moved > placed : go_back) {
            vertices_.positions = copy_of_large(placed_);
            vertices_.far = std::move(before.standing_out);
            return;
        }
        rise(fit.rises(after.heights));
        vertices_.far = std::move(after.standing_out);
        for_each_index(duals_.size(), chunks::light, [&](Index v) {
            const Index voxel = vertices_.voxel[v];
            if (after.misfit[voxel] > (1 + relaxation::farther) * before.misfit[voxel])
                vertices_.positions[v] = placed_[v];
        });
    }

private:
    /// A neighbouring vertex.
    struct Neighbour {
        Index vertex;
        std::uint16_t sides; // facets' half-edges that join the two: an interior edge has two
        bool carries;        // is it where its sheet is known, and is that the vertex's own?
    };
    std::span<const Neighbour> neighbours(Index dual) const {
        return {neighbours_.data() + 2 * std::size_t{duals_.first[dual]}, neighbour_count_[dual]};
    }

    void round(double step) {
        resize_unwritten(next_, duals_.size());
        for_each_index(duals_.size(), chunks::slow, [&](Index v) {
            next_[v] = vertices_.positions[v];
            if (duals_.open[v]) return;
            if (vertices_.classes[v] == VertexClass::smooth)
                next_[v] = kept_in(v, on_sheet(v, moved_on_sheet(v, step)));
            else if (vertices_.classes[v] == VertexClass::edge)
                next_[v] = kept_in(v, moved_along_crease(v, step));
        });
        vertices_.positions.swap(next_);
    }

    void list_neighbours() {
        resize_unwritten(neighbours_, 2 * duals_.corners.size()); // more than there are
        resize_unwritten(neighbour_count_, duals_.size());
        for_each_index(duals_.size(), chunks::slow, [&](Index v) {
            Neighbour* const first = neighbours_.data() + 2 * std::size_t{duals_.first[v]};
            Neighbour* last = first;
            const auto add = [&](Index n) {
                Neighbour* const known =
                    std::find_if(first, last, [n](const Neighbour& other) { return other.vertex == n; });
                if (known == last) *last++ = {n, 0, carries(n, v)};
                ++known->sides;
            };
            duals_.for_each_corner(v, [&](FacetCorner corner) {
                add(duals_.to(corner));
                add(duals_.from(corner.previous()));
            });
            neighbour_count_[v] = static_cast<Index>(last - first);
        });
    }

    /// Does a neighbour's place tell where the sheet of a smooth vertex is?
    bool carries(Index neighbour, Index dual) const {
        return vertices_.classes[neighbour] == VertexClass::smooth && !vertices_.is_clamped[neighbour]
               && (vertices_.directions[neighbour] | vertices_.directions[dual]) > angles::one_sheet;
    }

    Vec3 moved_on_sheet(Index dual, double step) const {
        const Vec3& p = vertices_.positions[dual];
        Vec3 mean(0, 0, 0);
        for (const Neighbour& n : neighbours(dual)) mean += vertices_.positions[n.vertex] * n.sides;
        const Vec3 way = mean / static_cast<double>(2 * duals_.corners_of(dual).size()) - p;
        const Vec3& normal = vertices_.directions[dual];
        return p + (way - normal * (normal | way)) * step;
    }

    /// Projects p onto the sheet: to the mean height of the vertices of the sheet around it, as they were
    /// placed.
    Vec3 on_sheet(Index dual, const Vec3& p) const {
        Vec3 normal(0, 0, 0), place(0, 0, 0);
        double sum = 0;
        const auto add = [&](Index v, double share) {
            const double weight =
                share
                / ((p - placed_[v]).sqrnorm() / (mesh_.voxel_size * mesh_.voxel_size) + relaxation::nearness);
            normal += vertices_.directions[v] * weight;
            place += placed_[v] * weight;
            sum += weight;
        };
        if (!vertices_.is_clamped[dual]) add(dual, 1);
        for (const Neighbour& n : neighbours(dual))
            if (n.carries) add(n.vertex, 0.5 * n.sides); // two sides inside: as much as the vertex itself
        if (!(sum > 0)) return p;
        normal.normalize();
        return p - normal * (normal | (p - place / sum));
    }

    /// Moves a crease vertex towards the middle between the next ones on the crease, if there is one either
    /// way.
    Vec3 moved_along_crease(Index dual, double step) const {
        const Vec3& p = vertices_.positions[dual];
        const Vec3& along = vertices_.directions[dual];
        double ahead = 0, behind = 0;
        for (const auto& [n, sides, carries] : neighbours(dual)) {
            if (vertices_.is_clamped[n]) return p;
            if (vertices_.classes[n] == VertexClass::smooth) continue;
            const Vec3 way = vertices_.positions[n] - p;
            const double s = way | along;
            if (std::abs(s) < angles::one_sheet * way.norm()) continue;
            (s > 0 ? ahead : behind) = s > 0 ? std::max(ahead, s) : std::min(behind, s);
        }
        return ahead > 0 && behind < 0 ? p + along * (0.5 * step * (ahead + behind)) : p;
    }

    /// Moves vertices along their directions.
    void rise(const std::vector<double>& heights) {
        for_each_index(duals_.size(), chunks::slow, [&](Index v) {
            if (heights[v] != 0) {
                const Vec3 to = vertices_.positions[v] + vertices_.directions[v] * heights[v];
                vertices_.positions[v] = kept_in(v, to);
            }
        });
    }

    Vec3 kept_in(Index dual, const Vec3& p) const {
        return within_voxel(mesh_, dual, vertices_.positions[dual], p);
    }

    const DualMesh& mesh_;
    const DualVertices& duals_;
    PlacedVertices& vertices_;
    const std::vector<Vec3> placed_;
    std::vector<Vec3> next_;
    std::vector<Neighbour> neighbours_; // those of a dual vertex begin at twice its first corner
    std::vector<Index> neighbour_count_;
};

/// The voxel's own set that a smooth vertex belongs to, or null.
const NormalSet* own_set(const NormalSets& sets, Index voxel, const Vec3& normal) {
    const NormalSet* best = nullptr;
    for (const NormalSet& set : sets.of_voxel(voxel))
        if ((set.normal | normal) > angles::one_sheet && (!best || set.count > best->count)) best = &set;
    return best;
}

} // namespace

void extend_borders(const DualMesh& mesh, const NormalSets& sets, PlacedVertices& vertices) {
    const std::vector<Vec3> placed = copy_of_large(vertices.positions);
    const DualVertices& duals = mesh.duals;
    for_each_index(duals.size(), chunks::slow, [&](Index v) {
        if (!duals.open[v] || vertices.classes[v] != VertexClass::smooth) return;
        const NormalSet* set = own_set(sets, vertices.voxel[v], vertices.directions[v]);
        if (!set) return;
        // `outward` points away from the facets' far corners, across the border, whose direction is from
        // the neighbour before to the one after.
        const auto corners = duals.corners_of(v);
        const auto beside = [&](FacetCorner corner, bool enters) {
            return placed[mesh.crossings.of(corner).leaving == enters ? duals.from(corner.previous())
                                                                      : duals.to(corner)];
        };
        const Vec3 first = beside(corners.front(), true), last = beside(corners.back(), false);
        Vec3 inner(0, 0, 0);
        for (FacetCorner corner : corners) inner += placed[duals.from(corner.opposite())];
        const Vec3 along = unit(last - first);
        Vec3 outward = placed[v] - inner / static_cast<double>(corners.size());
        outward -= along * (along | outward);
        outward = unit(outward - set->normal * (set->normal | outward));
        const double reach =
            (outward | (set->centroid - placed[v])) + std::sqrt(set->spread.reach_squared(outward));
        if (!(reach > 0)) return;
        const Vec3 to = placed[v] + outward * reach;
        vertices.positions[v] = within_voxel(mesh, v, placed[v], to);
    });
}

void relax_vertices(const Octree& octree, const OctreeLevel& level, const DualMesh& mesh,
                    const RelaxOptions& options, PlacedVertices& vertices) {
    check_option(options.rounds >= 0, "relaxation rounds", options.rounds, "be 0 or more");
    check_option(options.step > 0 && options.step <= 1, "relaxation step", options.step, "lie in (0, 1]");
    if (options.rounds == 0 && !options.fit) return;
    Relaxation relaxation(mesh, vertices);
    relaxation.move(options.rounds, options.step);
    if (options.fit)
        relaxation.fit(PointFit(octree, level, mesh.duals, vertices), options.part_of_whole, options.go_back);
}

} // namespace hsdm
