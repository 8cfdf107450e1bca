#include "hsdm/io/join_points.hh"

#include "hsdm/core/interruption.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/core/system.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/text.hh"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

namespace hsdm {
namespace {

/// Appends if both have some; else neither has. Returns false if one had.
template <class T>
bool append_if_both(const std::vector<T>& next, std::vector<T>& all) {
    if (!all.empty() && !next.empty()) {
        append_large(all, next);
        return true;
    }
    const bool none = all.empty() && next.empty();
    all = std::vector<T>();
    return none;
}

/// What a cloud says of its scanners, as PointCloud::sensors does.
std::vector<Vec3> sensors_in(const PointCloud& cloud) {
    if (cloud.sensors.empty() && cloud.sensor) return {*cloud.sensor};
    return cloud.sensors;
}

} // namespace

void JoinedPoints::add(PointFile&& scan) {
    const bool first = all_.format.empty();
    const std::string format = first || scan.format == all_.format ? scan.format : "several";
    add_notes(scan, all_);
    all_.format = format;
    PointCloud& next = scan.cloud;
    if (next.size() == 0) return;
    placed_ptx_ += scan.format == "ptx" && next.sensor;
    add_sensors(next);
    if (all_.cloud.size() == 0) {
        all_.cloud.positions = std::move(next.positions);
        all_.cloud.normals = std::move(next.normals);
        all_.cloud.colors = std::move(next.colors);
        all_.cloud.scalars = std::move(next.scalars);
        return;
    }
    append_large(all_.cloud.positions, next.positions);
    if (!append_if_both(next.normals, all_.cloud.normals)) leave_out("normals");
    if (!append_if_both(next.colors, all_.cloud.colors)) leave_out("colours");
    add_scalars(next.scalars, next.size());
}

/// By their names; of several of one name in their order.
void JoinedPoints::add_scalars(std::vector<Scalar>& next, std::size_t points) {
    std::vector<std::uint8_t> is_taken(next.size(), 0);
    std::vector<Scalar> kept;
    for (Scalar& scalar : all_.cloud.scalars) {
        std::size_t k = 0;
        while (k < next.size() && (is_taken[k] || next[k].name != scalar.name)) ++k;
        if (k == next.size() || next[k].values.size() != points) {
            leave_out(scalar.name);
            continue;
        }
        is_taken[k] = 1;
        append_large(scalar.values, next[k].values);
        scalar.is_label &= next[k].is_label;
        kept.push_back(std::move(scalar));
    }
    all_.cloud.scalars = std::move(kept);
    for (std::size_t k = 0; k < next.size(); ++k)
        if (!is_taken[k]) leave_out(next[k].name);
}

void JoinedPoints::add_sensors(const PointCloud& next) {
    const std::vector<Vec3> sensors = sensors_in(next);
    has_sure_sensors_ |= !next.sensors.empty();
    std::vector<std::int32_t> number; // of this scan's among all
    for (const Vec3& sensor : sensors) {
        const auto known = std::ranges::find(all_.cloud.sensors, sensor);
        number.push_back(static_cast<std::int32_t>(known - all_.cloud.sensors.begin()));
        if (known == all_.cloud.sensors.end()) all_.cloud.sensors.push_back(sensor);
    }
    if (all_.cloud.sensors.empty()) return;
    all_.cloud.sensor_of.resize(all_.cloud.size(), -1);
    for (std::size_t i = 0; i < next.size(); ++i) {
        const std::int32_t own = next.sensor_of.empty() ? 0 : next.sensor_of[i];
        const bool is_known = own >= 0 && static_cast<std::size_t>(own) < number.size();
        all_.cloud.sensor_of.push_back(is_known ? number[static_cast<std::size_t>(own)] : -1);
    }
}

void JoinedPoints::leave_out(const std::string& what) {
    if (std::ranges::find(all_.partial, what) == all_.partial.end()) all_.partial.push_back(what);
}

PointFile JoinedPoints::take() && {
    PointCloud& cloud = all_.cloud;
    const bool of_all = std::ranges::all_of(cloud.sensor_of, [](std::int32_t s) { return s == 0; });
    if (cloud.sensors.size() == 1 && !has_sure_sensors_) {
        if (of_all && placed_ptx_ < 2) cloud.sensor = cloud.sensors.front();
        cloud.sensors.clear();
    }
    if (cloud.sensors.empty() || (cloud.sensors.size() == 1 && of_all))
        cloud.sensor_of = std::vector<std::int32_t>();
    return std::move(all_);
}

void add_notes(const PointFile& next, PointFile& all) {
    all.faces += next.faces;
    all.nonfinite += next.nonfinite;
    if (all.withheld == 0) all.first_withheld = next.first_withheld;
    all.withheld += next.withheld;
    if (next.columns.empty() || next.columns == all.columns) return;
    if (!all.columns.empty())
        all.columns = "of several kinds";
    else
        all.columns = next.columns;
}

PointFile read_joined(std::span<const std::string> paths, const ReadOptions& options) {
    if (paths.size() == 1) return read_points(paths.front(), options);
    JoinedPoints all;
    for (const std::string& path : paths) {
        Interruption::poll();
        all.add(read_points(path, options));
    }
    return std::move(all).take();
}

std::vector<std::string> point_files_in(const std::string& folder) {
    std::vector<std::string> files;
    os::for_each_name(folder, [&](const char* name) {
        const std::string extension = std::filesystem::path(name).extension().string();
        if (*name == '.' || extension.empty()
            || std::ranges::find(point_formats(), io::lower(extension).substr(1)) == point_formats().end())
            return;
        const std::string path = (std::filesystem::path(folder) / name).string();
        os::FileStatus status;
        if (!os::status_of(path, status))
            throw Error(path, std::string("cannot be looked at: ") + std::strerror(errno)
                                  + "; remove it from the folder, or name the files");
        if (status.kind == os::FileStatus::Kind::regular) files.push_back(path);
    });
    if (files.empty())
        throw Error(folder, "holds no file with an extension of points (.ply, .pcd, .xyz and others) that "
                            "can be looked at; name the files");
    std::ranges::sort(files);
    return files;
}

} // namespace hsdm
