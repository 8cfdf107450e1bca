#pragma once
// On which side of a cloud on disk its normals are, as orient_normals() tells it in memory.

#include "hsdm/normals/orient_normals.hh"
#include "hsdm/pipeline/cloud_noise.hh"
#include "hsdm/pipeline/part_store.hh"

namespace hsdm {

/// Which normals all parts have, and how they are estimated.
struct Estimating {
    enum class Normals {
        estimated,   ///< of either sign
        along_given, ///< estimated, on the side of the given ones
        given,       ///< the points' own; what is estimated tells tolerances
    };
    NeighborOptions neighbors;
    EstimateOptions estimate;
    Normals normals = Normals::estimated;
};

/// Numbers of all patches, ascending, and their signs.
struct SignsOfAll {
    std::vector<Index> number;
    std::vector<std::int8_t> sign;
    OrientReport report;

    /// Of a patch in these; throws Error if it has none.
    Index place(Index patch) const;
};

/// What the positions of a part tell, and of which of its points that is known.
struct PartEstimate {
    Neighbors neighbors;
    EstimatedNormals estimate;
    KnownPoints known;

    PartEstimate(const CloudPart& part, const Estimating& how, PartStore& store);
    /// refined_normals()
    std::vector<Vec3> refine(const CloudPart& part);
    /// vote_on_normals()
    void vote(const CloudPart& part);
};

/// The same or given normals of a part, and its patches, with their number in the whole: that of their first
/// point.
class PartNormals : public PartEstimate {
public:
    PartNormals(const CloudPart& part, const Estimating& how, PartStore& store);

    Patches patches;
    std::vector<Index> first_point; ///< per patch

    Index number(Index patch) const { return part_.number(first_point[patch]); }
    /// Of patches that are not known 1.
    std::vector<std::int8_t> signs(const SignsOfAll& all) const;

private:
    const CloudPart& part_;
};

/// Of all patches, by what parts find, in one pass, and one more where sheets may be layers. The first rank
/// holds all patches and the pairs of them while it finds the signs, which may take so many bytes of memory;
/// else throws Error. Which scanner of `options` saw a point the cloud tells, or the first one saw all. For
/// all ranks at the same time.
SignsOfAll find_signs(ScratchCloud& cloud, const CloudSurvey& survey, const Estimating& how,
                      const OrientOptions& options, const CloudPasses& passes, std::size_t memory,
                      PartStore& store);

} // namespace hsdm
