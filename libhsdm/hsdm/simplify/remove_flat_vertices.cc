#include "hsdm/simplify/remove_flat_vertices.hh"

#include "hsdm/core/constants.hh"
#include "hsdm/simplify/constants.hh"
#include "hsdm/simplify/triangle_shape.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

class FlatVertexRemoval {
public:
    FlatVertexRemoval(CollapsingMesh& mesh, const std::vector<double>& reach) : mesh_(mesh), reach_(reach) {}

    std::size_t round() {
        const std::vector<Index> out = mesh_.sides_out();
        std::size_t removed = 0;
        for (Index v = 0; v < out.size(); ++v)
            if (out[v] != no_index && !mesh_.is_gone(out[v]) && mesh_.start(out[v]) == v && may_go(out[v]))
                removed += take_out(out[v]);
        return removed;
    }

private:
    const Vec3& at(Index v) const { return mesh_.at(v); }

    /// Is the start of a side on a flat place or a straight crease? Leaves its neighbours in ring_, starting
    /// at one end of the crease, and the position of its other end in other_end_ (0 on a flat place).
    bool may_go(Index side) {
        vertex_ = mesh_.start(side);
        if (!gives_way(vertex_) || !mesh_.ring_of(side, ring_) || ring_.size() > bounds::most_squared)
            return false;
        normals_.clear();
        for (std::size_t i = 0; i < ring_.size(); ++i)
            normals_.push_back(triangle_normal(at(vertex_), at(ring_[i]), at(ring_[(i + 1) % ring_.size()])));
        std::size_t ends[2] = {0, 0}, count = 0;
        for (std::size_t i = 0; i < ring_.size(); ++i) {
            const Vec3 &before = normals_[(i + ring_.size() - 1) % ring_.size()], &after = normals_[i];
            if ((before | after) > flat_vertices::flat_cosine * before.norm() * after.norm()) continue;
            if (count == 2) return false;
            ends[count++] = i;
        }
        if (count == 1) return false;
        const auto by = static_cast<std::ptrdiff_t>(ends[0]);
        std::rotate(ring_.begin(), ring_.begin() + by, ring_.end());
        std::rotate(normals_.begin(), normals_.begin() + by, normals_.end());
        other_end_ = ends[1] - ends[0];
        return count == 0 || is_straight(at(ring_[0]), at(ring_[other_end_]));
    }

    /// May the vertex merge into others, and others into it?
    bool gives_way(Index v) const { return reach_[v] > 0 && !mesh_.is_locked(v); }

    /// Does a crease go straight on at the vertex?
    bool is_straight(const Vec3& a, const Vec3& b) const {
        const Vec3 to_a = a - at(vertex_), to_b = b - at(vertex_);
        return (to_a | to_b) < 0 && (to_a % to_b).norm() <= reach_[vertex_] * (b - a).norm();
    }

    bool take_out(Index side) {
        least_ = collapses::least_shape;
        for (std::size_t i = 0; i < ring_.size(); ++i)
            least_ = std::min(least_,
                              triangle_shape(at(vertex_), at(ring_[i]), at(ring_[(i + 1) % ring_.size()])));
        turned_.clear();
        const bool is_ring = other_end_ == 0;
        if (is_ring ? !turn_edges(0, ring_.size(), true)
                    : !turn_edges(0, other_end_, false) || !turn_edges(other_end_, ring_.size(), false))
            return false;
        if (!is_ring) chain_ = {ring_[0], ring_[other_end_]};
        if (std::ranges::none_of(chain_, [&](Index onto) { return gives_way(onto); })) return false;
        side = side_to(side, chain_[0]);
        flipped_.clear();
        bool goes = true;
        for (std::size_t i = 0; i < turned_.size() && goes; ++i) {
            const Index edge = side_to(side, turned_[i]);
            goes = mesh_.flip(edge);
            if (goes) flipped_.push_back(previous_side(edge));
        }
        goes = goes && std::ranges::any_of(chain_, [&](Index onto) {
                   return gives_way(onto) && mesh_.collapse(side_to(side, onto), at(onto));
               });
        while (!goes && !flipped_.empty()) {
            mesh_.take_back_flip(flipped_.back());
            flipped_.pop_back();
        }
        return goes;
    }

    /// Chooses the edges of the vertex to flip: appends to turned_, in order, the neighbours that they lead
    /// to, so that between the crease's ends the vertex keeps one neighbour, or of a whole ring three or
    /// four; the remaining neighbours are left in chain_. False if that is impossible.
    bool turn_edges(std::size_t begin, std::size_t end, bool is_ring) {
        Vec3 up(0, 0, 0);
        for (std::size_t i = begin; i < end; ++i) up += normals_[i];
        chain_.clear();
        for (std::size_t i = begin; i < end + (is_ring ? 0 : 1); ++i)
            chain_.push_back(ring_[i % ring_.size()]);
        const double length = up.norm();
        for (Index v : chain_)
            if (std::abs(up | (at(v) - at(vertex_))) > reach_[vertex_] * length) return false;
        while (chain_.size() > 3) {
            const std::size_t ear = best_ear(up, is_ring);
            if (ear == chain_.size()) break;
            turned_.push_back(chain_[ear]);
            chain_.erase(chain_.begin() + static_cast<std::ptrdiff_t>(ear));
        }
        // Of a ring four may be left, if the vertex lies on the line between two of them.
        return chain_.size() == 3 || (is_ring && chain_.size() == 4);
    }

    /// Among the neighbours in the chain that can be cut off (the two beside them see each other) the one
    /// with the best triangles; chain_.size() if there is none.
    std::size_t best_ear(const Vec3& up, bool is_ring) const {
        const std::size_t n = chain_.size();
        std::size_t best = n;
        double best_shape = least_;
        for (std::size_t i = is_ring ? 0 : 1; i < (is_ring ? n : n - 1); ++i) {
            const Vec3& before = at(chain_[(i + n - 1) % n]);
            const Vec3 &here = at(chain_[i]), &after = at(chain_[(i + 1) % n]);
            if ((triangle_normal(before, here, after) | up) <= 0
                || (triangle_normal(at(vertex_), before, after) | up) <= 0)
                continue;
            const double shape =
                std::min(triangle_shape(before, here, after), triangle_shape(at(vertex_), before, after));
            if (shape < best_shape) continue;
            best_shape = shape;
            best = i;
        }
        return best;
    }

    /// The side from the start of this one to a neighbour.
    Index side_to(Index side, Index neighbour) const {
        while (mesh_.end(side) != neighbour) side = mesh_.twin(previous_side(side));
        return side;
    }

    CollapsingMesh& mesh_;
    const std::vector<double>& reach_;
    Index vertex_ = no_index;
    std::vector<Index> ring_, chain_, turned_, flipped_;
    std::vector<Vec3> normals_; // per neighbour, of the triangle between it and the next
    std::size_t other_end_ = 0;
    double least_ = 0;
};

} // namespace

std::size_t remove_flat_vertices(CollapsingMesh& mesh, const std::vector<double>& reach) {
    FlatVertexRemoval removal(mesh, reach);
    std::size_t removed = 0;
    for (int round = 0; round < enough_rounds; ++round) {
        const std::size_t now = removal.round();
        if (now == 0) break;
        removed += now;
    }
    return removed;
}

} // namespace hsdm
