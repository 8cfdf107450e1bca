#include "hsdm/stages/decimate_mesh.hh"

#include "hsdm/core/check_option.hh"
#include "hsdm/features/ModFeatureT.hh"
#include "hsdm/mesh/triangle_mesh.hh"

#include <OpenMesh/Core/Geometry/QuadricT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModHausdorffT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>

#include <cmath>

namespace hsdm {
namespace {

namespace Decimater = OpenMesh::Decimater;

/// The priority of a collapse: the squared distances, weighted by area, of the vertex that stays from the
/// planes of what was round both. OpenMesh's ModQuadricT knows no sharp edges and no boundary, which have
/// none of their own in a plane; here a plane stands on each.
template <class MeshT>
class CurveQuadricT : public Decimater::ModBaseT<MeshT> {
public:
    DECIMATING_MODULE(CurveQuadricT, MeshT, CurveQuadric)

    explicit CurveQuadricT(MeshT& mesh) : Base(mesh, false), mesh_(mesh) {}

    void initialize() override {
        quadrics_.assign(mesh_.n_vertices(), OpenMesh::Geometry::Quadricd());
        for (const auto f : mesh_.faces()) add_facet(f);
        for (const auto e : mesh_.edges())
            if (e.is_boundary() || mesh_.status(e).feature()) add_curve(e);
    }

    float collapse_priority(const CollapseInfo& collapse) override {
        auto sum = quadric(collapse.v0);
        sum += quadric(collapse.v1);
        return static_cast<float>(std::max(0.0, sum(collapse.p1)));
    }

    void postprocess_collapse(const CollapseInfo& collapse) override {
        quadric(collapse.v1) += quadric(collapse.v0);
    }

private:
    OpenMesh::Geometry::Quadricd& quadric(OpenMesh::VertexHandle v) { return quadrics_[index_of(v)]; }

    void add(OpenMesh::VertexHandle v, const Vec3& normal, double weight) {
        OpenMesh::Geometry::Quadricd plane(normal, mesh_.point(v));
        plane *= weight;
        quadric(v) += plane;
    }

    void add_facet(OpenMesh::SmartFaceHandle f) {
        const Vec3 area = mesh_.calc_face_normal(f) * mesh_.calc_sector_area(f.halfedge());
        for (const auto v : f.vertices()) add(v, unit_or_zero(area), area.norm());
    }

    /// For each facet at the edge the plane on it that is square to the facet; as heavy as a square on it.
    void add_curve(OpenMesh::SmartEdgeHandle e) {
        const Vec3 along = mesh_.calc_edge_vector(e);
        for (const auto h : {e.h0(), e.h1()}) {
            if (h.is_boundary()) continue;
            const Vec3 normal = unit_or_zero(along % mesh_.calc_face_normal(h.face()));
            for (const auto v : {h.from(), h.to()}) add(v, normal, along.sqrnorm());
        }
    }

    MeshT& mesh_;
    std::vector<OpenMesh::Geometry::Quadricd> quadrics_;
};

/// The mesh moved and scaled into a cube about the origin while it lives, for what is computed of coordinates
/// to have all its digits; the vertices that are left then are where they were.
class InUnitCube {
public:
    explicit InUnitCube(PolyMesh& mesh) : mesh_(mesh) {
        Box box;
        for (const auto v : mesh.vertices()) box.add(mesh.point(v));
        positions_.assign(mesh.points(), mesh.points() + mesh.n_vertices());
        const double largest = box.diagonal();
        if (largest > 0) scale_ = 1 / largest;
        for (const auto v : mesh.vertices())
            mesh.set_point(v, (mesh.point(v) - (box.lo + box.hi) * 0.5) * scale_);
    }
    ~InUnitCube() {
        for (const auto v : mesh_.vertices()) mesh_.set_point(v, positions_[index_of(v)]);
    }
    InUnitCube(const InUnitCube&) = delete;
    InUnitCube& operator=(const InUnitCube&) = delete;

    double scale() const { return scale_; }

private:
    PolyMesh& mesh_;
    std::vector<Vec3> positions_;
    double scale_ = 1;
};

void collapse_edges_of(PolyMesh& mesh, const DecimationOptions& options) {
    const InUnitCube cube(mesh);
    Decimater::DecimaterT<PolyMesh> decimater(mesh);
    CurveQuadricT<PolyMesh>::Handle quadrics;
    Decimater::ModNormalFlippingT<PolyMesh>::Handle flipping;
    ModFeatureT<PolyMesh>::Handle features;
    decimater.add(quadrics);
    decimater.add(flipping);
    decimater.add(features);
    decimater.module(features).set_options(
        {.crease_angle = options.crease_angle, .corner_angle = options.corner_angle});
    Decimater::ModHausdorffT<PolyMesh>::Handle distance;
    if (std::isfinite(options.max_error)) {
        decimater.add(distance);
        decimater.module(distance).set_tolerance(options.max_error * cube.scale());
    }
    decimater.initialize();
    decimater.decimate_to_faces(0, options.facets);
}

} // namespace

DecimationCounts decimate_mesh(PolyMesh& mesh, const DecimationOptions& options) {
    check_option(options.max_error > 0, "max_error", options.max_error, "be above 0");
    validate({.crease_angle = options.crease_angle, .corner_angle = options.corner_angle});
    mesh = triangle_mesh(mesh);
    DecimationCounts counts;
    counts.before = mesh.n_faces();
    collapse_edges_of(mesh, options);
    mesh.garbage_collection();
    mesh.update_face_normals();
    counts.after = mesh.n_faces();
    return counts;
}

} // namespace hsdm
