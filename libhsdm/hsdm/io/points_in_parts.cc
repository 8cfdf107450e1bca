#include "hsdm/io/points_in_parts.hh"

#include "hsdm/core/interruption.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/formats.hh"
#include "hsdm/io/join_points.hh"
#include "hsdm/io/source_bytes.hh"

#include <algorithm>

namespace hsdm {
namespace {

template <class T>
std::vector<T> slice(const std::vector<T>& all, std::size_t begin, std::size_t end) {
    if (all.empty()) return {};
    return {all.begin() + static_cast<std::ptrdiff_t>(begin), all.begin() + static_cast<std::ptrdiff_t>(end)};
}

PointCloud slice(const PointCloud& cloud, std::size_t begin, std::size_t end) {
    PointCloud part;
    part.positions = slice(cloud.positions, begin, end);
    part.normals = slice(cloud.normals, begin, end);
    part.colors = slice(cloud.colors, begin, end);
    for (const Scalar& scalar : cloud.scalars)
        part.scalars.push_back({scalar.name, slice(scalar.values, begin, end), scalar.is_label});
    part.sensor = cloud.sensor, part.sensors = cloud.sensors;
    part.sensor_of = slice(cloud.sensor_of, begin, end);
    return part;
}

/// Where a share of so many shares begins in a row of so many.
std::uint64_t begin_of(int share, int shares, std::uint64_t count) {
    const auto all = static_cast<std::uint64_t>(shares), own = static_cast<std::uint64_t>(share);
    return count / all * own + count % all * own / all;
}

/// The row of a file where so many of its bytes are over: each for all that ask, 0 and all at its ends.
std::size_t row_at(double byte, std::uint64_t bytes, std::size_t rows) {
    return static_cast<std::size_t>(static_cast<double>(rows) * (byte / static_cast<double>(bytes)));
}

} // namespace

PointsInParts::PointsInParts(std::vector<std::string> paths, const ReadOptions& options) : options_(options) {
    const bool may_be_parted = (options.format.empty() || options.format == "ply") && options.columns.empty();
    check_options(options);
    std::vector<Vec3> ptx_scanners;
    for (std::string& path : paths) {
        Source source{std::move(path)};
        if (source.path == "-" && paths.size() > 1)
            throw Error("standard input",
                        "cannot be one of several that are read in parts; save it to a file");
        if (source.path == "-") {
            one_.emplace(read_points(source.path, options));
            return;
        }
        io::SourceBytes bytes = io::SourceBytes::open(source.path);
        source.bytes = std::max<std::uint64_t>(1, bytes.size());
        if (may_be_parted) source.rows = io::ply_rows(bytes);
        if (const auto scanner = io::ptx_scanner(bytes)) ptx_scanners.push_back(*scanner);
        if (paths.size() == 1 && !source.rows) // at once: a pipe cannot be opened again
            one_.emplace(io::read_points(bytes, options));
        sources_.push_back(std::move(source));
    }
    moved_ptx_ = ptx_scanners.size() > 1 && ptx_scanners.size() == sources_.size()
                 && std::ranges::count(ptx_scanners, ptx_scanners.front()) == std::ssize(ptx_scanners);
}

void PointsInParts::visit_share(int share, int shares,
                                const std::function<void(const PointCloud&)>& visit) const {
    if (one_) {
        if (shares == 1) return visit(one_->cloud);
        const std::size_t points = one_->cloud.size();
        return visit(
            slice(one_->cloud, begin_of(share, shares, points), begin_of(share + 1, shares, points)));
    }
    const std::uint64_t all = bytes();
    std::uint64_t before = 0;
    const std::uint64_t begin = begin_of(share, shares, all), end = begin_of(share + 1, shares, all);
    for (Source& source : sources_) {
        const std::uint64_t last = before + source.bytes, middle = before + source.bytes / 2;
        if (source.rows && begin < last && before < end) {
            const auto row = [&](std::uint64_t at) {
                const std::uint64_t within = std::clamp(at, before, last) - before;
                return row_at(static_cast<double>(within), source.bytes, *source.rows);
            };
            visit_rows(source, row(begin), row(end), visit);
        } else if (!source.rows && begin <= middle && middle < end) {
            visit(read(source).cloud);
        }
        before = last;
    }
}

void PointsInParts::visit_rows(const Source& source, std::size_t begin, std::size_t end,
                               const std::function<void(const PointCloud&)>& visit) const {
    constexpr std::size_t points_at_once = std::size_t{1} << 18; // some megabytes
    const io::SourceBytes bytes = io::SourceBytes::open(source.path);
    const auto one = [&](PointCloud&& part) {
        Interruption::poll();
        io::set_sensors(bytes, options_, part);
        visit(part);
    };
    if (!io::read_ply_in_parts(bytes, begin, end, points_at_once, one))
        throw Error(source.path, "is not the file any more that it was before; leave it until all is done");
}

PointFile PointsInParts::read(Source& source) const {
    Interruption::poll();
    PointFile file = read_points(source.path, options_);
    if (moved_ptx_ && file.format == "ptx") file.cloud.sensor.reset();
    if (!std::exchange(source.is_noted, true)) add_notes(file, notes_);
    return file;
}

std::size_t PointsInParts::size() const {
    if (one_) return one_->cloud.size();
    std::size_t points = 0;
    for (Source& source : sources_) points += source.rows ? *source.rows : read(source).cloud.size();
    return points;
}

std::uint64_t PointsInParts::fingerprint() const {
    std::uint64_t all = one_ ? one_->cloud.size() : 0;
    for (const Source& source : sources_)
        for (const std::uint64_t part : {source.bytes, std::uint64_t{source.rows ? *source.rows + 1 : 0}})
            all = (all ^ part) * 0x100000001b3; // FNV-1a, by words
    return all;
}

std::uint64_t PointsInParts::bytes() const {
    std::uint64_t all = 0;
    for (const Source& source : sources_) all += source.bytes;
    return all;
}

} // namespace hsdm
