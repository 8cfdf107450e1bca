#include "page_mesh.hh"

#include "page_text.hh"
#include "summary.hh"

#include "hsdm/core/hash.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/json_text.hh"
#include "hsdm/mesh/triangulate.hh"
#include "hsdm/mesh/vertex_class.hh"
#include "hsdm/mesh/vertex_normals.hh"
#include "hsdm/pipeline/confidence.hh"
#include "hsdm/pipeline/extended_method.hh"
#include "hsdm/quality/deviations.hh"
#include "hsdm/quality/percentiles.hh"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace hsdm::command {
namespace {

constexpr std::int16_t nowhere = -32768; // no deviation is known; what is known lies in +-32767
constexpr double largest_step = 32767;
constexpr std::size_t most_facets = 2000000; // some 50 MB of page
constexpr std::size_t histogram_bins = 400;

/// Arrays as bytes, numbers with the lowest byte first whatever the machine.
class Bytes {
public:
    void add(float value) { add_bytes(std::bit_cast<std::uint32_t>(value), 4); }
    void add(std::int16_t value) { add_bytes(static_cast<std::uint16_t>(value), 2); }
    void add(std::uint8_t value) { bytes_ += static_cast<char>(value); }
    /// Seven bits a byte, the lowest first; all but the last byte have the eighth.
    void add_packed(std::uint64_t value) {
        for (; value > 127; value >>= 7) bytes_ += static_cast<char>((value & 127) | 128);
        bytes_ += static_cast<char>(value);
    }
    /// The step from the last vertex that was added so; its sign in the lowest bit.
    void add_step_to(Index vertex) {
        const std::int64_t step = std::int64_t(vertex) - last_;
        add_packed(step < 0 ? 2 * static_cast<std::uint64_t>(-step) - 1
                            : 2 * static_cast<std::uint64_t>(step));
        last_ = vertex;
    }
    bool empty() const { return bytes_.empty(); }
    std::string text() const { return base64(bytes_); }

private:
    void add_bytes(std::uint32_t value, unsigned count) {
        for (unsigned k = 0; k < count; ++k) bytes_ += static_cast<char>((value >> (8 * k)) & 255);
    }

    std::string bytes_;
    std::int64_t last_ = 0;
};

/// The page's own space: the mesh about 0, no vertex farther than 1.
struct PageSpace {
    Vec3 centre{0, 0, 0};
    double radius = 1;

    explicit PageSpace(const PolygonMesh& mesh) {
        Box box;
        for (const Vec3& p : mesh.positions) box.add(p);
        centre = 0.5 * box.lo + 0.5 * box.hi;
        const double extent = box.extent();
        if (extent > 0) radius = 0.5 * extent * (box.size() / extent).norm(); // squares might overflow
    }
    Vec3 inside(const Vec3& p) const { return (p - centre) / radius; }
};

const VertexProperty* find_property(const PolygonMesh& mesh, std::string_view name) {
    for (const VertexProperty& property : mesh.properties)
        if (property.name == name) return &property;
    return nullptr;
}

/// Facets with the corners where the triangles come together first: a triangle, and a quad that is cut from
/// its first corner to its third, need no list of triangles.
Bytes facets_of(const PolygonMesh& mesh) {
    const Triangulation cut = triangulate(mesh);
    Bytes bytes;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        const std::span<const Index> facet = mesh.facet(f);
        const std::span<const Triangle> triangles(cut.triangles.data() + cut.first[f],
                                                  cut.triangles.data() + cut.first[f + 1]);
        bytes.add_packed(facet.size());
        const auto has = [&](Index v) {
            return std::ranges::all_of(triangles,
                                       [v](const Triangle& t) { return std::ranges::count(t, v) > 0; });
        };
        const std::size_t begin = facet.size() == 4 && !has(facet[0]) ? 1 : 0;
        for (std::size_t k = 0; k < facet.size(); ++k) bytes.add_step_to(facet[(begin + k) % facet.size()]);
        if (facet.size() <= 4) continue;
        for (const Triangle& t : triangles)
            for (const Index v : t)
                bytes.add_packed(static_cast<std::uint64_t>(std::ranges::find(facet, v) - facet.begin()));
    }
    return bytes;
}

