#pragma once
// Small scans as text files.

#include "support/sample.hh"

#include <cstdio>
#include <string>

namespace hsdm::test {

/// `x y z` lines with every digit.
inline std::string xyz(const PointCloud& cloud) {
    std::string text;
    char line[96];
    for (const Vec3& p : cloud.positions) {
        std::snprintf(line, sizeof line, "%.17g %.17g %.17g\n", p[0], p[1], p[2]);
        text += line;
    }
    return text;
}

inline PointCloud sphere_scan(std::size_t points = 4000) {
    return support::sample(support::sphere(1), {.points = points, .normals = false});
}

} // namespace hsdm::test
