#include "hsdm/io/points_in_parts.hh"

#include "hsdm/core/interruption.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/formats.hh"
#include "hsdm/io/source_bytes.hh"

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
    return part;
}

} // namespace

PointsInParts::PointsInParts(const std::string& path, const ReadOptions& options) : path_(path) {
    const bool may_be_parted = path != "-" && (options.format.empty() || options.format == "ply")
                               && options.columns.empty() && options.sensors.empty();
    if (may_be_parted) rows_ = io::ply_rows(io::SourceBytes::open(path));
    if (rows_)
        file_.format = "ply";
    else
        file_ = read_points(path, options);
}

void PointsInParts::visit(const std::function<void(const PointCloud&)>& visit) const {
    this->visit(0, size(), visit);
}

void PointsInParts::visit(std::size_t begin, std::size_t end,
                          const std::function<void(const PointCloud&)>& visit) const {
    if (!rows_ && begin == 0 && end == size()) return visit(file_.cloud);
    if (!rows_) return visit(slice(file_.cloud, begin, end));
    constexpr std::size_t points_at_once = std::size_t{1} << 18; // some megabytes
    const auto one = [&](const PointCloud& part) {
        Interruption::poll();
        visit(part);
    };
    if (!io::read_ply_in_parts(io::SourceBytes::open(path_), begin, end, points_at_once, one))
        throw Error(path_, "is not the file any more that it was before; leave it until all is done");
}

} // namespace hsdm
