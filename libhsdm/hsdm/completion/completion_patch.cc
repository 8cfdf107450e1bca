#include "hsdm/completion/completion_patch.hh"

#include "hsdm/completion/conjugate_gradients.hh"
#include "hsdm/completion/constants.hh"
#include "hsdm/completion/crossed_moves.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/mesh/vertex_neighbors.hh"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <utility>

namespace hsdm {
namespace {

/// The lower corners of the four cells round an edge, counter-clockwise about its axis.
std::array<VoxelCoord, 4> cells_around(const VoxelCoord& lower, unsigned axis) {
    static constexpr std::array<std::array<int, 2>, 4> steps{{{-1, -1}, {0, -1}, {0, 0}, {-1, 0}}};
    std::array<VoxelCoord, 4> cells;
    for (unsigned j = 0; j < 4; ++j) {
        cells[j] = lower;
        cells[j][(axis + 1) % 3] += steps[j][0];
        cells[j][(axis + 2) % 3] += steps[j][1];
    }
    return cells;
}

/// Where the surface passes an edge.
struct Passage {
    Vec3 position{0, 0, 0};
    Vec3 normal{0, 0, 0}; ///< of the mesh there; 0 where it is missing
    bool passes = false, missing = false, leaving = false;
};

Passage passage(const CompletionField& field, std::size_t edge) {
    Passage result;
    const Lattice& lattice = field.lattice;
    const Index a = static_cast<Index>(edge / 3), b = lattice.next[a][edge % 3];
    if (b == no_index) return result;
    const auto hits = lattice.on_edge(edge);
    double t = 0;
    if (hits.size() % 2 == 1) {
        t = hits[0].t;
        result.normal = hits[0].normal;
        result.leaving = hits[0].normal[edge % 3] > 0;
        result.passes = true;
    } else if (field.is_open(edge)) {
        t = field.value[a] / (field.value[a] - field.value[b]);
        result.leaving = field.value[a] < 0;
        result.passes = result.missing = true;
    }
    result.position = lattice.place.position(lattice.coord(a));
    result.position[edge % 3] += t * lattice.place.spacing;
    return result;
}

/// The cells of the patch: those round missing edges, and as many around them as hold it.
std::vector<MortonCode> cells_of(const CompletionField& field) {
    std::vector<MortonCode> cells;
    for (std::size_t e = 0; e < 3 * field.lattice.size(); ++e) {
        if (!field.is_open(e)) continue;
        for (const VoxelCoord& c :
             cells_around(field.lattice.coord(static_cast<Index>(e / 3)), static_cast<unsigned>(e % 3)))
            if (field.lattice.place.holds(c)) cells.push_back(morton_encode(c));
    }
    dilate(field.lattice.place, completing::rim, cells);
    return cells;
}

/// Fair positions by sparse least squares; the three coordinates apart.
class Fairing {
public:
    explicit Fairing(CompletionPatch& patch)
        : patch_(patch),
          neighbors_(patch.net),
          number_(patch.net.vertex_count()),
          stays_(patch.net.vertex_count()) {
        const std::vector<std::uint8_t> attached = attached_vertices();
        for (Index v = 0; v < number_.size(); ++v) stays_[v] = patch.held[v] != 0 || attached[v] == 0;
        for (std::size_t q = 0; q < patch.net.facet_count(); ++q)
            if (attached[patch.net.facet(q)[0]] == 0) patch.missing[q] = 0;
    }

    /// Vertices that are to stay where they are, and so many rings around them.
    void stop(std::span<const Index> vertices, int rings) {
        std::vector<Index> reached(vertices.begin(), vertices.end());
        std::size_t from = 0;
        for (const Index v : reached) stays_[v] = 1;
        for (int ring = 0; ring < rings; ++ring)
            for (const std::size_t end = reached.size(); from < end; ++from)
                for (const Index k : around(reached[from]))
                    if (!std::exchange(stays_[k], std::uint8_t{1})) reached.push_back(k);
    }

