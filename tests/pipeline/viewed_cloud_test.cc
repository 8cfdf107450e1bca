#include "hsdm/errors.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/quality/mesh_digest.hh"
#include "hsdm/reconstruct.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <cstring>

using namespace hsdm;

namespace {

/// Position, normal and an intensity of each point, as a struct of an odd size has them: nothing is aligned.
template <class Number>
class PackedPoints {
public:
    explicit PackedPoints(const PointCloud& cloud) : count_(cloud.size()), bytes_(1 + cloud.size() * size) {
        for (std::size_t i = 0; i < count_; ++i) {
            put(i, 0, cloud.positions[i]);
            put(i, 3, cloud.normals[i]);
            const auto intensity = static_cast<std::uint16_t>(i % 1000);
            std::memcpy(row(i) + 6 * sizeof(Number), &intensity, sizeof intensity);
        }
    }

    PointView view() const {
        PointView view;
        view.positions = span(0, number_type<Number>());
        view.normals = span(3 * sizeof(Number), number_type<Number>());
        view.scalars = {{"intensity", span(6 * sizeof(Number), NumberType::uint16), false}};
        return view;
    }
    /// The cloud that a caller without views would make of them.
    PointCloud copied() const {
        PointCloud cloud;
        cloud.scalars = {{"intensity", {}, false}};
        for (std::size_t i = 0; i < count_; ++i) {
            Number numbers[6];
            std::memcpy(numbers, &bytes_[1 + i * size], sizeof numbers);
            cloud.positions.emplace_back(numbers[0], numbers[1], numbers[2]);
            cloud.normals.emplace_back(numbers[3], numbers[4], numbers[5]);
            cloud.scalars[0].values.push_back(static_cast<double>(i % 1000));
        }
        return cloud;
    }
    void set_position(std::size_t i, const Vec3& p) { put(i, 0, p); }
    const std::vector<std::byte>& bytes() const { return bytes_; }

private:
    static constexpr std::size_t size = 6 * sizeof(Number) + sizeof(std::uint16_t) + 1;
    std::byte* row(std::size_t i) { return &bytes_[1 + i * size]; }
    StridedSpan span(std::size_t offset, NumberType type) const {
        StridedSpan span;
        span.data = &bytes_[1 + offset];
        span.count = count_;
        span.stride = size;
        span.type = type;
        return span;
    }
    void put(std::size_t i, std::size_t first, const Vec3& v) {
        const Number numbers[3] = {static_cast<Number>(v[0]), static_cast<Number>(v[1]),
                                   static_cast<Number>(v[2])};
        std::memcpy(row(i) + first * sizeof(Number), numbers, sizeof numbers);
    }

    std::size_t count_;
    std::vector<std::byte> bytes_;
};

/// Bits of the mesh, and the values of its properties.
void check_same_result(const Reconstruction& a, const Reconstruction& b) {
    const PolygonMesh of_a = to_polygons(a.mesh), of_b = to_polygons(b.mesh);
    REQUIRE(of_a.facet_count() > 100);
    CHECK(mesh_digest(of_a) == mesh_digest(of_b));
    REQUIRE(of_a.properties.size() == of_b.properties.size());
    for (std::size_t k = 0; k < of_a.properties.size(); ++k) {
        CHECK(of_a.properties[k].name == of_b.properties[k].name);
        CHECK(of_a.properties[k].values == of_b.properties[k].values);
    }
    CHECK(a.report.input.points == b.report.input.points);
    CHECK(a.report.error.points_to_mesh_max == b.report.error.points_to_mesh_max);
    CHECK(a.report.rejected == b.report.rejected);
}

PointCloud scan_to_view(std::size_t points = 8000) {
    return support::sample(support::mechanical_part(), {.points = points});
}

} // namespace

TEMPLATE_TEST_CASE("points in the caller's own structs give the bits of a cloud with the same numbers",
                   "[pipeline][point_view]", double, float) {
    const PackedPoints<TestType> packed(scan_to_view(4000));
    const std::vector<std::byte> before = packed.bytes();
    std::vector<ReconstructOptions> ways(4);
    ways[0].depth = 5;
    ways[1].method = Method::basic;
    ways[2].normals = NormalSource::estimate; // moves points, and asks for them as they were
    ways[3].max_error = MaxError{0.01, true};
    for (const ReconstructOptions& options : ways) {
        const Reconstruction viewed = reconstruct(packed.view(), options);
        check_same_result(viewed, reconstruct(packed.copied(), options));
        const PointCloud kept = packed.copied();
        check_same_result(viewed, reconstruct(kept, options));
    }
    CHECK(packed.bytes() == before);
}

TEST_CASE("points that are not finite are skipped where they stand", "[pipeline][point_view]") {
    const PointCloud clean = scan_to_view();
    PointCloud spoilt = clean;
    const double inf = std::numeric_limits<double>::infinity(), nan = inf - inf;
    for (std::size_t i = 0; i < 3000; i += 3) {
        const auto at = static_cast<std::ptrdiff_t>(2 * i + 5);
        spoilt.positions.insert(spoilt.positions.begin() + at, i % 2 ? Vec3(0, nan, 0) : Vec3(-inf, 0, inf));
        spoilt.normals.insert(spoilt.normals.begin() + at, Vec3(nan, 0, 1));
    }
    const Reconstruction whole = reconstruct(clean, {.depth = 5});
    const PointView view = view_of(spoilt);
    for (const Reconstruction& result : {reconstruct(view, {.depth = 5}), reconstruct(spoilt, {.depth = 5}),
                                         reconstruct(PointCloud(spoilt), {.depth = 5})}) {
        check_same_result(result, whole);
        CHECK(result.report.input.dropped_nonfinite == 1000);
        CHECK(result.report.input.first_nonfinite == 5);
        CHECK(result.report.input.bbox.lo == whole.report.input.bbox.lo);
    }
    CHECK(spoilt.size() == clean.size() + 1000);
}

TEST_CASE("levels of a view are those of a cloud", "[pipeline][point_view]") {
    const PointCloud cloud = scan_to_view();
    const auto of_view = reconstruct_levels(view_of(cloud), 4, 5);
    const auto of_cloud = reconstruct_levels(cloud, 4, 5);
    REQUIRE(of_view.size() == 2);
    for (std::size_t i = 0; i < 2; ++i) check_same_result(of_view[i], of_cloud[i]);
}

TEST_CASE("a view that cannot be read is refused before anything is", "[pipeline][point_view]") {
    using Catch::Contains;
    CHECK_THROWS_WITH(reconstruct(PointView()), Contains("holds no point"));
    const PointCloud cloud = scan_to_view();
    PointView view = view_of(cloud);
    view.positions.stride = 0;
    CHECK_THROWS_WITH(reconstruct(view), Contains("positions are 0 bytes apart"));
    view = view_of(cloud);
    view.normals.data = nullptr;
    CHECK_THROWS_WITH(reconstruct_levels(view, 3, 4), Contains("normals are a null pointer"));
    view = view_of(cloud);
    view.normals.count -= 1;
    CHECK_THROWS_AS(reconstruct(view), Error);
}
