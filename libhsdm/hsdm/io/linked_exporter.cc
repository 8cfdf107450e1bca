#include "hsdm/io/linked_exporter.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/io/mesh_document.hh"
#include "hsdm/mesh/vertex_normals.hh"

#include <algorithm>
#include <memory>

namespace hsdm {

EdgeNumbers::EdgeNumbers(const std::vector<Index>& twins) : twins_(twins) {
    const std::size_t words = chunk_count(twins.size(), bits);
    assign_large(marks_, words, 0);
    assign_large(before_, words + 1, 0);
    for_each_index(words, chunks::quick, [&](Index word) {
        const std::size_t end = std::min(twins.size(), (std::size_t{word} + 1) * bits);
        for (std::size_t side = std::size_t{word} * bits; side < end; ++side)
            if (twins[side] == no_index || side < twins[side])
                marks_[word] |= std::uint64_t{1} << (side % bits);
        before_[word + 1] = static_cast<Index>(std::popcount(marks_[word]));
    });
    for (std::size_t word = 0; word < words; ++word) before_[word + 1] += before_[word];
}

Index EdgeNumbers::first_side(Index edge) const {
    if (edge < before_[last_] || edge >= before_[last_ + 1])
        last_ =
            static_cast<Index>(std::upper_bound(before_.begin(), before_.end(), edge) - before_.begin() - 1);
    std::uint64_t left = marks_[last_];
    for (Index n = edge - before_[last_]; n > 0; --n) left &= left - 1;
    return last_ * bits + static_cast<Index>(std::countr_zero(left));
}

std::pair<Vec3, const double*> RowsInOrder::at(std::size_t vertex) {
    constexpr std::size_t chunk = 1024, at_once = 64;
    if (vertex < begin_ || vertex >= end_) {
        begin_ = vertex;
        end_ = std::min(count_, begin_ + chunk * at_once);
        normals_.resize(at_once), values_.resize(at_once);
        for_chunks(end_ - begin_, chunk, [&](std::size_t begin, std::size_t end, std::size_t i) {
            normals_[i].clear(), values_[i].clear();
            rows_.fill(begin_ + begin, begin_ + end, normals_[i], values_[i]);
        });
    }
    const std::size_t i = (vertex - begin_) / chunk, place = (vertex - begin_) % chunk;
    return {rows_.normals ? normals_[i][place] : Vec3(0, 0, 0),
            values_[i].data() + place * rows_.columns.size()};
}

namespace {

/// A property whose values are made while they are written. `Take` gives that of a vertex's row.
template <class T, class Take>
class MadeProperty : public OpenMesh::PropertyT<T> {
    using Base = OpenMesh::PropertyT<T>;

public:
    MadeProperty(const std::string& name, std::size_t count, RowsInOrder& rows, const Take& take)
        : Base(name, OpenMesh::get_type_name<T>()), count_(count), rows_(rows), take_(take) {
        this->set_persistent(true);
    }

