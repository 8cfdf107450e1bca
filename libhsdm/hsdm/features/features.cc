#include "hsdm/features/features.hh"

#include "hsdm/errors.hh"
#include "hsdm/features/AnisotropicNormalSmootherT.hh"
#include "hsdm/features/FeatureClassifierT.hh"

#include <charconv>

namespace hsdm {

template class FeatureClassifierT<PolyMesh>;
template class AnisotropicNormalSmootherT<PolyMesh>;

namespace {

/// Marks and locks the edges of which something is known; returns those locked here.
std::vector<OpenMesh::EdgeHandle> lock_known_edges(PolyMesh& mesh, const std::vector<EdgeHint>& sides) {
    std::vector<OpenMesh::EdgeHandle> locked;
    if (sides.empty()) return locked;
    std::size_t side = 0;
    for (const auto f : mesh.faces()) side += f.valence();
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

namespace {

void append_point(const Vec3& p, std::string& text) {
    char digits[32]; // the longest double has 24 characters
    for (std::size_t i = 0; i < 3; ++i) {
        if (!text.empty() && text.back() != '\n') text += ' ';
        text.append(digits, std::to_chars(digits, digits + sizeof digits, p[i]).ptr);
    }
}

} // namespace

std::string feature_lines(const PolyMesh& mesh) {
    std::string text;
    for (const auto e : mesh.edges()) {
        if (!mesh.status(e).feature()) continue;
        append_point(mesh.point(e.v0()), text);
        append_point(mesh.point(e.v1()), text);
        text += '\n';
    }
    OpenMesh::VPropHandleT<std::uint8_t> classes;
    if (!mesh.get_property_handle(classes, vertex_class_property)) return text;
    for (const auto v : mesh.vertices()) {
        if (mesh.property(classes, v) != static_cast<std::uint8_t>(VertexClass::corner)) continue;
        text += 'c';
        append_point(mesh.point(v), text);
        text += '\n';
    }
    return text;
}

} // namespace hsdm
