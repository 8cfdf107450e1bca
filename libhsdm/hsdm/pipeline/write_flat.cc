#include "hsdm/io/write_by_ranks.hh"
#include "hsdm/mesh/vertex_normals.hh"
#include "hsdm/pipeline/extended_method.hh"
#include "hsdm/pipeline/reconstruct_in_tiles.hh"

namespace hsdm {
namespace {

/// Colours and scalars, level, what is completed, class, normals and their count, in the order in which a
/// Reconstruction's mesh has them.
VertexRows rows_of(const FlatReconstruction& flat) {
    using Type = VertexProperty::Type;
    const bool classes = !flat.features.sharp.empty(), normals = !flat.features.normals.empty();
    VertexRows rows;
    rows.normals = true;
    for (const AttributeRows::Column& column : flat.rows.columns())
        rows.columns.emplace_back(column.name, column.type);
    rows.columns.emplace_back(level_property, Type::uint8);
    if (flat.rows.has_kinds()) rows.columns.emplace_back(completed_property, Type::uint8);
    if (classes) rows.columns.emplace_back(vertex_class_property, Type::uint8);
    for (std::size_t i = 0; normals && i < 9; ++i)
        rows.columns.emplace_back(vertex_normal_component(i), Type::float32);
    if (normals) rows.columns.emplace_back(normal_count_property, Type::uint8);
    rows.fill = [&flat, classes, normals](std::size_t begin, std::size_t end, std::vector<Vec3>& means,
                                          std::vector<double>& values) {
        FacetFan fan(flat.mesh, flat.links, flat.features);
        for (std::size_t v = begin; v < end; ++v) {
            Vec3& mean = means.emplace_back(0, 0, 0);
            const char* const row = flat.attributes.data() + v * flat.rows.bytes();
            for (std::size_t k = 0; k < flat.rows.columns().size(); ++k)
                values.push_back(flat.rows.value(row, k));
            values.push_back(flat.depth);
            if (flat.rows.has_kinds()) values.push_back(flat.rows.kind(row) == PointKind::completed);
            if (!classes) continue;
            fan.gather(static_cast<Index>(v));
            values.push_back(static_cast<double>(fan.kind()));
            if (!normals) continue;
            const SectorNormals sectors = fan.normals(mean);
            for (const Vec3& normal : sectors.normals)
                for (const double x : normal) values.push_back(x);
            values.push_back(sectors.count);
        }
    };
    return rows;
}

/// Act on the mesh as writers take it.
WrittenMesh with_linked(const FlatReconstruction& flat, bool plain,
                        const std::function<WrittenMesh(const LinkedMesh&)>& act) {
    const VertexRows rows = plain ? VertexRows() : rows_of(flat);
    const auto sharp = plain ? std::span<const std::uint8_t>() : std::span(flat.features.sharp);
    return act({flat.mesh, flat.links, sharp, rows});
}

} // namespace

WrittenMesh write_flat(const std::string& path, const FlatReconstruction& flat, MeshFormat format, bool plain,
                       const WriteOptions& options) {
    return with_linked(flat, plain,
                       [&](const LinkedMesh& mesh) { return write_mesh(path, mesh, format, options); });
}

WrittenMesh write_flat(const std::string& path, const FlatReconstruction& flat, MeshFormat format, bool plain,
                       const WriteOptions& options, Ranks& ranks) {
    return with_linked(flat, plain, [&](const LinkedMesh& mesh) {
        return write_mesh_by_ranks(path, mesh, format, options, ranks);
    });
}

} // namespace hsdm
