// Clouds on disk made of another one and of points that are added to it.

#include "hsdm/core/chunks.hh"
#include "hsdm/pipeline/cell_attributes.hh"
#include "hsdm/pipeline/completed_cloud.hh"
#include "hsdm/pipeline/scratch_cloud.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {

ScratchCloud ScratchCloud::emptied_aside() const {
    ScratchCloud next(*this, cube(), AttributeRows(), nullptr);
    next.begins_ = begins_;
    next.has_normals_ = true;
    return next;
}

ScratchCloud ScratchCloud::in_voxels_of(int depth, std::size_t most) const {
    Cube same = cube();
    same.depth = depth;
    ScratchCloud next(*this, same, AttributeRows(), nullptr);
    next.divide(*this, Vec3(0, 0, 0), most);
    next.fill([&](const PutRow& put_row) {
        for_groups(most, [&](const Octree& part) {
            for_each_in_order(part.size(), [&](std::size_t i) { put_row(row_at(part, i), nullptr); });
        });
    });
    return next;
}

ScratchCloud ScratchCloud::with_points(const ScratchCloud& added, PointKind kind, int depth,
                                       std::size_t most) const {
    Box box = box_of_points(most);
    box.add(added.box_of_points(most));
    const double h = none_.voxel_size(depth);
    const CubeOfVoxels larger = cube_around(box, origin(), h, depth, 0);
    ScratchCloud next(*this, {box, larger.origin, std::ldexp(h, larger.depth), larger.depth},
                      attributes_.with_kinds(), nullptr);
    next.divide(*this, origin() - next.origin(), most);
    next.fill([&](const PutRow& put_row) {
        next.move_points(*this, PointKind::measured, most, put_row);
        next.move_points(added, kind, most, put_row);
    });
    return next;
}

/// Of a cloud whose rows have kinds already these stay; added points are of no scanner. Places and normals
/// are rounded as complete_cloud() rounds them.
void ScratchCloud::move_points(const ScratchCloud& from, PointKind kind, std::size_t most,
                               const PutRow& put_row) const {
    CellAttributes attributes(from);
    std::vector<char> beside(attributes_.bytes());
    const bool has_attributes = from.attributes_.bytes() > 0;
    if (!has_attributes && attributes_.has_scanners()) attributes_.set_scanner(beside.data(), -1);
    attributes_.set_kind(beside.data(), kind);
    from.for_groups(most, [&](const Octree& part) {
        for_each_in_order(part.size(), [&](std::size_t i) {
            const Vec3 place = (part.positions[i] + from.origin()) - origin() + Vec3(0, 0, 0);
            const Vec3 normal = normal_in_octree(part.normals[i]);
            if (has_attributes) std::copy_n(attributes.of(part, i), from.attributes_.bytes(), beside.begin());
            put_row({place[0], place[1], place[2], normal[0], normal[1], normal[2]}, beside.data());
        });
    });
}

} // namespace hsdm
