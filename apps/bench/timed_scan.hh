// The options of benchmarks that time the phases of one scan.
#pragma once

#include "support/named_solid.hh"

#include <CLI/CLI.hpp>

#include <string>

namespace hsdm::bench {

/// What is scanned, and how often its phases are timed.
struct TimedScan {
    std::string shape = "torus";
    std::size_t points = 1000000;
    double points_per_voxel = 7;
    int repeats = 5;

    /// All of them but the number of points, of which a benchmark may have several.
    void add_options(CLI::App& app) {
        app.add_option("--shape", shape, "of hsdm_generate, in general pose")
            ->check(CLI::IsMember(support::solid_names()))
            ->capture_default_str();
        app.add_option("--points-per-voxel", points_per_voxel, "on average")
            ->check(CLI::Range(1.0, 1000.0))
            ->capture_default_str();
        app.add_option("--repeats", repeats, "the fastest of so many runs counts")
            ->check(CLI::PositiveNumber)
            ->capture_default_str();
    }
    void add_points(CLI::App& app) {
        app.add_option("--points", points, "how many")
            ->check(CLI::Range(1000, 2000000000))
            ->capture_default_str();
    }
};

} // namespace hsdm::bench
