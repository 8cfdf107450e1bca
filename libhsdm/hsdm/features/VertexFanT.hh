#pragma once
// Flat views of any OpenMesh mesh that both modules of phase 3 start from.

#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/features/normal_filter.hh"
#include "hsdm/features/sectors.hh"
#include "hsdm/mesh/corner_count.hh"
#include "hsdm/mesh/facet_normal.hh"

#include <OpenMesh/Core/Utils/vector_traits.hh>

#include <array>
#include <span>
#include <vector>

namespace hsdm {

template <class Vector>
Vec3 to_vec3(const Vector& v) {
    return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

template <class Normal>
Normal to_normal(const Vec3& v) {
    using Number = typename OpenMesh::vector_traits<Normal>::value_type;
    return Normal(static_cast<Number>(v[0]), static_cast<Number>(v[1]), static_cast<Number>(v[2]));
}

/// Calls body(handle) for handles 0 .. count - 1, in parallel; the body tells deleted elements itself.
template <class Handle, class Body>
void for_each_handle(std::size_t count, const Body& body) {
    for_each_index(count, chunks::quick, [&](Index i) { body(Handle(static_cast<int>(i))); });
}

template <class Handle>
std::size_t index_of(Handle handle) {
    return static_cast<std::size_t>(handle.idx());
}

/// Newell's area vector of every facet, zero for deleted ones. O(corners), parallel.
template <class Mesh>
std::vector<Vec3> facet_area_vectors(const Mesh& mesh);

/// The facets across the edges of each facet, as normal_filter.hh wants them. If the status bits are obeyed,
/// feature edges part their facets and a locked facet has no neighbours, so that its normal stays. The mesh
/// must have edge and face status. `among`: empty for all facets, or per facet, 0 for those that need no
/// neighbours. O(corners), parallel.
enum class StatusBits { obey, ignore };
template <class Mesh>
FacetNeighbours facet_neighbours(const Mesh& mesh, StatusBits bits,
                                 const std::vector<unsigned char>& among = {});

/// The facets around one vertex, gathered again and again in the same memory.
template <class Mesh>
class VertexFanT {
public:
    /// The mesh must have edge status: its feature bits are what cuts the fan. Normals are per facet.
    VertexFanT(const Mesh& mesh, const std::vector<Vec3>& facet_normals)
        : mesh_(mesh), facet_normals_(facet_normals) {}

    void gather(OpenMesh::VertexHandle v);

    /// The facets around the vertex gathered last; costs an arc tangent each.
    std::span<const FanFacet> facets();
    int sharp_edges() const { return sharp_edges_; }
    /// The angle by which the line turns here, if exactly two sharp edges meet; else 0.
    double turn() const { return sharp_edges_ == 2 ? angle_between(-sharp_[0], sharp_[1]) : 0; }

private:
    struct Spoke {
        Vec3 direction;
        int facet = -1; ///< between this spoke and the one before; -1 for a gap
        bool sharp = false;
    };

    const Mesh& mesh_;
    const std::vector<Vec3>& facet_normals_;
    std::vector<Spoke> spokes_;
    std::vector<FanFacet> facets_;
    std::array<Vec3, 2> sharp_;
    int sharp_edges_ = 0;
};

/// Writes the one to three normals of every vertex, from facet normals and the sharp edges' feature bits:
/// `hsdm_normals`, `hsdm_normal_count`, and if asked the standard normals (the mean of a vertex's normals).
/// A locked vertex keeps its standard normal. The mesh must have vertex and edge status.
template <class Mesh>
void write_vertex_normals(Mesh& mesh, const std::vector<Vec3>& facet_normals, bool standard_normals);

} // namespace hsdm

#include "hsdm/features/VertexFanT_impl.hh"
