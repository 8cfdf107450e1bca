#include "hsdm/core/chunks.hh"
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
    FacetShape shape;
    std::vector<double> lengths = unwritten_vector<double>(mesh.corners.size());
    const auto measure = [&](std::size_t begin, std::size_t end, std::vector<double>& of_quads) {
        for (std::size_t f = begin; f < end; ++f) {
            const auto facet = mesh.facet(f);
            double* const sides = lengths.data() + mesh.first[f];
            for (std::size_t i = 0; i < facet.size(); ++i) {
                const Index next = facet[i + 1 == facet.size() ? 0 : i + 1];
                sides[i] = (mesh.positions[next] - mesh.positions[facet[i]]).norm();
            }
            if (facet.size() == 4) of_quads.push_back(scaled_jacobian(mesh.positions, facet, sides));
        }
    };
    std::vector<double> jacobians = collected<double>(mesh.facet_count(), chunks::usual, measure);
    double length = 0; // in the order of the sides, so that it is the same however many threads there are
    for_each_in_order(lengths.size(), [&](std::size_t side) { length += lengths[side]; });
    if (!lengths.empty()) shape.edge_length_mean = length / static_cast<double>(lengths.size());
    if (jacobians.empty()) return shape;
    shape.quad_share = static_cast<double>(jacobians.size()) / static_cast<double>(mesh.facet_count());
    const auto median = jacobians.begin() + static_cast<std::ptrdiff_t>((jacobians.size() - 1) / 2);
    std::nth_element(jacobians.begin(), median, jacobians.end());
    shape.scaled_jacobian_median = *median;
    shape.scaled_jacobian_min = *std::min_element(jacobians.begin(), median + 1);
    return shape;
}

} // namespace hsdm
