#include "hsdm/normals/vote_on_normals.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/normals/constants.hh"
#include "hsdm/normals/neighborhood.hh"
#include "hsdm/normals/plane_support.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

/// The neighbours that lie on one plane with the point and whose normals agree with a given one.
class Agreement {
public:
    Agreement(const Octree& octree, const Neighbors& neighbors, const EstimatedNormals& estimate, Index point)
        : normals_(estimate.normals),
          around_(octree, neighbors, point),
          inverse_(1 / estimate.tolerance[point]) {}

    Vec3 settled(const Vec3& own) const {
        Vec3 best = own;
        double most =
            normal_votes::clear_gain * support(VectorPair(own, own))[0] + normal_votes::least_support;
        Planes planes;
        planes.inverse_tolerance = inverse_;
        for (std::size_t k = 0; k < around_.size(); ++k) planes.add(normal(k), around_.offset(k));
        Support found;
        agreeing_with_planes(planes, found);
        for (std::size_t k = 0; k < around_.size(); ++k)
            if (found[k] > most) most = found[k], best = normal(k);
        Vec3 sum = best * estimation::own_weight;
        for (std::size_t k = 0; k < around_.size(); ++k)
            sum += normal(k) * weight(VectorPair(best, best), k)[0];
        return sum.sqrnorm() > 0 ? sum.normalized() : own;
    }

private:
    const Vec3& normal(std::size_t k) const { return normals_[around_.point(k)]; }
    Double2 weight(const VectorPair& n, std::size_t k) const {
        const Double2 cosine = n | normal(k);
        const Double2 all = agreement(cosine) * closeness(n | around_.offset(k), inverse_);
        return cosine > 0 ? all : Double2{};
    }
    Double2 support(const VectorPair& n) const {
        Double2 sum{};
        for (std::size_t k = 0; k < around_.size(); ++k) sum += weight(n, k);
        return sum;
    }

    const std::vector<Vec3>& normals_;
    Neighborhood around_;
    double inverse_;
};

} // namespace

void vote_on_normals(const Octree& octree, const Neighbors& neighbors, EstimatedNormals& estimate) {
    const std::vector<Index>& bent = estimate.bent;
    std::vector<Vec3> settled(bent.size());
    for (int round = 0; round < repeats::twice; ++round) {
        for_each_index(bent.size(), chunks::heavy, [&](Index b) {
            const Vec3& own = settled[b] = estimate.normals[bent[b]];
            const auto around = neighbors.of(bent[b]);
            if (std::any_of(around.begin(), around.end(),
                            [&](Index j) { return (own | estimate.normals[j]) < angles::one_sheet; }))
                settled[b] = Agreement(octree, neighbors, estimate, bent[b]).settled(own);
        });
        for_each_index(bent.size(), chunks::light, [&](Index b) { estimate.normals[bent[b]] = settled[b]; });
    }
}

} // namespace hsdm
