#include "hsdm/pipeline/point_exchange.hh"

#include "hsdm/core/interruption.hh"

#include <cstring>

namespace hsdm {

PointExchange::PointExchange(Ranks& ranks, std::size_t most_points, std::size_t beside, Receive receive)
    : ranks_(ranks),
      most_points_(most_points),
      beside_(beside),
      receive_(std::move(receive)),
      out_(static_cast<std::size_t>(ranks.size())) {}

void PointExchange::add(int to, const PointRow& row, const char* beside) {
    Ranks::Bytes& out = out_[static_cast<std::size_t>(to)];
    put(row, out);
    append_bytes(beside, beside_, out);
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
        PointRow row;
        for (std::size_t at = 0; at < got.size(); at += sizeof row + beside_) {
            std::memcpy(&row, got.data() + at, sizeof row);
            receive_(row, got.data() + at + sizeof row);
        }
    }
    return again;
}

} // namespace hsdm
