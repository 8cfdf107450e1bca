#pragma once

namespace hsdm {
namespace detail {

template <class Mesh>
void copy_vertices(const Mesh& mesh, HalfEdges& flat) {
    OpenMesh::VPropHandleT<std::uint8_t> classes;
    const bool has_classes = mesh.get_property_handle(classes, vertex_class_property);
    const auto pin_of = [&](OpenMesh::VertexHandle v) {
        const auto& status = mesh.status(v);
        const bool is_corner =
            has_classes && mesh.property(classes, v) == static_cast<std::uint8_t>(VertexClass::corner);
        if (is_corner || status.locked()) return Pin::always;
        return status.feature() ? Pin::unless_on_curve : Pin::none;
    };
    flat.positions.resize(mesh.n_vertices());
    flat.pins.resize(mesh.n_vertices());
    flat.out.resize(mesh.n_vertices());
    for_each_handle<OpenMesh::VertexHandle>(mesh.n_vertices(), [&](OpenMesh::VertexHandle v) {
        flat.positions[index_of(v)] = to_vec3(mesh.point(v));
        flat.pins[index_of(v)] = pin_of(v);
        flat.out[index_of(v)] =
            mesh.status(v).deleted() ? no_index : static_cast<Index>(mesh.halfedge_handle(v).idx());
    });
}

template <class Mesh>
void copy_half_edges(const Mesh& mesh, HalfEdges& flat) {
    flat.to.assign(mesh.n_halfedges(), no_index);
    flat.next.assign(mesh.n_halfedges(), no_index);
    flat.facet.assign(mesh.n_halfedges(), no_index);
    flat.marked.assign(mesh.n_edges(), 0);
    for_each_handle<OpenMesh::EdgeHandle>(mesh.n_edges(), [&](OpenMesh::EdgeHandle e) {
        if (mesh.status(e).deleted()) return;
        flat.marked[index_of(e)] = mesh.status(e).feature();
        for (const unsigned side : {0u, 1u}) {
            const auto h = mesh.halfedge_handle(e, side);
            flat.to[index_of(h)] = static_cast<Index>(mesh.to_vertex_handle(h).idx());
            flat.next[index_of(h)] = static_cast<Index>(mesh.next_halfedge_handle(h).idx());
            flat.facet[index_of(h)] = static_cast<Index>(mesh.face_handle(h).idx());
        }
    });
}

/// The standard normals of a mesh's vertices: means of the facets', by their angles.
template <class Mesh>
void write_mean_normals(Mesh& mesh, const std::vector<Vec3>& facet_normals) {
    for_chunks(mesh.n_vertices(), chunks::usual, [&](std::size_t begin, std::size_t end, std::size_t) {
        VertexFanT<Mesh> fan(mesh, facet_normals);
        for (std::size_t i = begin; i != end; ++i) {
            const OpenMesh::VertexHandle v(static_cast<int>(i));
            if (mesh.status(v).deleted()) continue;
            fan.gather(v);
            Vec3 sum(0, 0, 0);
            for (const FanFacet& facet : fan.facets()) sum += facet.normal * facet.weight;
            mesh.set_normal(v, to_normal<typename Mesh::Normal>(unit_or_zero(sum)));
        }
    });
}

} // namespace detail

template <class Mesh>
HalfEdges half_edges_of(const Mesh& mesh) {
    HalfEdges flat;
    detail::copy_vertices(mesh, flat);
    detail::copy_half_edges(mesh, flat);
    flat.side.resize(mesh.n_faces());
    for_each_handle<OpenMesh::FaceHandle>(mesh.n_faces(), [&](OpenMesh::FaceHandle f) {
        flat.side[index_of(f)] =
            mesh.status(f).deleted() ? no_index : static_cast<Index>(mesh.halfedge_handle(f).idx());
    });
    return flat;
}

template <class Mesh>
void renew_normals(Mesh& mesh) {
    std::vector<Vec3> normals = facet_area_vectors(mesh);
    for_each_handle<OpenMesh::FaceHandle>(normals.size(), [&](OpenMesh::FaceHandle f) {
        normals[index_of(f)] = unit_or_zero(normals[index_of(f)]);
        if (mesh.has_face_normals())
            mesh.set_normal(f, to_normal<typename Mesh::Normal>(normals[index_of(f)]));
    });
    OpenMesh::VPropHandleT<std::uint8_t> counts;
    if (mesh.get_property_handle(counts, normal_count_property))
        write_vertex_normals(mesh, normals, mesh.has_vertex_normals());
    else if (mesh.has_vertex_normals())
        detail::write_mean_normals(mesh, normals);
}

} // namespace hsdm
