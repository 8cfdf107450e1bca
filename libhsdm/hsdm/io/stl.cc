#include "hsdm/core/chunks.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/formats.hh"
#include "hsdm/io/tagged.hh"
#include "hsdm/mesh/weld.hh"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace hsdm::io {
namespace {

constexpr std::size_t header_size = 84, facet_size = 50;

float load_float(const char* at) {
    std::array<unsigned char, 4> b;
    std::memcpy(b.data(), at, 4);
    return std::bit_cast<float>(static_cast<std::uint32_t>(b[0] | b[1] << 8 | b[2] << 16)
                                | static_cast<std::uint32_t>(b[3]) << 24);
}

std::uint32_t load_count(const char* at) {
    return std::bit_cast<std::uint32_t>(load_float(at));
}

std::vector<Vec3> read_binary_corners(const SourceBytes& bytes) {
    if (bytes.size() < header_size)
        throw Error(bytes.name(), "too short for an STL file: " + std::to_string(bytes.size())
                                      + " bytes, the header alone has 84; it was cut off");
    const std::uint64_t count = load_count(bytes.head().data() + 80);
    const std::uint64_t found = (bytes.size() - header_size) / facet_size;
    if (count == 0) throw Error(bytes.name(), "holds no points: the header says 0 triangles");
    if (found < count)
        throw Error(bytes.name(), "the file ends after " + std::to_string(found) + " of "
                                      + std::to_string(count) + " triangles (at byte "
                                      + std::to_string(bytes.size())
                                      + "); it was cut off, or its header counts wrong");
    if (found > count)
        throw Error(bytes.name(),
                    "more bytes behind the last of " + std::to_string(count)
                        + " triangles than a triangle has; the header's count is wrong, correct it");
    const char* data = bytes.view().data();
    std::vector<Vec3> corners(3 * static_cast<std::size_t>(count));
    for_each_task(static_cast<std::size_t>(count), [&](std::size_t f) {
        const char* at = data + header_size + f * facet_size + 12; // behind the facet's normal
        for (std::size_t i = 0; i < 9; ++i)
            corners[3 * f + i / 3][i % 3] = static_cast<double>(load_float(at + 4 * i));
    });
    return corners;
}

std::vector<Vec3> read_text_corners(const SourceBytes& bytes) {
    const Text text(bytes);
    TaggedLines lines = read_tagged(text, {"vertex", "", "endfacet", "endsolid"});
    const std::size_t corners = lines.cloud.positions.size();
    if (corners != 3 * lines.faces || lines.ends == 0)
        text.fail(text.end, "the file ends after " + std::to_string(lines.faces) + " facets and "
                                + std::to_string(corners) + " corners without "
                                + (lines.ends == 0 ? "endsolid; it was cut off"
                                                   : "three for each facet; export it again"));
    if (corners == 0) throw Error(bytes.name(), "holds no points: there is no facet in it");
    return std::move(lines.cloud.positions);
}

} // namespace

bool is_binary_stl(const SourceBytes& bytes) {
    if (bytes.size() < header_size) return false;
    const std::uint64_t count = load_count(bytes.head().data() + 80);
    return count > 0 && bytes.size() == header_size + count * facet_size;
}

bool is_text_stl(const SourceBytes& bytes) {
    const std::string head = lower(Text::head_of(bytes).view().substr(0, 4096));
    const std::size_t first = std::min(head.find_first_not_of(" \t\r\n"), head.size());
    return head.compare(first, 5, "solid") == 0 && head.find('\0') == std::string::npos
           && (head.find("facet") != std::string::npos || head.find("endsolid") != std::string::npos);
}

std::vector<Vec3> read_stl_corners(const SourceBytes& bytes) {
    return is_text_stl(bytes) && !is_binary_stl(bytes) ? read_text_corners(bytes)
                                                       : read_binary_corners(bytes);
}

PointFile read_stl(const SourceBytes& bytes) {
    const std::vector<Vec3> corners = read_stl_corners(bytes);
    const std::vector<Index> same = weld(corners);
    PointFile file;
    file.format = "stl";
    file.faces = corners.size() / 3;
    for (std::size_t c = 0; c < corners.size(); ++c)
        if (same[c] == c) file.cloud.positions.push_back(corners[c]);
    return file;
}

} // namespace hsdm::io
