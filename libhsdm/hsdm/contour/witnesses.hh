#pragma once
// What measured points say of facets, and of rings of edges that may be cut. Completed points (those without
// a source) are guesses, by what the facets did not say: they are not asked.

#include "hsdm/octree/octree.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

class Witnesses {
public:
    /// All must outlive it; `voxel` is per origin of the mesh's vertices. Asked of the mesh as it is then.
    Witnesses(const Octree& octree, const OctreeLevel& level, std::span<const Index> voxel,
              const PolygonMesh& mesh)
        : octree_(octree), level_(level), voxel_(voxel), mesh_(mesh) {}

    /// Do at least two of the points nearest to a facet, eight for each side of a bar, face its way and lie
    /// in its plane?
    bool speak_for(Index facet) const;

    /// Do points say that a ring of vertices is none of the part's? Some face along its axis, within it, as
    /// the two sides of a gap where the facets beside the ring face away from its axis, and else of a wall;
    /// and the stretch of the axis that they stand in holds no point of a bore or rod, though some should lie
    /// there: a tunnel passes a wall like that, and a bridge a gap. At the mouth of a bore all face one way,
    /// round the foot of a post on a wall they are those of the wall, and gaps beyond it are none of the
    /// ring.
    bool deny(std::span<const Index> ring, std::span<const Index> beside) const;

    /// Do points on all sides of a ring of vertices face its axis, or all face away from it? So they do in a
    /// bore and round a rod. A web or tunnel that is none lacks the points of one side at least, or they are
    /// those of the two sides of one wall or gap, and face two opposite ways.
    bool surround(std::span<const Index> ring) const;

    /// Do points lack on the two discs that would close the mesh if it were cut along a ring, as many as
    /// should lie there? They would be parts of sheets that stand across it: of those that face each other
    /// across a gap where the facets beside the ring face away from its axis, as round a rod, and else of
    /// those of a wall, which face apart. Not where points were completed: there, none are missing.
    bool are_missing_across(std::span<const Index> ring, std::span<const Index> beside) const;

    /// Do the vertices of a ring lie nearer to its axis than points around to each other?
    bool is_narrow(std::span<const Index> ring) const;

    /// Spacing of the points in a vertex's voxel, as if they lay on a plane through it.
    double spacing_at(Index vertex) const;

private:
    class Tube; // round a ring of vertices

    /// Do facets face away from a tube's axis, as round a rod, rather than face it?
    bool face_away(const Tube& tube, std::span<const Index> facets) const;

    double spacing(std::size_t points, std::size_t voxels) const;
    Index voxel_of(Index vertex) const { return voxel_[mesh_.origin[vertex]]; }
    /// The voxels of the ring's vertices and those round them, each once.
    std::vector<Index> voxels_at(std::span<const Index> ring) const;
    /// Calls f for each measured point of the voxels.
    template <class F>
    void for_points(std::span<const Index> voxels, F&& f) const {
        for (const Index v : voxels)
            for (Index p = level_.first_point[v]; p < level_.first_point[v + 1]; ++p)
                if (!octree_.is_completed(p)) f(p);
    }
    /// A point of a sheet across a tube: does it face as the first of two along the axis should?
    struct Across {
        Vec3 at;
        bool is_first;
    };
    /// Those of the voxels. `facing`: of two sheets that face each other, rather than apart.
    std::vector<Across> sheets_across(const Tube& tube, std::span<const Index> voxels, bool facing) const;
    /// Do two of them stand across a tube at `place`, within `beside` of it, first and last?
    static bool has_sheets(const Tube& tube, std::span<const Across> across, const Vec3& place,
                           double beside);
    /// Are there completed points, where no scanner saw any?
    bool has_completed(std::span<const Index> voxels) const;
    std::size_t points_in(std::span<const Index> voxels) const;
    /// The mean direction of the normals of points in a ring that face along its axis; 0 if less than two do.
    Vec3 axis_across(const Tube& tube, std::span<const Index> voxels) const;

    const Octree& octree_;
    const OctreeLevel& level_;
    std::span<const Index> voxel_;
    const PolygonMesh& mesh_;
};

} // namespace hsdm
