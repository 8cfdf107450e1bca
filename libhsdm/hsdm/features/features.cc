#include "hsdm/features/features.hh"

#include "hsdm/features/AnisotropicNormalSmootherT.hh"
#include "hsdm/features/FeatureClassifierT.hh"

#include <charconv>

namespace hsdm {

template class FeatureClassifierT<PolyMesh>;
template class AnisotropicNormalSmootherT<PolyMesh>;

FeatureCounts classify_features(PolyMesh& mesh, const FeatureOptions& options) {
    FeatureClassifierT<PolyMesh> classifier(mesh);
    classifier.initialize(options);
    return classifier.classify();
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
