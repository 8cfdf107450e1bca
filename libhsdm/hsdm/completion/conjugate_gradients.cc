#include "hsdm/completion/conjugate_gradients.hh"

#include "hsdm/core/chunks.hh"

#include <cmath>

namespace hsdm {
namespace {

/// The sum of f(i) over i below n, added up by chunks in order.
template <class F>
double sum_of(std::size_t n, F&& f) {
    std::vector<double> parts(chunk_count(n, chunks::light), 0);
    for_chunks(n, chunks::light, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
        for (std::size_t i = begin; i < end; ++i) parts[chunk] += f(i);
    });
    double sum = 0;
    for (const double part : parts) sum += part;
    return sum;
}

double times(const HarmonicEquations& equations, const std::vector<double>& values, Index i) {
    double sum = equations.degree[i] * values[i];
    for (Index k = equations.first[i]; k < equations.first[i + 1]; ++k) sum -= values[equations.beside[k]];
    return sum;
}

} // namespace

void solve_harmonic(const HarmonicEquations& equations, double tolerance, int most_rounds,
                    std::vector<double>& values) {
    const std::size_t n = equations.size();
    std::vector<double> rest = large_vector<double>(n), way = large_vector<double>(n),
                        product = large_vector<double>(n);
    for_each_index(n, chunks::light,
                   [&](Index i) { way[i] = rest[i] = equations.known[i] - times(equations, values, i); });
    double off = sum_of(n, [&](std::size_t i) { return rest[i] * rest[i]; });
    const double enough = tolerance * tolerance
                          * sum_of(n, [&](std::size_t i) { return equations.known[i] * equations.known[i]; });
    for (int round = 0; round < most_rounds && off > enough; ++round) {
        for_each_index(n, chunks::light, [&](Index i) { product[i] = times(equations, way, i); });
        const double step = off / sum_of(n, [&](std::size_t i) { return way[i] * product[i]; });
        if (!std::isfinite(step)) return;
        for_each_index(n, chunks::light, [&](Index i) {
            values[i] += step * way[i];
            rest[i] -= step * product[i];
        });
        const double before = off;
        off = sum_of(n, [&](std::size_t i) { return rest[i] * rest[i]; });
        for_each_index(n, chunks::light, [&](Index i) { way[i] = rest[i] + way[i] * (off / before); });
    }
}

} // namespace hsdm
