#include "mesh_picture.hh"

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/mesh/triangulate.hh"

#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace hsdm::command {
namespace {

/// Each pixel is drawn as so many squared, which are averaged: smooth outlines and lines of half a pixel.
constexpr int fine = 2;
constexpr int fine_width = picture_width * fine, fine_height = picture_height * fine, fine_margin = 4 * fine;
/// More facets than these would be all edges.
constexpr std::size_t most_with_edges = 2500;
/// In pixels, what lines lie before the facets that they bound.
constexpr double line_bias = 1.5;

using Color = std::array<std::uint8_t, 3>;
constexpr Color front_color{150, 180, 215}, inside_color{230, 150, 60}, line_color{60, 80, 110},
    sharp_color{10, 20, 45};

/// What is seen so far.
class Canvas {
public:
    void put(int x, int y, double depth, const Color& color) {
        if (x < 0 || y < 0 || x >= fine_width || y >= fine_height) return;
        const auto at = static_cast<std::size_t>(y * fine_width + x);
        if (depth <= depths_[at]) return;
        depths_[at] = depth;
        colors_[at] = color;
    }

    /// Averaged, with what is not covered transparent.
    std::vector<std::uint8_t> pixels() const {
        std::vector<std::uint8_t> result;
        for (int y = 0; y < picture_height; ++y)
            for (int x = 0; x < picture_width; ++x) add_pixel(x, y, result);
        return result;
    }

private:
    void add_pixel(int x, int y, std::vector<std::uint8_t>& result) const {
        std::array<int, 3> sum{};
        int covered = 0;
        for (int k = 0; k < fine * fine; ++k) {
            const auto at =
                static_cast<std::size_t>((y * fine + k / fine) * fine_width + x * fine + k % fine);
            if (depths_[at] == nothing) continue;
            ++covered;
            for (std::size_t c = 0; c < 3; ++c) sum[c] += colors_[at][c];
        }
        for (const int c : sum) result.push_back(static_cast<std::uint8_t>(covered ? c / covered : 0));
        result.push_back(static_cast<std::uint8_t>(255 * covered / (fine * fine)));
    }

