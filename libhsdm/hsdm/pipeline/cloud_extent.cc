#include "hsdm/pipeline/cloud_extent.hh"

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/cloud/strided.hh"
#include "hsdm/errors.hh"
#include "hsdm/octree/octree.hh"

namespace hsdm {
namespace {

/// Every so-manieth of points that come one after the other, as few as are wanted.
void add_to_sample(const PointView& part, std::size_t before, CloudExtent& extent) {
    for (std::size_t i = (extent.sample_stride - before % extent.sample_stride) % extent.sample_stride;
         i < part.size(); i += extent.sample_stride) {
        const Vec3 p = vec3_at(part.positions, i);
        if (is_finite(p)) extent.sample.push_back(p);
    }
    while (extent.sample.size() > most_sampled) {
        std::vector<Vec3> fewer;
        for (std::size_t i = 0; i < extent.sample.size(); i += 2) fewer.push_back(extent.sample[i]);
        extent.sample = std::move(fewer);
        extent.sample_stride *= 2;
    }
}

/// What this rank finds in its part.
CloudExtent extent_of_part(const PointParts& parts, JoinedScanners& scanners) {
    CloudExtent extent;
    parts([&](const PointView& part) {
        check_view(part);
        if (part.size() == 0) return;
        if (extent.points > 0 && extent.has_normals != part.has_normals())
            refuse_in_tiles("some parts of the cloud have normals and others have none");
        extent.has_normals = part.has_normals();
        scanners.join(JoinedScanners::of(part));
        extent.attributes.join(CloudAttributes::of(part), extent.points > 0);
        const NonfiniteRows nonfinite = find_nonfinite(part.positions);
        if (nonfinite.count > 0 && extent.nonfinite == 0)
            extent.first_nonfinite = extent.points + nonfinite.first;
        extent.nonfinite += nonfinite.count;
        add_to_sample(part, extent.points, extent);
        extent.points += part.size();
        extent.box.add(finite_bounds(part.positions));
    });
    return extent;
}

/// Adds what the next rank finds.
void join(const CloudExtent& next, CloudExtent& extent) {
    if (extent.points > 0 && next.points > 0 && extent.has_normals != next.has_normals)
        refuse_in_tiles("some parts of the cloud have normals and others have none");
    extent.has_normals = next.points > 0 ? next.has_normals : extent.has_normals;
    if (next.points > 0) extent.attributes.join(next.attributes, extent.points > 0);
    if (extent.nonfinite == 0) extent.first_nonfinite = extent.points + next.first_nonfinite;
    extent.nonfinite += next.nonfinite;
    extent.points += next.points;
    extent.box.add(next.box);
}

} // namespace

void refuse_in_tiles(const std::string& what) {
    throw RefusedInTiles(
        what + "; this is not done in tiles, reconstruct it in one piece (by hsdm, without --memory)");
}

CloudExtent measure_extent(const PointParts& parts, Ranks& ranks) {
    JoinedScanners scanners, of_all;
    CloudExtent own = extent_of_part(parts, scanners), extent;
    Ranks::Bytes bytes;
    put_extent(own, bytes);
    scanners.put(bytes);
    for (const Ranks::Bytes& got : ranks.gather(bytes)) {
        ByteReader reader(got);
        join(extent_from(reader), extent);
        of_all.join(JoinedScanners::from(reader));
    }
    extent.scanners = of_all.known(), extent.attributes.scanners = of_all.are_several();
    extent.sample = std::move(own.sample);
    extent.sample_stride = own.sample_stride;
    if (extent.points == 0) throw Error("the cloud holds no point; nothing can be reconstructed");
    if (extent.points >= no_index)
        throw Error("the cloud holds 2^32 points or more; leave some out, or reconstruct parts of it");
    if (2 * extent.nonfinite > extent.points)
        throw Error(std::to_string(extent.nonfinite) + " of " + std::to_string(extent.points)
                    + " points have coordinates that are not finite; check how the file was exported");
    const Vec3 zero(0, 0, 0); // -0 becomes 0, as in the octree
    extent.box = {extent.box.lo + zero, extent.box.hi + zero};
    if (CloudFrame(extent.box).unit() != 1) refuse_in_tiles("the cloud is of extreme size");
    if (!has_voxels(extent.box)) throw Error("all points are equal; a surface needs points that differ");
    return extent;
}

void put_extent(const CloudExtent& extent, Ranks::Bytes& bytes) {
    for (const std::size_t count : {extent.points, extent.nonfinite, extent.first_nonfinite})
        put(count, bytes);
    put(extent.box, bytes);
    put(extent.has_normals, bytes), extent.scanners.put(bytes);
    extent.attributes.put(bytes);
}

CloudExtent extent_from(ByteReader& bytes) {
    CloudExtent extent;
    for (std::size_t* count : {&extent.points, &extent.nonfinite, &extent.first_nonfinite})
        *count = bytes.take<std::size_t>();
    extent.box = bytes.take<Box>();
    extent.has_normals = bytes.take<bool>(), extent.scanners = CloudScanners::from(bytes);
    extent.attributes = CloudAttributes::from(bytes);
    return extent;
}

} // namespace hsdm
