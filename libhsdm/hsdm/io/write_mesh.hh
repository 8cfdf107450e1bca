#pragma once
// PolygonMesh -> OFF, STL, PLY, OBJ, .om, GLB, 3MF, in the precision that each has: temporary file, check,
// rename.

#include "hsdm/polygon_mesh.hh"

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hsdm {

/// What a mesh is written as.
enum class MeshFormat {
    off, ///< text: positions and facets
    stl, ///< triangles, binary or text
    ply, ///< binary or text, with normals and vertex properties
    obj, ///< text, with normals
    om,  ///< OpenMesh's own, with normals, vertex properties and sharp edges
    glb, ///< binary glTF 2.0: triangles in floats, with normals and colours, in metres if the unit is known
    mf3, ///< 3MF: triangles, and the unit
};

/// A format and what it can hold.
struct MeshFormatInfo {
    std::string_view name;  ///< "off": as options and extensions call it
    MeshFormat format;      ///< which it is
    std::string_view title; ///< "OFF", ".om": as messages call it
    bool holds_normals;     ///< and classes or colours of vertices, as far as it knows them
    bool holds_unit;        ///< whether a file says what its lengths are in
    bool is_read;           ///< by read_mesh()
};

/// All there are, each once.
std::span<const MeshFormatInfo> mesh_formats();
/// That of one format.
const MeshFormatInfo& info_of(MeshFormat format);

/// What a mesh's lengths are in.
enum class LengthUnit {
    none,       ///< not known
    millimetre, ///< mm
    centimetre, ///< cm
    metre,      ///< m
    inch,       ///< in
};
/// "mm", "cm", "m", "in"; empty for none.
std::string_view name_of(LengthUnit unit);
/// Metres in a unit; of none 1.
double metres_of(LengthUnit unit);

/// How it is written.
struct WriteOptions {
    bool ascii = false;                 ///< PLY and STL: text instead of binary (OFF and OBJ are always text)
    LengthUnit unit = LengthUnit::none; ///< of the positions; GLB is scaled by it, 3MF takes none for mm
    bool recentre = false;              ///< less a shift, so that positions far from the origin lie round it
};

/// What was written differently from the options, or is not to be seen in the file.
struct WrittenMesh {
    bool text_for_precision = false; ///< STL as text though binary was asked for: floats are too coarse
    double moved_by_floats = 0;      ///< STL: how far floats would move a vertex, over the diagonal
    Vec3 shift{0, 0, 0};             ///< what was taken off all positions for `recentre`
    bool by_all_ranks = false;       ///< each wrote a part of it
};

/// The format a file name's extension asks for. Throws Error naming the extensions known.
MeshFormat mesh_format(const std::string& path);

/// Writes the mesh; "-" is standard output. STL, GLB and 3MF are triangulated; OFF, PLY and OBJ keep
/// polygons, and all three and 3MF write doubles that read back to the same bits. Either the complete file is
/// there afterwards or the old one is untouched. Binary STL holds floats: where that would move a vertex by
/// more than 1e-6 of the mesh's diagonal (coordinates far from the origin), text is written instead, and
/// said. GLB holds floats relative to a translation of its node then. Throws Error; so do GLB and 3MF of a
/// mesh without facets, and GLB of lengths outside a float's range in metres.
WrittenMesh write_mesh(const std::string& path, const PolygonMesh& mesh, MeshFormat format,
                       const WriteOptions& options = {});

/// Normals and properties of vertices that are made while they are written.
struct VertexRows {
    bool normals = false;                                                ///< are there normals
    std::vector<std::pair<std::string, VertexProperty::Type>> columns{}; ///< names of the properties
    /// fill(begin, end, normals, values) for vertices begin .. end - 1: their normals, if there are some, and
    /// their values, one vertex after the other. Called from several threads, more than once.
    std::function<void(std::size_t, std::size_t, std::vector<Vec3>&, std::vector<double>&)> fill{};
};

/// Writes `text` to a file under the same promise; "-" is standard output. Throws Error.
void write_text(const std::string& path, const std::string& text);

} // namespace hsdm
