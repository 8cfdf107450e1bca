#pragma once
// Phase 3 (section 3.3) on facets in flat arrays, for meshes too large for half-edges: the same features and
// normals, bit for bit, as classify_features() and smooth_normals() give the mesh made of them.

#include "hsdm/features/feature_options.hh"
#include "hsdm/features/normal_filter.hh"
#include "hsdm/features/sectors.hh"
#include "hsdm/mesh/facet_links.hh"
#include "hsdm/mesh/feature_hints.hh"

#include <array>

namespace hsdm {

struct FacetFeatures {
    std::vector<std::uint8_t> sharp; ///< per side of a facet, whether its edge is
    std::vector<Vec3> normals;       ///< per facet, smoothed; empty if they were not asked for
    double corner_angle = 0;         ///< of the options
    FeatureCounts counts;
};

/// The features, without normals. `facets` must have one fan round each vertex, so that of `links` only
/// facet, twin, side_out and open_in are read. Takes the hints. O(corners), parallel; at most 60 bytes a
/// facet beside the result.
FacetFeatures find_facet_features(const PolygonMesh& facets, const FacetLinks& links, FeatureHints&& hints,
                                  const FeatureOptions& options);

/// The normals that are smoothed, and what they are weighted by. In steps, so that what one alone reads need
/// not be in memory during the others.
struct FacetNormals {
    std::vector<Vec3> normals; ///< per facet, unit or (0, 0, 0)
    std::vector<double> area;  ///< per facet
};
FacetNormals facet_normals(const PolygonMesh& facets);
/// Of all facets those across sides that are not sharp; reads `first` of the facets, facet and twin.
FacetNeighbours neighbours_of(const PolygonMesh& facets, const FacetLinks& links,
                              std::span<const std::uint8_t> sharp);
/// Throws OptionError.
void smooth_facet_normals(FacetNormals& normals, const FacetNeighbours& neighbours,
                          const NormalSmoothingOptions& options);

/// The facets round one vertex after the other, in the same memory: what VertexFanT is on a mesh.
class FacetFan {
public:
    /// All must outlive it.
    FacetFan(const PolygonMesh& facets, const FacetLinks& links, const FacetFeatures& features)
        : facets_(facets), links_(links), features_(features) {}

    void gather(Index vertex);
    int sharp_edges() const { return sharp_edges_; }
    VertexClass kind() const;
    /// The vertex's one to three normals; the features must have normals. `mean` becomes that of the vertex.
    SectorNormals normals(Vec3& mean);

private:
    struct Spoke {
        Vec3 direction;
        Index facet; ///< between this spoke and the one before; no_index for a gap
        bool sharp;
    };
    void add(Index end, Index facet, bool sharp);

    const PolygonMesh& facets_;
    const FacetLinks& links_;
    const FacetFeatures& features_;
    Vec3 centre_{0, 0, 0};
    std::vector<Spoke> spokes_;
    std::vector<FanFacet> fan_;
    std::array<Vec3, 2> sharp_;
    int sharp_edges_ = 0;
};

} // namespace hsdm
