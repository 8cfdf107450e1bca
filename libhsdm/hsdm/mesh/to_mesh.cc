#include "hsdm/mesh/to_mesh.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/interruption.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/errors.hh"
#include "hsdm/mesh/corner_count.hh"
#include "hsdm/mesh/facet_normal.hh"
#include "hsdm/mesh/vertex_normals.hh"
#include "hsdm/mesh/vertex_properties.hh"

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <type_traits>

namespace hsdm {
namespace {

using OpenMesh::EdgeHandle;
using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

VertexHandle vertex_handle(Index i) {
    return VertexHandle(static_cast<int>(i));
}
FaceHandle face_handle(Index i) {
    return FaceHandle(static_cast<int>(i));
}
HalfedgeHandle half_edge_handle(Index i) {
    return HalfedgeHandle(static_cast<int>(i));
}

/// Half-edges numbered in the order of the sides, twins 2e and 2e + 1; returns the number of edges.
Index number_half_edges(const FacetLinks& links, std::vector<Index>& half_edge) {
    Index edges = 0;
    resize_large(half_edge, links.twin.size());
    for_each_in_order(links.twin.size(), [&](std::size_t c) {
        const Index twin = links.twin[c];
        if (links.vertex[c] == no_index || (twin != no_index && twin < c)) return;
        half_edge[c] = 2 * edges;
        if (twin != no_index) half_edge[twin] = 2 * edges + 1;
        ++edges;
    });
    return edges;
}

Index number_faces(const FacetLinks& links, std::vector<Index>& face) {
    Index count = 0;
    resize_large(face, links.accepted.size());
    for (std::size_t f = 0; f < face.size(); ++f) face[f] = links.accepted[f] ? count++ : no_index;
    return count;
}

/// Makes a mesh of so many elements, step by step: its memory is touched here for the first time.
void resize_mesh(std::size_t vertices, std::size_t edges, std::size_t faces, PolyMesh& mesh) {
    constexpr std::size_t step = std::size_t{1} << 17; // edges
    mesh.reserve(vertices, edges, faces);
    const std::size_t steps = edges / step;
    for (std::size_t k = 1; k <= steps; ++k) {
        Interruption::poll();
        mesh.resize(vertices * k / (steps + 1), edges * k / (steps + 1), faces * k / (steps + 1));
    }
    mesh.resize(vertices, edges, faces);
}

/// Writes the connectivity through the kernel's setters: it is complete, so OpenMesh need not search for
/// anything.
void write_connectivity(const PolygonMesh& facets, const FacetLinks& links, PolyMesh& mesh) {
    std::vector<Index> half_edge, face;
    const Index edges = number_half_edges(links, half_edge);
    const Index faces = number_faces(links, face);
    resize_mesh(links.source.size(), edges, faces, mesh);
    for_each_index(facets.facet_count(), chunks::quick, [&](Index f) {
        if (face[f] == no_index) return;
        for (Index c = facets.first[f]; c < facets.first[f + 1]; ++c) {
            const Index next = next_side(facets, f, c);
            const HalfedgeHandle h = half_edge_handle(half_edge[c]);
            mesh.set_vertex_handle(h, vertex_handle(links.vertex[next]));
            mesh.set_face_handle(h, face_handle(face[f]));
            mesh.set_next_halfedge_handle(h, half_edge_handle(half_edge[next]));
            if (links.twin[c] != no_index) continue;
            const HalfedgeHandle outside = mesh.opposite_halfedge_handle(h);
            const Index end = links.vertex[c];
            mesh.set_vertex_handle(outside, vertex_handle(end));
            mesh.set_next_halfedge_handle(
                outside, mesh.opposite_halfedge_handle(half_edge_handle(half_edge[links.open_in[end]])));
        }
        // The last half-edge ends in the facet's first vertex, where OpenMesh starts to go round a face.
        mesh.set_halfedge_handle(face_handle(face[f]), half_edge_handle(half_edge[facets.first[f + 1] - 1]));
    });
    for_each_index(links.source.size(), chunks::quick, [&](Index v) {
        const Index open = links.open_in[v];
        mesh.set_halfedge_handle(vertex_handle(v),
                                 open == no_index
                                     ? half_edge_handle(half_edge[links.side_out[v]])
                                     : mesh.opposite_halfedge_handle(half_edge_handle(half_edge[open])));
    });
}

void write_geometry(const PolygonMesh& facets, const FacetLinks& links, PolyMesh& mesh) {
    for_each_index(links.source.size(), chunks::quick, [&](Index v) {
        mesh.set_point(vertex_handle(v), facets.positions[links.source[v]]);
        // Always set: a normal that is never set is uninitialised memory.
        mesh.set_normal(vertex_handle(v),
                        facets.normals.empty() ? Vec3(0, 0, 0) : facets.normals[links.source[v]]);
    });
    for_each_index(mesh.n_faces(), chunks::quick, [&](Index f) {
        HalfedgeHandle h = mesh.next_halfedge_handle(mesh.halfedge_handle(face_handle(f)));
        AreaVector area(mesh.point(mesh.from_vertex_handle(h)));
        for (const HalfedgeHandle last = mesh.halfedge_handle(face_handle(f)); h != last;
             h = mesh.next_halfedge_handle(h))
            area.add(mesh.point(mesh.to_vertex_handle(h)));
        mesh.set_normal(face_handle(f), unit_or_zero(*area));
    });
}

/// Which of the nine numbers of `hsdm_normals` it is; nine if none.
std::size_t normal_component(const VertexProperty& property) {
    std::size_t i = 0;
    while (i < 9 && property.name != vertex_normal_component(i)) ++i;
    return i;
}

void write_normal_component(const VertexProperty& component, std::size_t i, const FacetLinks& links,
                            PolyMesh& mesh) {
    auto property = kept_vertex_property<NormalTriple<Vec3>>(mesh, vertex_normals_property);
    auto& values = mesh.property(property.getRawProperty()).data_vector();
    for_each_index(links.source.size(), chunks::quick,
                   [&](Index v) { values[v][i / 3][i % 3] = component.values[links.source[v]]; });
}

void write_properties(const PolygonMesh& facets, const FacetLinks& links, PolyMesh& mesh) {
    for (const VertexProperty& property : facets.properties) {
        if (property.values.size() != facets.vertex_count()) continue;
        if (const std::size_t i = normal_component(property); i < 9)
            write_normal_component(property, i, links, mesh);
        else
            set_vertex_property(property, links.source, mesh);
    }
}

/// Sets the feature bits; see to_mesh().
void write_marks(const PolygonMesh& facets, const FacetLinks& links, PolyMesh& mesh) {
    for (const VertexProperty& classes : facets.properties) {
        if (classes.name != vertex_class_property || classes.values.size() != facets.vertex_count()) continue;
        for_each_index(links.source.size(), chunks::quick, [&](Index v) {
            mesh.status(vertex_handle(v)).set_feature(classes.values[links.source[v]] > 0);
        });
    }
    if (facets.sharp_edges.empty()) return;
    std::vector<std::array<Index, 2>> sharp = facets.sharp_edges;
    std::sort(sharp.begin(), sharp.end());
    for (const auto e : mesh.edges()) {
        const Index from = links.source[static_cast<std::size_t>(e.v0().idx())];
        const Index to = links.source[static_cast<std::size_t>(e.v1().idx())];
        if (!std::binary_search(sharp.begin(), sharp.end(),
                                std::array{std::min(from, to), std::max(from, to)}))
            continue;
        mesh.status(e).set_feature(true);
        mesh.status(e.v0()).set_feature(true);
        mesh.status(e.v1()).set_feature(true);
    }
}

/// The part of a mesh that becomes polygons: all that is neither deleted nor isolated.
struct Selection {
    std::vector<VertexHandle> vertices;
    std::vector<FaceHandle> faces;
    std::vector<Index> number; ///< per vertex of the mesh, its index among the vertices
};

/// The handles of all n elements that is_part() holds of, in order.
template <class Handle, class Test>
std::vector<Handle> selected(std::size_t n, const Test& is_part) {
    return collected<Handle>(n, chunks::quick,
                             [&](std::size_t begin, std::size_t end, std::vector<Handle>& found) {
                                 for (std::size_t i = begin; i < end; ++i)
                                     if (const Handle h(static_cast<int>(i)); is_part(h)) found.push_back(h);
                             });
}

/// As OpenMesh's ranges skip elements.
template <class Handle>
bool is_skipped(const PolyMesh& mesh, Handle h) {
    return mesh.status(h).deleted() || mesh.status(h).hidden();
}

Selection select(const PolyMesh& mesh) {
    Selection selection;
    selection.vertices = selected<VertexHandle>(mesh.n_vertices(), [&](VertexHandle v) {
        return !(mesh.has_vertex_status() && is_skipped(mesh, v)) && !mesh.is_isolated(v);
    });
    assign_large(selection.number, mesh.n_vertices(), no_index);
    for_each_index(selection.vertices.size(), chunks::light, [&](Index v) {
        selection.number[static_cast<std::size_t>(selection.vertices[v].idx())] = v;
    });
    selection.faces = selected<FaceHandle>(
        mesh.n_faces(), [&](FaceHandle f) { return !(mesh.has_face_status() && is_skipped(mesh, f)); });
    return selection;
}

void read_facets(const PolyMesh& mesh, const Selection& selection, PolygonMesh& polygons) {
    resize_unwritten(polygons.first, selection.faces.size() + 1);
    for_each_index(selection.faces.size(), chunks::quick,
                   [&](Index f) { polygons.first[f + 1] = corner_count(mesh, selection.faces[f]); });
    for (std::size_t f = 0; f < selection.faces.size(); ++f) polygons.first[f + 1] += polygons.first[f];
    resize_unwritten(polygons.corners, polygons.first.back());
    for_each_index(selection.faces.size(), chunks::quick, [&](Index f) {
        Index c = polygons.first[f];
        for (const auto v : mesh.fv_range(selection.faces[f]))
            polygons.corners[c++] = selection.number[static_cast<std::size_t>(v.idx())];
    });
}

template <class Value>
VertexProperty read_property(std::string name, VertexProperty::Type type, const Selection& selection,
                             const Value& value) {
    VertexProperty property{std::move(name), type, unwritten_vector<double>(selection.vertices.size())};
    for_each_index(selection.vertices.size(), chunks::quick, [&](Index v) {
        property.values[v] =
            static_cast<double>(value(static_cast<std::size_t>(selection.vertices[v].idx())));
    });
    return property;
}

/// Adds the property if it holds values of type T; returns whether it does.
template <class T>
bool read_scalars(const OpenMesh::BaseProperty& base, VertexProperty::Type type, const Selection& selection,
                  PolygonMesh& polygons) {
    const auto* typed = dynamic_cast<const OpenMesh::PropertyT<T>*>(&base);
    if (typed == nullptr) return false;
    const auto& values = typed->data_vector();
    polygons.properties.push_back(
        read_property(base.name(), type, selection, [&](std::size_t v) { return values[v]; }));
    return true;
}

void read_vertex_normals(const OpenMesh::BaseProperty& base, const Selection& selection,
                         PolygonMesh& polygons) {
    const auto* typed = dynamic_cast<const OpenMesh::PropertyT<NormalTriple<Vec3>>*>(&base);
    if (typed == nullptr || base.name() != vertex_normals_property) return;
    const auto& values = typed->data_vector();
    for (std::size_t i = 0; i < 9; ++i)
        polygons.properties.push_back(read_property(vertex_normal_component(i), VertexProperty::Type::float32,
                                                    selection,
                                                    [&](std::size_t v) { return values[v][i / 3][i % 3]; }));
}

void read_properties(const PolyMesh& mesh, const Selection& selection, PolygonMesh& polygons) {
    using Type = VertexProperty::Type;
    for (auto it = mesh.vprops_begin(); it != mesh.vprops_end(); ++it) {
        // Names with ':' second are OpenMesh's own: points, normals, status.
        if (*it == nullptr || (*it)->name().find(':') == 1 || (*it)->name() == "<vprop>") continue;
        const OpenMesh::BaseProperty& base = **it;
        if (read_scalars<std::uint8_t>(base, Type::uint8, selection, polygons)) continue;
        if (read_scalars<std::int32_t>(base, Type::int32, selection, polygons)) continue;
        if (read_scalars<float>(base, Type::float32, selection, polygons)) continue;
        if (read_scalars<double>(base, Type::float64, selection, polygons)) continue;
        read_vertex_normals(base, selection, polygons);
    }
}

void read_marks(const PolyMesh& mesh, const Selection& selection, PolygonMesh& polygons) {
    if (!mesh.has_edge_status()) return;
    const auto sharp = selected<EdgeHandle>(
        mesh.n_edges(), [&](EdgeHandle e) { return mesh.status(e).feature() && !is_skipped(mesh, e); });
    polygons.sharp_edges.reserve(sharp.size());
    for (const EdgeHandle e : sharp) {
        const auto number_of_end = [&](unsigned k) {
            const VertexHandle v = mesh.to_vertex_handle(mesh.halfedge_handle(e, 1 - k));
            return selection.number[static_cast<std::size_t>(v.idx())];
        };
        const Index from = number_of_end(0), to = number_of_end(1);
        polygons.sharp_edges.push_back({std::min(from, to), std::max(from, to)});
    }
}

} // namespace

ToMeshCounts to_mesh(const PolygonMesh& facets, PolyMesh& mesh) {
    return to_mesh(facets, link_facets(facets), mesh);
}

ToMeshCounts to_mesh(const PolygonMesh& facets, const FacetLinks& links, PolyMesh& mesh) {
    if (!facets.normals.empty() && facets.normals.size() != facets.vertex_count())
        throw Error("the mesh holds " + std::to_string(facets.normals.size()) + " normals for "
                    + std::to_string(facets.vertex_count())
                    + " vertices; give one for each, or leave them out");
    write_connectivity(facets, links, mesh);
    write_geometry(facets, links, mesh);
    write_properties(facets, links, mesh);
    write_marks(facets, links, mesh);
    return {links.rejected, links.split_vertices};
}

ToMeshResult to_mesh(const PolygonMesh& facets) {
    ToMeshResult result;
    const ToMeshCounts counts = to_mesh(facets, result.mesh);
    result.rejected = counts.rejected;
    result.split_vertices = counts.split_vertices;
    return result;
}

PolygonMesh to_polygons(const PolyMesh& mesh) {
    const Selection selection = select(mesh);
    PolygonMesh polygons;
    resize_unwritten(polygons.positions, selection.vertices.size());
    if (mesh.has_vertex_normals()) resize_unwritten(polygons.normals, selection.vertices.size());
    for_each_index(selection.vertices.size(), chunks::quick, [&](Index v) {
        polygons.positions[v] = mesh.point(selection.vertices[v]);
        if (!polygons.normals.empty()) polygons.normals[v] = mesh.normal(selection.vertices[v]);
    });
    read_facets(mesh, selection, polygons);
    read_properties(mesh, selection, polygons);
    read_marks(mesh, selection, polygons);
    return polygons;
}

} // namespace hsdm
