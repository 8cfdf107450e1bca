// How thin may walls and gaps be? Shapes of many widths in many poses, normals given and estimated: the table
// and the plot of docs/sheets.md.

#include "benchmarks.hh"
#include "plot.hh"

#include "hsdm/errors.hh"
#include "hsdm/reconstruct.hh"
#include "support/pose.hh"
#include "support/sample.hh"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>

using namespace hsdm;
using support::Solid;

namespace {

constexpr double voxel = 1.0 / 16;
constexpr double per_voxel = 8; // points per squared voxel: a spacing is 0.35 voxels

struct Shape {
    const char* name;
    std::function<Solid(double)> of_width;
    double area;
    std::size_t components;
    long euler;
};

Solid at(const Solid& solid, const Vec3& where) {
    return solid.placed(support::turned({0, 0, 1}, 0, where));
}

Solid boxes_apart(double gap) {
    const double away = 0.4 + 0.5 * gap;
    return at(support::box({0.8, 1, 0.5}), {-away, 0, 0}) | at(support::box({0.8, 1, 0.5}), {away, 0, 0});
}

Solid layers(double width) {
    return at(support::box({1, 0.8, width}), {0, 0, -width})
           | at(support::box({1, 0.8, width}), {0, 0, width});
}

const std::vector<Shape> walls_and_gaps = {
    {"plate",
     [](double w) {
         return support::box({1, 0.8, w}) - support::box({0.3, 0.3, 1});
     },
     1.6, 1, 0},
    {"wall on a base",
     [](double w) {
         return support::box({1.4, 1, 0.3}) | at(support::box({w, 0.8, 0.8}), {0, 0, 0.4});
     },
     5, 1, 2},
    {"slot",
     [](double w) {
         return support::box({1.4, 1, 0.8}) - at(support::box({w, 2, 0.8}), {0, 0, 0.4});
     },
     6.8, 1, 2},
    {"gap", boxes_apart, 6.8, 2, 4},
    {"tube", [](double w) { return support::cylinder(0.4, 1) - support::cylinder(0.4 - w, 2); }, 5, 1, 0},
    {"T of sheets",
     [](double w) {
         return support::box({1, 0.8, w}) | at(support::box({w, 0.8, 0.6}), {0, 0, 0.3});
     },
     2.6, 1, 2},
    {"layers", layers, 3.4, 2, 4},
};

bool is_right(const Shape& shape, double width, std::uint64_t pose, NormalSource normals, double noise = 0) {
    const Solid solid = shape.of_width(width * voxel).placed(support::random_pose(pose));
    const PointCloud cloud =
        support::sample(solid, {.points = static_cast<std::size_t>(per_voxel * shape.area / (voxel * voxel)),
                                .seed = pose,
                                .position_noise = noise * voxel});
    try {
        const Report r = reconstruct(cloud, {.voxel_size = voxel, .normals = normals}).report;
        return r.mesh.closed && r.mesh.components == shape.components && r.mesh.euler == shape.euler
               && r.rejected.at("intersections_left") == 0;
    } catch (const Error&) {
        return false;
    }
}

/// Prints a row for each width; returns the percentages of all shapes.
std::vector<double> print_table(NormalSource normals, const std::vector<double>& widths,
                                std::uint64_t poses) {
    std::vector<double> percents;
    std::printf("| width |");
    for (const Shape& shape : walls_and_gaps) std::printf(" %s |", shape.name);
    std::printf(" all |\n|---|");
    for (std::size_t i = 0; i <= walls_and_gaps.size(); ++i) std::printf("---|");
    std::printf("\n");
    for (const double width : widths) {
        std::printf("| %g |", width);
        std::uint64_t all = 0;
        for (const Shape& shape : walls_and_gaps) {
            std::uint64_t right = 0;
            for (std::uint64_t pose = 1; pose <= poses; ++pose)
                right += is_right(shape, width, pose, normals);
            std::printf(" %.0f |", 100.0 * static_cast<double>(right) / static_cast<double>(poses));
            all += right;
        }
        percents.push_back(100.0 * static_cast<double>(all)
                           / static_cast<double>(poses * walls_and_gaps.size()));
        std::printf(" %.1f |\n", percents.back());
        std::fflush(stdout);
    }
    return percents;
}

/// Prints a row for each width: percent of all shapes, by how many deviations of the noise that is. Normals
/// are estimated.
void print_noise(const std::vector<double>& widths, const std::vector<double>& deviations,
                 std::uint64_t poses) {
    std::printf("| spacings |");
    for (const double d : deviations) std::printf(" %g |", d);
    std::printf("\n|---|");
    for (std::size_t i = 0; i < deviations.size(); ++i) std::printf("---|");
    std::printf("\n");
    for (const double width : widths) {
        std::printf("| %.1f |", width * std::sqrt(per_voxel));
        for (const double d : deviations) {
            std::uint64_t right = 0;
            for (const Shape& shape : walls_and_gaps)
                for (std::uint64_t pose = 1; pose <= poses; ++pose)
                    right += is_right(shape, width, pose, NormalSource::estimate, width / d);
            std::printf(" %.0f |", 100.0 * static_cast<double>(right)
                                       / static_cast<double>(poses * walls_and_gaps.size()));
            std::fflush(stdout);
        }
        std::printf("\n");
    }
}

/// Percentages over the width, and where the width is a spacing of the points.
bench::Plot plot_of(const std::vector<double>& widths) {
    const auto [least, most] = std::ranges::minmax(widths);
    const double spacing = 1 / std::sqrt(per_voxel);
    bench::Plot plot({"width in voxels", least, std::max(most, 1.001 * least), widths},
                     {"% right", 0, 100, {0, 50, 95, 100}, false});
    plot.guide({spacing, 100}, {spacing, 0}, "a spacing");
    return plot;
}

void add_line(const std::vector<double>& widths, const std::vector<double>& percents, const char* name,
              bench::Plot& plot) {
    std::vector<bench::PlotPoint> line;
    for (std::size_t i = 0; i < widths.size(); ++i) line.push_back({widths[i], percents[i]});
    plot.line(line, name);
}

} // namespace

int bench::walls(int argc, char** argv) {
    CLI::App app(
        "Percent of meshes with the topology of the shape, and without intersections, by width in voxels.");
    std::uint64_t poses = 20;
    std::string plot_file;
    std::vector<double> widths{0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 1, 1.4, 2}, deviations;
    app.add_option("--poses", poses, "of each shape and width");
    app.add_option("--widths", widths, "in voxels; a spacing is 0.35");
    app.add_option("--plot", plot_file, "an SVG file: what is right of all shapes, by width");
    app.add_option("--deviations", deviations,
                   "noise instead: widths in its deviations; percent of all shapes");
    CLI11_PARSE(app, argc, argv);
    if (!deviations.empty()) {
        print_noise(widths, deviations, poses);
        return 0;
    }
    Plot plot = plot_of(widths);
    std::printf("Normals given:\n\n");
    add_line(widths, print_table(NormalSource::given, widths, poses), "normals given", plot);
    std::printf("\nNormals estimated:\n\n");
    add_line(widths, print_table(NormalSource::estimate, widths, poses), "normals estimated", plot);
    if (!plot_file.empty()) plot.write(plot_file);
    return 0;
}
