#include "hsdm/contour/blunt_creases.hh"

#include "hsdm/contour/constants.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

constexpr int most_rounds = 3; // of sorting samples anew by the means of the round before

/// Weighted means of one face.
struct Face {
    Vec3 position{0, 0, 0}, normal{0, 0, 0};
    double weight = 0;

    void add(const CreaseSample& s) {
        position += s.weight * s.position;
        normal += s.weight * s.normal;
        weight += s.weight;
    }
    void divide() {
        position /= weight;
        normal.normalize();
    }
};

using Faces = std::array<Face, 2>;

/// The two normals farthest from the mean and from each other.
std::array<Vec3, 2> farthest_normals(std::span<const CreaseSample> samples) {
    Vec3 mean(0, 0, 0);
    for (const CreaseSample& s : samples) mean += s.weight * s.normal;
    const auto farthest = [&](const Vec3& from) {
        return std::ranges::min_element(samples, {}, [&](const CreaseSample& s) { return s.normal | from; })
            ->normal;
    };
    const Vec3 one = farthest(mean);
    return {one, farthest(one)};
}

Faces means(std::span<const CreaseSample> samples, std::span<const std::uint8_t> face) {
    Faces faces;
    for (std::size_t i = 0; i < samples.size(); ++i) faces[face[i]].add(samples[i]);
    return faces;
}

/// Is nearly every sample on its face's side of the line where the two planes meet?
bool lie_apart(std::span<const CreaseSample> samples, std::span<const std::uint8_t> face, const Faces& faces,
               bool is_convex) {
    double astray = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Vec3& p = samples[i].position;
        const double above =
            (faces[1].normal | (p - faces[1].position)) - (faces[0].normal | (p - faces[0].position));
        if ((above > 0) == (is_convex == (face[i] == 0))) astray += samples[i].weight;
    }
    return astray <= blunt_creases::most_astray * (faces[0].weight + faces[1].weight);
}

/// Sorts samples by the nearer of two mean normals. False if a face weighs too little, or if both are one.
bool group_by_normals(std::span<const CreaseSample> samples, double least_weight,
                      std::span<std::uint8_t> face, Faces& faces) {
    std::array<Vec3, 2> modes = farthest_normals(samples);
    if ((modes[0] | modes[1]) > blunt_creases::bluntest_cosine) return false;
    for (int round = 0; round < most_rounds; ++round) {
        bool same = round > 0; // faces then are what they were, and so are their means
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const bool second = (samples[i].normal | modes[1]) > (samples[i].normal | modes[0]);
            same = same && face[i] == second;
            face[i] = second;
        }
        if (same) break;
        faces = means(samples, face);
        if (faces[0].weight < least_weight || faces[1].weight < least_weight) return false;
        for (std::size_t k : {0u, 1u}) {
            faces[k].divide();
            modes[k] = faces[k].normal;
        }
    }
    return (modes[0] | modes[1]) <= blunt_creases::bluntest_cosine;
}

/// Do normals scatter little within the faces, and turn little along them?
bool are_flat(std::span<const CreaseSample> samples, std::span<const std::uint8_t> face, const Faces& faces) {
    Vec3 bend = faces[1].normal - faces[0].normal;
    const double size = bend.norm();
    bend /= size;
    double scatter = 0, turn = 0, extent = 0; // of normals; with positions along the bend; of these
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const CreaseSample& s = samples[i];
        const Vec3 n = s.normal - faces[face[i]].normal;
        const double along = (s.position - faces[face[i]].position) | bend;
        scatter += s.weight * n.sqrnorm();
        turn += s.weight * (s.turn + (n | bend) * along);
        extent += s.weight * (along * along + (s.spread != nullptr ? s.spread->along(bend) : 0));
    }
    const double weight = faces[0].weight + faces[1].weight;
    const double way = (faces[1].position - faces[0].position) | bend;
    return scatter <= std::pow(blunt_creases::most_scatter * size, 2) * weight
           && is_nearer_to_flat(turn, extent * size, way);
}

} // namespace

bool find_blunt_crease(std::span<const CreaseSample> samples, double least_weight,
                       std::span<std::uint8_t> face, BluntCrease& crease) {
    Faces faces;
    if (samples.size() < 2 || !group_by_normals(samples, least_weight, face, faces)
        || !are_flat(samples, face, faces))
        return false;
    crease.normals = {faces[0].normal, faces[1].normal};
    crease.is_convex = ((faces[1].position - faces[0].position) | (faces[1].normal - faces[0].normal)) > 0;
    return lie_apart(samples, face, faces, crease.is_convex);
}

} // namespace hsdm
