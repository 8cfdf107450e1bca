#pragma once
// A mesh written as a case of a suite asks for, read back and held against what it was.

#include "case_report.hh"
#include "suite_file.hh"

#include "hsdm/mesh_types.hh"

namespace hsdm::command {

struct CaseOptions;

/// A mesh that was written, and what the file says otherwise.
struct OutputCheck {
    WrittenAndRead output;
    std::string fault; ///< empty if the file holds what was to be written
};

/// Writes the mesh as `reconstruct -o` does, in the case's format, to a file for a moment. OFF, PLY, OBJ and
/// .om must hold the mesh to the bit, PLY and .om also its normals and properties, .om its sharp edges; STL
/// the triangles that its facets are cut into, each corner where it was, in binary within the writer's 1e-6
/// of the diagonal. Throws Error for a file that cannot be written or read.
OutputCheck check_output(const Case& one, const CaseOptions& asked, const PolyMesh& mesh);

} // namespace hsdm::command
