#pragma once
// LAS files, put together by the ASPRS's tables for tests.

#include "io/temp_file.hh"

#include <array>
#include <cstdint>
#include <vector>

namespace hsdm::test {

/// What a point of any format may hold; a format takes what it has.
struct LasPoint {
    std::array<std::int32_t, 3> at{};
    std::uint16_t intensity = 0;
    std::uint8_t classification = 0;
    bool withheld = false;
    std::uint16_t source = 0;
    std::array<std::uint16_t, 3> color{};
};

/// How the file is made up.
struct LasLayout {
    int minor = 2, format = 0;
    std::array<double, 3> scale{0.001, 0.001, 0.001}, offset{0, 0, 0};
    std::vector<std::string> records;   ///< contents of the records of variable length
    std::string between, extra, behind; ///< bytes before the points, in each point, and behind the last
};

std::string las_file(const LasLayout& layout, const std::vector<LasPoint>& points);

} // namespace hsdm::test