    void move() {
        free_.clear();
        for (Index v = 0; v < number_.size(); ++v) {
            number_[v] = stays_[v] != 0 ? no_index : static_cast<Index>(free_.size());
            if (stays_[v] == 0) free_.push_back(v);
        }
        to_membrane();
        to_plate();
    }

private:
    void to_membrane() {
        HarmonicEquations equations;
        std::array<std::vector<double>, 3> known, values;
        for_each_in_order(free_.size(), [&](std::size_t i) {
            Vec3 held(0, 0, 0);
            for (const Index k : around(free_[i]))
                if (number_[k] != no_index)
                    equations.beside.push_back(number_[k]);
                else
                    held += patch_.net.positions[k];
            equations.first.push_back(static_cast<Index>(equations.beside.size()));
            equations.degree.push_back(static_cast<double>(around(free_[i]).size()));
            for (unsigned k = 0; k < 3; ++k) {
                known[k].push_back(held[k]);
                values[k].push_back(patch_.net.positions[free_[i]][k]);
            }
        });
        for (unsigned k = 0; k < 3; ++k) {
            equations.known = std::move(known[k]);
            solve_harmonic(equations, completing::membrane_tolerance, completing::most_steps, values[k]);
            for (std::size_t i = 0; i < free_.size(); ++i) patch_.net.positions[free_[i]][k] = values[k][i];
        }
    }

    void to_plate() {
        if (free_.size() > completing::most_bending) return;
        const std::vector<Vec3> normals = steady_normals();
        std::vector<Index> at = free_;
        for_each_in_order(number_.size(), [&](std::size_t i) {
            const auto v = static_cast<Index>(i);
            if (patch_.held[v] != 0 && continues(v, normals[v])) at.push_back(v);
        });
        const Rows rows = each_less_mean(at);
        Eigen::MatrixX3d target = -rows.of_held;
        for (std::size_t r = free_.size(); r < at.size(); ++r) {
            const Vec3 bend = bend_of_slope(at[r], normals[at[r]]);
            for (unsigned k = 0; k < 3; ++k) target(static_cast<Eigen::Index>(r), k) += bend[k];
        }
        const Matrix transposed = rows.of_free.transpose();
        solve(transposed * rows.of_free, transposed * target);
    }

    using Matrix = Eigen::SparseMatrix<double>;

    /// Vertices less the means of those around them, as a matrix of the free ones and what held ones add.
    struct Rows {
        Matrix of_free;
        Eigen::MatrixX3d of_held;
    };

    std::span<const Index> around(Index v) const { return neighbors_.of(v); }
    /// A held vertex less the mean of those around it where the patch goes on in the mesh's plane: the
    /// membrane's edges turned into it. They are longer by 1 / cos^2 of half the angle of turning, so that a
    /// plate over a disc or a gap becomes as high as the arc that leaves at that angle; as short as the
    /// membrane leaves them across the plane, a dome would be flat.
    Vec3 bend_of_slope(Index v, const Vec3& normal) const {
        const Vec3& p = patch_.net.positions[v];
        const Vec3 away = into_patch(v);
        const double length = away.norm(), rise = length > 0 ? (away | normal) / length : 0,
                     stretch = 2 / (1 + std::sqrt(std::max(0.0, 1 - rise * rise)));
        Vec3 sum(0, 0, 0);
        for (const Index k : around(v)) {
            Vec3 edge = patch_.net.positions[k] - p;
            if (patch_.held[k] == 0) {
                const Vec3 along = edge - normal * (normal | edge);
                if (const double flat = along.norm(); flat > 0) edge = along * (stretch * edge.norm() / flat);
            }
            sum -= edge;
        }
        return sum / static_cast<double>(around(v).size());
    }

    /// Per vertex, do quads lead from it to one that is held? What hangs on nothing completes nothing.
    std::vector<std::uint8_t> attached_vertices() const {
        std::vector<std::uint8_t> attached(patch_.held);
        std::vector<Index> pending;
        for (Index v = 0; v < attached.size(); ++v)
            if (attached[v] != 0) pending.push_back(v);
        while (!pending.empty()) {
            const Index v = pending.back();
            pending.pop_back();
            for (const Index k : around(v))
                if (!std::exchange(attached[k], std::uint8_t{1})) pending.push_back(k);
        }
        return attached;
    }

