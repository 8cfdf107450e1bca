#include "hsdm/pipeline/cloud_free_space.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/errors.hh"
#include "hsdm/pipeline/cell_attributes.hh"

namespace hsdm {
namespace {

using Rays = std::vector<std::vector<FreeSpace::Ray>>; // by scanner

void refuse_large(std::size_t points, std::size_t memory) {
    const std::size_t bytes = points * bytes_per_ray;
    if (bytes > memory)
        throw Error("the space that scanners looked through takes about "
                    + std::to_string((bytes + 999999) / 1000000)
                    + " MB, which is held in memory; give --memory that much, or --holes auto");
}

/// Of this rank's points. `facing`: how many more of them face their scanner than do not.
Rays own_rays(const ScratchCloud& cloud, const std::vector<Vec3>& scanners, std::size_t most,
              std::int64_t& facing) {
    Rays rays(scanners.size());
    cloud.for_groups(most, [&](const Octree& part) {
        const std::vector<std::int32_t> numbers = scanners_of(cloud, part);
        for_each_in_order(part.size(), [&](std::size_t i) {
            const std::int32_t number = numbers.empty() ? 0 : numbers[i];
            if (number < 0) return;
            const Vec3& from = scanners[static_cast<std::size_t>(number)];
            facing += (part.normals[i] | (from - part.positions[i])) > 0 ? 1 : -1;
            if (from != part.positions[i])
                rays[static_cast<std::size_t>(number)].push_back(
                    FreeSpace::Ray::between(from, part.positions[i]));
        });
    });
    return rays;
}

/// Those of all ranks, on the first one.
Rays gathered(Rays&& own, Ranks& ranks) {
    if (ranks.size() == 1) return std::move(own);
    std::vector<Ranks::Bytes> out(static_cast<std::size_t>(ranks.size()));
    for (const std::vector<FreeSpace::Ray>& rays : own) put_vector(rays, out[0]);
    Rays all(own.size());
    own = Rays();
    for (const Ranks::Bytes& got : ranks.exchange(std::move(out))) {
        if (got.empty()) continue;
        ByteReader reader(got);
        for (std::vector<FreeSpace::Ray>& rays : all)
            append_large(rays, reader.take_vector<FreeSpace::Ray>());
    }
    return all;
}

} // namespace

FreeSpace cloud_free_space(const ScratchCloud& cloud, std::size_t most, std::size_t memory) {
    const CloudScanners scanners = cloud.extent().scanners.placed(cloud.frame(), cloud.origin());
    if (scanners.sensors.empty() || cloud.frame().has_cuts()) return {};
    Ranks& ranks = cloud.ranks();
    const std::size_t points = ranks.sum(cloud.points_here());
    if (ranks.is_first()) refuse_large(points, memory);
    std::int64_t facing = 0;
    Rays rays = gathered(own_rays(cloud, scanners.sensors, most, facing), ranks);
    std::int64_t all = 0;
    for (const std::int64_t of_rank : values_of_all(ranks, std::vector{facing})) all += of_rank;
    if (all <= 0 || !ranks.is_first()) return {};
    return {scanners.sensors, std::move(rays), cloud.voxel_size()};
}

} // namespace hsdm