void put_mesh(const PolygonMesh& mesh, const PageSpace& space, JsonText& json) {
    json.member("vertex_count", mesh.vertex_count());
    json.member("facet_count", mesh.facet_count());
    json.member("corner_count", mesh.corners.size());
    json.member("centre", space.centre);
    json.member("radius", space.radius);
    Bytes positions;
    for (const Vec3& p : mesh.positions)
        for (const double x : space.inside(p)) positions.add(static_cast<float>(x));
    json.member("positions", positions.text());
    json.member("facets", facets_of(mesh).text());
    Bytes sharp, corners;
    for (const auto& edge : mesh.sharp_edges)
        for (const Index v : edge) sharp.add_step_to(v);
    json.member("sharp_edges", sharp.text());
    if (const auto* classes = find_property(mesh, vertex_class_property))
        for (std::size_t v = 0; v < classes->values.size(); ++v)
            if (classes->values[v] == static_cast<int>(VertexClass::corner))
                corners.add_step_to(static_cast<Index>(v));
    json.member("corner_vertices", corners.text());
}

/// Shares of 1 as whole numbers up to 255.
void put_shares(const PolygonMesh& mesh, std::string_view property, std::string_view key, JsonText& json) {
    const VertexProperty* const shares = find_property(mesh, property);
    if (!shares) return;
    Bytes bytes;
    for (const double share : shares->values)
        bytes.add(static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0))));
    json.member(key, bytes.text());
}

/// A number with few digits at least as large: the end of a scale.
double round_up(double value) {
    const double power = std::pow(10, std::floor(std::log10(value)));
    for (const double digit : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0})
        if (value <= digit * power * (1 + 1e-9)) return digit * power;
    return 10 * power;
}

/// The points that are no strays.
std::vector<Index> counted_points(std::span<const double> deviations, double largest) {
    std::vector<Index> counted;
    const double bound = largest > 0 ? largest * (1 + 1e-6) : Box::inf;
    for (std::size_t i = 0; i < deviations.size(); ++i)
        if (std::abs(deviations[i]) <= bound) counted.push_back(static_cast<Index>(i));
    return counted;
}

/// The farthest point, then the farthest of those at least a sixth of the radius from all chosen, and so on.
void find_farthest(const std::span<const Vec3> points, std::span<const double> deviations,
                   const std::vector<Index>& counted, double radius, DeviationFigures& figures) {
    constexpr std::size_t most = 5, looked_at = 20000;
    std::vector<Index> order = counted;
    const auto end = order.begin() + static_cast<std::ptrdiff_t>(std::min(looked_at, order.size()));
    std::partial_sort(order.begin(), end, order.end(), [&](Index a, Index b) {
        const double da = std::abs(deviations[a]), db = std::abs(deviations[b]);
        return da != db ? da > db : a < b;
    });
    for (auto i = order.begin(); i != end && figures.farthest.size() < most; ++i) {
        const Vec3& p = points[*i];
        if (std::ranges::any_of(figures.farthest,
                                [&](const Vec3& q) { return ((p - q) / radius).norm() < 1.0 / 6; }))
            continue;
        figures.farthest.push_back(p);
        figures.farthest_deviations.push_back(deviations[*i]);
    }
}

DeviationFigures figures_of(std::span<const double> deviations, const std::vector<Index>& counted) {
    DeviationFigures figures;
    figures.points = counted.size();
    figures.strays = deviations.size() - counted.size();
    if (counted.empty()) return figures;
    std::vector<double> magnitudes;
    double largest = 0;
    for (const Index i : counted) {
        figures.mean += deviations[i] / static_cast<double>(counted.size());
        figures.highest = std::max(figures.highest, deviations[i]);
        figures.lowest = std::min(figures.lowest, deviations[i]);
        magnitudes.push_back(std::abs(deviations[i]));
        largest = std::max(largest, magnitudes.back());
    }
    double squares = 0, off = 0; // of shares of the largest, which neither overflow nor vanish
    for (const Index i : counted) {
        const double share = largest > 0 ? deviations[i] / largest : 0;
        squares += share * share;
        off += largest > 0 ? std::pow(share - figures.mean / largest, 2) : 0;
    }
    figures.rms = largest * std::sqrt(squares / static_cast<double>(counted.size()));
    figures.spread = largest * std::sqrt(off / static_cast<double>(counted.size()));
    const Percentiles percentiles = percentiles_of(std::move(magnitudes));
    figures.median = percentiles.median;
    figures.p95 = percentiles.p95;
    figures.p99 = percentiles.p99;
    return figures;
}