    /// The mesh's normals at held vertices, levelled along each side of its creases: where points end noise
    /// tilts single ones, and a whole patch goes on along what they say.
    std::vector<Vec3> steady_normals() const {
        std::vector<Vec3> normals = patch_.normals;
        for (int round = 0; round < completing::slope_rounds; ++round) {
            std::vector<Vec3> next = normals;
            for_each_in_order(normals.size(), [&](std::size_t i) {
                const auto v = static_cast<Index>(i);
                if (patch_.held[v] == 0) return;
                for (const Index k : around(v))
                    if (patch_.held[k] != 0 && (normals[k] | normals[v]) > angles::one_sheet)
                        next[v] += normals[k];
                if (const double length = next[v].norm(); length > 0) next[v] *= 1 / length;
            });
            normals = std::move(next);
        }
        return normals;
    }

    /// From a held vertex to the free ones that few edges lead to, summed; 0 where none is beside it.
    Vec3 into_patch(Index v) const {
        Vec3 away(0, 0, 0);
        std::vector<Index> reached{v};
        std::size_t from = 0;
        for (int step = 0; step < completing::crease_reach; ++step)
            for (const std::size_t end = reached.size(); from < end; ++from)
                for (const Index k : around(reached[from])) {
                    if (patch_.held[k] != 0 || std::ranges::find(reached, k) != reached.end()) continue;
                    reached.push_back(k);
                    away += patch_.net.positions[k] - patch_.net.positions[v];
                }
        return away;
    }

    /// Does the patch continue the mesh at a held vertex, rather than meet it in a crease?
    bool continues(Index v, const Vec3& normal) const {
        const auto is_free = [&](Index k) { return patch_.held[k] == 0; };
        if (std::ranges::none_of(around(v), is_free)) return false;
        const Vec3 away = into_patch(v);
        return std::abs(away | normal) <= completing::crease_sine * away.norm();
    }

    Rows each_less_mean(std::span<const Index> vertices) const {
        const auto count = static_cast<Eigen::Index>(vertices.size());
        Rows rows{Matrix(count, static_cast<Eigen::Index>(free_.size())), Eigen::MatrixX3d::Zero(count, 3)};
        std::vector<Eigen::Triplet<double>> entries;
        for (Eigen::Index r = 0; r < count; ++r) {
            const auto add = [&](Index v, double value) {
                if (number_[v] != no_index)
                    entries.emplace_back(static_cast<int>(r), static_cast<int>(number_[v]), value);
                else
                    for (unsigned k = 0; k < 3; ++k) rows.of_held(r, k) += value * patch_.net.positions[v][k];
            };
            const Index vertex = vertices[static_cast<std::size_t>(r)];
            const auto valence = static_cast<double>(around(vertex).size());
            add(vertex, 1);
            for (const Index k : around(vertex)) add(k, -1 / valence);
        }
        rows.of_free.setFromTriplets(entries.begin(), entries.end());
        return rows;
    }

    /// Moves the free vertices to where matrix * positions = target.
    void solve(Matrix matrix, Eigen::MatrixX3d target) {
        const auto count = static_cast<Eigen::Index>(free_.size());
        if (count == 0) return;
        for (Eigen::Index i = 0; i < count; ++i) {
            const Vec3& p = patch_.net.positions[free_[static_cast<std::size_t>(i)]];
            matrix.coeffRef(i, i) += completing::hold;
            for (unsigned k = 0; k < 3; ++k) target(i, k) += completing::hold * p[k];
        }
        const Eigen::SimplicialLDLT<Matrix> factors(matrix);
        if (factors.info() != Eigen::Success) return;
        const Eigen::MatrixX3d x = factors.solve(target);
        if (!x.allFinite()) return;
        for (Eigen::Index i = 0; i < count; ++i)
            patch_.net.positions[free_[static_cast<std::size_t>(i)]] = Vec3(x(i, 0), x(i, 1), x(i, 2));
    }

    CompletionPatch& patch_;
    VertexNeighbors neighbors_;
    std::vector<Index> number_;       // per vertex, which of the free ones it is, or no_index
    std::vector<std::uint8_t> stays_; // per vertex
    std::vector<Index> free_;
};

/// Places the vertices of a patch: where the mesh passes their cells' edges, or else the missing surface;
/// where both do, on the mesh's border.
class Placing {
public:
    explicit Placing(CompletionPatch& patch)
        : patch_(patch), hits_(patch.net.positions.size()), missing_(hits_.size()), border_(hits_.size()) {}

    void add(std::span<const Index> corners, const Passage& at) {
        for (const Index v : corners) {
            (at.missing ? missing_ : hits_)[v].add(at.position);
            patch_.normals[v] += at.normal;
        }
    }
    void add_border(Index v, const Vec3& position) { border_[v].add(position); }

