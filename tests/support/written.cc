#include "support/written.hh"

#include "support/folder.hh"

namespace hsdm::support {
namespace {

std::string bytes_of(const auto& write) {
    const Folder folder;
    write(folder / "mesh");
    return read_file(folder / "mesh");
}

} // namespace

std::string ply_of(const PolygonMesh& mesh) {
    return bytes_of([&](const std::string& path) { write_mesh(path, mesh, MeshFormat::ply, {}); });
}

std::string ply_of(const FlatReconstruction& flat) {
    return bytes_of([&](const std::string& path) { write_flat(path, flat, MeshFormat::ply, false); });
}

std::string difference_of_loops(const Report& one, const Report& other) {
    if (one.loops.size() != other.loops.size()) return "number of loops";
    for (std::size_t l = 0; l < one.loops.size(); ++l) {
        const Report::Loop &a = one.loops[l], &b = other.loops[l];
        if (a.completed != b.completed) return "completed";
        if (a.length != b.length) return "length";
        if (a.where != b.where) return "place";
    }
    return "";
}

} // namespace hsdm::support
