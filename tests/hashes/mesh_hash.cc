#include "hashes/mesh_hash.hh"

#include "hsdm/core/hash.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/quality/mesh_digest.hh"

#include <span>
#include <type_traits>

namespace hsdm::test {
namespace {

void add(OrderedHash& hash, std::span<const double> all) {
    for (const double x : all) hash.add(x);
}

/// With their number, so that no two lists make one.
template <class T>
void add_list(OrderedHash& hash, const std::vector<T>& all) {
    hash.add(std::uint64_t{all.size()});
    if constexpr (std::is_same_v<T, Vec3>) {
        for (const Vec3& one : all) add(hash, {one.data(), 3});
    } else {
        add(hash, all);
    }
}

} // namespace

MeshHash hash_of(const PolyMesh& mesh) {
    const PolygonMesh polygons = to_polygons(mesh);
    OrderedHash features;
    add_list(features, polygons.normals);
    for (const VertexProperty& property : polygons.properties) {
        for (const char c : property.name) features.add(static_cast<std::uint64_t>(c));
        add_list(features, property.values);
    }
    for (const auto e : mesh.edges())
        if (mesh.status(e).feature()) features.add(static_cast<std::uint64_t>(e.idx()));
    return {mesh_hash(polygons), features.value()};
}

} // namespace hsdm::test
