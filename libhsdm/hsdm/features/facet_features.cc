#include "hsdm/features/facet_features.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/features/constants.hh"
#include "hsdm/features/normal_filter.hh"
#include "hsdm/mesh/facet_normal.hh"

#include <atomic>
#include <cmath>

namespace hsdm {
namespace {

Vec3 area_of(const PolygonMesh& facets, std::size_t f) {
    AreaVector area(facets.positions[facets.corners[facets.first[f]]]);
    for (Index c = facets.first[f] + 1; c < facets.first[f + 1]; ++c)
        area.add(facets.positions[facets.corners[c]]);
    return *area;
}

/// Calls visit(side) for the sides of a facet in the order in which a half-edge mesh has them: its last
/// first.
template <class Visit>
void for_sides(const PolygonMesh& facets, std::size_t f, const Visit& visit) {
    const Index last = facets.first[f + 1] - 1;
    visit(last);
    for (Index c = facets.first[f]; c < last; ++c) visit(c);
}

class FeatureFinder {
public:
    FeatureFinder(const PolygonMesh& facets, const FacetLinks& links, const FeatureOptions& options)
        : facets_(facets), links_(links), options_(options) {}

    FacetFeatures find(FeatureHints&& hints) {
        hints_ = std::move(hints.sides);
        found_.corner_angle = options_.corner_angle;
        resize_large(found_.sharp, facets_.corners.size());
        mark();
        release(hints_);
        classify();
        return std::move(found_);
    }

private:
    Index across(Index side) const {
        const Index twin = links_.twin[side];
        return twin == no_index ? no_index : links_.facet[twin];
    }
    /// What is known of an edge; of its two sides the first one's word counts.
    EdgeHint hint(Index side) const {
        if (hints_.empty()) return EdgeHint::none;
        const Index twin = links_.twin[side];
        if (twin == no_index) return hints_[side];
        const EdgeHint first = hints_[std::min(side, twin)];
        return first == EdgeHint::none ? hints_[std::max(side, twin)] : first;
    }

    /// Sharp edges: as hints say, else by their angle, which has to outlast smoothing.
    void mark() {
        std::vector<Vec3> normals = large_vector<Vec3>(facets_.facet_count());
        for_each_index(normals.size(), chunks::quick,
                       [&](Index f) { normals[f] = unit_or_zero(area_of(facets_, f)); });
        const auto exceeds = [&](Index f, Index other, double cosine) {
            const Vec3 &a = normals[f], &b = normals[other];
            return a.sqrnorm() > 0 && b.sqrnorm() > 0 && (a | b) < cosine;
        };
        const double cosine = std::cos(options_.crease_angle);
        std::atomic<bool> in_question = false;
        for_each_index(facets_.corners.size(), chunks::quick, [&](Index c) {
            const EdgeHint known = hint(c);
            if (known == EdgeHint::none) {
                const Index other = across(c);
                found_.sharp[c] = other != no_index && exceeds(links_.facet[c], other, cosine);
                if (found_.sharp[c]) in_question.store(true, std::memory_order_relaxed);
            } else {
                found_.sharp[c] = known == EdgeHint::sharp;
            }
        });
        if (in_question && options_.confirmation_rounds > 0) confirm(normals);
    }

    bool is_in_question(Index side) const {
        return found_.sharp[side] && hint(side) == EdgeHint::none && across(side) != no_index;
    }

    /// Facets whose normals smoothing can bring to an edge in question, and after them those beside.
    std::vector<Index> facets_near(std::vector<Index>& number, std::size_t& inner) const {
        std::vector<Index> near;
        assign_large(number, facets_.facet_count(), no_index);
        const auto add = [&](Index f) {
            if (f == no_index || number[f] != no_index) return;
            number[f] = static_cast<Index>(near.size());
            push_large(near, f);
        };
        for_each_in_order(facets_.corners.size(), [&](std::size_t c) {
            if (is_in_question(static_cast<Index>(c))) add(links_.facet[c]);
        });
        for (int round = 1; round <= options_.confirmation_rounds; ++round) {
            inner = near.size();
            for_each_in_order(inner, [&](std::size_t i) {
                for (Index c = facets_.first[near[i]]; c < facets_.first[near[i] + 1]; ++c) add(across(c));
            });
        }
        return near;
    }

    void confirm(const std::vector<Vec3>& all_normals) {
        std::vector<Index> number;
        std::size_t inner = 0;
        const std::vector<Index> near = facets_near(number, inner);
        FacetNeighbours neighbours;
        std::vector<Vec3> normals = large_vector<Vec3>(near.size());
        std::vector<double> weights = large_vector<double>(near.size());
        for_each_index(near.size(), chunks::quick, [&](Index i) {
            normals[i] = all_normals[near[i]];
            weights[i] = area_of(facets_, near[i]).norm();
        });
        for_each_in_order(near.size(), [&](std::size_t i) {
            if (i < inner)
                for_sides(facets_, near[i], [&](Index c) {
                    const Index other = across(c);
                    push_large(neighbours.neighbour, other == no_index ? no_index : number[other]);
                });
            push_large(neighbours.first, static_cast<Index>(neighbours.neighbour.size()));
        });
        for (int round = 0; round < options_.confirmation_rounds; ++round)
            filter_normals(neighbours, weights, detail::confirming_similarity * options_.crease_angle, 0,
                           normals);
        const double cosine = std::cos(detail::confirmed_share * options_.crease_angle);
        for_each_index(facets_.corners.size(), chunks::quick, [&](Index c) {
            if (!is_in_question(c)) return;
            const Vec3 &a = normals[number[links_.facet[c]]], &b = normals[number[across(c)]];
            found_.sharp[c] = a.sqrnorm() > 0 && b.sqrnorm() > 0 && (a | b) < cosine;
        });
    }

