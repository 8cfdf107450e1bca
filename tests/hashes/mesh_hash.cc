#include "hashes/mesh_hash.hh"

#include "hsdm/mesh/to_mesh.hh"

#include <bit>

namespace hsdm::test {
namespace {

class Hash {
public:
    void add(std::uint64_t word) {
        value_ = (value_ ^ word) * 0x9e3779b97f4a7c15u;
        value_ ^= value_ >> 32; // what the product moved up reaches the low bits too
    }
    void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
    void add(const Vec3& p) {
        for (const double x : p) add(x);
    }
    template <class T>
    void add(const std::vector<T>& all) {
        add(static_cast<std::uint64_t>(all.size())); // so that no two lists make one
        for (const T& one : all) add(one);
    }
    void add(const std::vector<Index>& all) {
        add(static_cast<std::uint64_t>(all.size()));
        for (const Index i : all) add(static_cast<std::uint64_t>(i));
    }
    std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 0x243f6a8885a308d3u;
};

} // namespace

MeshHash hash_of(const PolyMesh& mesh) {
    const PolygonMesh polygons = to_polygons(mesh);
    Hash geometry, features;
    geometry.add(polygons.positions);
    geometry.add(polygons.corners);
    geometry.add(polygons.first);
    features.add(polygons.normals);
    for (const VertexProperty& property : polygons.properties) {
        for (const char c : property.name) features.add(static_cast<std::uint64_t>(c));
        features.add(property.values);
    }
    for (const auto e : mesh.edges())
        if (mesh.status(e).feature()) features.add(static_cast<std::uint64_t>(e.idx()));
    return {geometry.value(), features.value()};
}

} // namespace hsdm::test
