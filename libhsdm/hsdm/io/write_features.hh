#pragma once
// A mesh's sharp edges and corners -> lines for CAD programs.

#include "hsdm/io/write_mesh.hh"
#include "hsdm/mesh_types.hh"

#include <string>

namespace hsdm {

/// What they are written as.
enum class FeatureFormat {
    text, ///< see feature_lines()
    obj,  ///< vertices, elements `l` and `p`
    dxf,  ///< of AutoCAD's release 12: entities LINE on the layer SHARP_EDGES, POINT on CORNERS
};

/// By the name's extension: .obj, .dxf, any other is text.
FeatureFormat feature_format(const std::string& path);

/// Writes them under the promise of write_mesh(); "-" is standard output. Coordinates are doubles in the
/// fewest digits, less `shift`. DXF says the unit in a comment alone, for this release has no other place.
/// Throws Error.
void write_features(const std::string& path, const PolyMesh& mesh, FeatureFormat format,
                    LengthUnit unit = LengthUnit::none, const Vec3& shift = Vec3(0, 0, 0));

} // namespace hsdm