    void classify() {
        std::array<std::atomic<std::size_t>, 3> count{};
        for_chunks(facets_.vertex_count(), chunks::usual,
                   [&](std::size_t begin, std::size_t end, std::size_t) {
                       FacetFan fan(facets_, links_, found_);
                       std::array<std::size_t, 3> here{};
                       for (std::size_t v = begin; v < end; ++v) {
                           fan.gather(static_cast<Index>(v));
                           ++here[static_cast<std::size_t>(fan.kind())];
                       }
                       for (std::size_t k = 0; k < 3; ++k) count[k] += here[k];
                   });
        found_.counts.smooth_vertices = count[0];
        found_.counts.edge_vertices = count[1];
        found_.counts.corner_vertices = count[2];
        for_each_in_order(facets_.corners.size(), [&](std::size_t c) {
            const Index twin = links_.twin[c];
            found_.counts.sharp_edges += found_.sharp[c] && (twin == no_index || c < twin);
        });
    }

    const PolygonMesh& facets_;
    const FacetLinks& links_;
    const FeatureOptions& options_;
    std::vector<EdgeHint> hints_;
    FacetFeatures found_;
};

} // namespace

FacetFeatures find_facet_features(const PolygonMesh& facets, const FacetLinks& links, FeatureHints&& hints,
                                  const FeatureOptions& options) {
    validate(options);
    return FeatureFinder(facets, links, options).find(std::move(hints));
}

FacetNormals facet_normals(const PolygonMesh& facets) {
    FacetNormals result{unwritten_vector<Vec3>(facets.facet_count()),
                        unwritten_vector<double>(facets.facet_count())};
    for_each_index(facets.facet_count(), chunks::quick, [&](Index f) {
        const Vec3 whole = area_of(facets, f);
        result.area[f] = 0.5 * whole.norm();
        result.normals[f] = unit_or_zero(whole);
    });
    return result;
}

FacetNeighbours neighbours_of(const PolygonMesh& facets, const FacetLinks& links,
                              std::span<const std::uint8_t> sharp) {
    FacetNeighbours result;
    result.first = copy_of_large(facets.first);
    resize_unwritten(result.neighbour, facets.first.back());
    for_each_index(facets.facet_count(), chunks::quick, [&](Index f) {
        Index slot = facets.first[f];
        for_sides(facets, f, [&](Index c) {
            const Index twin = links.twin[c];
            result.neighbour[slot++] = sharp[c] || twin == no_index ? no_index : links.facet[twin];
        });
    });
    return result;
}

void smooth_facet_normals(FacetNormals& normals, const FacetNeighbours& neighbours,
                          const NormalSmoothingOptions& options) {
    validate(options);
    for (int round = 0; round < options.rounds; ++round)
        filter_normals(neighbours, normals.area, options.similarity_angle, options.settled_angle,
                       normals.normals);
}

void FacetFan::add(Index end, Index facet, bool sharp) {
    spokes_.push_back({facets_.positions[end] - centre_, facet, sharp});
    if (!sharp) return;
    if (sharp_edges_ < 2) sharp_[static_cast<std::size_t>(sharp_edges_)] = spokes_.back().direction;
    ++sharp_edges_;
}

/// Clockwise, as a half-edge mesh goes round a vertex, from the boundary if there is one.
void FacetFan::gather(Index vertex) {
    spokes_.clear();
    sharp_edges_ = 0;
    centre_ = facets_.positions[vertex];
    if (const Index open = links_.open_in[vertex]; open != no_index)
        add(facets_.corners[open], no_index, features_.sharp[open]);
    for_sides_from(facets_, links_, vertex, [&](Index c) {
        add(facets_.corners[next_side(facets_, links_.facet[c], c)], links_.facet[c], features_.sharp[c]);
    });
}

VertexClass FacetFan::kind() const {
    const double turn = sharp_edges_ == 2 ? angle_between(-sharp_[0], sharp_[1]) : 0;
    return vertex_class(sharp_edges_, turn, features_.corner_angle);
}

SectorNormals FacetFan::normals(Vec3& mean) {
    fan_.clear();
    for (std::size_t i = 0; i < spokes_.size(); ++i) {
        const Spoke& spoke = spokes_[i];
        const Spoke& before = spokes_[i == 0 ? spokes_.size() - 1 : i - 1];
        if (spoke.facet == no_index) continue;
        fan_.push_back({features_.normals[spoke.facet], angle_between(before.direction, spoke.direction),
                        before.sharp || before.facet == no_index});
    }
    const SectorNormals sectors = sector_normals(fan_);
    if (sectors.count == 0) return sectors;
    const Vec3 sum = unit_or_zero(sectors.normals[0] + sectors.normals[1] + sectors.normals[2]);
    mean = sum.sqrnorm() > 0 ? sum : sectors.normals[0];
    return sectors;
}

} // namespace hsdm
