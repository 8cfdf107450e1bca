#pragma once
// Files whose lines begin with a word that says what they are: OBJ, Hoppe's points, STL as text.

#include "hsdm/io/read_points.hh"
#include "hsdm/io/text.hh"

#include <string_view>

namespace hsdm::io {

/// The words, in lower case; empty: there is no such line.
struct Tags {
    std::string_view position, normal, face, end;
};

/// What the lines hold, in their order. Colours (three numbers behind a position) are there if every position
/// has them, as fractions of 1 or in 0..255.
struct TaggedLines {
    PointCloud cloud; ///< normals: as many as there are normal lines, not necessarily one per position
    std::size_t faces = 0, ends = 0;
};

/// Reads all lines in parallel; lines with other words are skipped. Throws Error for the first bad line.
TaggedLines read_tagged(const Text& text, const Tags& tags);

} // namespace hsdm::io
