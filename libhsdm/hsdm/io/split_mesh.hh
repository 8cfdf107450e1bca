#pragma once
// A mesh cut along its creases, for renderers (mesh/split_creases.hh), of which a stretch is asked for at a
// time.

#include "hsdm/io/linked_mesh.hh"
#include "hsdm/mesh/triangulate.hh"

#include <functional>

namespace hsdm {

class SplitMesh {
public:
    /// Of `mesh`, vertices first .. last - 1.
    using Visit = std::function<void(const PolygonMesh& mesh, std::size_t first, std::size_t last)>;

    virtual ~SplitMesh() = default;
    virtual std::size_t vertices() const = 0;
    virtual bool has_normals() const = 0;
    /// What vertices are asked for by: each stands for one or more, in their order.
    virtual std::size_t elements() const = 0;
    /// Places of all vertices, each at least once.
    virtual std::span<const Vec3> positions() const = 0;
    /// Shows the vertices of elements begin .. end - 1, with normals and properties; of none what there would
    /// be. From several threads, more than once.
    virtual void show_vertices(std::size_t begin, std::size_t end, const Visit& visit) const = 0;
    virtual std::size_t facets() const = 0;
    /// Appends the triangles of facets begin .. end - 1, over all vertices. From several threads.
    virtual void append_triangles(std::size_t begin, std::size_t end, std::vector<Triangle>& out) const = 0;
};

/// All at once.
class WholeSplitMesh : public SplitMesh {
public:
    explicit WholeSplitMesh(const PolygonMesh& mesh);

    std::size_t vertices() const override { return mesh_.vertex_count(); }
    bool has_normals() const override { return !mesh_.normals.empty(); }
    std::size_t elements() const override { return mesh_.vertex_count(); }
    std::span<const Vec3> positions() const override { return mesh_.positions; }
    void show_vertices(std::size_t begin, std::size_t end, const Visit& visit) const override {
        visit(mesh_, begin, end);
    }
    std::size_t facets() const override { return mesh_.facet_count(); }
    void append_triangles(std::size_t begin, std::size_t end, std::vector<Triangle>& out) const override;

private:
    PolygonMesh mesh_;
};

/// The same vertices and triangles, each stretch with what is round it cut for itself: a number a vertex is
/// all that is held.
class SplitStretches : public SplitMesh {
public:
    /// The mesh must outlive it.
    explicit SplitStretches(const LinkedMesh& mesh);

    std::size_t vertices() const override { return number_.back(); }
    bool has_normals() const override { return mesh_.rows.normals; }
    std::size_t elements() const override { return mesh_.facets.vertex_count(); }
    std::span<const Vec3> positions() const override { return mesh_.facets.positions; }
    void show_vertices(std::size_t begin, std::size_t end, const Visit& visit) const override;
    std::size_t facets() const override { return mesh_.facets.facet_count(); }
    void append_triangles(std::size_t begin, std::size_t end, std::vector<Triangle>& out) const override;

private:
    const LinkedMesh mesh_;
    std::vector<Index> number_; ///< per vertex of the mesh, of its first one; at the end how many there are
};

} // namespace hsdm
