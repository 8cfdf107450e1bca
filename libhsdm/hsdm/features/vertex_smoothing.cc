#include "hsdm/features/vertex_smoothing.hh"

#include "hsdm/core/check_option.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/features/constants.hh"
#include "hsdm/features/normal_filter.hh"
#include "hsdm/mesh/facet_normal.hh"
#include "hsdm/spatial/self_intersections.hh"

#include <array>
#include <cmath>
#include <numbers>

namespace hsdm {
namespace {

/// The sum of term(i) for i below n, chunk by chunk: the same bits for any number of threads.
template <class Term>
double sum_of(std::size_t n, const Term& term) {
    std::vector<double> parts(chunk_count(n, chunks::quick), 0.0);
    for_chunks(n, chunks::quick, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
        for (auto i = static_cast<Index>(begin); i < end; ++i) parts[chunk] += term(i);
    });
    return std::accumulate(parts.begin(), parts.end(), 0.0);
}

/// The facets across the sides of each facet that are not sharp.
FacetNeighbours unparted_neighbours(const HalfEdges& mesh) {
    FacetNeighbours result;
    result.first.assign(mesh.facet_count() + 1, 0);
    for_each_index(mesh.facet_count(), chunks::usual, [&](Index f) {
        if (mesh.side[f] != no_index) mesh.for_each_side(f, [&](Index) { ++result.first[f + 1]; });
    });
    counts_to_first(result.first);
    result.neighbour.resize(result.first.back());
    for_each_index(mesh.facet_count(), chunks::usual, [&](Index f) {
        Index slot = result.first[f];
        if (mesh.side[f] == no_index) return;
        mesh.for_each_side(f, [&](Index h) {
            result.neighbour[slot++] = mesh.marked[h / 2] ? no_index : mesh.facet[h ^ 1];
        });
    });
    return result;
}

struct FacetPlane {
    Vec3 centroid{0, 0, 0};
    Vec3 area{0, 0, 0}; ///< Newell's vector: twice the area, along the normal
};

FacetPlane plane_of(const HalfEdges& mesh, const std::vector<Vec3>& positions, Index f) {
    if (mesh.side[f] == no_index) return {};
    const Vec3& first = positions[mesh.to[mesh.side[f]]];
    AreaVector area(first);
    Vec3 sum(0, 0, 0);
    int corners = 0;
    mesh.for_each_side(f, [&](Index h) {
        const Vec3& p = positions[mesh.to[h]];
        if (corners++ > 0) area.add(p);
        sum += p - first;
    });
    return {first + sum / corners, *area};
}

class PositionSmoother {
public:
    PositionSmoother(HalfEdges& mesh, const VertexSmoothingOptions& options)
        : mesh_(mesh),
          options_(options),
          roles_(curve_roles(mesh, options.corner_angle)),
          neighbours_(unparted_neighbours(mesh)),
          start_(mesh.positions),
          planes_(mesh.facet_count()),
          normals_(mesh.facet_count()),
          is_free_(mesh.vertex_count()) {
        for_each_index(is_free_.size(), chunks::usual, [&](Index v) { is_free_[v] = is_inside(v); });
        bool closed = true;
        Box box;
        for (Index e = 0; e < mesh.edge_count(); ++e)
            closed = closed && (mesh.to[2 * e] == no_index || !mesh.is_open(e));
        for (Index v = 0; v < mesh.vertex_count(); ++v)
            if (mesh.out[v] != no_index) box.add(mesh.positions[v]);
        if (!box.empty()) centre_ = box.lo + box.size() / 2;
        result_.volume_before = volume(mesh.positions);
        if (closed) volume_bound_ = options.max_volume_change * std::abs(result_.volume_before);
        result_.drift_bound = options.max_drift.value_or(options.max_drift_share * mean_edge());
    }

    VertexSmoothingResult run() {
        for (int round = 0; round < options_.rounds && !result_.volume_bound_met; ++round) {
            filter();
            for (int i = 0; i < options_.position_rounds && !result_.volume_bound_met; ++i) step();
        }
        if (options_.keep_apart) keep_apart();
        report();
        return result_;
    }

private:
    /// The facets that are there.
    PolygonMesh polygons(const std::vector<Vec3>& positions) const {
        PolygonMesh result;
        result.positions = positions;
        for (Index f = 0; f < mesh_.facet_count(); ++f) {
            if (mesh_.side[f] == no_index) continue;
            mesh_.for_each_side(f, [&](Index h) { result.corners.push_back(mesh_.to[h]); });
            result.first.push_back(static_cast<Index>(result.corners.size()));
        }
        return result;
    }