    static constexpr double nothing = -1e300;
    std::vector<double> depths_ = std::vector<double>(std::size_t{fine_width} * fine_height, nothing);
    std::vector<Color> colors_ = std::vector<Color>(std::size_t{fine_width} * fine_height);
};

/// Positions as pixels across and down, and towards the eye, also in pixels.
std::vector<Vec3> project(const PolygonMesh& mesh) {
    const Vec3 eye = Vec3(0.55, -0.75, 0.5).normalized();
    const Vec3 right = Vec3(-eye[1], eye[0], 0).normalized(), up = eye % right;
    Box world, seen;
    for (const Vec3& p : mesh.positions) world.add(p);
    const double unit = CloudFrame(world).unit(); // products of extreme lengths would be none
    const Vec3 middle = world.lo / unit / 2 + world.hi / unit / 2;
    std::vector<Vec3> places;
    for (const Vec3& p : mesh.positions) {
        const Vec3 from = p / unit - middle;
        places.emplace_back(from | right, -(from | up), from | eye);
        seen.add(places.back());
    }
    const Vec3 size = seen.size();
    const double scale = std::min((fine_width - 2 * fine_margin) / std::max(size[0], 1e-300),
                                  (fine_height - 2 * fine_margin) / std::max(size[1], 1e-300));
    const Vec3 center = seen.lo / 2 + seen.hi / 2;
    for (Vec3& p : places) {
        p = (p - center) * scale;
        p += Vec3(fine_width / 2.0, fine_height / 2.0, 0);
    }
    return places;
}

/// The color of a facet with this area vector, in the picture's axes.
Color shade(const Vec3& area) {
    const double length = area.norm();
    const bool is_front = area[2] >= 0;
    const Vec3 light = Vec3(-0.35, -0.55, 0.76);
    const Vec3 normal = length > 0 ? area / (is_front ? length : -length) : Vec3(0, 0, 1);
    // in steps, so that the file is small
    const double strength = std::round((0.45 + 0.55 * std::max(0.0, normal | light)) * 40) / 40;
    Color color = is_front ? front_color : inside_color;
    for (std::uint8_t& c : color) c = static_cast<std::uint8_t>(c * strength);
    return color;
}

/// Twice the signed area; pixels count downwards, so it is positive seen from the front with this order.
double cross(const Vec3& a, const Vec3& b, double x, double y) {
    return (b[1] - a[1]) * (x - a[0]) - (b[0] - a[0]) * (y - a[1]);
}

void draw_triangle(const std::array<Vec3, 3>& t, const Color& color, Canvas& canvas) {
    const double area = cross(t[0], t[1], t[2][0], t[2][1]);
    if (!(std::abs(area) > 0)) return;
    const auto first = [](double low) { return static_cast<int>(std::ceil(low - 0.5)); };
    const auto [x0, x1] = std::minmax({t[0][0], t[1][0], t[2][0]});
    const auto [y0, y1] = std::minmax({t[0][1], t[1][1], t[2][1]});
    for (int y = first(y0); y + 0.5 <= y1; ++y)
        for (int x = first(x0); x + 0.5 <= x1; ++x) {
            const double a = cross(t[1], t[2], x + 0.5, y + 0.5) / area,
                         b = cross(t[2], t[0], x + 0.5, y + 0.5) / area, c = 1 - a - b;
            if (a >= 0 && b >= 0 && c >= 0) canvas.put(x, y, a * t[0][2] + b * t[1][2] + c * t[2][2], color);
        }
}

void draw_line(const Vec3& from, const Vec3& to, const Color& color, Canvas& canvas) {
    const Vec3 way = to - from;
    const int steps = static_cast<int>(std::ceil(std::max(std::abs(way[0]), std::abs(way[1])))) + 1;
    for (int i = 0; i <= steps; ++i) {
        const Vec3 p = from + way * (static_cast<double>(i) / steps);
        const int x = static_cast<int>(p[0]), y = static_cast<int>(p[1]);
        canvas.put(x, y, p[2] + line_bias, color);
    }
}

/// Of the facet's polygon, in the picture's axes with y up, so that fronts look along z.
Vec3 area_of(const PolygonMesh& mesh, std::size_t f, const std::vector<Vec3>& places) {
    const auto facet = mesh.facet(f);
    const auto upright = [&places](Index v) { return Vec3(places[v][0], -places[v][1], places[v][2]); };
    Vec3 area(0, 0, 0);
    for (std::size_t i = 2; i < facet.size(); ++i)
        area += (upright(facet[i - 1]) - upright(facet[0])) % (upright(facet[i]) - upright(facet[0]));
    return area;
}

void draw_facets(const PolygonMesh& mesh, const std::vector<Vec3>& places, Canvas& canvas) {
    const Triangulation cut = triangulate(mesh);
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        Vec3 area = area_of(mesh, f, places);
        const Color color = shade({area[0], -area[1], area[2]});
        for (std::size_t t = cut.first[f]; t < cut.first[f + 1]; ++t) {
            const auto [a, b, c] = cut.triangles[t];
            draw_triangle({places[a], places[b], places[c]}, color, canvas);
        }
    }
}

std::string png_of(const std::vector<std::uint8_t>& pixels) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = picture_width;
    image.height = picture_height;
    image.format = PNG_FORMAT_RGBA;
    png_alloc_size_t size = 0;
    std::string file;
    bool done = png_image_write_to_memory(&image, nullptr, &size, 0, pixels.data(), 0, nullptr) != 0;
    if (done) {
        file.resize(size);
        done = png_image_write_to_memory(&image, file.data(), &size, 0, pixels.data(), 0, nullptr) != 0;
    }
    if (!done) throw std::runtime_error(std::string("the picture of a mesh: ") + image.message);
    return file;
}

} // namespace

std::string draw_picture(const PolygonMesh& mesh) {
    const std::vector<Vec3> places = project(mesh);
    Canvas canvas;
    draw_facets(mesh, places, canvas);
    if (mesh.facet_count() <= most_with_edges)
        for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
            const auto facet = mesh.facet(f);
            for (std::size_t i = 0; i < facet.size(); ++i)
                draw_line(places[facet[i]], places[facet[(i + 1) % facet.size()]], line_color, canvas);
        }
    for (const auto& [a, b] : mesh.sharp_edges) draw_line(places[a], places[b], sharp_color, canvas);
    return png_of(canvas.pixels());
}

} // namespace hsdm::command