/// How many points deviate by how much, in bins over a range that holds all but the last stragglers.
void put_histogram(std::span<const double> deviations, const std::vector<Index>& counted, double range,
                   JsonText& json) {
    std::vector<std::size_t> counts(histogram_bins, 0);
    std::size_t below = 0, above = 0;
    for (const Index i : counted) {
        const double place = (deviations[i] / range + 1) / 2 * histogram_bins;
        if (place < 0)
            ++below;
        else if (place > histogram_bins)
            ++above;
        else
            ++counts[std::min(histogram_bins - 1, static_cast<std::size_t>(place))];
    }
    json.key("histogram");
    json.begin_object();
    json.member("range", range);
    json.member("counts", counts);
    json.member("below", below);
    json.member("above", above);
    json.end();
}

/// Some of the points, spread over their list by a hash so that no row of a scan is preferred.
std::vector<Index> some_of(const std::vector<Index>& counted, std::size_t most) {
    if (counted.size() <= most) return counted;
    std::vector<Index> some = counted;
    const auto end = some.begin() + static_cast<std::ptrdiff_t>(most);
    std::nth_element(some.begin(), end, some.end(),
                     [](Index a, Index b) { return hash_index(a) < hash_index(b); });
    some.erase(end, some.end());
    std::sort(some.begin(), some.end());
    return some;
}

std::int16_t steps(double value, double step) {
    return static_cast<std::int16_t>(std::lround(std::clamp(value / step, -largest_step, largest_step)));
}

void put_points(const PageContent& content, const PageSpace& space, std::span<const double> deviations,
                const std::vector<Index>& counted, double deviation_step, JsonText& json) {
    const std::vector<Index> shown = some_of(counted, content.points_shown);
    double reach = 1;
    for (const Index i : shown)
        for (const double x : space.inside(content.points[i])) reach = std::max(reach, std::abs(x));
    const double step = reach / largest_step;
    Bytes places, values;
    for (const Index i : shown) {
        for (const double x : space.inside(content.points[i])) places.add(steps(x, step));
        values.add(steps(deviations[i], deviation_step));
    }
    json.member("point_step", step);
    json.member("points", places.text());
    json.member("point_deviations", values.text());
}

DeviationFigures put_deviations(const PageContent& content, const PageSpace& space, JsonText& json) {
    const double largest_error = content.report ? content.report->error.points_to_mesh_max : 0;
    const Deviations deviations = measure_deviations(content.points, content.mesh);
    const std::vector<Index> counted = counted_points(deviations.of_points, largest_error);
    DeviationFigures figures = figures_of(deviations.of_points, counted);
    if (counted.empty()) return figures;
    find_farthest(content.points, deviations.of_points, counted, space.radius, figures);
    const double largest = std::max(figures.highest, -figures.lowest);
    const double least = 1e-9 * space.radius; // of a mesh that all points lie on
    const double step = std::max(largest, least) / largest_step;
    Bytes at_vertices;
    for (const double d : deviations.at_vertices) at_vertices.add(std::isnan(d) ? nowhere : steps(d, step));
    json.member("deviation_step", step);
    json.member("deviations", at_vertices.text());
    const double range = round_up(std::max(figures.p99, least));
    json.member("range", range);
    put_histogram(deviations.of_points, counted, std::min(4 * range, round_up(std::max(largest, least))),
                  json);
    put_points(content, space, deviations.of_points, counted, step, json);
    return figures;
}

} // namespace

MeshElement describe_mesh(const std::string& id, const PageContent& content) {
    if (content.mesh.facet_count() == 0) throw Error("a mesh without facets: there is nothing to show");
    if (content.mesh.facet_count() > most_facets)
        throw Error(grouped(content.mesh.facet_count()) + " facets are more than the " + grouped(most_facets)
                    + " that a page can show; make it of a coarser --depth, or of a level of --levels");
    const PageSpace space(content.mesh);
    MeshElement result;
    JsonText json;
    json.begin_object();
    put_mesh(content.mesh, space, json);
    put_shares(content.mesh, confidence_property, "confidence", json);
    put_shares(content.mesh, completed_property, "completed", json);
    if (!content.points.empty()) result.figures = put_deviations(content, space, json);
    json.end();
    result.html = "<script type=\"application/json\" id=\"" + html_text(id) + "\">" + std::move(json).take()
                  + "</script>\n";
    return result;
}

} // namespace hsdm::command
