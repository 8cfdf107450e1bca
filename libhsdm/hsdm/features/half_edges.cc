#include "hsdm/features/half_edges.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/mesh/facet_normal.hh"

#include <array>

namespace hsdm {
namespace {

CurveRole role_of(const HalfEdges& mesh, Index v, double corner_angle) {
    std::size_t count = 0;
    std::array<Vec3, 2> along;
    mesh.for_each_spoke(v, [&](Index h) {
        if (!mesh.is_curve(h / 2)) return;
        if (count < 2) along[count] = mesh.positions[mesh.to[h]] - mesh.positions[v];
        ++count;
    });
    const Pin pin = mesh.pins[v];
    if (pin == Pin::always || (pin == Pin::unless_on_curve && count == 0) || count > 2)
        return CurveRole::corner;
    if (count == 2)
        return angle_between(-along[0], along[1]) > corner_angle ? CurveRole::corner : CurveRole::crease;
    return count == 1 ? CurveRole::dart : CurveRole::smooth;
}

} // namespace

std::vector<CurveRole> curve_roles(const HalfEdges& mesh, double corner_angle) {
    std::vector<CurveRole> roles(mesh.vertex_count(), CurveRole::smooth);
    for_each_index(roles.size(), chunks::usual, [&](Index v) {
        if (mesh.out[v] != no_index) roles[v] = role_of(mesh, v, corner_angle);
    });
    return roles;
}

} // namespace hsdm
