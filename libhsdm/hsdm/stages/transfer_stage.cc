#include "hsdm/stages/transfer_stage.hh"

#include "hsdm/core/check_option.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/read_points.hh"
#include "hsdm/spatial/transfer_attributes.hh"

#include <utility>

namespace hsdm {
namespace {

bool is_asked_for(const PluginOptions& options, const char* key, const char* fallback) {
    return options.text(key, fallback) == "yes";
}

ReadOptions reading(const PluginOptions& options) {
    return {.format = options.text("format", ""), .columns = options.text("columns", "")};
}

TransferOptions transfer_options(const PluginOptions& options) {
    TransferOptions transfer;
    transfer.neighbors = options.count("neighbors", transfer.neighbors);
    transfer.max_distance = options.number("max-distance", transfer.max_distance);
    transfer.missing_value = options.number("missing-value", transfer.missing_value);
    transfer.colors = is_asked_for(options, "colors", "yes");
    transfer.scalars = is_asked_for(options, "scalars", "yes");
    transfer.normals = is_asked_for(options, "normals", "no");
    return transfer;
}

/// A cloud and what messages call it.
struct NamedCloud {
    PointCloud cloud;
    std::string name;
    std::size_t nonfinite = 0; ///< points that it had and that are left out
};

NamedCloud take_cloud(const PluginOptions& options, const StageContext& context) {
    NamedCloud taken;
    if (options.has("cloud")) {
        taken.name = options.text("cloud", "");
        PointFile file = read_points(taken.name, reading(options));
        taken.cloud = std::move(file.cloud);
        taken.nonfinite = file.nonfinite;
    } else if (context.scan) {
        taken.name = "the scan";
        taken.cloud = *context.scan;
    } else {
        throw OptionError("cloud says whose points; the mesh was not reconstructed from any here");
    }
    taken.nonfinite += drop_nonfinite(taken.cloud).nonfinite;
    if (taken.cloud.size() == 0) throw Error(taken.name, "no point with finite coordinates; give another");
    if (context.unit != 1)
        for (Vec3& p : taken.cloud.positions) p /= context.unit;
    return taken;
}

std::string words_of(const TransferCounts& counts, const NamedCloud& from) {
    const auto number = [](std::size_t count) { return std::to_string(count); };
    std::string words = number(counts.properties) + (counts.properties == 1 ? " property" : " properties");
    if (counts.normals > 0) words += " and " + number(counts.normals) + " normals";
    words += " from " + number(from.cloud.size()) + " points";
    if (from.nonfinite > 0) words += " (" + number(from.nonfinite) + " more are not finite)";
    words += " to " + number(counts.vertices) + " vertices";
    if (counts.too_far > 0) words += "; " + number(counts.too_far) + " of them are too far from every point";
    return words;
}

} // namespace

void check_transfer_options(const PluginOptions& options) {
    const TransferOptions transfer = transfer_options(options);
    check_option(transfer.neighbors > 0, "neighbors", transfer.neighbors, "be at least 1");
    if (!transfer.colors && !transfer.scalars && !transfer.normals)
        throw OptionError("colors, scalars and normals are all no; ask for one");
    if (!options.has("cloud") && (options.has("format") || options.has("columns")))
        throw OptionError("format and columns are about a file; give cloud, too");
    check_options(reading(options));
}

std::string transfer_stage(PolyMesh& mesh, const PluginOptions& options, const StageContext& context) {
    check_transfer_options(options);
    const TransferOptions transfer = transfer_options(options);
    const NamedCloud from = take_cloud(options, context);
    const PointCloud& cloud = from.cloud;
    if (!(transfer.normals && cloud.has_normals()) && !(transfer.scalars && !cloud.scalars.empty())
        && !(transfer.colors && !cloud.colors.empty()))
        throw Error(from.name,
                    "its points have nothing of what is asked for (colors, scalars, normals); give "
                    "a cloud that has, or leave the stage out");
    const TransferCounts counts = transfer_attributes(cloud, mesh, transfer);
    return words_of(counts, from);
}

} // namespace hsdm
