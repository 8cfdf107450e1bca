#pragma once

namespace hsdm {

template <class Mesh>
std::vector<Vec3> facet_area_vectors(const Mesh& mesh) {
    std::vector<Vec3> areas = large_vector<Vec3>(mesh.n_faces(), Vec3(0, 0, 0));
    for_each_handle<OpenMesh::FaceHandle>(mesh.n_faces(), [&](OpenMesh::FaceHandle f) {
        if (mesh.has_face_status() && mesh.status(f).deleted()) return;
        const auto last = mesh.halfedge_handle(f);
        AreaVector area(to_vec3(mesh.point(mesh.to_vertex_handle(last))));
        for (auto h = mesh.next_halfedge_handle(last); h != last; h = mesh.next_halfedge_handle(h))
            area.add(to_vec3(mesh.point(mesh.to_vertex_handle(h))));
        areas[index_of(f)] = *area;
    });
    return areas;
}

template <class Mesh>
FacetNeighbours facet_neighbours(const Mesh& mesh, StatusBits bits, const std::vector<unsigned char>& among) {
    const auto is_fixed = [&](OpenMesh::FaceHandle f) {
        return mesh.status(f).deleted() || (!among.empty() && !among[index_of(f)])
               || (bits == StatusBits::obey && mesh.status(f).locked());
    };
    FacetNeighbours result;
    assign_large(result.first, mesh.n_faces() + 1, 0);
    for_each_handle<OpenMesh::FaceHandle>(mesh.n_faces(), [&](OpenMesh::FaceHandle f) {
        if (!is_fixed(f)) result.first[index_of(f) + 1] = corner_count(mesh, f);
    });
    for_each_in_order(mesh.n_faces(), [&](std::size_t f) { result.first[f + 1] += result.first[f]; });
    resize_large(result.neighbour, result.first.back());
    for_each_handle<OpenMesh::FaceHandle>(mesh.n_faces(), [&](OpenMesh::FaceHandle f) {
        if (is_fixed(f)) return;
        Index slot = result.first[index_of(f)];
        for (const auto h : mesh.fh_range(f)) {
            const auto across = mesh.face_handle(mesh.opposite_halfedge_handle(h));
            const bool parted = bits == StatusBits::obey && mesh.status(mesh.edge_handle(h)).feature();
            result.neighbour[slot++] =
                across.is_valid() && !parted ? static_cast<Index>(across.idx()) : no_index;
        }
    });
    return result;
}

template <class Mesh>
void VertexFanT<Mesh>::gather(OpenMesh::VertexHandle v) {
    spokes_.clear();
    sharp_edges_ = 0;
    const auto first = mesh_.halfedge_handle(v);
    if (!first.is_valid()) return;
    const Vec3 centre = to_vec3(mesh_.point(v));
    auto h = first;
    do { // clockwise: the facet of h lies between h and the half-edge before it
        spokes_.push_back({to_vec3(mesh_.point(mesh_.to_vertex_handle(h))) - centre,
                           mesh_.face_handle(h).idx(), mesh_.status(mesh_.edge_handle(h)).feature()});
        if (spokes_.back().sharp) {
            if (sharp_edges_ < 2) sharp_[static_cast<std::size_t>(sharp_edges_)] = spokes_.back().direction;
            ++sharp_edges_;
        }
        h = mesh_.next_halfedge_handle(mesh_.opposite_halfedge_handle(h));
    } while (h != first);
}

template <class Mesh>
std::span<const FanFacet> VertexFanT<Mesh>::facets() {
    facets_.clear();
    for (std::size_t i = 0; i < spokes_.size(); ++i) {
        const Spoke& spoke = spokes_[i];
        const Spoke& before = spokes_[i == 0 ? spokes_.size() - 1 : i - 1];
        if (spoke.facet < 0) continue;
        facets_.push_back({facet_normals_[static_cast<std::size_t>(spoke.facet)],
                           angle_between(before.direction, spoke.direction),
                           before.sharp || before.facet < 0});
    }
    return facets_;
}

template <class Mesh>
void write_vertex_normals(Mesh& mesh, const std::vector<Vec3>& facet_normals, bool standard_normals) {
    using Normal = typename Mesh::Normal;
    auto normals = kept_vertex_property<VertexNormalsT<Mesh>>(mesh, vertex_normals_property);
    auto counts = kept_vertex_property<std::uint8_t>(mesh, normal_count_property);
    for_chunks(mesh.n_vertices(), chunks::usual, [&](std::size_t begin, std::size_t end, std::size_t) {
        VertexFanT<Mesh> fan(mesh, facet_normals);
        for (std::size_t i = begin; i != end; ++i) {
            const OpenMesh::VertexHandle v(static_cast<int>(i));
            if (mesh.status(v).deleted()) continue;
            fan.gather(v);
            const SectorNormals sectors = sector_normals(fan.facets());
            counts[v] = static_cast<std::uint8_t>(sectors.count);
            for (std::size_t k = 0; k < 3; ++k) normals[v][k] = to_normal<Normal>(sectors.normals[k]);
            if (!standard_normals || mesh.status(v).locked() || sectors.count == 0) continue;
            const Vec3 mean = unit_or_zero(sectors.normals[0] + sectors.normals[1] + sectors.normals[2]);
            mesh.set_normal(v, to_normal<Normal>(mean.sqrnorm() > 0 ? mean : sectors.normals[0]));
        }
    });
}

} // namespace hsdm
