// hsdm_generate: a scan of a known solid, for the demo, the tests and anyone's own trials.

#include "hsdm/errors.hh"
#include "support/named_solid.hh"
#include "support/scanner.hh"

#include <CLI/CLI.hpp>

#include <iostream>

using namespace hsdm::support;

namespace {

/// Of a ball about the origin that holds the solid.
double radius_of(const Solid& solid) {
    double radius = 0;
    for (const hsdm::Vec3& p : sample(solid, {.points = 2000}).positions) radius = std::max(radius, p.norm());
    return 1.05 * radius;
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app("Writes a scan of a known solid as a binary PLY file of doubles.");
    std::string shape, output;
    SampleOptions options;
    double normal_noise_degrees = 0, width = 0.04;
    bool no_normals = false, turn = false;
    ScannerOptions scanner{.positions = 0};
    app.add_option("shape", shape, "the solid; `random` is a tree of solids that --seed chooses")
        ->required()
        ->check(CLI::IsMember(solid_names()));
    app.add_option("--width", width,
                   "of the walls and gaps of a comb, honeycomb, heat-sink, hinge, can or roll")
        ->check(CLI::Range(0.001, 0.2))
        ->capture_default_str();
    app.add_option("-o,--output", output, "the PLY file to write")->required();
    app.add_option("--points", options.points, "how many points")->capture_default_str();
    app.add_option("--seed", options.seed, "the same seed gives the same file")->capture_default_str();
    app.add_option("--noise", options.position_noise,
                   "standard deviation along the normal, in the solid's units");
    app.add_option("--normal-noise", normal_noise_degrees, "standard deviation of the normals, in degrees");
    app.add_option("--outliers", options.outliers, "share of stray points, 0 to 1")
        ->check(CLI::Range(0.0, 1.0));
    app.add_flag("--no-normals", no_normals, "positions only");
    app.add_flag("--turn", turn, "turn the solid at random (by the seed) instead of leaving it on the axes");
    app.add_option(
           "--positions", scanner.positions,
           "scanner positions above the solid, which see what nothing hides, without normals; 0: all is seen")
        ->check(CLI::Range(0, 100));
    CLI11_PARSE(app, argc, argv);

    options.normal_noise = normal_noise_degrees * std::numbers::pi / 180;
    options.normals = !no_normals;
    try {
        Solid solid = solid_named(shape, options.seed, width);
        if (turn) solid = solid.placed(pose_by_seed(options.seed));
        scanner.points = options.points, scanner.seed = options.seed;
        scanner.noise = options.position_noise, scanner.outliers = options.outliers;
        write_ply(output, scanner.positions > 0 ? scan_from_above(solid, radius_of(solid), scanner)
                                                : sample(solid, options));
    } catch (const std::exception& error) {
        std::cerr << "hsdm_generate: " << error.what() << '\n';
        return 1;
    }
    return 0;
}
