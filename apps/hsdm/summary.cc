#include "summary.hh"

#include "messages.hh"

#include "hsdm/io/write_mesh.hh"

#include <algorithm>
#include <cstdio>
#include <string_view>
#include <utility>

namespace hsdm::command {
namespace {

/// Not by a string stream: one that finds no memory is silent and leaves the rest out.
std::string number(double value, int digits = 4) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    return text;
}

std::string normals_words(const Report& report) {
    std::string given = report.input.has_normals ? "with normals" : "no normals";
    if (const std::size_t mended = rejected_count(report, "normals_mended"))
        given += " (" + grouped(mended) + " turned to one side)";
    if (const std::size_t steadied = rejected_count(report, "normals_steadied"))
        given += " (noisy: " + grouped(steadied) + " got their axes from positions)";
    if (option_value(report, "normals") != "estimate") return given;
    return report.input.has_normals ? "normals estimated anew" : "normals estimated";
}

std::string small_component_words(const Report& report) {
    const std::size_t dropped = rejected_count(report, "components_small");
    return dropped ? "; " + counted(dropped, "small component", "small components") + " dropped" : "";
}

/// Whether the bound of an adaptive grid was kept, in words.
std::string bound_words(const Report& report) {
    if (report.grid.max_error == 0) return {};
    const std::string bound = "\nbound     " + number(report.grid.max_error, 3) + ": ";
    const bool incomplete = rejected_count(report, "components_small") > 0;
    if (report.grid.points_beyond == 0)
        return bound + "kept by all points" + (incomplete ? " but those of the components dropped" : "");
    return bound + "not met at " + counted(report.grid.points_beyond, "point", "points")
           + ", which the finest surface misses already"
           + (incomplete ? ", nor at those of the components dropped" : "");
}

std::string seconds(double value) {
    char text[64];
    std::snprintf(text, sizeof text, "%.2f s", value);
    return text;
}

/// A text put together before any of it is written: without memory there is none, rather than half of one.
class Text {
public:
    Text& operator<<(std::string_view more) {
        text_ += more;
        return *this;
    }
    Text& operator<<(int number) { return *this << std::to_string(number); }
    std::string take() && { return std::move(text_); }

private:
    std::string text_;
};

std::string dropped_words(const Report::Dropped& dropped) {
    return dropped.what + ": " + grouped(dropped.count) + ", the first at " + number(dropped.where[0], 6)
           + ' ' + number(dropped.where[1], 6) + ' ' + number(dropped.where[2], 6);
}

std::string warning_words(const Report::Warning& warning) {
    return warning.what + ": " + number(warning.how_much, 6) + ", the first at " + number(warning.where[0], 6)
           + ' ' + number(warning.where[1], 6) + ' ' + number(warning.where[2], 6);
}

std::string intersection_words(const Report::Mesh& mesh) {
    return mesh.intersections ? ", " + counted(*mesh.intersections, "intersection", "intersections") : "";
}

} // namespace

std::string grouped(std::size_t value) {
    std::string text = std::to_string(value);
    for (std::size_t i = text.size(); i > 3; i -= 3) text.insert(i - 3, 1, ',');
    return text;
}

std::string counted(std::size_t count, const std::string& one, const std::string& many) {
    return grouped(count) + ' ' + (count == 1 ? one : many);
}

std::string option_value(const Report& report, const std::string& name) {
    const auto found = report.options.find(name);
    return found == report.options.end() ? std::string() : found->second;
}

std::size_t rejected_count(const Report& report, const std::string& stage) {
    const auto found = report.rejected.find(stage);
    return found == report.rejected.end() ? 0 : found->second;
}

std::string columns_words(const std::string& columns, bool has_normals) {
    const auto count = 1 + std::count(columns.begin(), columns.end(), ',');
    return printable(columns) + ", told from the values"
           + (has_normals || count < 6 ? "" : ": no three are unit vectors; --columns says otherwise");
}

std::string topology_words(const Report::Mesh& mesh) {
    std::string text = counted(mesh.components, "component", "components") + ", ";
    if (mesh.closed) {
        text += "closed";
    } else {
        text += "open: " + counted(mesh.boundary_loops, "boundary loop", "boundary loops") + " of "
                + counted(mesh.boundary_edges, "edge", "edges");
    }
    return text + ", genus " + std::to_string(mesh.genus);
}

