#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/reconstruct.hh"
#include "support/check.hh"
#include "support/trial.hh"

#include <catch2/catch.hpp>
#include <tbb/parallel_for.h>

#include <sstream>

using namespace hsdm;
using support::FeatureSize;

namespace {

struct Outcome {
    std::uint64_t seed = 0;
    FeatureSize size = FeatureSize::ill_posed;
    std::string faults;
    bool closed = false, right_euler = false;
    std::string adaptive_faults; ///< of the mesh over an adaptive grid; another topology is one too
};

Outcome outcome_of(std::uint64_t seed, const support::TrialOptions& options) {
    const support::Trial trial = support::make_trial(seed, options);
    Outcome outcome{seed, trial.size, {}, false, false, {}};
    if (trial.size == FeatureSize::ill_posed) return outcome;
    ReconstructOptions how;
    how.method = Method::extended;
    how.voxel_size = options.voxel;
    const Reconstruction result = reconstruct(trial.cloud, how);
    outcome.faults = support::faults(to_polygons(result.mesh));
    outcome.closed = result.report.mesh.closed;
    outcome.right_euler = result.report.mesh.euler == trial.euler;
    how.grid = Grid::adaptive;
    const Reconstruction adaptive = reconstruct(trial.cloud, how);
    outcome.adaptive_faults = support::faults(to_polygons(adaptive.mesh));
    const Report::Mesh &one = result.report.mesh, &other = adaptive.report.mesh;
    if (one.closed != other.closed || one.euler != other.euler || one.components != other.components)
        outcome.adaptive_faults += "another topology than on the uniform grid";
    return outcome;
}

/// The first hundred seeds that give a well-posed solid.
std::vector<Outcome> hundred_outcomes(const support::TrialOptions& options) {
    constexpr std::size_t wanted = 100, batch = 20;
    std::vector<Outcome> outcomes;
    for (std::uint64_t from = 1; outcomes.size() < wanted; from += batch) {
        std::array<Outcome, batch> some;
        tbb::parallel_for(std::size_t{0}, batch,
                          [&](std::size_t i) { some[i] = outcome_of(from + i, options); });
        for (const Outcome& outcome : some)
            if (outcome.size != FeatureSize::ill_posed && outcomes.size() < wanted)
                outcomes.push_back(outcome);
    }
    return outcomes;
}

template <class Predicate>
std::string seeds_of(const std::vector<Outcome>& outcomes, Predicate&& predicate) {
    std::ostringstream text;
    for (const Outcome& outcome : outcomes)
        if (predicate(outcome)) text << outcome.seed << ' ' << outcome.faults << ' ';
    return text.str();
}

} // namespace

TEST_CASE("random solids come out closed, those with large features with the right Euler characteristic",
          "[pipeline][slow]") {
    support::TrialOptions options;
    const auto family = GENERATE(as<std::string>{}, "walls of 2.2 to 5 voxels", "walls of 0.3 to 1 voxel");
    if (family == "walls of 0.3 to 1 voxel") options.thinnest = 0.3, options.thickest = 1;
    const std::vector<Outcome> outcomes = hundred_outcomes(options);

    INFO(family);
    CHECK(seeds_of(outcomes, [](const Outcome& o) { return !o.faults.empty(); }) == "");
    CHECK(seeds_of(outcomes, [](const Outcome& o) { return !o.closed; }) == "");
    for (const Outcome& o : outcomes) {
        INFO("seed " << o.seed << " on an adaptive grid");
        CHECK(o.adaptive_faults == "");
    }
    const auto large = std::count_if(outcomes.begin(), outcomes.end(),
                                     [](const Outcome& o) { return o.size == FeatureSize::large; });
    const auto right = std::count_if(outcomes.begin(), outcomes.end(), [](const Outcome& o) {
        return o.size == FeatureSize::large && o.right_euler;
    });
    INFO("another Euler characteristic than the solid's, seeds " << seeds_of(
             outcomes, [](const Outcome& o) { return o.size == FeatureSize::large && !o.right_euler; }));
    CAPTURE(large, right);
    CHECK(large >= (options.thinnest > 2 ? 20 : 5)); // solids without thin walls are in either family
    CHECK(static_cast<double>(right) >= 0.95 * static_cast<double>(large));
}
