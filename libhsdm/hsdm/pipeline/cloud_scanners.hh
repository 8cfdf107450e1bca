#pragma once
// Where the points of a cloud that comes in parts were seen from.

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/core/ranks.hh"
#include "hsdm/normals/orient_normals.hh"
#include "hsdm/point_view.hh"

#include <optional>
#include <span>

namespace hsdm {

/// What is known of where the points were seen from.
struct CloudScanners {
    std::optional<Vec3> sensor{}; ///< as PointCloud::sensor
    std::vector<Vec3> sensors{};  ///< as PointCloud::sensors, each place once

    /// Of the cloud -> relative to the cube there.
    CloudScanners placed(const CloudFrame& frame, const Vec3& origin) const;
    void move(const Vec3& by);
    /// Which of the sensors saw a point is not told by it.
    OrientOptions orientation() const;
    /// Of a part of the cloud, by its own numbers, the numbers that its scanners have here, or -1.
    std::vector<std::int32_t> numbers_in(const PointView& part) const;
    void put(Ranks::Bytes& bytes) const;
    static CloudScanners from(ByteReader& bytes);
};

/// The scanners that a part of a cloud tells of: those of PointCloud::sensors, or that of PointCloud::sensor.
std::span<const Vec3> scanners_in(const PointView& part);
/// By its own numbers, which of them saw a point; -1: none.
std::int32_t scanner_of(const PointView& part, std::size_t point);

/// Scanners of parts that are added one after the other, as JoinedPoints has them.
class JoinedScanners {
public:
    static JoinedScanners of(const PointView& part);
    void join(const JoinedScanners& next);
    /// What all are together.
    CloudScanners known() const;
    /// Does each point have to say which one saw it?
    bool are_several() const { return !places_.empty() && !is_single() && are_known(); }

    void put(Ranks::Bytes& bytes) const;
    static JoinedScanners from(ByteReader& bytes);

private:
    void add_place(const Vec3& place);
    bool is_single() const { return places_.size() == 1 && of_all_; }
    bool are_known() const { return are_sure_ || places_.size() > 1; }

    std::vector<Vec3> places_;              // each once
    bool are_sure_ = false;                 // some are of PointCloud::sensors
    bool of_all_ = true;                    // does each point have one of them?
    std::optional<Vec3> sensor_;            // as PointCloud::sensor of the first part
    bool has_some_ = false, is_one_ = true; // parts; do all have that sensor?
};

} // namespace hsdm
