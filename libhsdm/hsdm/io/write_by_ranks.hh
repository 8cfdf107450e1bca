#pragma once
// A mesh that one rank has, written by all.

#include "hsdm/io/linked_mesh.hh"

namespace hsdm {

class Ranks;

/// What write_mesh() of the same arguments writes, to the same bytes: the first rank, whose `mesh` it is,
/// sends stretches of it, which each rank formats and writes at their place in the temporary file;
/// once all are there the first one puts it in place. For all ranks at the same time, in the same format, the
/// others with an empty mesh. What cannot be written so, since it is a pipe, not all ranks see one file, or
/// the format is no document of rows (is_document()), the first rank writes alone. Holds some 50 MB of
/// stretches on the first rank at once (more from 64 ranks on), and a number a vertex for STL. Throws Error
/// on the rank that fails.
WrittenMesh write_mesh_by_ranks(const std::string& path, const LinkedMesh& mesh, MeshFormat format,
                                const WriteOptions& options, Ranks& ranks);

} // namespace hsdm