    /// Takes back what has moved of facets that meet, until none of these has: some goes each time. If facets
    /// met before, what has moved may well be better than what was.
    void keep_apart() {
        PolygonMesh moved = polygons(mesh_.positions);
        auto pairs = find_self_intersections(moved).facet_pairs;
        if (pairs.empty() || !find_self_intersections(polygons(start_)).facet_pairs.empty()) return;
        for (; !pairs.empty(); pairs = find_self_intersections(moved).facet_pairs)
            for (const auto& pair : pairs)
                for (const Index f : pair)
                    for (const Index v : moved.facet(f)) {
                        result_.taken_back += moved.positions[v] != start_[v];
                        moved.positions[v] = start_[v];
                    }
        const bool kept = std::abs(volume(moved.positions) - result_.volume_before) <= volume_bound_;
        mesh_.positions = kept ? std::move(moved.positions) : start_;
    }

    double mean_edge() const {
        const auto length = [&](Index e) {
            const Index a = mesh_.to[2 * e];
            return a == no_index ? 0.0 : (mesh_.positions[a] - mesh_.positions[mesh_.from(2 * e)]).norm();
        };
        const double count = sum_of(mesh_.edge_count(), [&](Index e) { return mesh_.to[2 * e] != no_index; });
        return count > 0 ? sum_of(mesh_.edge_count(), length) / count : 0;
    }

    /// Of the triangles from the facets' centroids to their sides: exact, flat facets or not.
    double volume(const std::vector<Vec3>& positions) const {
        return sum_of(mesh_.facet_count(), [&](Index f) {
            const FacetPlane plane = plane_of(mesh_, positions, f);
            return ((plane.centroid - centre_) | plane.area) / 6;
        });
    }

    void find_planes() {
        for_each_index(planes_.size(), chunks::usual,
                       [&](Index f) { planes_[f] = plane_of(mesh_, mesh_.positions, f); });
    }

    void filter() {
        find_planes();
        std::vector<double> areas(planes_.size());
        for_each_index(planes_.size(), chunks::quick, [&](Index f) {
            normals_[f] = unit_or_zero(planes_[f].area);
            areas[f] = planes_[f].area.norm();
        });
        for (int i = 0; i < options_.normal_rounds; ++i)
            filter_normals(neighbours_, areas, options_.similarity_angle, 0, normals_);
    }

    /// The facets between two sharp edges at a vertex, as one plane.
    struct Sector {
        Vec3 way{0, 0, 0};
        double weight = 0;

        Vec3 mean() const { return weight > 0 ? way / weight : Vec3(0, 0, 0); }
    };

    void add(Sector& sector, Index v, Index f) const {
        const double weight = planes_[f].area.norm();
        const Vec3& normal = normals_[f];
        sector.way += normal * (weight * (normal | (planes_[f].centroid - mesh_.positions[v])));
        sector.weight += weight;
    }

    Vec3 step_of(Index v) const {
        Index start = mesh_.out[v];
        if (roles_[v] == CurveRole::crease)
            mesh_.for_each_spoke(v, [&](Index h) { start = mesh_.marked[h / 2] ? h : start; });
        std::array<Sector, 2> sectors;
        std::size_t at = 0;
        Index h = start;
        do {
            if (h != start && mesh_.marked[h / 2] && roles_[v] == CurveRole::crease) at = 1;
            add(sectors[at], v, mesh_.facet[h ^ 1]);
            h = mesh_.next[h ^ 1];
        } while (h != start);
        return at == 0 ? sectors[0].mean() : onto_both(sectors[0].mean(), sectors[1].mean());
    }

    static Vec3 onto_both(const Vec3& a, const Vec3& b) { return (a + b) * 0.5; }

    /// Whether a vertex is neither a corner nor on the boundary.
    bool is_inside(Index v) const {
        if (mesh_.out[v] == no_index || roles_[v] == CurveRole::corner) return false;
        bool inside = true;
        mesh_.for_each_spoke(v, [&](Index h) { inside = inside && !mesh_.is_open(h / 2); });
        return inside;
    }

    /// One step of all vertices: they read the places before it only, so their order plays no part.
    void step() {
        find_planes();
        std::vector<Vec3> there = mesh_.positions;
        for_each_index(there.size(), chunks::usual, [&](Index v) {
            if (!is_free_[v]) return;
            const Vec3 drift = there[v] + step_of(v) - start_[v];
            const double length = drift.norm();
            if (!(length > 0)) return;
            there[v] = start_[v] + drift * std::min(1.0, result_.drift_bound / length);
        });
        take(std::move(there));
    }

