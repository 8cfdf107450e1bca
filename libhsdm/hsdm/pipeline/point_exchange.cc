#include "hsdm/pipeline/point_exchange.hh"

#include "hsdm/core/interruption.hh"

namespace hsdm {

PointExchange::PointExchange(Ranks& ranks, std::size_t most_points, Receive receive)
    : ranks_(ranks),
      most_points_(most_points),
      receive_(std::move(receive)),
      out_(static_cast<std::size_t>(ranks.size())) {}

void PointExchange::add(int to, const PointRow& row) {
    put(row, out_[static_cast<std::size_t>(to)]);
    if (++waiting_ >= most_points_) round(true);
}

void PointExchange::finish() {
    while (round(false)) {
    }
}

bool PointExchange::round(bool has_more) {
    Interruption::poll();
    const bool again = ranks_.any(has_more);
    std::vector<Ranks::Bytes> out(out_.size());
    out.swap(out_);
    waiting_ = 0;
    for (const Ranks::Bytes& got : ranks_.exchange(std::move(out))) {
        ByteReader reader(got);
        while (!reader.at_end()) receive_(reader.take<PointRow>());
    }
    return again;
}

} // namespace hsdm
