#include "support/edges.hh"

#include "hsdm/mesh/facet_normal.hh"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hsdm::support {

EdgedSolid edged_prism(int sides) {
    const double turn = 2 * std::numbers::pi / sides, radius = 0.5 / std::cos(turn / 2);
    const auto corner = [&](int i, double z) {
        const double at = (i + 0.5) * turn;
        return Vec3(radius * std::cos(at), radius * std::sin(at), z);
    };
    EdgedSolid result{prism(sides, 1, 1), std::tan(turn / 2) * sides * 1.5, {}, {}};
    for (int i = 0; i < sides; ++i) {
        result.blunt.push_back({corner(i, -0.5), corner(i, 0.5)});
        for (const double z : {-0.5, 0.5}) result.all.push_back({corner(i, z), corner(i + 1, z)});
    }
    result.all.insert(result.all.end(), result.blunt.begin(), result.blunt.end());
    return result;
}

EdgedSolid chamfered_bar(double width, double turn) {
    const double c = std::cos(turn), s = std::sin(turn);
    const double across = c + s - 2 * width * c * s; // between two opposite chamfers
    EdgedSolid result{
        box({1, 1, 1}) & box({2, across, across}).placed(turned(Vec3(1, 0, 0), turn)), 6, {}, {}};
    // Round the cross-section, two corners per quarter turn: where a chamfer meets the side before it and the
    // one after.
    const auto corner = [&](int i, double x) {
        const double y = i % 2 == 0 ? 0.5 : 0.5 - width * s, z = i % 2 == 0 ? 0.5 - width * c : 0.5;
        const Vec3 first(x, y, z);
        return turned(Vec3(1, 0, 0), i / 2 * std::numbers::pi / 2).rotate(first);
    };
    for (int i = 0; i < 8; ++i) {
        result.blunt.push_back({corner(i, -0.5), corner(i, 0.5)});
        for (const double x : {-0.5, 0.5}) result.all.push_back({corner(i, x), corner(i + 1, x)});
    }
    result.all.insert(result.all.end(), result.blunt.begin(), result.blunt.end());
    return result;
}

EdgedSolid filleted_bar(double radius) {
    const double in = 0.5 - radius, on = 0.5 - (1 - std::sqrt(0.5)) * radius;
    EdgedSolid result{box({1, 2 * in, 1}) | box({1, 1, 2 * in}), 6, {}, {}};
    for (int i = 0; i < 4; ++i) {
        const Pose quarter = turned(Vec3(1, 0, 0), i * std::numbers::pi / 2);
        Pose axis = turned(Vec3(0, 1, 0), std::numbers::pi / 2);
        axis.shift = quarter.rotate(Vec3(0, in, in));
        result.solid = result.solid | cylinder(radius, 1).placed(axis);
        result.blunt.push_back({quarter.rotate(Vec3(-0.4, on, on)), quarter.rotate(Vec3(0.4, on, on))});
    }
    result.all = result.blunt;
    return result;
}

EdgedSolid placed(const EdgedSolid& one, const Pose& pose) {
    EdgedSolid result{one.solid.placed(pose), one.area, one.blunt, one.all};
    for (Lines* lines : {&result.blunt, &result.all})
        for (Segment& s : *lines) s = {pose.to_world(s.from), pose.to_world(s.to)};
    return result;
}

Lines folds(const PolyMesh& mesh, double angle) {
    Lines found;
    for (const auto e : mesh.edges()) {
        if (e.is_boundary()) continue;
        const auto h = e.h0();
        if (angle_between(mesh.calc_face_normal(h.face()), mesh.calc_face_normal(h.opp().face())) > angle)
            found.push_back({mesh.point(h.from()), mesh.point(h.to())});
    }
    return found;
}

Lines marked(const PolyMesh& mesh) {
    Lines found;
    for (const auto e : mesh.edges())
        if (mesh.status(e).feature()) found.push_back({mesh.point(e.v0()), mesh.point(e.v1())});
    return found;
}

double share_near(const Lines& these, const Lines& those, double tolerance) {
    double near = 0, all = 0;
    for (const Segment& s : these) {
        constexpr int pieces = 64;
        const double length = (s.to - s.from).norm();
        for (int i = 0; i < pieces; ++i) {
            const Vec3 p = s.from + (s.to - s.from) * ((i + 0.5) / pieces);
            all += length;
            if (std::ranges::any_of(those, [&](const Segment& t) { return distance(p, t) <= tolerance; }))
                near += length;
        }
    }
    return all > 0 ? near / all : 1;
}

} // namespace hsdm::support
