#pragma once
// The header of a PLY file: which elements follow, how many, made of what.

#include "hsdm/io/stored_type.hh"
#include "hsdm/io/text.hh"

#include <cstdint>
#include <string>
#include <vector>

namespace hsdm::io {

using PlyType = StoredType; // PLY itself has no integers of eight bytes
enum class PlyEncoding : std::uint8_t { ascii, little_endian, big_endian };

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;
    bool is_list = false;
    PlyType count_type = PlyType::uint8; ///< of a list's count
};

struct PlyElement {
    std::string name;
    std::uint64_t count =
        0; ///< as the header says: not to be trusted before it is held against the file's size
    std::vector<PlyProperty> properties;

    bool has_list() const;
    /// Bytes of one element, its lists being empty.
    std::size_t least_size() const;
};

struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::ascii;
    std::vector<PlyElement> elements;
    std::size_t size = 0; ///< bytes from the start of the source to the data
    bool padded = false;  ///< whether zeros may follow the data
};

/// The text of a PLY file with the line ends of its first line: binary data decide nothing about them.
Text with_line_end_of_header(Text text);

/// Parses the header. Throws Error for the first line that is not as it must be.
PlyHeader read_ply_header(const Text& text);

} // namespace hsdm::io
