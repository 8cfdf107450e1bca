#include "hsdm/pipeline/method.hh"

namespace hsdm {

void note_dropped(const std::string& what, const Occurrences& discarded, const CloudFrame& frame,
                  Report& report) {
    if (discarded.count > 0)
        report.dropped.push_back({what, discarded.count, frame.to_cloud(discarded.first)});
}

void note_repairs(const FillHolesCounts& holes, const ManifoldCounts& manifold, Report& report) {
    report.rejected["holes_closed"] = holes.closed;
    report.rejected["holes_refused"] = holes.refused;
    report.rejected["facets_degenerate"] = manifold.degenerate;
    report.rejected["facets_cancelled"] = manifold.cancelled;
    report.rejected["facets_duplicate"] = manifold.duplicates;
    report.rejected["edges_opened"] = manifold.opened_edges;
    report.rejected["vertices_split"] = manifold.split_vertices;
}

void note_loops(const PolygonMesh& mesh, const BoundaryLoops& loops, bool completed, const Vec3& origin,
                const CloudFrame& frame, Report& report) {
    for (std::size_t l = 0; l < loops.size(); ++l)
        report.loops.push_back({frame.to_cloud(mesh.positions[loops[l][0]] + origin), loops[l].size(),
                                length_of(mesh, loops[l]), completed});
}

} // namespace hsdm
