#include "hsdm/pipeline/cloud_extent.hh"

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/cloud/strided.hh"
#include "hsdm/errors.hh"
#include "hsdm/octree/octree.hh"

#include <algorithm>
#include <utility>

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

/// Scanners of parts that are added one after the other, as JoinedPoints has them.
struct JoinedScanners {
    std::vector<Vec3> places{};           ///< each once
    bool are_sure = false;                ///< some are of PointCloud::sensors
    bool of_all = true;                   ///< has each point one of them?
    std::optional<Vec3> sensor{};         ///< of PointCloud::sensor, of all parts
    bool has_some = false, is_one = true; ///< parts; have all that same sensor?

    static JoinedScanners of(const PointView& part) {
        JoinedScanners one;
        for (const Vec3& place : scanners_in(part)) one.add_place(place);
        one.are_sure = !part.sensors.empty();
        one.sensor = part.sensor;
        one.has_some = true;
        for (std::size_t i = 0; i < part.sensor_of.count && one.of_all; ++i)
            one.of_all = scanner_of(part, i) >= 0;
        one.of_all = one.of_all && !one.places.empty();
        return one;
    }
    void add_place(const Vec3& place) {
        if (std::ranges::find(places, place) == places.end()) places.push_back(place);
    }
    void join(const JoinedScanners& next) {
        if (!next.has_some) return;
        if (!std::exchange(has_some, true)) sensor = next.sensor;
        for (const Vec3& place : next.places) add_place(place);
        are_sure = are_sure || next.are_sure;
        of_all = of_all && next.of_all;
        is_one = is_one && next.is_one && sensor == next.sensor;
    }
    bool is_single() const { return places.size() == 1 && of_all; }
    /// Does each point have to say which one saw it?
    bool are_several() const { return !places.empty() && !is_single() && (are_sure || places.size() > 1); }
    CloudScanners known() const {
        CloudScanners scanners;
        if (are_sure || places.size() > 1) scanners.sensors = places;
        if (are_sure ? is_one : is_single()) scanners.sensor = are_sure ? sensor : places.front();
        return scanners;
    }

    void put(Ranks::Bytes& bytes) const {
        put_vector(places, bytes);
        hsdm::put(sensor, bytes);
        for (const bool is : {are_sure, of_all, has_some, is_one}) hsdm::put(is, bytes);
    }
    static JoinedScanners from(ByteReader& bytes) {
        JoinedScanners scanners;
        scanners.places = bytes.take_vector<Vec3>();
        scanners.sensor = bytes.take<std::optional<Vec3>>();
        for (bool* const is : {&scanners.are_sure, &scanners.of_all, &scanners.has_some, &scanners.is_one})
            *is = bytes.take<bool>();
        return scanners;
    }
};

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

std::span<const Vec3> scanners_in(const PointView& part) {
    if (!part.sensors.empty() || !part.sensor) return part.sensors;
    return {&*part.sensor, 1};
}

std::int32_t scanner_of(const PointView& part, std::size_t point) {
    const std::size_t count = scanners_in(part).size();
    const double number = part.sensor_of.count == 0 ? 0 : number_at(part.sensor_of, point, 0);
    return number >= 0 && number < static_cast<double>(count) ? static_cast<std::int32_t>(number) : -1;
}

CloudScanners CloudScanners::placed(const CloudFrame& frame, const Vec3& origin) const {
    CloudScanners result = *this;
    const auto place = [&](Vec3& at) { at = frame.to_work(at) - origin; };
    if (result.sensor) place(*result.sensor);
    for (Vec3& at : result.sensors) place(at);
    return result;
}

void CloudScanners::move(const Vec3& by) {
    if (sensor) *sensor += by;
    for (Vec3& at : sensors) at += by;
}

OrientOptions CloudScanners::orientation() const {
    OrientOptions options;
    options.sensor = sensor;
    options.viewpoints.sensors = sensors;
    return options;
}

std::vector<std::int32_t> CloudScanners::numbers_in(const PointView& part) const {
    std::vector<std::int32_t> numbers;
    for (const Vec3& place : scanners_in(part)) {
        const auto known = std::ranges::find(sensors, place);
        numbers.push_back(known == sensors.end() ? -1 : static_cast<std::int32_t>(known - sensors.begin()));
    }
    return numbers;
}

void CloudScanners::put(Ranks::Bytes& bytes) const {
    hsdm::put(sensor, bytes);
    put_vector(sensors, bytes);
}

CloudScanners CloudScanners::from(ByteReader& bytes) {
    CloudScanners scanners;
    scanners.sensor = bytes.take<std::optional<Vec3>>();
    scanners.sensors = bytes.take_vector<Vec3>();
    return scanners;
}

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
