#pragma once
// Values that are each the mean of those beside them, some of which are given.

#include "hsdm/core/large_vector.hh"
#include "hsdm/types.hh"

#include <span>

namespace hsdm {

/// The equations of a harmonic function on a graph: per unknown, its degree times its value, less the values
/// of the unknowns beside it, beside[first[i]] .. beside[first[i + 1]], is what the known ones beside it sum
/// up to.
struct HarmonicEquations {
    std::vector<Index> first{0}, beside;
    std::vector<double> degree, known;

    std::size_t size() const { return degree.size(); }
};

/// Solves them by conjugate gradients, from `values`, until what they are off is less than `tolerance` of
/// what is known, or after `most_rounds`. O(edges) a round, parallel; asks in between; the same bits for any
/// number of threads.
void solve_harmonic(const HarmonicEquations& equations, double tolerance, int most_rounds,
                    std::vector<double>& values);

} // namespace hsdm