std::string summary_of(const Report& r, const std::string& written) {
    Text out;
    const Vec3 size = r.input.bbox.size();
    out << "cloud     " << counted(r.input.points, "point", "points")
        << (r.input.files.empty() ? "" : " of " + counted(r.input.files.size(), "file", "files")) << ", "
        << normals_words(r) << ", " << number(size[0]) << " x " << number(size[1]) << " x " << number(size[2])
        << ", spacing " << number(r.input.spacing, 3);
    if (r.input.dropped_nonfinite > 0)
        out << "; " << grouped(r.input.dropped_nonfinite) << " without finite coordinates"
            << (r.input.first_nonfinite
                    ? ", the first at index " + std::to_string(*r.input.first_nonfinite) + ','
                    : std::string(","))
            << " dropped";
    if (r.input.merged_duplicates > 0)
        out << "; " << grouped(r.input.merged_duplicates) << " duplicates, merged";
    if (const std::string left_out = option_value(r, "left_out"); !left_out.empty())
        out << "; not all files have these, which are left out: " << printable(left_out);
    if (rejected_count(r, "points_moved")) out << "; noisy, moved onto their surface";
    if (const std::string columns = option_value(r, "columns"); !columns.empty())
        out << "\ncolumns   " << columns_words(columns, r.input.has_normals);
    out << "\nvoxels    " << grouped(r.grid.voxels) << " of edge " << number(r.grid.voxel_size) << ", depth "
        << r.grid.depth << ": " << option_value(r, "resolution") << "\nmesh      "
        << counted(r.mesh.vertices, "vertex", "vertices") << ", " << counted(r.mesh.faces, "face", "faces")
        << " (" << grouped(r.mesh.quads) << " quads, " << grouped(r.mesh.triangles) << " triangles), "
        << counted(r.features.sharp_edges, "sharp edge", "sharp edges") << "\ntopology  "
        << topology_words(r.mesh) << intersection_words(r.mesh) << small_component_words(r);
    for (const Report::Dropped& dropped : r.dropped) out << "\ndropped   " << dropped_words(dropped);
    for (const Report::Stage& stage : r.stages)
        out << "\nstage     " << printable(stage.call + ": " + stage.summary);
    out << "\nerror     points to mesh: max " << number(r.error.points_to_mesh_max, 3) << " ("
        << number(100 * r.error.normalised_max, 3) << " % of the diagonal), mean "
        << number(r.error.points_to_mesh_mean, 3) << (r.stages.empty() ? bound_words(r) : "")
        << "\nwritten   " << printable(written) << " in " << seconds(r.seconds.total) << "\n";
    return std::move(out).take();
}

std::string details_of(const Report& r) {
    Text out;
    const Report::Seconds& s = r.seconds;
    const std::pair<const char*, double> phases[] = {
        {"read", s.read},         {"octree", s.octree}, {"normals", s.normals},
        {"graph", s.graph},       {"facets", s.facets}, {"mesh", s.mesh},
        {"features", s.features}, {"error", s.error},   {"write", s.write}};
    out << "seconds  ";
    for (const auto& [name, taken] : phases) {
        char text[64];
        std::snprintf(text, sizeof text, "%s %s %.3f", name == phases[0].first ? "" : ",", name, taken);
        out << text;
    }
    out << "\n";
    out << "features  " << grouped(r.features.smooth_vertices) << " smooth, "
        << grouped(r.features.edge_vertices) << " edge, " << grouped(r.features.corner_vertices)
        << " corner vertices\n";
    for (const auto& [stage, count] : r.rejected)
        if (count > 0) out << "rejected  " << stage << ": " << grouped(count) << "\n";
    out << "memory    " << grouped(r.peak_memory_bytes / 1000000) << " MB at most, " << r.threads
        << " threads\n";
    if (r.scratch_bytes > 0)
        out << "scratch   " << grouped(r.scratch_bytes / 1000000) << " MB at most, "
            << grouped(r.scratch_bytes_written / 1000000) << " MB written\n";
    return std::move(out).take();
}

std::string warnings_of(const Report& r) {
    Text out;
    for (const Report::Warning& warning : r.warnings) out << "warning   " << warning_words(warning) << "\n";
    return std::move(out).take();
}

std::string written_words(const Report::Written& w) {
    Text out;
    if (w.text_for_precision)
        out << "format    STL as text: so far from the origin the floats of binary STL would move vertices "
               "by up to "
            << number(w.moved_by_floats, 2)
            << " of the diagonal; --recentre writes it binary, relative to a shift\n";
    if (w.shift != Vec3(0, 0, 0))
        out << "shift     " << number(w.shift[0], 17) << " " << number(w.shift[1], 17) << " "
            << number(w.shift[2], 17) << ": add it to the file's coordinates for those of the cloud\n";
    if (!w.units.empty()) {
        const MeshFormatInfo& format = info_of(mesh_format("x." + w.format));
        out << "units     " << w.units;
        if (format.format == MeshFormat::glb) out << ", scaled to metres, which GLB is in";
        if (!format.holds_unit) out << ", which " << format.title << " has no place for";
        out << "\n";
    }
    return std::move(out).take();
}

std::string strict_words(const Report& r) {
    const std::size_t more = r.warnings.size() - 1;
    return "a warning, which --strict makes a failure: " + warning_words(r.warnings.front())
           + (more > 0 ? "; and " + grouped(more) + " more" : "");
}

std::string line_of(const Report& r, const std::string& written) {
    Text out;
    out << printable(written) << ": " << grouped(r.input.points) << " points, depth " << r.grid.depth << ", "
        << grouped(r.mesh.faces) << " faces, " << topology_words(r.mesh) << intersection_words(r.mesh)
        << small_component_words(r) << ", error " << number(100 * r.error.normalised_max, 3) << " %, "
        << seconds(r.seconds.total);
    for (const Report::Dropped& dropped : r.dropped) out << "; dropped " << dropped_words(dropped);
    out << "\n";
    return std::move(out).take();
}

} // namespace hsdm::command
