#include "hsdm/report.hh"

#include "hsdm/io/json_text.hh"
#include "hsdm/version.hh"

namespace hsdm {
namespace {

template <class Value>
void fill(JsonText& json, const std::map<std::string, Value>& values) {
    json.begin_object();
    for (const auto& [name, value] : values) json.member(name, value);
    json.end();
}

void fill(JsonText& json, const Report::Input& input) {
    json.begin_object();
    json.member("file", input.file);
    if (!input.files.empty()) json.member("files", input.files);
    json.member("points", input.points);
    json.member("dropped_nonfinite", input.dropped_nonfinite);
    if (input.first_nonfinite) json.member("first_nonfinite", *input.first_nonfinite);
    json.member("merged_duplicates", input.merged_duplicates);
    json.member("has_normals", input.has_normals);
    json.member("bbox_min", input.bbox.lo);
    json.member("bbox_max", input.bbox.hi);
    json.member("spacing", input.spacing);
    json.end();
}

void fill(JsonText& json, const Report::Grid& grid) {
    json.begin_object();
    json.member("kind", grid.kind);
    json.member("depth", grid.depth);
    json.member("voxel_size", grid.voxel_size);
    json.member("voxels", grid.voxels);
    json.member("leaves_per_level", grid.leaves_per_level);
    json.member("sets", grid.sets);
    json.member("balance_splits", grid.balance_splits);
    json.member("merged", grid.merged);
    json.member("max_error", grid.max_error);
    json.member("points_beyond", grid.points_beyond);
    json.end();
}

void fill(JsonText& json, const Report::Mesh& mesh) {
    json.begin_object();
    json.member("vertices", mesh.vertices);
    json.member("edges", mesh.edges);
    json.member("faces", mesh.faces);
    json.member("triangles", mesh.triangles);
    json.member("quads", mesh.quads);
    json.member("larger", mesh.larger);
    json.member("components", mesh.components);
    json.member("boundary_loops", mesh.boundary_loops);
    json.member("boundary_edges", mesh.boundary_edges);
    json.member("euler", mesh.euler);
    json.member("genus", mesh.genus);
    json.member("closed", mesh.closed);
    if (const auto& details = mesh.details) {
        json.member("digest", details->digest);
        json.member("quad_share", details->quad_share);
        json.member("scaled_jacobian_median", details->scaled_jacobian_median);
        json.member("scaled_jacobian_min", details->scaled_jacobian_min);
        json.member("edge_length_mean", details->edge_length_mean);
    }
    if (mesh.intersections) json.member("intersections", *mesh.intersections);
    json.end();
}

void fill(JsonText& json, const Report::Features& features) {
    json.begin_object();
    json.member("sharp_edges", features.sharp_edges);
    json.member("smooth_vertices", features.smooth_vertices);
    json.member("edge_vertices", features.edge_vertices);
    json.member("corner_vertices", features.corner_vertices);
    json.end();
}

void fill(JsonText& json, const Report::Error& error) {
    json.begin_object();
    json.member("points_to_mesh_max", error.points_to_mesh_max);
    json.member("points_to_mesh_mean", error.points_to_mesh_mean);
    json.member("points_to_mesh_rms", error.points_to_mesh_rms);
    json.member("normalised_max", error.normalised_max);
    json.member("mesh_to_surface_max", error.mesh_to_surface_max);
    json.member("mesh_to_surface_mean", error.mesh_to_surface_mean);
    json.end();
}

void fill(JsonText& json, const Report::Seconds& s) {
    json.begin_object();
    json.member("read", s.read);
    json.member("normals", s.normals);
    json.member("octree", s.octree);
    json.member("graph", s.graph);
    json.member("facets", s.facets);
    json.member("mesh", s.mesh);
    json.member("features", s.features);
    json.member("error", s.error);
    json.member("write", s.write);
    json.member("total", s.total);
    json.end();
}

void fill(JsonText& json, const std::vector<Report::Dropped>& dropped) {
    json.begin_array();
    for (const Report::Dropped& d : dropped) {
        json.begin_object();
        json.member("what", d.what);
        json.member("count", d.count);
        json.member("where", d.where);
        json.end();
    }
    json.end();
}

void fill(JsonText& json, const std::vector<Report::Warning>& warnings) {
    json.begin_array();
    for (const Report::Warning& w : warnings) {
        json.begin_object();
        json.member("what", w.what);
        json.member("where", w.where);
        json.member("how_much", w.how_much);
        json.end();
    }
    json.end();
}

void fill(JsonText& json, const std::vector<Report::Loop>& loops) {
    json.begin_array();
    for (const Report::Loop& loop : loops) {
        json.begin_object();
        json.member("where", loop.where);
        json.member("edges", loop.edges);
        json.member("length", loop.length);
        json.member("completed", loop.completed);
        json.end();
    }
    json.end();
}

void fill(JsonText& json, const std::vector<Report::Stage>& stages) {
    json.begin_array();
    for (const Report::Stage& stage : stages) {
        json.begin_object();
        json.member("call", stage.call);
        json.member("summary", stage.summary);
        json.member("seconds", stage.seconds);
        json.end();
    }
    json.end();
}

void fill(JsonText& json, const std::vector<Report::Rank>& ranks) {
    json.begin_array();
    for (const Report::Rank& rank : ranks) {
        json.begin_object();
        json.member("points", rank.points);
        json.member("tiles", rank.tiles);
        json.member("seconds", rank.seconds);
        json.member("seconds_waited", rank.seconds_waited);
        json.member("bytes_sent", rank.bytes_sent);
        json.member("peak_memory_bytes", rank.peak_memory_bytes);
        json.member("scratch_bytes", rank.scratch_bytes);
        json.end();
    }
    json.end();
}

void fill(JsonText& json, const Report::Written& written) {
    json.begin_object();
    json.member("format", written.format);
    if (!written.units.empty()) json.member("units", written.units);
    json.member("text_for_precision", written.text_for_precision);
    json.member("moved_by_floats", written.moved_by_floats);
    json.member("shift", written.shift);
    if (written.by_all_ranks) json.member("by_all_ranks", true);
    json.end();
}

} // namespace

double imbalance_of(const std::vector<Report::Rank>& ranks) {
    double most = 0, sum = 0;
    for (const Report::Rank& rank : ranks) most = std::max(most, rank.seconds), sum += rank.seconds;
    return sum > 0 ? most * static_cast<double>(ranks.size()) / sum : 1.0;
}

std::string to_json(const Report& report) {
    JsonText json;
    json.begin_object();
    json.member("version", version);
    json.key("options");
    fill(json, report.options);
    json.key("input");
    fill(json, report.input);
    if (!report.failure.empty()) {
        json.key("grid");
        json.begin_object();
        json.member("depth", report.grid.depth);
        json.end();
        json.member("failure", report.failure);
        json.end();
        return std::move(json).take();
    }
    json.key("grid");
    fill(json, report.grid);
    json.key("mesh");
    fill(json, report.mesh);
    json.key("features");
    fill(json, report.features);
    json.key("error");
    fill(json, report.error);
    json.key("rejected");
    fill(json, report.rejected);
    json.key("dropped");
    fill(json, report.dropped);
    json.key("warnings");
    fill(json, report.warnings);
    json.key("loops");
    fill(json, report.loops);
    json.key("stages");
    fill(json, report.stages);
    if (report.written) {
        json.key("written");
        fill(json, *report.written);
    }
    json.key("seconds");
    fill(json, report.seconds);
    if (!report.ranks.empty()) {
        json.key("ranks");
        fill(json, report.ranks);
        json.member("imbalance", imbalance_of(report.ranks));
    }
    json.member("peak_memory_bytes", report.peak_memory_bytes);
    if (report.scratch_bytes > 0) {
        json.member("scratch_bytes", report.scratch_bytes);
        json.member("scratch_bytes_written", report.scratch_bytes_written);
    }
    json.member("threads", report.threads);
    json.end();
    return std::move(json).take();
}

} // namespace hsdm
