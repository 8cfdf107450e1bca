#include "hsdm/pipeline/cloud_scanners.hh"

#include "hsdm/cloud/strided.hh"

#include <algorithm>
#include <utility>

namespace hsdm {

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

JoinedScanners JoinedScanners::of(const PointView& part) {
    JoinedScanners one;
    for (const Vec3& place : scanners_in(part)) one.add_place(place);
    one.are_sure_ = !part.sensors.empty();
    one.sensor_ = part.sensor;
    one.has_some_ = true;
    for (std::size_t i = 0; i < part.sensor_of.count && one.of_all_; ++i)
        one.of_all_ = scanner_of(part, i) >= 0;
    one.of_all_ = one.of_all_ && !one.places_.empty();
    return one;
}

void JoinedScanners::add_place(const Vec3& place) {
    if (std::ranges::find(places_, place) == places_.end()) places_.push_back(place);
}

void JoinedScanners::join(const JoinedScanners& next) {
    if (!next.has_some_) return;
    if (!std::exchange(has_some_, true)) sensor_ = next.sensor_;
    for (const Vec3& place : next.places_) add_place(place);
    are_sure_ = are_sure_ || next.are_sure_;
    of_all_ = of_all_ && next.of_all_;
    is_one_ = is_one_ && next.is_one_ && sensor_ == next.sensor_;
}

CloudScanners JoinedScanners::known() const {
    CloudScanners scanners;
    if (are_known()) scanners.sensors = places_;
    if (are_sure_ ? is_one_ : is_single()) scanners.sensor = are_sure_ ? sensor_ : places_.front();
    return scanners;
}

void JoinedScanners::put(Ranks::Bytes& bytes) const {
    put_vector(places_, bytes);
    hsdm::put(sensor_, bytes);
    for (const bool is : {are_sure_, of_all_, has_some_, is_one_}) hsdm::put(is, bytes);
}

JoinedScanners JoinedScanners::from(ByteReader& bytes) {
    JoinedScanners scanners;
    scanners.places_ = bytes.take_vector<Vec3>();
    scanners.sensor_ = bytes.take<std::optional<Vec3>>();
    for (bool* const is : {&scanners.are_sure_, &scanners.of_all_, &scanners.has_some_, &scanners.is_one_})
        *is = bytes.take<bool>();
    return scanners;
}

} // namespace hsdm
