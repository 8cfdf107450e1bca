#include "hsdm/pipeline/method.hh"

namespace hsdm {

void note_dropped(const std::string& what, const Occurrences& discarded, const CloudFrame& frame,
                  Report& report) {
    if (discarded.count > 0)
        report.dropped.push_back({what, discarded.count, frame.to_cloud(discarded.first)});
}

void note_loops(const PolygonMesh& mesh, const BoundaryLoops& loops, bool completed, const Vec3& origin,
                const CloudFrame& frame, Report& report) {
    for (std::size_t l = 0; l < loops.size(); ++l) {
        const auto vertices = loops[l];
        const auto at = [&](std::size_t i) { return mesh.positions[vertices[i % vertices.size()]]; };
        Report::Loop loop{frame.to_cloud(at(0) + origin), vertices.size(), 0, completed};
        for (std::size_t i = 0; i < vertices.size(); ++i) loop.length += (at(i + 1) - at(i)).norm();
        report.loops.push_back(loop);
    }
}

} // namespace hsdm