    void finish() {
        for (std::size_t v = 0; v < hits_.size(); ++v) {
            patch_.held[v] = hits_[v].count > 0;
            const bool at_border = hits_[v].count > 0 && missing_[v].count > 0 && border_[v].count > 0;
            patch_.net.positions[v] = (at_border             ? border_[v]
                                       : patch_.held[v] != 0 ? hits_[v]
                                                             : missing_[v])
                                          .mean();
            const double length = patch_.normals[v].norm();
            if (length > 0) patch_.normals[v] *= 1 / length;
        }
    }

private:
    struct Mean {
        Vec3 sum{0, 0, 0};
        int count = 0;

        void add(const Vec3& p) { sum += p, ++count; }
        Vec3 mean() const { return sum / std::max(count, 1); }
    };

    CompletionPatch& patch_;
    std::vector<Mean> hits_, missing_, border_;
};

/// Vertices that lie in known space and did not before.
std::vector<Index> entered(const KnownSpace& space, const CompletionPatch& patch,
                           const std::vector<Vec3>& before) {
    if (!space.holds) return {};
    return indices_where(before.size(), chunks::usual, [&](Index v) {
        return patch.held[v] == 0 && space.holds(patch.net.positions[v]) && !space.holds(before[v]);
    });
}

/// Fairs a patch; as long as that takes vertices to where they may not be (`wrong`, given their positions
/// before), they and more and more around them stay.
template <class Wrong>
void fair_unless(CompletionPatch& patch, Wrong&& wrong) {
    const std::vector<Vec3> net = patch.net.positions;
    Fairing fairing(patch);
    for (int round = 0, rings = 1;; ++round, rings *= 2) {
        fairing.move();
        const std::vector<Index> stopped = wrong(net);
        if (stopped.empty() || round + 1 == enough_rounds) return;
        fairing.stop(stopped, rings);
        patch.net.positions = net;
    }
}

} // namespace

CompletionPatch completion_patch(const CompletionField& field, const PolygonMesh& mesh,
                                 const BoundaryLoops& border) {
    const LatticePlace& place = field.lattice.place;
    const std::vector<MortonCode> cells = cells_of(field);
    const std::size_t count = cells.size();
    CompletionPatch patch{{}, std::vector<Vec3>(count, Vec3(0, 0, 0)), std::vector<std::uint8_t>(count), {}};
    patch.net.positions.resize(count);
    Placing placing(patch);
    MortonIndex number;
    number.build(cells);
    const auto vertex_in = [&](const VoxelCoord& cell) {
        return place.holds(cell) ? number.find(morton_encode(cell)) : no_index;
    };
    for_each_in_order(3 * field.lattice.size(), [&](std::size_t e) {
        const auto around =
            cells_around(field.lattice.coord(static_cast<Index>(e / 3)), static_cast<unsigned>(e % 3));
        std::array<Index, 4> corners;
        for (unsigned j = 0; j < 4; ++j)
            if (corners[j] = vertex_in(around[j]); corners[j] == no_index) return;
        const Passage at = passage(field, e);
        if (!at.passes) return;
        placing.add(corners, at);
        if (!at.leaving) std::reverse(corners.begin(), corners.end());
        patch.net.add_facet(corners);
        patch.missing.push_back(at.missing);
    });
    for_each_sample(mesh, border, 0.5 * place.spacing, [&](const Vec3& p) {
        const Vec3 local = place.local(p);
        const Index v =
            vertex_in({static_cast<int>(std::floor(local[0])), static_cast<int>(std::floor(local[1])),
                       static_cast<int>(std::floor(local[2]))});
        if (v != no_index) placing.add_border(v, p);
    });
    placing.finish();
    return patch;
}

void fair(CompletionPatch& patch, const KnownSpace& space) {
    fair_unless(patch, [&](const std::vector<Vec3>& net) { return entered(space, patch, net); });
}

void fair_beside(const PolygonMesh& mesh, CompletionPatch& patch, const KnownSpace& space) {
    fair_unless(patch, [&](const std::vector<Vec3>& net) {
        std::vector<Index> wrong = entered(space, patch, net);
        for (const Index v : crossed_moves(mesh, patch, net)) wrong.push_back(v);
        sort_unique(wrong);
        return wrong;
    });
}

} // namespace hsdm
