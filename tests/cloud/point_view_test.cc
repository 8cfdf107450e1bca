#include "hsdm/cloud/point_attributes.hh"
#include "hsdm/cloud/strided.hh"
#include "hsdm/errors.hh"

#include <catch2/catch.hpp>

using namespace hsdm;

namespace {

struct Hit {
    float x, y, z;
    std::uint8_t rgb[3];
    std::uint16_t intensity;
};

const std::vector<Hit> hits = {{1, 2, 3, {0, 100, 255}, 65535}, {4, 5, 6, {7, 8, 9}, 3}};

PointView view_of_hits() {
    PointView view;
    view.positions = {&hits[0].x, hits.size(), sizeof(Hit)};
    view.colors = {&hits[0].rgb[0], hits.size(), sizeof(Hit)};
    view.color_channels = 3;
    view.scalars = {{"intensity", {&hits[0].intensity, hits.size(), sizeof(Hit)}, false}};
    return view;
}

std::string refusal(const PointView& view) {
    try {
        check_view(view);
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

/// Of a view in which one thing is wrong.
template <class Spoil>
std::string refusal_after(const Spoil& spoil) {
    PointView view = view_of_hits();
    view.normals = view.positions;
    REQUIRE(refusal(view).empty());
    spoil(view);
    return refusal(view);
}

} // namespace

TEST_CASE("an array of structs is read where it is, whatever its numbers are", "[point_view]") {
    const PointView view = view_of_hits();
    REQUIRE(view.size() == 2);
    CHECK_FALSE(view.has_normals());
    CHECK(vec3_at(view.positions, 1) == Vec3(4, 5, 6));
    const auto attributes = attributes_of(view);
    REQUIRE(attributes.size() == 5);
    CHECK(attributes[1](0) == 100);
    CHECK(attributes[2](1) == 9);
    CHECK(attributes[3].name == "alpha");
    CHECK(attributes[3](1) == 255);
    CHECK(attributes[4](0) == 65535);
}

TEST_CASE("colours in fractions become the nearest bytes", "[point_view]") {
    const float none = std::numeric_limits<float>::quiet_NaN();
    const std::vector<float> colors = {0, 0.5f, 1, none, 2, -1, 0.2f, 0.999f};
    PointView view;
    view.colors = {colors.data(), 2, 4 * sizeof(float)};
    std::vector<double> bytes;
    for (Index i = 0; i < 2; ++i)
        for (std::size_t k = 0; k < 4; ++k) bytes.push_back(channel_at(view.colors, i, k));
    CHECK(bytes == std::vector<double>{0, 128, 255, 0, 255, 0, 51, 255});
}

TEST_CASE("a view of a cloud has all of it", "[point_view]") {
    PointCloud cloud;
    cloud.positions = {Vec3(1, 2, 3), Vec3(0.1, -5e-324, 1e300)};
    cloud.normals = {Vec3(0, 0, 1), Vec3(0, 1, 0)};
    cloud.colors = {{1, 2, 3, 4}, {5, 6, 7, 8}};
    cloud.scalars = {{"part", {7, 8}, true}};
    cloud.sensor = Vec3(9, 9, 9);
    const PointView view = view_of(cloud);
    CHECK(refusal(view).empty());
    for (Index i = 0; i < 2; ++i) {
        CHECK(vec3_at(view.positions, i) == cloud.positions[i]);
        CHECK(vec3_at(view.normals, i) == cloud.normals[i]);
        for (std::size_t k = 0; k < 4; ++k) CHECK(channel_at(view.colors, i, k) == cloud.colors[i][k]);
        CHECK(number_at(view.scalars[0].values, i, 0) == cloud.scalars[0].values[i]);
    }
    CHECK(view.scalars[0].is_label);
    CHECK(view.sensor == cloud.sensor);
    CHECK(refusal(view_of(PointCloud())).empty());
}

TEST_CASE("points that are not finite are counted, and the box is that of the others", "[point_view]") {
    std::vector<Vec3> positions(70000, Vec3(1, 2, 3));
    positions[69999] = Vec3(-4, 5, 6);
    CHECK(find_nonfinite(rows_of(positions)).count == 0);
    positions[40000][1] = std::numeric_limits<double>::infinity();
    positions[69998][0] = std::numeric_limits<double>::quiet_NaN();
    const NonfiniteRows found = find_nonfinite(rows_of(positions));
    CHECK(found.count == 2);
    CHECK(found.first == 40000);
    const Box box = finite_bounds(rows_of(positions));
    CHECK(box.lo == Vec3(-4, 2, 3));
    CHECK(box.hi == Vec3(1, 5, 6));
}

TEST_CASE("arrays that cannot be read are refused by name", "[point_view]") {
    using Catch::Contains;
    CHECK_THAT(refusal_after([](PointView& v) { v.normals.count = 1; }),
               Contains("1 normals for 2 points; give one for each"));
    CHECK_THAT(refusal_after([](PointView& v) { v.scalars[0].values.count = 0; }),
               Contains("0 values of intensity for 2 points"));
    CHECK_THAT(refusal_after([](PointView& v) { v.colors.count = 3; }), Contains("3 colours for 2 points"));
    CHECK_THAT(refusal_after([](PointView& v) { v.positions.data = nullptr; }),
               Contains("positions are a null pointer"));
    CHECK_THAT(refusal_after([](PointView& v) { v.scalars[0].values.data = nullptr; }),
               Contains("values of intensity are a null pointer"));
    CHECK_THAT(refusal_after([](PointView& v) { v.positions.stride = 0; }),
               Contains("positions are 0 bytes apart, and each takes 12; give the stride in bytes"));
    CHECK_THAT(refusal_after([](PointView& v) { v.normals.stride = 3; }),
               Contains("normals are 3 bytes apart, and each takes 12"));
    CHECK_THAT(refusal_after([](PointView& v) { v.color_channels = 2; }), Contains("2 channels"));
    CHECK_THAT(refusal_after([](PointView& v) { v.positions.type = NumberType::int32; }),
               Contains("positions must be float or double"));
    CHECK_THAT(refusal_after([](PointView& v) { v.colors.type = NumberType::uint16; }),
               Contains("colours must be bytes"));
}
