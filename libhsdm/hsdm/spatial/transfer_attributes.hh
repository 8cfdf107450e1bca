#pragma once
// Colours, scalars and normals of a cloud's points, carried to the vertices of any mesh.

#include "hsdm/mesh_types.hh"
#include "hsdm/point_cloud.hh"
#include "hsdm/polygon_mesh.hh"

#include <limits>

namespace hsdm {

/// What is carried, from how many points, and what vertices get that no point is near.
struct TransferOptions {
    int neighbors = 8; ///< nearest points whose mean a vertex gets, > 0
    /// in the mesh's units, >= 0: points farther from a vertex have no part in its mean
    double max_distance = std::numeric_limits<double>::infinity();
    bool colors = true;   ///< as `red`, `green`, `blue`, `alpha`
    bool scalars = true;  ///< under their own names, but for those that begin with `hsdm_`
    bool normals = false; ///< as the vertices' normals
    /// of scalars, where no point is within max_distance
    double missing_value = std::numeric_limits<double>::quiet_NaN();
    std::int32_t missing_label = -1;                       ///< the same of labels
    std::array<std::uint8_t, 4> missing_color{0, 0, 0, 0}; ///< the same of colours
};

/// What was done.
struct TransferCounts {
    std::size_t vertices = 0;   ///< that are not deleted
    std::size_t too_far = 0;    ///< of these, farther than max_distance from every point
    std::size_t properties = 0; ///< set: one for each channel and scalar
    std::size_t normals = 0;    ///< vertices that were given a normal
};

/// Gives every vertex the mean of its nearest points, weighted by (1 - d^2 / R^2)^2 for the distance d: R is
/// that of the first point that does not count any more, or max_distance if that is less, so that values
/// change without steps from place to place. (A biweight kernel whose width follows the density.) Values that
/// are not finite have no part; of labels, the one of most weight; channels are rounded. Properties that the
/// mesh has under these names are replaced, all others stay. Normals are means of directions: those of the
/// cloud have to be on one side of the surface. A vertex too far from the points, or among normals that
/// cancel, keeps the normal it has, (0, 0, 0) if it has none.
///
/// O((n + v) log n), parallel; the same bits for any number of threads. Throws OptionError; Error for an
/// empty cloud, as check_arrays(), for coordinates that are not finite and if the cloud is out of reach of
/// double precision.
TransferCounts transfer_attributes(const PointCloud& cloud, PolygonMesh& mesh,
                                   const TransferOptions& options = {});
/// The same on an OpenMesh mesh: properties as to_mesh() makes them.
TransferCounts transfer_attributes(const PointCloud& cloud, PolyMesh& mesh,
                                   const TransferOptions& options = {});

} // namespace hsdm
