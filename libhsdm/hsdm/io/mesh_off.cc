#include "hsdm/io/cursor.hh"
#include "hsdm/io/formats.hh"
#include "hsdm/io/mesh_readers.hh"

#include <algorithm>

namespace hsdm::io {
namespace {

/// Reads the keyword, if there is one; the counts may follow in its line.
void read_keyword(Cursor& cursor) {
    if (!cursor.find_next()) cursor.fail(cursor.at(), "is empty; expected an OFF file");
    Cursor ahead = cursor;
    const std::string_view keyword = ahead.field();
    if (!is_off_keyword(keyword)) return; // some writers leave it out
    if (keyword.find_first_of("4n") != std::string_view::npos)
        cursor.fail(cursor.at(),
                    io::quoted(keyword) + " has vertices that are not x y z; export the file as OFF");
    cursor = ahead;
    if (cursor.find_in_line() && ahead.find_in_line() && ahead.field() == "BINARY")
        cursor.fail(cursor.at(), "binary OFF files are not read; export the file as text");
}

std::size_t read_count(Cursor& cursor, const char* what) {
    const char* begin = cursor.at();
    const std::int64_t count = cursor.integer_in_line(what);
    // Every element takes at least two bytes: nothing is allocated by the header's word alone.
    if (count < 0 || static_cast<std::uint64_t>(count) > cursor.left() / 2 + 1)
        cursor.fail(begin,
                    std::to_string(count) + " cannot be " + what
                        + ": the file is too short for it; it was cut off, or its header counts wrong");
    return static_cast<std::size_t>(count);
}

void expect_element(Cursor& cursor, std::size_t index, std::size_t count, const char* what) {
    if (!cursor.find_next())
        cursor.fail(cursor.at(), "the file ends after " + std::to_string(index) + " of "
                                     + std::to_string(count) + " " + what
                                     + "; it was cut off, or its header counts wrong");
}

} // namespace

PolygonMesh read_mesh_off(const SourceBytes& bytes) {
    const Text text(bytes);
    Cursor cursor(text);
    read_keyword(cursor);
    if (!cursor.find_next()) cursor.fail(cursor.at(), "the file ends within its header; it was cut off");
    const std::size_t vertices = read_count(cursor, "the number of vertices");
    const std::size_t facets = read_count(cursor, "the number of faces");
    cursor.skip_line(); // the number of edges, which some writers leave out

    PolygonMesh mesh;
    mesh.positions.resize(vertices);
    for (std::size_t v = 0; v < vertices; ++v) {
        expect_element(cursor, v, vertices, "vertices");
        for (double& x : mesh.positions[v]) x = cursor.number_in_line("a coordinate");
        cursor.skip_line(); // colours, normals
    }
    std::vector<const char*> facet_at;
    for (std::size_t f = 0; f < facets; ++f) {
        expect_element(cursor, f, facets, "faces");
        facet_at.push_back(cursor.at());
        const std::int64_t corners = cursor.integer_in_line("a face's number of corners");
        if (corners < 0)
            cursor.fail(facet_at.back(), "a face cannot have fewer than 0 corners; correct the line");
        for (std::int64_t i = 0; i < corners; ++i)
            mesh.corners.push_back(to_index(static_cast<double>(cursor.integer_in_line("a vertex index"))));
        mesh.first.push_back(static_cast<Index>(mesh.corners.size()));
        cursor.skip_line(); // colours
    }
    check_corners(text, mesh, facet_at);
    return mesh;
}

} // namespace hsdm::io
