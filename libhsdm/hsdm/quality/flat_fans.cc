#include "hsdm/quality/flat_fans.hh"

#include "hsdm/chunks.hh"
#include "hsdm/quality/mix.hh"

#include <atomic>

namespace hsdm {
namespace {

constexpr std::size_t triangles_per_chunk = 4096;
/// Sine of the least angle of a corner as it is seen: far above rounding, far below angles in use.
constexpr double least_sine = 1e-6;

/// What the triangles round a vertex add up to, in any order.
struct Fan {
    std::atomic<std::uint64_t> ends = 0;  // sides that lead away less those that come back, mixed
    std::atomic<std::uint32_t> turns = 0; // times that the fan passes the side of its first triangle
};

} // namespace

/// Seen along the normal of one of its triangles, a fan whose corners all turn left and that comes round once
/// covers nothing twice. It comes round where it passes from the right of one of that triangle's sides, of
/// any direction across the line of sight, to its left.
std::vector<std::uint8_t> flat_fans(const std::vector<Vec3>& positions,
                                    const std::vector<Triangle>& triangles,
                                    const std::vector<Index>& vertex) {
    std::vector<Index> seen_from(positions.size(), 0); // a triangle of each vertex
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (Index v : triangles[t]) seen_from[vertex[v]] = static_cast<Index>(t);
    std::vector<Fan> fans(positions.size());
    for_chunks(triangles.size(), triangles_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t t = begin; t < end; ++t)
            for (std::size_t k = 0; k < 3; ++k) {
                const Index v = triangles[t][k], next = triangles[t][(k + 1) % 3],
                            last = triangles[t][(k + 2) % 3];
                const Vec3 a = positions[next] - positions[v], b = positions[last] - positions[v];
                const auto& [q0, q1, q2] = triangles[seen_from[vertex[v]]];
                const Vec3 side = positions[q1] - positions[q0];
                const Vec3 sight = side % (positions[q2] - positions[q0]);
                const double area = (a % b) | sight;
                const bool left =
                    area > 0
                    && area * area > least_sine * least_sine * a.sqrnorm() * b.sqrnorm() * sight.sqrnorm();
                Fan& fan = fans[vertex[v]];
                fan.ends.fetch_add(mix(vertex[next]) - mix(vertex[last]), std::memory_order_relaxed);
                const std::uint32_t turns = !left ? 2 : (a | side) < 0 && (b | side) >= 0;
                if (turns > 0) fan.turns.fetch_add(turns, std::memory_order_relaxed);
            }
    });
    std::vector<std::uint8_t> flat(positions.size());
    for (std::size_t v = 0; v < flat.size(); ++v) flat[v] = fans[v].turns == 1 && fans[v].ends == 0;
    return flat;
}

} // namespace hsdm
