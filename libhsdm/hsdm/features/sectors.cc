#include "hsdm/features/sectors.hh"

#include "hsdm/mesh/facet_normal.hh"

#include <algorithm>

namespace hsdm {
namespace {

struct Sector {
    Vec3 sum{0, 0, 0};
    double weight = 0;

    void add(const FanFacet& facet) {
        sum += facet.normal * facet.weight;
        weight += facet.weight;
    }
};

/// The heaviest three of the sectors seen; among equals the earlier stays first.
class Heaviest {
public:
    void add(const Sector& sector) {
        if (!(sector.sum.sqrnorm() > 0)) return;
        std::size_t at = count_;
        while (at > 0 && sector.weight > sectors_[at - 1].weight) --at;
        if (at == sectors_.size()) return;
        count_ = std::min(count_ + 1, sectors_.size());
        std::move_backward(sectors_.begin() + at, sectors_.begin() + count_ - 1, sectors_.begin() + count_);
        sectors_[at] = sector;
    }
    SectorNormals normals() const {
        SectorNormals result;
        result.count = static_cast<int>(count_);
        for (std::size_t i = 0; i < count_; ++i) result.normals[i] = unit_or_zero(sectors_[i].sum);
        return result;
    }

private:
    std::array<Sector, 3> sectors_;
    std::size_t count_ = 0;
};

} // namespace

SectorNormals sector_normals(std::span<const FanFacet> fan) {
    const auto first_cut = static_cast<std::size_t>(
        std::find_if(fan.begin(), fan.end(), [](const FanFacet& f) { return f.cut; }) - fan.begin());
    const std::size_t start = first_cut < fan.size() ? first_cut : 0;
    Heaviest heaviest;
    Sector sector;
    for (std::size_t i = 0; i < fan.size(); ++i) {
        const FanFacet& facet = fan[(start + i) % fan.size()];
        if (i > 0 && facet.cut) {
            heaviest.add(sector);
            sector = {};
        }
        sector.add(facet);
    }
    heaviest.add(sector);
    return heaviest.normals();
}

VertexClass vertex_class(int sharp_edges, double turn, double corner_angle) {
    if (sharp_edges == 0) return VertexClass::smooth;
    if (sharp_edges > 2 || (sharp_edges == 2 && turn > corner_angle)) return VertexClass::corner;
    return VertexClass::edge;
}

} // namespace hsdm
