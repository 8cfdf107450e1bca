#include "hsdm/normals/patches.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/normals/constants.hh"

#include <algorithm>
#include <array>
#include <cmath>

namespace hsdm {
namespace {

class PatchBuilder {
public:
    PatchBuilder(const Octree& octree, const Neighbors& neighbors, const EstimatedNormals& estimate)
        : octree_(octree), neighbors_(neighbors), estimate_(estimate) {}

    Patches run() {
        const std::size_t leaves = neighbors_.leaf_first.size() - 1;
        assign_large(result_.of_point, octree_.size(), no_index);
        assign_large(result_.sign, octree_.size(), 1);
        std::vector<Index> first(chunk_count(leaves, chunks::heavy) + 1, 0);
        for_chunks(leaves, chunks::heavy, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
            Index count = 0;
            for (std::size_t l = begin; l < end; ++l) count += join_leaf(l, count);
            first[chunk + 1] = count;
        });
        counts_to_first(first);
        assign_large(result_.centroids, first.back(), Vec3(0, 0, 0));
        assign_large(result_.normals, first.back(), Vec3(0, 0, 0));
        assign_large(result_.counts, first.back(), 0);
        assign_large(result_.sides, first.back(), 0);
        for_chunks(leaves, chunks::heavy, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
            sum_points(neighbors_.leaf_first[begin], neighbors_.leaf_first[end], first[chunk]);
            for (Index p = first[chunk]; p < first[chunk + 1]; ++p) {
                result_.centroids[p] /= result_.counts[p];
                result_.normals[p].normalize();
            }
        });
        return std::move(result_);
    }

private:
    bool flat(Index i, Index j, double cosine) const {
        if (std::abs(cosine) < patches::least_cosine) return false;
        const Vec3& a = estimate_.normals[i];
        const Vec3 sum = cosine < 0 ? a - estimate_.normals[j] : a + estimate_.normals[j];
        const Vec3 d = octree_.positions[j] - octree_.positions[i];
        const double rise = std::abs(sum | d) / sum.norm();
        const double length = d.norm();
        return rise <= std::max(patches::steepest * length,
                                std::min(estimate_.tolerance[i], patches::most_rise * length));
    }

    /// Numbers the leaf's patches from `base` on; returns how many there are. A patch's number is taken by
    /// its first point.
    Index join_leaf(std::size_t leaf, Index base) {
        const Index begin = neighbors_.leaf_first[leaf], end = neighbors_.leaf_first[leaf + 1];
        const auto most = static_cast<Index>(neighborhoods::leaf_points); // others share the deepest voxel
        Index count = 0;
        for (Index i = begin; i < end; ++i) {
            if (estimate_.normals[i].sqrnorm() < 0.5) continue;
            for (Index j = i - std::min(i - begin, most); j < i; ++j) {
                if (result_.of_point[j] == no_index || result_.of_point[j] == result_.of_point[i]) continue;
                const double cosine = estimate_.normals[i] | estimate_.normals[j];
                if (!flat(i, j, cosine)) continue;
                const auto sign = static_cast<std::int8_t>(cosine < 0 ? -result_.sign[j] : result_.sign[j]);
                if (result_.of_point[i] == no_index) {
                    result_.of_point[i] = result_.of_point[j];
                    result_.sign[i] = sign;
                }
            }
            if (result_.of_point[i] == no_index) result_.of_point[i] = base + count++;
        }
        return count;
    }

    void sum_points(Index begin, Index end, Index base) {
        for (Index i = begin; i < end; ++i) {
            if (result_.of_point[i] == no_index) continue;
            const Index p = result_.of_point[i] += base;
            result_.centroids[p] += octree_.positions[i];
            result_.normals[p] += estimate_.normals[i] * result_.sign[i];
            ++result_.counts[p], result_.sides[p] += result_.sign[i];
        }
    }

    const Octree& octree_;
    const Neighbors& neighbors_;
    const EstimatedNormals& estimate_;
    Patches result_;
};

/// Adds up evidence by edge. An edge may be listed twice if another edge of the same slot came in between.
class EdgeList {
public:
    void add(Index a, Index b, double weight) {
        if (b < a) std::swap(a, b);
        std::size_t& place = place_[(spread * a + b) % places];
        if (place >= edges.size() || edges[place].a != a || edges[place].b != b) {
            place = edges.size();
            edges.push_back({a, b, 0, 0});
        }
        const float w = in_steps(weight);
        edges[place].weight += w;
        edges[place].total += std::abs(w);
    }

    std::vector<SignedEdge> edges;

private:
    static constexpr std::size_t places = 1024, spread = 37;

    std::array<std::size_t, places> place_{}; // where the last edge of such patches is
};

/// One normal against the other's mirror image in the plane halfway between the points; the chord `d` counts
/// as one whose squared length is `square`.
double mirrored(const Vec3& n, const Vec3& m, const Vec3& d, double square) {
    if (!(square > 0)) return n | m; // two points at one place
    return std::clamp((n | m) - 2 * (n | d) * (m | d) / square, -1.0, 1.0);
}

