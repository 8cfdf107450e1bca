#include "hsdm/contour/untangle.hh"

#include "hsdm/contour/untangle_rounds.hh"
#include "hsdm/core/check_option.hh"

namespace hsdm {
namespace {

/// Mean of the vertices joined to v by an edge, for every vertex.
std::vector<Vec3> neighbour_means(const PolygonMesh& mesh) {
    std::vector<Vec3> sums(mesh.vertex_count(), Vec3(0, 0, 0));
    std::vector<double> counts(mesh.vertex_count(), 0);
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        const auto ring = mesh.facet(f);
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Index a = ring[i], b = ring[(i + 1) % ring.size()];
            sums[a] += mesh.positions[b];
            sums[b] += mesh.positions[a];
            ++counts[a];
            ++counts[b];
        }
    }
    for (std::size_t v = 0; v < sums.size(); ++v)
        sums[v] = counts[v] > 0 ? sums[v] / counts[v] : mesh.positions[v];
    return sums;
}

void validate(const UntangleOptions& options) {
    check_option(options.rounds >= 0, "rounds", options.rounds, "be 0 or more");
    check_option(options.step > 0 && options.step <= 1, "step", options.step, "lie in (0, 1]");
    check_option(options.nearby > 0, "nearby", options.nearby, "be positive");
    check_option(!(options.reach < 0), "reach", options.reach, "be 0 or more");
}

} // namespace

void UntangleRounds::move() {
    const std::vector<Vec3> means = neighbour_means(part_);
    std::vector<std::uint8_t> due(part_.vertex_count(), 0);
    for (const auto& pair : found_.facet_pairs)
        for (Index f : pair)
            for (Index v : part_.facet(f)) due[v] = around_.inner(v);
    for (Index v = 0; v < due.size(); ++v) {
        if (!due[v]) continue;
        Vec3& p = part_.positions[v];
        p += (means[v] - p) * options_.step;
        const Vec3 way = p - start_[v];
        if (options_.reach > 0 && way.norm() > options_.reach)
            p = start_[v] + way * (options_.reach / way.norm());
    }
    find();
}

UntangleCounts untangle(PolygonMesh& mesh, const UntangleOptions& options, const FacetCells* cells) {
    validate(options);
    const SelfIntersections found =
        cells ? find_self_intersections(mesh, *cells) : find_self_intersections(mesh);
    UntangleCounts counts;
    counts.before = counts.after = found.triangle_pairs;
    counts.pairs = found.facet_pairs.size();
    if (found.triangle_pairs == 0) return counts;
    Index first = mesh.facet(found.facet_pairs[0][0])[0];
    counts.first = mesh.positions[first];
    if (options.rounds == 0) return counts;

    TangledPart around(mesh, found.facet_pairs, options.nearby);
    UntangleRounds rounds(around, options);
    const std::vector<Vec3>& start = rounds.start();
    std::vector<Vec3> best = start;
    const auto first_of = [&] { return around.part.facet(rounds.found().facet_pairs[0][0])[0]; };
    std::size_t fewest = rounds.found().triangle_pairs;
    counts.pairs = rounds.found().facet_pairs.size();
    if (fewest > 0) first = first_of();
    for (int round = 0; round < options.rounds && rounds.found().triangle_pairs > 0; ++round) {
        rounds.move();
        if (rounds.found().triangle_pairs >= fewest) continue;
        fewest = rounds.found().triangle_pairs;
        counts.pairs = rounds.found().facet_pairs.size();
        best = around.part.positions;
        if (fewest > 0) first = first_of();
    }
    around.part.positions = best;
    for (std::size_t v = 0; v < best.size(); ++v) counts.moved += best[v] != start[v];
    around.write_back(mesh);
    counts.after = fewest;
    if (fewest > 0) counts.first = best[first];
    return counts;
}

} // namespace hsdm
