#include "hsdm/io/cursor.hh"
#include "hsdm/io/mesh_readers.hh"

#include <charconv>

namespace hsdm::io {
namespace {

/// Faces are `f a b c`, each corner `v`, `v/vt`, `v//vn` or `v/vt/vn`, counted from 1, or back from the last
/// one read if negative.
class ObjReader {
public:
    explicit ObjReader(const Text& text) : text_(text), cursor_(text) {}

    PolygonMesh read() {
        while (cursor_.find_next()) {
            const char* line = cursor_.at();
            const std::string_view keyword = cursor_.field();
            if (keyword == "v")
                read_vector(mesh_.positions);
            else if (keyword == "vn")
                read_vector(mesh_.normals);
            else if (keyword == "f")
                read_facet(line);
            cursor_.skip_line();
        }
        if (mesh_.positions.empty())
            cursor_.fail(cursor_.at(), "holds no vertices: no line begins with \"v\"; check the format");
        check_corners(text_, mesh_, facet_at_);
        // Only normals that belong to vertices, not to corners, have a place in the mesh.
        if (!normal_per_vertex_ || mesh_.normals.size() != mesh_.positions.size()) mesh_.normals.clear();
        return std::move(mesh_);
    }

private:
    void read_vector(std::vector<Vec3>& vectors) {
        Vec3 v;
        for (double& x : v) x = cursor_.number_in_line("a coordinate");
        vectors.push_back(v);
    }

    void read_facet(const char* line) {
        facet_at_.push_back(line);
        while (cursor_.find_in_line()) {
            const char* at = cursor_.at();
            const std::string_view corner = cursor_.field();
            const Index vertex = parse_index(at, corner.substr(0, corner.find('/')), mesh_.positions.size());
            mesh_.corners.push_back(vertex);
            const std::size_t last = corner.rfind('/');
            if (last != std::string_view::npos && last != corner.find('/') && last + 1 < corner.size())
                normal_per_vertex_ &=
                    parse_index(at, corner.substr(last + 1), mesh_.normals.size()) == vertex;
        }
        mesh_.first.push_back(static_cast<Index>(mesh_.corners.size()));
    }

    Index parse_index(const char* at, std::string_view digits, std::size_t count) const {
        std::int64_t index = 0;
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
        if (error == std::errc::invalid_argument || end != digits.data() + digits.size() || index == 0)
            cursor_.fail(at, io::quoted(digits) + " is no index of a face's corner; correct the line");
        if (error != std::errc()) return no_index;
        return to_index(
            static_cast<double>(index > 0 ? index - 1 : static_cast<std::int64_t>(count) + index));
    }

    const Text& text_;
    Cursor cursor_;
    PolygonMesh mesh_;
    std::vector<const char*> facet_at_;
    bool normal_per_vertex_ = true;
};

} // namespace

PolygonMesh read_mesh_obj(const SourceBytes& bytes) {
    const Text text(bytes);
    return ObjReader(text).read();
}

} // namespace hsdm::io
