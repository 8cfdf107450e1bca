#include "hsdm/io/points_in_parts.hh"

#include "hsdm/core/interruption.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/formats.hh"
#include "hsdm/io/source_bytes.hh"

namespace hsdm {

PointsInParts::PointsInParts(const std::string& path, const ReadOptions& options) : path_(path) {
    const bool may_be_parted = path != "-" && (options.format.empty() || options.format == "ply")
                               && options.columns.empty() && options.sensors.empty();
    // Its first point tells whether the file can be read like that.
    struct Enough {};
    try {
        if (may_be_parted)
            io::read_ply_in_parts(io::SourceBytes::open(path), 1, [](const PointCloud&) { throw Enough(); });
    } catch (const Enough&) {
        in_parts_ = true;
        file_.format = "ply";
        return;
    }
    file_ = read_points(path, options);
}

void PointsInParts::visit(const std::function<void(const PointCloud&)>& visit) const {
    if (!in_parts_) return visit(file_.cloud);
    constexpr std::size_t points_at_once = std::size_t{1} << 18; // some megabytes
    const auto one = [&](const PointCloud& part) {
        Interruption::poll();
        visit(part);
    };
    if (!io::read_ply_in_parts(io::SourceBytes::open(path_), points_at_once, one))
        throw Error(path_, "is not the file any more that it was before; leave it until all is done");
}

} // namespace hsdm
