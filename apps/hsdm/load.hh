#pragma once
// A file that may hold a mesh or a cloud.

#include "hsdm/io/json_text.hh"
#include "hsdm/io/read_points.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm::command {

struct Loaded {
    PolygonMesh mesh;         ///< without facets if the file holds points only
    PointCloud cloud;         ///< filled only then
    Dropped dropped;          ///< from the cloud
    std::size_t withheld = 0; ///< points that a LAS file marks as deleted, left out
    std::string columns;      ///< of a table, as PointFile::columns
    bool is_mesh() const { return mesh.facet_count() > 0; }
};

/// A mesh if the file has faces, otherwise a cloud of finite points, whose positions are the mesh's too.
/// "-" is standard input. Throws Error.
Loaded load(const std::string& path);

/// Counts, topology and shape, in the report's words.
void fill_topology(JsonText& json, const PolygonMesh& mesh);

/// Lines for people, each `name  value`; the first none if nothing was dropped.
void print_dropped(std::ostream& out, const Loaded& loaded);
void print_topology(std::ostream& out, const PolygonMesh& mesh);

} // namespace hsdm::command
