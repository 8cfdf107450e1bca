#pragma once
// PolygonMesh -> OFF, STL, PLY, OBJ, in full precision, nothing lost on the way: temporary file, check,
// rename.

#include "hsdm/polygon_mesh.hh"

#include <string>

namespace hsdm {

/// What a mesh is written as.
enum class MeshFormat {
    off, ///< text: positions and facets
    stl, ///< triangles, binary or text
    ply, ///< binary or text, with normals and vertex properties
    obj, ///< text, with normals
    om,  ///< OpenMesh's own, with normals, vertex properties and sharp edges
};

/// How it is written.
struct WriteOptions {
    bool ascii = false; ///< PLY and STL: text instead of binary (OFF and OBJ are always text)
};

/// What was written differently from the options.
struct WrittenMesh {
    bool text_for_precision = false; ///< STL as text though binary was asked for: floats are too coarse
};

/// The format a file name's extension asks for. Throws Error naming the extensions known.
MeshFormat mesh_format(const std::string& path);

/// Writes the mesh; "-" is standard output. STL is triangulated; OFF, PLY and OBJ keep polygons and write
/// doubles that read back to the same bits. Either the complete file is there afterwards or the old one is
/// untouched. Binary STL holds floats: where that would move a vertex by more than 1e-6 of the mesh's
/// diagonal (coordinates far from the origin), text is written instead, and said. Throws Error.
WrittenMesh write_mesh(const std::string& path, const PolygonMesh& mesh, MeshFormat format,
                       const WriteOptions& options = {});

/// Writes `text` to a file under the same promise; "-" is standard output. Throws Error.
void write_text(const std::string& path, const std::string& text);

} // namespace hsdm
