#include "hsdm/features/normal_filter.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/features/constants.hh"
#include "hsdm/mesh/facet_normal.hh"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace hsdm {
std::size_t filter_normals(const FacetNeighbours& neighbours, const std::vector<double>& area,
                           double similarity_angle, double settled_angle, std::vector<Vec3>& normals) {
    const double steepness = -0.5 / (similarity_angle * similarity_angle);
    const double settled = 2 * std::sin(settled_angle / 2); // as a chord between unit vectors
    std::vector<Vec3> next = unwritten_vector<Vec3>(normals.size());
    std::atomic<std::size_t> turning = 0;
    for_chunks(normals.size(), chunks::quick, [&](std::size_t begin, std::size_t end, std::size_t) {
        std::size_t here = 0;
        for (std::size_t f = begin; f != end; ++f) {
            next[f] = normals[f];
            if (neighbours.first[f] == neighbours.first[f + 1]) continue;
            Vec3 sum = normals[f] * area[f];
            for (Index i = neighbours.first[f]; i < neighbours.first[f + 1]; ++i) {
                const Index g = neighbours.neighbour[i];
                if (g == no_index) continue;
                const double distance = (normals[g] - normals[f]).sqrnorm();
                sum += normals[g]
                       * (std::min(normal_filters::most_of_own * area[f], area[g])
                          * std::exp(steepness * distance));
            }
            const Vec3 mean = unit_or_zero(sum);
            if (mean.sqrnorm() > 0) next[f] = mean;
            if ((next[f] - normals[f]).sqrnorm() > settled * settled) ++here;
        }
        turning += here;
    });
    normals.swap(next);
    return turning;
}

} // namespace hsdm
