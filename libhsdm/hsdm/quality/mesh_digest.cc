#include "hsdm/quality/mesh_digest.hh"

#include "hsdm/core/hash.hh"

#include <cstdio>

namespace hsdm {
namespace {

/// With their number, so that no two lists make one.
void add(OrderedHash& hash, const std::vector<Index>& all) {
    hash.add(std::uint64_t{all.size()});
    for (const Index i : all) hash.add(std::uint64_t{i});
}

} // namespace

std::uint64_t mesh_hash(const PolygonMesh& mesh) {
    OrderedHash hash;
    hash.add(std::uint64_t{mesh.positions.size()});
    for (const Vec3& p : mesh.positions)
        for (const double x : p) hash.add(x);
    add(hash, mesh.corners);
    add(hash, mesh.first);
    return hash.value();
}

std::string mesh_digest(const PolygonMesh& mesh) {
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(mesh_hash(mesh)));
    return digits;
}

} // namespace hsdm