    std::size_t n_elements() const override { return count_; }
    using Base::size_of;
    std::size_t size_of() const override { return this->size_of(count_); }
    std::size_t store(std::ostream& stream, bool swap) const override {
        constexpr std::size_t at_once = 1 << 14;
        Base some;
        std::size_t bytes = 0;
        for (std::size_t begin = 0; begin < count_; begin += at_once) {
            auto& values = some.data_vector();
            values.clear();
            for (std::size_t v = begin; v < std::min(count_, begin + at_once); ++v)
                values.push_back(take_(rows_.values(v)));
            bytes += some.store(stream, swap);
        }
        return bytes;
    }

private:
    const std::size_t count_;
    RowsInOrder& rows_;
    const Take take_;
};

template <class T, class Take>
void add_property(const std::string& name, std::size_t count, RowsInOrder& rows, const Take& take,
                  PolyMesh& mesh) {
    auto property = std::make_unique<MadeProperty<T, Take>>(name, count, rows, take);
    mesh._add_vprop(property.get());
    static_cast<void>(property.release()); // the mesh has it now
}

} // namespace

LinkedExporter::LinkedExporter(const LinkedMesh& mesh)
    : ExporterT(properties_),
      mesh_(mesh),
      numbers_(mesh.links.twin),
      rows_(mesh_.rows, n_vertices()),
      class_column_(static_cast<std::size_t>(
          std::ranges::find(mesh.rows.columns, vertex_class_property, [](const auto& c) { return c.first; })
          - mesh.rows.columns.begin())) {
    add_properties();
}

/// As to_mesh() adds them: `hsdm_normals`, which is one of nine numbers, where the first of these stands.
void LinkedExporter::add_properties() {
    const auto& columns = mesh_.rows.columns;
    for (std::size_t k = 0; k < columns.size(); ++k) {
        const std::string& name = columns[k].first;
        if (name == vertex_normal_component(0)) add_normals(k);
        if (name.starts_with(std::string(vertex_normals_property) + '_')) continue;
        with_type(columns[k].second, 0, [&]<class Number>(Number) {
            add_property<Number>(
                name, n_vertices(), rows_, [k](const double* row) { return static_cast<Number>(row[k]); },
                properties_);
        });
    }
}

void LinkedExporter::add_normals(std::size_t first_column) {
    add_property<NormalTriple<Vec3>>(
        vertex_normals_property, n_vertices(), rows_,
        [first_column](const double* row) {
            NormalTriple<Vec3> normals;
            for (std::size_t i = 0; i < 9; ++i) normals[i / 3][i % 3] = row[first_column + i];
            return normals;
        },
        properties_);
}

OpenMesh::Vec3d LinkedExporter::pointd(VertexHandle v) const {
    return mesh_.facets.positions[static_cast<std::size_t>(v.idx())];
}

OpenMesh::Vec3d LinkedExporter::normald(VertexHandle v) const {
    return rows_.normal(static_cast<std::size_t>(v.idx()));
}

LinkedExporter::Status LinkedExporter::status(VertexHandle v) const {
    const auto vertex = static_cast<std::size_t>(v.idx());
    const Index open = mesh_.links.open_in[vertex];
    bool feature = open != no_index && mesh_.is_sharp(open);
    mesh_.for_sides_from(static_cast<Index>(vertex), [&](Index side) { feature |= mesh_.is_sharp(side); });
    if (class_column_ < mesh_.rows.columns.size()) feature |= rows_.values(vertex)[class_column_] > 0;
    Status status;
    status.set_feature(feature);
    return status;
}

LinkedExporter::Status LinkedExporter::status(EdgeHandle e) const {
    Status status;
    status.set_feature(mesh_.is_sharp(numbers_.first_side(static_cast<Index>(e.idx()))));
    return status;
}

int LinkedExporter::get_halfedge_id(VertexHandle v) {
    const auto vertex = static_cast<std::size_t>(v.idx());
    const Index open = mesh_.links.open_in[vertex];
    return open == no_index ? static_cast<int>(numbers_.half_edge(mesh_.links.side_out[vertex]))
                            : outside_of(open);
}

/// The one that ends in the facet's first vertex, where OpenMesh starts to go round.
int LinkedExporter::get_halfedge_id(FaceHandle f) {
    return static_cast<int>(
        numbers_.half_edge(mesh_.facets.first[static_cast<std::size_t>(f.idx()) + 1] - 1));
}

LinkedExporter::Side LinkedExporter::side_of(HalfedgeHandle h) const {
    const Index first = numbers_.first_side(static_cast<Index>(h.idx() / 2));
    return {h.idx() % 2 == 0 ? first : mesh_.links.twin[first], first};
}

int LinkedExporter::get_next_halfedge_id(HalfedgeHandle h) {
    const Side of = side_of(h);
    if (of.side == no_index) return outside_of(mesh_.links.open_in[mesh_.facets.corners[of.first]]);
    return static_cast<int>(numbers_.half_edge(next_side(mesh_.facets, mesh_.links.facet[of.side], of.side)));
}

int LinkedExporter::get_to_vertex_id(HalfedgeHandle h) {
    const Side of = side_of(h);
    if (of.side == no_index) return static_cast<int>(mesh_.facets.corners[of.first]);
    const Index end = next_side(mesh_.facets, mesh_.links.facet[of.side], of.side);
    return static_cast<int>(mesh_.facets.corners[end]);
}

int LinkedExporter::get_face_id(HalfedgeHandle h) {
    const Index side = side_of(h).side;
    return side == no_index ? -1 : static_cast<int>(mesh_.links.facet[side]);
}

} // namespace hsdm