/// The squared length from which on chords from a point count as that long.
double longest_square(const Neighbors& neighbors, const EstimatedNormals& estimate, Index i) {
    const double both = 2 * estimate.tolerance[i]; // the tolerances of both points, much alike
    const double span = std::max(patches::near_pair * neighbors.reach[i], both);
    return span * span;
}

/// Sums up what pair_of(point)(neighbour, chord) says of the signs of neighbouring points' normals.
template <class PairOf>
std::vector<SignedEdge> evidence_of_pairs(const Octree& octree, const Neighbors& neighbors,
                                          const Patches& patches, std::size_t first_leaf,
                                          std::size_t last_leaf, const PairOf& pair_of) {
    const auto gather = [&](std::size_t begin, std::size_t end, std::vector<SignedEdge>& found) {
        EdgeList list;
        const Index first = neighbors.leaf_first[first_leaf + begin];
        for (Index i = first; i < neighbors.leaf_first[first_leaf + end]; ++i) {
            const Index a = patches.of_point[i];
            if (a == no_index) continue;
            const auto pair = pair_of(i);
            const auto around = neighbors.of(i);
            for (std::size_t k = 0; k < around.size(); k += 2) { // every second pair is enough
                const Index j = around[k], b = patches.of_point[j];
                if (b == no_index || a == b) continue;
                const double said = pair(j, octree.positions[j] - octree.positions[i]);
                list.add(a, b, said * patches.sign[i] * patches.sign[j]);
            }
        }
        found = std::move(list.edges);
    };
    return collected<SignedEdge>(last_leaf - first_leaf, chunks::heavy, gather);
}

} // namespace

Patches build_patches(const Octree& octree, const Neighbors& neighbors, const EstimatedNormals& estimate) {
    return PatchBuilder(octree, neighbors, estimate).run();
}

std::vector<SignedEdge> patch_evidence(const Octree& octree, const Neighbors& neighbors,
                                       const EstimatedNormals& estimate, const Patches& patches) {
    return patch_evidence(octree, neighbors, estimate, patches, 0, neighbors.leaf_first.size() - 1);
}

std::vector<SignedEdge> patch_evidence(const Octree& octree, const Neighbors& neighbors,
                                       const EstimatedNormals& estimate, const Patches& patches,
                                       std::size_t begin, std::size_t end) {
    return evidence_of_pairs(octree, neighbors, patches, begin, end, [&](Index i) {
        return [&estimate, n = estimate.normals[i],
                longest = longest_square(neighbors, estimate, i)](Index j, const Vec3& d) {
            return mirrored(n, estimate.normals[j], d, std::min(d.sqrnorm(), longest));
        };
    });
}

std::vector<std::uint8_t> sheets_beside(const Octree& octree, const Neighbors& neighbors,
                                        const EstimatedNormals& estimate, const Patches& patches) {
    std::vector<std::uint8_t> beside = large_vector<std::uint8_t>(patches.size(), 0);
    const std::size_t leaves = neighbors.leaf_first.size() - 1; // a patch is of one leaf
    for_each_index(leaves, chunks::slow, [&](std::size_t leaf) {
        for (Index i = neighbors.leaf_first[leaf]; i < neighbors.leaf_first[leaf + 1]; ++i) {
            const Index p = patches.of_point[i];
            if (p == no_index) continue;
            const Vec3& n = estimate.normals[i];
            const double longest = longest_square(neighbors, estimate, i);
            for (const Index j : neighbors.of(i)) {
                const Vec3 d = octree.positions[j] - octree.positions[i];
                const Vec3& m = estimate.normals[j];
                const double cosine = n | m;
                if (std::abs(cosine) < patches::least_cosine
                    || mirrored(n, m, d, std::min(d.sqrnorm(), longest)) * cosine >= 0)
                    continue;
                const unsigned side = (n | d) * patches.sign[i] > 0 ? 1 : 2;
                beside[p] = static_cast<std::uint8_t>(beside[p] | side);
            }
        }
    });
    return beside;
}

std::vector<SignedEdge> layer_evidence(const Octree& octree, const Neighbors& neighbors,
                                       const EstimatedNormals& estimate, const Patches& patches) {
    return layer_evidence(octree, neighbors, estimate, patches, 0, neighbors.leaf_first.size() - 1);
}

std::vector<SignedEdge> layer_evidence(const Octree& octree, const Neighbors& neighbors,
                                       const EstimatedNormals& estimate, const Patches& patches,
                                       std::size_t begin, std::size_t end) {
    return evidence_of_pairs(octree, neighbors, patches, begin, end, [&](Index i) {
        return [&estimate, n = estimate.normals[i]](Index j, const Vec3& d) {
            const Vec3& m = estimate.normals[j];
            const double said = mirrored(n, m, d, d.sqrnorm()), cosine = n | m;
            return said * cosine < 0 && std::abs(cosine) > patches::least_cosine ? 0 : said;
        };
    });
}

} // namespace hsdm
