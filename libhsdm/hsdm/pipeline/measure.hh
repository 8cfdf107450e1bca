#pragma once
// The report's part on facets: their topology and how far the points are from them.

#include "hsdm/core/occurrences.hh"
#include "hsdm/mesh_types.hh"
#include "hsdm/pipeline/method.hh"
#include "hsdm/quality/topology.hh"

namespace hsdm {

/// The octree's points at the positions that they have in the cloud, relative to its origin.
std::vector<Vec3> points_as_read(const PointView& cloud, const CloudFrame& frame, const Octree& octree);

/// Leaves out the components that options.min_component, which must be given, has for too small, and notes
/// them. Vertices stay. Returns how many.
std::size_t drop_small_components(const MethodInput& in, PolygonMesh& facets, FeatureHints& hints,
                                  Report& report);

/// Drops small components if asked to, and measures the rest. An error bound is checked before, because it
/// covers the points of dropped components too.
void drop_and_measure(std::span<const Vec3> points, const MethodInput& in, PolygonMesh& facets,
                      FacetKnowledge& known, Report& report);

/// Measures a mesh that stages have changed since: its topology, its sharp edges and vertex classes, and if
/// there are points, in the cloud's units, their distances from it. What the report said of the mesh before
/// goes.
void measure_again(const PolyMesh& mesh, std::span<const Vec3> points, Report& report);

/// What the report says of a mesh's connectivity.
void note_topology(const Topology& topology, Report& report);
/// By the mesh's links if they are known and say all: no facet was rejected.
void note_topology(const PolygonMesh& facets, const std::optional<FacetLinks>& links, Report& report);

/// Pairs of facets that pass through each other, and a corner of the first.
Occurrences facets_that_meet(const PolygonMesh& facets);

/// Digest and shape of a finished mesh. O(corners).
void measure_details(const PolyMesh& mesh, Report::Mesh& report);
void measure_details(const PolygonMesh& facets, Report::Mesh& report);
/// Its self-intersections, exactly: as long as a few phases of the reconstruction take. They are the report's
/// warning of them then.
void count_intersections(const PolyMesh& mesh, Report& report);

} // namespace hsdm
