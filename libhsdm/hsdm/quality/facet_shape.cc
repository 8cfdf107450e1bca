#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/quality/topology.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

/// Least over the corners of the sine between the two sides, seen along the quad's area vector. `sides`:
/// their lengths.
double scaled_jacobian(const std::vector<Vec3>& p, std::span<const Index> quad, const double* sides) {
    Vec3 axis = (p[quad[2]] - p[quad[0]]) % (p[quad[3]] - p[quad[1]]);
    const double length = axis.norm();
    if (length > 0) axis /= length;
    double least = 1;
    for (std::size_t k = 0; k < 4; ++k) {
        const Vec3 to_next = p[quad[(k + 1) % 4]] - p[quad[k]], to_last = p[quad[(k + 3) % 4]] - p[quad[k]];
        const double lengths = sides[k] * sides[(k + 3) % 4];
        least = std::min(least, lengths > 0 ? (axis | (to_next % to_last)) / lengths : 0.0);
    }
    return least;
}

} // namespace

FacetShape measure_shape(const PolygonMesh& mesh) {
    constexpr std::size_t facets_at_once = std::size_t{1} << 18; // their lengths take some megabytes
    FacetShape shape;
    std::vector<double> lengths, jacobians;
    reserve_large(jacobians, mesh.facet_count());
    double length = 0; // in the order of the sides, so that it is the same however many threads there are
    for (std::size_t first = 0; first < mesh.facet_count(); first += facets_at_once) {
        const std::size_t count = std::min(facets_at_once, mesh.facet_count() - first);
        resize_unwritten(lengths, mesh.first[first + count] - mesh.first[first]);
        const auto measure = [&](std::size_t begin, std::size_t end, std::vector<double>& of_quads) {
            for (std::size_t f = first + begin; f < first + end; ++f) {
                const auto facet = mesh.facet(f);
                double* const sides = lengths.data() + (mesh.first[f] - mesh.first[first]);
                for (std::size_t i = 0; i < facet.size(); ++i) {
                    const Index next = facet[i + 1 == facet.size() ? 0 : i + 1];
                    sides[i] = (mesh.positions[next] - mesh.positions[facet[i]]).norm();
                }
                if (facet.size() == 4) of_quads.push_back(scaled_jacobian(mesh.positions, facet, sides));
            }
        };
        append_large(jacobians, collected<double>(count, chunks::usual, measure));
        for_each_in_order(lengths.size(), [&](std::size_t side) { length += lengths[side]; });
    }
    if (!mesh.corners.empty()) shape.edge_length_mean = length / static_cast<double>(mesh.corners.size());
    if (jacobians.empty()) return shape;
    shape.quad_share = static_cast<double>(jacobians.size()) / static_cast<double>(mesh.facet_count());
    const auto median = jacobians.begin() + static_cast<std::ptrdiff_t>((jacobians.size() - 1) / 2);
    std::nth_element(jacobians.begin(), median, jacobians.end());
    shape.scaled_jacobian_median = *median;
    shape.scaled_jacobian_min = *std::min_element(jacobians.begin(), median + 1);
    return shape;
}

} // namespace hsdm
