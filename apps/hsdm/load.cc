#include "load.hh"

#include "activity.hh"
#include "summary.hh"

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/read_mesh.hh"
#include "hsdm/quality/mesh_digest.hh"
#include "hsdm/quality/topology.hh"

#include <cmath>
#include <limits>
#include <ostream>

namespace hsdm::command {
namespace {

struct Measured {
    Topology topology; ///< signed_volume in `unit`, the rest in the mesh's own
    FacetShape shape;
    double unit = 1; ///< in which products of the mesh's lengths are numbers

    /// NaN where no double holds it.
    double volume() const {
        const double own = topology.signed_volume * unit * unit * unit;
        return std::isnormal(own) || topology.signed_volume == 0 ? own
                                                                 : std::numeric_limits<double>::quiet_NaN();
    }
};

Measured measure(const PolygonMesh& mesh) {
    Measured m;
    m.unit = CloudFrame(bounds_of(mesh.positions)).unit();
    if (m.unit == 1) {
        m.topology = measure_topology(mesh);
        m.shape = measure_shape(mesh);
        return m;
    }
    PolygonMesh scaled = mesh;
    for (Vec3& p : scaled.positions) p /= m.unit;
    m.topology = measure_topology(scaled);
    m.shape = measure_shape(scaled);
    m.shape.edge_length_mean *= m.unit;
    return m;
}

} // namespace

Loaded load(const std::string& path) {
    set_activity(path.c_str(), "read");
    MeshOrPoints file = read_mesh_or_points(path);
    Loaded loaded;
    loaded.mesh = std::move(file.mesh);
    if (loaded.is_mesh()) return loaded;
    loaded.columns = std::move(file.points.columns);
    loaded.withheld = file.points.withheld;
    loaded.cloud = std::move(file.points.cloud);
    loaded.dropped = drop_nonfinite(loaded.cloud);
    loaded.dropped.nonfinite += file.points.nonfinite;
    if (loaded.cloud.size() == 0) throw Error(path, "no point with finite coordinates; nothing to look at");
    loaded.mesh.positions = loaded.cloud.positions;
    return loaded;
}

void fill_topology(JsonText& json, const PolygonMesh& mesh) {
    json.begin_object();
    const Measured measured = measure(mesh);
    const Topology& t = measured.topology;
    const FacetShape& shape = measured.shape;
    json.member("vertices", t.vertices);
    json.member("edges", t.edges);
    json.member("faces", t.faces);
    json.member("triangles", t.triangles);
    json.member("quads", t.quads);
    json.member("larger", t.larger);
    json.member("components", t.components);
    json.member("boundary_loops", t.boundary_loops);
    json.member("boundary_edges", t.boundary_edges);
    json.member("euler", t.euler);
    json.member("genus", t.genus());
    json.member("closed", t.closed());
    json.member("manifold", t.manifold());
    json.member("isolated_vertices", t.isolated_vertices);
    json.member("nonmanifold_edges", t.nonmanifold_edges);
    json.member("nonmanifold_vertices", t.nonmanifold_vertices);
    json.member("misoriented_edges", t.misoriented_edges);
    json.member("degenerate_facets", t.degenerate_facets);
    json.member("duplicate_facets", t.duplicate_facets);
    json.member("signed_volume", measured.volume());
    json.member("quad_share", shape.quad_share);
    json.member("scaled_jacobian_median", shape.scaled_jacobian_median);
    json.member("scaled_jacobian_min", shape.scaled_jacobian_min);
    json.member("edge_length_mean", shape.edge_length_mean);
    json.member("digest", mesh_digest(mesh));
    json.end();
}

void print_dropped(std::ostream& out, const Loaded& loaded) {
    const auto print = [&out](std::size_t count, const char* what) {
        if (count > 0)
            out << "dropped   " << grouped(count) << (count == 1 ? " point " : " points ") << what << '\n';
    };
    print(loaded.dropped.nonfinite, "without finite coordinates");
    print(loaded.withheld, "that the file marks as withheld");
}

void print_topology(std::ostream& out, const PolygonMesh& mesh) {
    const Measured measured = measure(mesh);
    const Topology& t = measured.topology;
    const FacetShape& shape = measured.shape;
    Report::Mesh counts;
    counts.components = t.components;
    counts.boundary_loops = t.boundary_loops;
    counts.boundary_edges = t.boundary_edges;
    counts.genus = t.genus();
    counts.closed = t.closed();
    out << "mesh      " << grouped(t.vertices) << " vertices, " << grouped(t.edges) << " edges, "
        << grouped(t.faces) << " faces (" << grouped(t.quads) << " quads, " << grouped(t.triangles)
        << " triangles, " << grouped(t.larger) << " larger)\n"
        << "topology  " << topology_words(counts) << ", Euler characteristic " << t.euler << '\n'
        << "manifold  " << (t.manifold() && t.misoriented_edges == 0 ? "yes, consistently oriented" : "NO")
        << ": " << t.nonmanifold_edges << " non-manifold edges, " << t.nonmanifold_vertices
        << " non-manifold vertices, " << t.misoriented_edges << " edges between opposite facets\n"
        << "faults    " << t.degenerate_facets << " degenerate, " << t.duplicate_facets
        << " duplicate facets, " << t.isolated_vertices << " isolated vertices\n"
        << "shape     quads " << 100 * shape.quad_share << " %, scaled Jacobian of quads: median "
        << shape.scaled_jacobian_median << ", least " << shape.scaled_jacobian_min << "; mean edge "
        << shape.edge_length_mean << '\n';
    if (!t.closed()) return;
    out << "volume    ";
    if (const double volume = measured.volume(); std::isfinite(volume))
        out << volume;
    else
        out << "no number holds it";
    out << (t.signed_volume > 0 ? " (outward)" : " (INWARD)") << '\n';
}

} // namespace hsdm::command
