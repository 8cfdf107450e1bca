#pragma once
// One side for all normals: out of a solid, towards the scanner, or at least the same for a whole sheet.

#include "hsdm/cloud/strided.hh"
#include "hsdm/normals/estimate_normals.hh"
#include "hsdm/normals/layers.hh"
#include "hsdm/normals/outside.hh"

#include <functional>
#include <optional>

namespace hsdm {

/// Scanners that are sure, each where it stood, relative to the octree's origin, and which of them saw a
/// point.
struct Viewpoints {
    std::vector<Vec3> sensors;
    StridedSpan sensor_of; ///< by the points' `source`; none: the first one saw all

    /// The scanner of a point, or nullptr if none is known.
    const Vec3* of(Index source) const;
};

struct OrientOptions {
    Viewpoints viewpoints;      ///< patches face the scanners of their points, whatever the shape says
    std::optional<Vec3> sensor; ///< where the scanner stood, relative to the octree's origin: decides what
                                ///< the shape leaves open
    bool signs_count =
        false; ///< what the shape leaves open is decided by the signs that most of the normals have
};

/// How signs were decided; all counts are of points, except the first two.
struct OrientReport {
    std::size_t patches = 0, components = 0;
    std::size_t seen_from_outside = 0; ///< points whose patch lies between inside and outside
    std::size_t of_layers = 0; ///< points that were turned as those of layers of one surface (take_layers)
    std::size_t by_volume = 0; ///< whose component its signed volume had to orient (or the sensor, or the
                               ///< signs that came): none of it sees the outside, or its views contradict
                               ///< each other
};

/// The normals to turn, and what decided.
struct Orientation {
    std::vector<std::uint8_t> turns; ///< per point
    OrientReport report;
};

/// Joins patches by the evidence of neighbouring points (patch_evidence) and of the empty space around and in
/// between (view_outside), the strongest first. A component without a view of the outside, or with
/// contradicting views, is turned towards the sensor, or so that its signed volume is positive. `meanwhile`
/// is called once, by another thread if one is free, while signs are decided from all of that, which is not
/// parallel. O(n log n) at worst.
Orientation orient_normals(
    const Octree& octree, const Neighbors& neighbors, const EstimatedNormals& estimate,
    const OrientOptions& options = {}, const std::function<void()>& meanwhile = [] {});

/// Per patch, how many of its points have their scanner in front of it, less those that have it behind; empty
/// if none is known. `source`: per point, by what the viewpoints tell its scanner.
std::vector<float> seen_by_sensors(const Octree& octree, const Patches& patches, const Viewpoints& viewpoints,
                                   std::span<const Index> source);

/// The last step of that, of all patches of a cloud: by the evidence between them, by what they see of the
/// outside, and by the scanners (per patch, as in Viewpoints; none: empty). evidence_of_layers() is asked
/// where the evidence contradicts itself; the signs in what it gives are found here. Of `patches` nothing
/// is read that is of points.
struct PatchSigns {
    std::vector<std::int8_t> sign; ///< per patch, -1 if its normal is to be turned
    OrientReport report;
};
PatchSigns sign_patches(const Patches& patches, std::vector<SignedEdge> edges, const OutsideView& view,
                        const std::vector<float>& seen_by, const OrientOptions& options,
                        const std::function<LayerReading()>& evidence_of_layers);
/// Per point, whether its normal is to be turned.
std::vector<std::uint8_t> turns_of(const Patches& patches, const std::vector<std::int8_t>& sign);

/// Turns normals in place.
void turn_normals(const Orientation& orientation, std::vector<Vec3>& normals);

} // namespace hsdm
