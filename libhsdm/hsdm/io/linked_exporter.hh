#pragma once
// What OpenMesh's writers ask of a half-edge mesh, answered from a mesh in flat arrays: the half-edges are
// those that to_mesh() would make.

#include "hsdm/io/linked_mesh.hh"
#include "hsdm/mesh_types.hh"

#include <OpenMesh/Core/IO/exporter/ExporterT.hh>

#include <bit>

namespace hsdm {

/// Edges in the order of their first sides, which are marked, a fifth of a byte a side: side to edge and
/// back without an array of either.
class EdgeNumbers {
public:
    explicit EdgeNumbers(const std::vector<Index>& twins);

    Index edges() const { return before_.back(); }
    /// Twins have 2e and 2e + 1; what lies opposite to a side without twin, too.
    Index half_edge(Index side) const {
        const Index twin = twins_[side];
        return twin == no_index || side < twin ? 2 * edge_of_first(side) : 2 * edge_of_first(twin) + 1;
    }
    /// Quick where edges are asked for in ascending order; from one thread.
    Index first_side(Index edge) const;

private:
    static constexpr Index bits = 64;
    Index edge_of_first(Index side) const {
        const std::uint64_t below = marks_[side / bits] & ((std::uint64_t{1} << (side % bits)) - 1);
        return before_[side / bits] + static_cast<Index>(std::popcount(below));
    }

    const std::vector<Index>& twins_;
    std::vector<std::uint64_t> marks_; ///< whether a side is its edge's first
    std::vector<Index> before_;        ///< per 64 sides the edges before them; at the end all
    mutable Index last_ = 0;           ///< where the last edge was found
};

/// Rows of vertices that are asked for in ascending order: made by all threads, some thousands at a time, as
/// often as a format asks for one of their numbers.
class RowsInOrder {
public:
    RowsInOrder(const VertexRows& rows, std::size_t count) : rows_(rows), count_(count) {}

    Vec3 normal(std::size_t vertex) { return rows_.normals ? at(vertex).first : Vec3(0, 0, 0); }
    /// Of all columns.
    const double* values(std::size_t vertex) { return at(vertex).second; }

private:
    std::pair<Vec3, const double*> at(std::size_t vertex);

    const VertexRows& rows_;
    const std::size_t count_;
    std::size_t begin_ = 0, end_ = 0; ///< those that are there
    std::vector<std::vector<Vec3>> normals_;
    std::vector<std::vector<double>> values_;
};

/// Its kernel has the properties of the vertices, and no vertex.
class LinkedExporter : public OpenMesh::IO::ExporterT<PolyMesh> {
public:
    using VertexHandle = OpenMesh::VertexHandle;
    using FaceHandle = OpenMesh::FaceHandle;
    using EdgeHandle = OpenMesh::EdgeHandle;
    using HalfedgeHandle = OpenMesh::HalfedgeHandle;
    using Status = OpenMesh::Attributes::StatusInfo;

    /// The mesh must outlive it.
    explicit LinkedExporter(const LinkedMesh& mesh);

    OpenMesh::Vec3f point(VertexHandle v) const override { return OpenMesh::Vec3f(pointd(v)); }
    OpenMesh::Vec3d pointd(VertexHandle v) const override;
    OpenMesh::Vec3f normal(VertexHandle v) const override { return OpenMesh::Vec3f(normald(v)); }
    OpenMesh::Vec3d normald(VertexHandle v) const override;
    Status status(VertexHandle v) const override;
    Status status(EdgeHandle e) const override;
    Status status(HalfedgeHandle) const override { return {}; }
    Status status(FaceHandle) const override { return {}; }
    int get_halfedge_id(VertexHandle v) override;
    int get_halfedge_id(FaceHandle f) override;
    int get_next_halfedge_id(HalfedgeHandle h) override;
    int get_to_vertex_id(HalfedgeHandle h) override;
    int get_face_id(HalfedgeHandle h) override;
    const OpenMesh::BaseKernel* kernel() override { return &properties_; }
    std::size_t n_vertices() const override { return mesh_.facets.vertex_count(); }
    std::size_t n_faces() const override { return mesh_.facets.facet_count(); }
    std::size_t n_edges() const override { return numbers_.edges(); }

private:
    void add_properties();
    void add_normals(std::size_t first_column);
    struct Side {
        Index side;      ///< the half-edge's own, or no_index outside
        Index first = 0; ///< of its edge
    };
    Side side_of(HalfedgeHandle h) const;
    /// What lies opposite to a side without twin.
    int outside_of(Index side) const { return static_cast<int>(numbers_.half_edge(side) ^ 1u); }

    const LinkedMesh mesh_;
    const EdgeNumbers numbers_;
    mutable RowsInOrder rows_;
    std::size_t class_column_; ///< as many as there are, where there are no classes
    PolyMesh properties_;
};

} // namespace hsdm
