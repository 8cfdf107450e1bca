#pragma once
// Normals that a cloud on disk came with, mended as PreparedCloud does it in memory.

#include "hsdm/normals/orient_normals.hh"
#include "hsdm/pipeline/cloud_noise.hh"

namespace hsdm {

class PartStore;

/// Gives normals that scatter the axes that the positions tell, as steady_normals(): the same bits. Returns
/// how many got another one. The survey becomes that of the cloud with these. For all ranks at the same time.
/// Throws Error as for_parts().
std::size_t steady_cloud_normals(ScratchCloud& cloud, CloudSurvey& survey, const CloudPasses& passes,
                                 PartStore& store);

/// Turns normals that contradict each other to one side, as mend_normals(): the same bits. Returns how many
/// were turned. `options`: as of that; a scanner saw all points. `memory`: bytes that the patches of all may
/// take. Else as the same.
std::size_t mend_cloud_normals(ScratchCloud& cloud, CloudSurvey& survey, OrientOptions options,
                               const CloudPasses& passes, std::size_t memory, PartStore& store);

} // namespace hsdm
