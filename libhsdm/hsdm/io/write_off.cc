#include "hsdm/io/format_chunks.hh"
#include "hsdm/io/mesh_writers.hh"

namespace hsdm {

void write_off(AtomicFile& file, const PolygonMesh& mesh) {
    file.write("OFF\n" + std::to_string(mesh.vertex_count()) + " " + std::to_string(mesh.facet_count())
               + " 0\n");
    write_chunks(file, mesh.vertex_count(), [&](std::string& out, std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v)
            for (unsigned k = 0; k < 3; ++k) {
                append_number(out, mesh.positions[v][k]);
                out += k < 2 ? ' ' : '\n';
            }
    });
    write_chunks(file, mesh.facet_count(), [&](std::string& out, std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) {
            append_number(out, mesh.facet(f).size());
            for (Index v : mesh.facet(f)) append_number(out += ' ', v);
            out += '\n';
        }
    });
}

} // namespace hsdm
