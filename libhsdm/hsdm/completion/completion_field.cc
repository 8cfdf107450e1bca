#include "hsdm/completion/completion_field.hh"

#include "hsdm/completion/conjugate_gradients.hh"
#include "hsdm/completion/constants.hh"
#include "hsdm/errors.hh"

#include <cmath>

namespace hsdm {
namespace {

/// The places of all levels, the coarsest first.
std::vector<LatticePlace> places(const Box& box, double spacing) {
    const double extent = box.extent(), room = completing::margin * extent;
    int levels = 1;
    while (std::ldexp(spacing, levels - 1) * completing::coarsest_cells < extent) ++levels;
    const double coarsest = std::ldexp(spacing, levels - 1);
    LatticePlace place{{0, 0, 0}, coarsest, {}};
    for (unsigned k = 0; k < 3; ++k) {
        const double cells = std::ceil((box.size()[k] + 2 * room) / coarsest) + 1;
        place.last[k] = static_cast<int>(cells);
        // No plane of the lattice passes the box's own faces, where those of a part often lie.
        place.origin[k] = 0.5 * (box.lo[k] + box.hi[k]) - 0.5 * cells * coarsest + spacing * 0.0618;
    }
    std::vector<LatticePlace> result(static_cast<std::size_t>(levels), place);
    for (std::size_t l = 1; l < result.size(); ++l) {
        result[l].spacing = 0.5 * result[l - 1].spacing;
        for (unsigned k = 0; k < 3; ++k) result[l].last[k] = 2 * result[l - 1].last[k];
    }
    return result;
}

/// The value at a finer grid point, by trilinear interpolation of what there is.
double interpolated(const CompletionField& coarse, const VoxelCoord& fine) {
    double sum = 0, weight = 0;
    for (unsigned corner = 0; corner < 8; ++corner) {
        VoxelCoord c;
        bool apart = true;
        for (unsigned k = 0; k < 3; ++k) {
            const auto upper = static_cast<int>(corner >> k & 1u);
            apart = apart && (upper == 0 || fine[k] % 2 == 1);
            c[k] = fine[k] / 2 + upper;
        }
        const Index point = apart ? coarse.lattice.find(c) : no_index;
        if (point == no_index) continue;
        sum += coarse.value[point];
        weight += 1;
    }
    return weight > 0 ? sum / weight : 0;
}

/// The values of grid points beside the mesh: their distances from its planes, signed.
void hold_beside_mesh(CompletionField& field) {
    const Lattice& lattice = field.lattice;
    std::vector<double> nearest(lattice.size(), Box::inf);
    for_each_beside(lattice, [&](Index point, double distance) {
        if (std::abs(distance) >= nearest[point]) return;
        nearest[point] = std::abs(distance);
        field.known[point] = Known::beside_mesh;
        field.value[point] = distance * lattice.place.spacing;
    });
}

/// Solves for the values that nobody knows: each the mean of those around it.
void solve(CompletionField& field) {
    const Lattice& lattice = field.lattice;
    const std::vector<Index> unknown = indices_where(
        lattice.size(), chunks::light, [&](Index i) { return field.known[i] == Known::solved; });
    std::vector<Index> number = large_vector<Index>(lattice.size(), no_index);
    for_each_index(unknown.size(), chunks::light, [&](Index row) { number[unknown[row]] = row; });
    HarmonicEquations equations;
    std::vector<double> values = large_vector<double>(unknown.size());
    for_each_in_order(unknown.size(), [&](std::size_t row) {
        double degree = 0, known = 0;
        for (const Index k : lattice.next[unknown[row]]) {
            if (k == no_index) continue;
            ++degree;
            if (field.known[k] == Known::solved)
                equations.beside.push_back(number[k]);
            else
                known += field.value[k];
        }
        equations.first.push_back(static_cast<Index>(equations.beside.size()));
        equations.degree.push_back(degree);
        equations.known.push_back(known);
        values[row] = field.value[unknown[row]];
    });
    solve_harmonic(equations, completing::tolerance, completing::most_steps, values);
    for_each_index(unknown.size(), chunks::light,
                   [&](Index row) { field.value[unknown[row]] = values[row]; });
}

/// Solves, and once more with grid points of known space held on its side that came out on the other; unless
/// the mesh is beside them, which says more. Held from the start they would draw the surface off also where
/// it keeps out of that space. Held ones draw others to their own side only, so once is enough.
void solve_beside(const KnownSpace& space, CompletionField& field) {
    solve(field);
    if (!space.holds) return;
    const Lattice& lattice = field.lattice;
    const double value = (space.outside ? 0.5 : -0.5) * lattice.place.spacing;
    const std::vector<Index> wrong = indices_where(lattice.size(), chunks::usual, [&](Index i) {
        return (field.value[i] > 0) != space.outside && field.known[i] != Known::beside_mesh
               && space.holds(lattice.place.position(lattice.coord(i)));
    });
    if (wrong.empty()) return;
    for_each_index(wrong.size(), chunks::light, [&](Index k) {
        field.known[wrong[k]] = Known::seen;
        field.value[wrong[k]] = value;
    });
    solve(field);
}

CompletionField coarsest_field(const LatticePlace& place, const PolygonMesh& mesh, const KnownSpace& space) {
    CompletionField field{build_lattice(place, all_points(place), mesh), {}, {}};
    assign_large(field.value, field.lattice.size(), 0.5 * place.spacing);
    assign_large(field.known, field.lattice.size(), Known::solved);
    for_each_index(field.lattice.size(), chunks::light, [&](Index i) {
        if (std::ranges::find(field.lattice.next[i], no_index) != field.lattice.next[i].end())
            field.known[i] = Known::given;
    });
    hold_beside_mesh(field);
    solve_beside(space, field);
    return field;
}

/// Finer grid points of known space that lie on its other side on the coarser level: what is too narrow for
/// that one.
std::vector<MortonCode> points_overlooked(const CompletionField& coarse, const LatticePlace& place,
                                          const KnownSpace& space) {
    if (!space.holds) return {};
    const auto of_point = [&](Index i, std::vector<MortonCode>& codes) {
        if ((coarse.value[i] > 0) == space.outside) return;
        const VoxelCoord c = coarse.lattice.coord(i);
        for (int corner = 0; corner < 8; ++corner) {
            const VoxelCoord fine{2 * c[0] + (corner & 1), 2 * c[1] + (corner >> 1 & 1),
                                  2 * c[2] + (corner >> 2)};
            if (place.holds(fine) && space.holds(place.position(fine))) codes.push_back(morton_encode(fine));
        }
    };
    return collected<MortonCode>(coarse.lattice.size(), chunks::usual,
                                 [&](std::size_t begin, std::size_t end, std::vector<MortonCode>& part) {
                                     for (std::size_t i = begin; i < end; ++i)
                                         of_point(static_cast<Index>(i), part);
                                 });
}

/// The grid points around what is missing: the open edges of the coarser level, and the mesh's border.
std::vector<MortonCode> points_around(const CompletionField& coarse, const LatticePlace& place,
                                      const PolygonMesh& mesh, const BoundaryLoops& border,
                                      const KnownSpace& space) {
    std::vector<MortonCode> codes = points_overlooked(coarse, place, space);
    const auto add = [&](const VoxelCoord& c) {
        if (place.holds(c)) codes.push_back(morton_encode(c));
    };
    for (std::size_t e = 0; e < 3 * coarse.lattice.size(); ++e) {
        if (!coarse.is_open(e)) continue;
        VoxelCoord c = coarse.lattice.coord(static_cast<Index>(e / 3));
        for (int& k : c) k *= 2;
        for (int step = 0; step <= 2; ++step, ++c[e % 3]) add(c);
    }
    for_each_sample(mesh, border, place.spacing, [&](const Vec3& p) {
        const Vec3 x = place.local(p);
        add({static_cast<int>(std::lround(x[0])), static_cast<int>(std::lround(x[1])),
             static_cast<int>(std::lround(x[2]))});
    });
    dilate(place, completing::band + 1, codes);
    return codes;
}

constexpr std::size_t bytes_per_grid_point = 200;

void refuse_large(std::size_t grid_points, std::size_t most_bytes) {
    const std::size_t bytes = grid_points * bytes_per_grid_point;
    if (bytes > most_bytes)
        throw Error(
            "completing what is missing takes about " + std::to_string((bytes + 999999) / 1000000)
            + " MB beside the mesh, which is held in memory; give --memory that much more, or --holes "
              "auto");
}

CompletionField finer_field(const CompletionField& coarse, const LatticePlace& place, const PolygonMesh& mesh,
                            const BoundaryLoops& border, const KnownSpace& space, std::size_t most_bytes) {
    std::vector<MortonCode> points = points_around(coarse, place, mesh, border, space);
    refuse_large(points.size(), most_bytes);
    CompletionField field{build_lattice(place, std::move(points), mesh), {}, {}};
    const std::size_t size = field.lattice.size();
    resize_large(field.value, size);
    resize_large(field.known, size);
    for_each_index(size, chunks::usual, [&](Index i) {
        field.value[i] = interpolated(coarse, field.lattice.coord(i));
        const bool at_end = std::ranges::find(field.lattice.next[i], no_index) != field.lattice.next[i].end();
        field.known[i] = at_end ? Known::given : Known::solved;
    });
    hold_beside_mesh(field);
    solve_beside(space, field);
    return field;
}

} // namespace

CompletionField completion_field(const PolygonMesh& mesh, const BoundaryLoops& border, double spacing,
                                 const KnownSpace& known_space, std::size_t most_bytes) {
    Box box;
    for (const Vec3& p : mesh.positions) box.add(p);
    const std::vector<LatticePlace> levels = places(box, spacing);
    CompletionField field = coarsest_field(levels[0], mesh, known_space);
    for (std::size_t l = 1; l < levels.size(); ++l)
        field = finer_field(field, levels[l], mesh, border, known_space, most_bytes);
    return field;
}

} // namespace hsdm
