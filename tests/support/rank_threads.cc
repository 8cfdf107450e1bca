#include "support/rank_threads.hh"

#include "hsdm/errors.hh"

#include <barrier>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <thread>

namespace hsdm::support {
namespace {

/// What the threads share: a place for what each gives, which all take between two barriers.
struct Table {
    explicit Table(int count) : given(static_cast<std::size_t>(count)), barrier(count) {}
    std::vector<std::vector<Ranks::Bytes>> given; // by the rank that gives, then by the one that takes
    std::barrier<> barrier;
};

class RankThread final : public Ranks {
public:
    RankThread(Table& table, int rank, const OpenShared& open) : table_(table), rank_(rank), open_(open) {}
    int rank() const override { return rank_; }
    int size() const override { return static_cast<int>(table_.given.size()); }
    std::unique_ptr<SharedFile> open_shared(const std::string& path) override {
        return open_ ? open_(rank_, path) : Ranks::open_shared(path);
    }

private:
    std::vector<Bytes> gather_bytes(const Bytes& own) override {
        return exchange_bytes(std::vector<Bytes>(table_.given.size(), own), {});
    }
    std::vector<Bytes> exchange_bytes(std::vector<Bytes>&& out,
                                      const std::vector<std::vector<std::uint64_t>>&) override {
        const auto self = static_cast<std::size_t>(rank_);
        table_.given[self] = std::move(out);
        table_.barrier.arrive_and_wait();
        std::vector<Bytes> got;
        for (const auto& of_rank : table_.given) got.push_back(of_rank[self]);
        table_.barrier.arrive_and_wait();
        return got;
    }
    [[noreturn]] void abort(const std::string&) noexcept override { std::abort(); }

    Table& table_;
    int rank_;
    const OpenShared& open_;
};

} // namespace

std::vector<std::string> run_ranks(int count, const std::function<void(Ranks&)>& work,
                                   const OpenShared& open) {
    return run_ranks_apart(
        count, [&](Ranks& ranks) { ranks.together([&] { work(ranks); }); }, open);
}

std::vector<std::string> run_ranks_apart(int count, const std::function<void(Ranks&)>& work,
                                         const OpenShared& open) {
    Table table(count);
    std::vector<std::string> failures(static_cast<std::size_t>(count));
    std::vector<std::thread> threads;
    for (int r = 0; r < count; ++r)
        threads.emplace_back([&, r] {
            RankThread ranks(table, r, open);
            try {
                work(ranks);
            } catch (const std::exception& error) {
                failures[static_cast<std::size_t>(r)] = error.what();
            }
        });
    for (std::thread& thread : threads) thread.join();
    return failures;
}

PointParts share_of(const PointCloud& cloud, const Ranks& ranks) {
    return [&cloud, rank = ranks.rank(), size = ranks.size()](const auto& visit) {
        PointCloud part;
        part.sensor = cloud.sensor, part.sensors = cloud.sensors;
        for (const Scalar& scalar : cloud.scalars) part.scalars.push_back({scalar.name, {}, scalar.is_label});
        for (auto i = static_cast<std::size_t>(rank); i < cloud.size(); i += static_cast<std::size_t>(size)) {
            part.positions.push_back(cloud.positions[i]);
            if (!cloud.normals.empty()) part.normals.push_back(cloud.normals[i]);
            if (!cloud.colors.empty()) part.colors.push_back(cloud.colors[i]);
            for (std::size_t s = 0; s < cloud.scalars.size(); ++s)
                part.scalars[s].values.push_back(cloud.scalars[s].values[i]);
            if (!cloud.sensor_of.empty()) part.sensor_of.push_back(cloud.sensor_of[i]);
        }
        visit(view_of(part));
    };
}

Reconstruction reconstruct_by_ranks(int count, const PointCloud& cloud, const ReconstructOptions& options,
                                    const TileOptions& tiles) {
    std::optional<Reconstruction> result;
    const auto failures = run_ranks(count, [&](Ranks& ranks) {
        Reconstruction made = reconstruct_in_tiles(share_of(cloud, ranks), options, tiles, ranks);
        if (ranks.is_first()) result.emplace(std::move(made));
    });
    for (const std::string& failure : failures)
        if (!failure.empty()) throw Error(failure);
    return std::move(result).value();
}

} // namespace hsdm::support