    /// Takes the step as far as the volume's bound lets it.
    void take(std::vector<Vec3> there) {
        double share = 1;
        std::size_t refused = 0;
        while (share > shortest_step) {
            std::vector<Vec3> part = there;
            if (share < 1)
                for_each_index(part.size(), chunks::quick, [&](Index v) {
                    part[v] = mesh_.positions[v] + (there[v] - mesh_.positions[v]) * share;
                });
            refused = keep_sides(part);
            if (std::abs(volume(part) - result_.volume_before) <= volume_bound_) {
                mesh_.positions.swap(part);
                result_.refused += refused;
                result_.volume_bound_met = share < 1;
                return;
            }
            share /= 2;
        }
        result_.volume_bound_met = true;
    }

    bool turns_over(Index f, const std::vector<Vec3>& there) const {
        const double before = planes_[f].area | normals_[f];
        return before > 0
               && (plane_of(mesh_, there, f).area | normals_[f])
                      < vertex_smoothings::least_area_left * before;
    }

    /// Takes vertices back to where they are now until no facet turns over; returns how many would have. Each
    /// vertex goes back once, so that the whole is linear.
    std::size_t keep_sides(std::vector<Vec3>& there) const {
        std::vector<Index> turned = indices_where(mesh_.facet_count(), chunks::usual, [&](Index f) {
            return mesh_.side[f] != no_index && turns_over(f, there);
        });
        std::size_t count = 0;
        while (!turned.empty()) {
            count += turned.size();
            std::vector<Index> around;
            for (const Index f : turned)
                mesh_.for_each_side(f, [&](Index h) { take_back(mesh_.to[h], there, around); });
            sort_unique(around);
            turned.clear();
            for (const Index f : around)
                if (turns_over(f, there)) turned.push_back(f);
        }
        return count;
    }

    void take_back(Index v, std::vector<Vec3>& there, std::vector<Index>& around) const {
        if (there[v] == mesh_.positions[v]) return;
        there[v] = mesh_.positions[v];
        mesh_.for_each_spoke(v, [&](Index h) {
            if (mesh_.facet[h] != no_index) around.push_back(mesh_.facet[h]);
        });
    }

    void report() {
        const auto drift = [&](Index v) { return (mesh_.positions[v] - start_[v]).norm(); };
        for (Index v = 0; v < start_.size(); ++v) {
            result_.moved += mesh_.positions[v] != start_[v];
            result_.drift_max = std::max(result_.drift_max, drift(v));
        }
        if (result_.moved > 0)
            result_.drift_mean = sum_of(start_.size(), drift) / static_cast<double>(result_.moved);
        result_.volume_after = volume(mesh_.positions);
    }

    static constexpr double shortest_step = 1e-3; // of a step: what is left of it then changes nothing

    HalfEdges& mesh_;
    VertexSmoothingOptions options_;
    std::vector<CurveRole> roles_;
    FacetNeighbours neighbours_;
    std::vector<Vec3> start_;
    std::vector<FacetPlane> planes_;
    std::vector<Vec3> normals_;          ///< of facets, filtered
    std::vector<unsigned char> is_free_; ///< per vertex
    Vec3 centre_{0, 0, 0};
    double volume_bound_ = Box::inf;
    VertexSmoothingResult result_;
};

void check_rounds_of(const char* name, int rounds) {
    check_option(rounds >= 0, name, rounds, "not be negative");
}

void check_angle_of(const char* name, double angle) {
    check_option(angle > 0 && angle < std::numbers::pi, name, angle, "lie in (0, pi), in radians");
}

} // namespace

void validate(const VertexSmoothingOptions& options) {
    check_rounds_of("rounds", options.rounds);
    check_rounds_of("normal_rounds", options.normal_rounds);
    check_rounds_of("position_rounds", options.position_rounds);
    check_angle_of("similarity_angle", options.similarity_angle);
    check_angle_of("corner_angle", options.corner_angle);
    if (options.max_drift)
        check_option(*options.max_drift > 0 && std::isfinite(*options.max_drift), "max_drift",
                     *options.max_drift, "be finite and above 0");
    check_option(options.max_drift_share > 0 && std::isfinite(options.max_drift_share), "max_drift_share",
                 options.max_drift_share, "be finite and above 0");
    check_option(options.max_volume_change >= 0 && std::isfinite(options.max_volume_change),
                 "max_volume_change", options.max_volume_change, "be finite and not negative");
}

VertexSmoothingResult smooth_positions(HalfEdges& mesh, const VertexSmoothingOptions& options) {
    return PositionSmoother(mesh, options).run();
}

} // namespace hsdm
