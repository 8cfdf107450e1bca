#pragma once
// Ranks as threads of one process, for tests.

#include "hsdm/core/ranks.hh"
#include "hsdm/pipeline/reconstruct_in_tiles.hh"

namespace hsdm::support {

/// How a rank opens a file that all write.
using OpenShared = std::function<std::unique_ptr<SharedFile>(int rank, const std::string& path)>;

/// Runs work(ranks) for so many ranks, each on a thread of its own, all within together(). Returns by rank
/// what() of the exception that came out of it, or "". `open`: instead of by positioned writes.
std::vector<std::string> run_ranks(int count, const std::function<void(Ranks&)>& work,
                                   const OpenShared& open = {});

/// The same without together().
std::vector<std::string> run_ranks_apart(int count, const std::function<void(Ranks&)>& work,
                                         const OpenShared& open = {});

/// A rank's part of the points: every so-manieth, so that all of space has some of all.
PointParts share_of(const PointCloud& cloud, const Ranks& ranks);

/// What so many ranks make of a cloud that they share. Throws Error with what the first that failed did of.
Reconstruction reconstruct_by_ranks(int count, const PointCloud& cloud, const ReconstructOptions& options,
                                    const TileOptions& tiles);

} // namespace hsdm::support
