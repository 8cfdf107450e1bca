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

ScratchCloud ScratchCloud::with_points(const Box& added, int depth, double shift, std::size_t most,
                                       const AddPoints& add_points) const {
    Box box = box_of_points(most);
    box.add(added);
    const double h = none_.voxel_size(depth);
    const CubeOfVoxels larger = cube_around(box, origin(), h, depth, shift);
    ScratchCloud next(*this, {box, larger.origin, std::ldexp(h, larger.depth), larger.depth},
                      attributes_.with_kinds(), nullptr);
    next.divide(*this, origin() - next.origin(), most);
    next.fill([&](const PutRow& put_row) {
        next.move_points(*this, PointKind::measured, most, put_row);
        add_points(next, put_row);
    });
    return next;
}

ScratchCloud ScratchCloud::with_points(const ScratchCloud& between, int depth, std::size_t most) const {
    return with_points(between.box_of_points(most), depth, 0, most,
                       [&](const ScratchCloud& next, const PutRow& put_row) {
                           next.move_points(between, PointKind::between, most, put_row);
                       });
}

ScratchCloud ScratchCloud::with_points(const CompletedPoints& completed, double shift,
                                       std::size_t most) const {
    Box box;
    for (const Vec3& p : completed.positions) box.add(p + origin());
    Ranks::Bytes bytes;
    put(box, bytes);
    const Box of_first = ByteReader(ranks_.of_first(std::move(bytes))).take<Box>();
    return with_points(of_first, depth_, shift, most, [&](const ScratchCloud& next, const PutRow& put_row) {
        const std::vector<char> beside = next.row_of_added(PointKind::completed);
        for (std::size_t i = 0; i < completed.positions.size(); ++i)
            put_row(next.row_of(completed.positions[i], completed.normals[i], origin()), beside.data());
    });
}

/// Of a point of another cloud of this origin. Places and normals are rounded as complete_cloud() rounds
/// them.
PointRow ScratchCloud::row_of(const Vec3& position, const Vec3& normal, const Vec3& from) const {
    const Vec3 place = (position + from) - origin() + Vec3(0, 0, 0), n = normal_in_octree(normal);
    return {place[0], place[1], place[2], n[0], n[1], n[2]};
}

/// What lies beside a point that was added: it is of no scanner.
std::vector<char> ScratchCloud::row_of_added(PointKind kind) const {
    std::vector<char> row(attributes_.bytes());
    if (attributes_.has_scanners()) attributes_.set_scanner(row.data(), -1);
    attributes_.set_kind(row.data(), kind);
    return row;
}

/// Of a cloud whose rows have kinds already these stay.
void ScratchCloud::move_points(const ScratchCloud& from, PointKind kind, std::size_t most,
                               const PutRow& put_row) const {
    CellAttributes attributes(from);
    std::vector<char> beside = row_of_added(kind);
    const bool has_attributes = from.attributes_.bytes() > 0;
    from.for_groups(most, [&](const Octree& part) {
        for_each_in_order(part.size(), [&](std::size_t i) {
            if (has_attributes) std::copy_n(attributes.of(part, i), from.attributes_.bytes(), beside.begin());
            put_row(row_of(part.positions[i], part.normals[i], from.origin()), beside.data());
        });
    });
}

} // namespace hsdm
