#include "hsdm/features/features.hh"

#include "hsdm/errors.hh"
#include "hsdm/features/AnisotropicNormalSmootherT.hh"
#include "hsdm/features/AnisotropicSmootherT.hh"
#include "hsdm/features/FeatureClassifierT.hh"
#include "hsdm/features/FeatureSubdividerT.hh"

#include <algorithm>
#include <charconv>

namespace hsdm {

template class FeatureClassifierT<PolyMesh>;
template class AnisotropicNormalSmootherT<PolyMesh>;
template class AnisotropicSmootherT<PolyMesh>;
template class FeatureSubdividerT<PolyMesh>;

namespace {

/// Marks and locks the edges of which something is known; returns those locked here.
std::vector<OpenMesh::EdgeHandle> lock_known_edges(PolyMesh& mesh, const std::vector<EdgeHint>& sides) {
    std::vector<OpenMesh::EdgeHandle> locked;
    if (sides.empty()) return locked;
    std::size_t side = 0;
    for (const auto f : mesh.faces()) side += corner_count(mesh, f);
    if (side != sides.size())
        throw Error("hints for " + std::to_string(sides.size()) + " sides of facets, but the mesh has "
                    + std::to_string(side) + "; give those of this mesh");
    side = 0;
    for (std::size_t f = 0; f < mesh.n_faces(); ++f) {
        const auto last = mesh.halfedge_handle(OpenMesh::FaceHandle(static_cast<int>(f)));
        auto h = last;
        do {
            h = mesh.next_halfedge_handle(h);
            const EdgeHint hint = sides[side++];
            const auto e = mesh.edge_handle(h);
            if (hint == EdgeHint::none || mesh.status(e).locked()) continue;
            mesh.status(e).set_feature(hint == EdgeHint::sharp);
            mesh.status(e).set_locked(true);
            locked.push_back(e);
        } while (h != last);
    }
    return locked;
}

} // namespace

FeatureCounts classify_features(PolyMesh& mesh, const FeatureOptions& options, const FeatureHints& hints) {
    FeatureClassifierT<PolyMesh> classifier(mesh);
    classifier.initialize(options);
    const auto locked = lock_known_edges(mesh, hints.sides);
    const FeatureCounts counts = classifier.classify();
    for (const auto e : locked) mesh.status(e).set_locked(false);
    return counts;
}

std::size_t smooth_normals(PolyMesh& mesh, const NormalSmoothingOptions& options) {
    AnisotropicNormalSmootherT<PolyMesh> smoother(mesh);
    smoother.initialize(options);
    return smoother.smooth(options.rounds);
}

VertexSmoothingResult smooth_vertices(PolyMesh& mesh, const VertexSmoothingOptions& options) {
    AnisotropicSmootherT<PolyMesh> smoother(mesh);
    smoother.initialize(options);
    return smoother.smooth();
}

SubdivisionCounts subdivide(PolyMesh& mesh, const SubdivisionOptions& options) {
    FeatureSubdividerT<PolyMesh> subdivider(mesh);
    subdivider.initialize(options);
    return subdivider.divide();
}

namespace {

/// What phase 3 has left on a mesh's vertices.
struct VertexMarks {
    OpenMesh::VPropHandleT<std::uint8_t> classes, counts;
    OpenMesh::VPropHandleT<VertexNormalsT<PolyMesh>> normals;

    bool find(const PolyMesh& mesh) {
        return mesh.get_property_handle(classes, vertex_class_property)
               && mesh.get_property_handle(counts, normal_count_property)
               && mesh.get_property_handle(normals, vertex_normals_property);
    }
};

/// Which of a vertex's normals a facet's is nearest to.
std::size_t nearest_normal(const PolyMesh& mesh, const VertexMarks& marks, OpenMesh::VertexHandle v,
                           OpenMesh::FaceHandle f) {
    const auto& normals = mesh.property(marks.normals, v);
    const std::size_t count = std::min<std::size_t>(mesh.property(marks.counts, v), normals.size());
    std::size_t nearest = 0;
    for (std::size_t k = 1; k < count; ++k)
        if ((normals[k] | mesh.normal(f)) > (normals[nearest] | mesh.normal(f))) nearest = k;
    return nearest;
}

} // namespace

void mark_edges_by_normals(PolyMesh& mesh) {
    VertexMarks marks;
    const auto is_marked = [&](const auto& e) { return mesh.status(e).feature(); };
    if (!marks.find(mesh) || std::any_of(mesh.edges_begin(), mesh.edges_end(), is_marked)) return;
    for (const auto e : mesh.edges()) {
        const auto ends = {e.v0(), e.v1()};
        const auto is_smooth = [&](const auto& v) { return mesh.property(marks.classes, v) == 0; };
        if (e.is_boundary() || std::any_of(ends.begin(), ends.end(), is_smooth)) continue;
        const auto a = e.h0().face(), b = e.h1().face();
        const auto parts = [&](const auto& v) {
            return nearest_normal(mesh, marks, v, a) != nearest_normal(mesh, marks, v, b);
        };
        if (std::any_of(ends.begin(), ends.end(), parts)) mesh.status(e).set_feature(true);
    }
}

namespace {

void append_point(const Vec3& p, std::string& text) {
    char digits[32]; // the longest double has 24 characters
    for (std::size_t i = 0; i < 3; ++i) {
        if (!text.empty() && text.back() != '\n') text += ' ';
        text.append(digits, std::to_chars(digits, digits + sizeof digits, p[i]).ptr);
    }
}

} // namespace

std::string feature_lines(const PolyMesh& mesh, const Vec3& shift) {
    std::string text;
    for (const auto e : mesh.edges()) {
        if (!mesh.status(e).feature()) continue;
        append_point(mesh.point(e.v0()) - shift, text);
        append_point(mesh.point(e.v1()) - shift, text);
        text += '\n';
    }
    OpenMesh::VPropHandleT<std::uint8_t> classes;
    if (!mesh.get_property_handle(classes, vertex_class_property)) return text;
    for (const auto v : mesh.vertices()) {
        if (mesh.property(classes, v) != static_cast<std::uint8_t>(VertexClass::corner)) continue;
        text += 'c';
        append_point(mesh.point(v) - shift, text);
        text += '\n';
    }
    return text;
}

} // namespace hsdm
