#include "hsdm/mesh/editable_triangles.hh"

namespace hsdm {

EditableTriangles::EditableTriangles(std::vector<Index> corners, const PolygonMesh& others,
                                     std::size_t vertex_count)
    : corners_(std::move(corners)), facets_(vertex_count, 0) {
    TriangleSides sides = link_triangles(corners_, others, vertex_count);
    twin_ = std::move(sides.twin);
    border_ = std::move(sides.border);
    crowded_ = sides.crowded;
    for (Index v : corners_) ++facets_[v];
    for (Index v : others.corners) ++facets_[v];
}

bool EditableTriangles::ring_of(Index side, std::vector<Index>& ring) const {
    ring.clear();
    Index s = side;
    do {
        ring.push_back(end(s));
        s = twin_[previous_side(s)];
    } while (s != no_index && s != side);
    return s == side && ring.size() == facets_[start(side)];
}

void EditableTriangles::flip_edge(Index side) {
    const Index other = twin_[side], ca = previous_side(side), db = previous_side(other);
    const Index a = start(side), b = start(other), c = start(ca), d = start(db);
    const Index beyond_ca = twin_[ca], beyond_db = twin_[db];
    corners_[side] = d;
    corners_[other] = c;
    pair_up(side, beyond_db);
    pair_up(other, beyond_ca);
    pair_up(ca, db);
    --facets_[a];
    --facets_[b];
    ++facets_[c];
    ++facets_[d];
}

void EditableTriangles::collapse_edge(Index side) {
    const Index other = twin_[side], from = start(side), to = end(side);
    facets_[to] += facets_[from] - 4;
    --facets_[opposite(side)];
    --facets_[opposite(other)];
    Index s = side;
    do {
        corners_[s] = to;
        s = twin_[previous_side(s)];
    } while (s != side);
    for (const Index gone : {side, other}) {
        pair_up(twin_[next_side(gone)], twin_[previous_side(gone)]);
        for (const Index corner : {gone, next_side(gone), previous_side(gone)}) corners_[corner] = no_index;
    }
}

} // namespace hsdm
