#include "hsdm/io/format_chunks.hh"
#include "hsdm/io/mesh_writers.hh"

namespace hsdm {
namespace {

void write_vectors(AtomicFile& file, const char* keyword, const std::vector<Vec3>& vectors) {
    write_chunks(file, vectors.size(), [&](std::string& out, std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            out += keyword;
            for (unsigned k = 0; k < 3; ++k) append_number(out += ' ', vectors[v][k]);
            out += '\n';
        }
    });
}

} // namespace

void write_obj(AtomicFile& file, const PolygonMesh& mesh) {
    write_vectors(file, "v", mesh.positions);
    write_vectors(file, "vn", mesh.normals);
    const bool normals = !mesh.normals.empty();
    write_chunks(file, mesh.facet_count(), [&](std::string& out, std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) {
            out += 'f';
            for (Index v : mesh.facet(f)) {
                append_number(out += ' ', v + 1u);
                if (normals) append_number(out += "//", v + 1u);
            }
            out += '\n';
        }
    });
}

} // namespace hsdm
