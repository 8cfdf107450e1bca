#include "hsdm/io/points_in_parts.hh"

#include "hsdm/core/interruption.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/formats.hh"
#include "hsdm/io/source_bytes.hh"

namespace hsdm {

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
    if (!rows_) return visit(file_.cloud);
    constexpr std::size_t points_at_once = std::size_t{1} << 18; // some megabytes
    const auto one = [&](const PointCloud& part) {
        Interruption::poll();
        visit(part);
    };
    if (!io::read_ply_in_parts(io::SourceBytes::open(path_), points_at_once, one))
        throw Error(path_, "is not the file any more that it was before; leave it until all is done");
}

} // namespace hsdm
