#include "hsdm/pipeline/kept_passes.hh"

#include "hsdm/core/system.hh"
#include "hsdm/errors.hh"
#include "hsdm/normals/normals.hh"
#include "hsdm/pipeline/survey.hh"
#include "hsdm/pipeline/tile_piece.hh"

#include <algorithm>
#include <bit>
#include <utility>

namespace hsdm {
namespace {

constexpr auto last_pass = static_cast<std::uint64_t>(Pass::strays);
constexpr const char* pieces_name = "pieces";

/// On a machine, in the folder for scratch: the ranks that something was kept for.
struct SeenByRank {
    std::string host;
    std::vector<int> processes;
};

bool sees(const SeenByRank& one, int process) {
    return std::ranges::binary_search(one.processes, process);
}

/// The machines that have what each rank needs, in the order of ranks; empty if some is nowhere.
std::string hosts_in_order(const std::vector<SeenByRank>& seen) {
    std::string hosts;
    for (int r = 0; r < static_cast<int>(seen.size()); ++r) {
        const auto one =
            std::ranges::find_if(seen, [&](const SeenByRank& of_rank) { return sees(of_rank, r); });
        if (one == seen.end()) return {};
        hosts += (r > 0 ? "," : "") + one->host;
    }
    return hosts;
}

/// Of a rank that finds nothing, if there is something for it elsewhere, or for more ranks than there are.
void refuse_moved(const std::string& folder, const std::vector<SeenByRank>& seen, int rank) {
    const SeenByRank& own = seen[static_cast<std::size_t>(rank)];
    const std::string name = KeptScratch::name_of(rank);
    const auto other = std::ranges::find_if(seen, [&](const SeenByRank& one) { return sees(one, rank); });
    if (other != seen.end()) {
        const std::string hosts = hosts_in_order(seen);
        throw Error(folder, "rank " + std::to_string(rank) + " on " + own.host + " has no " + name
                                + ", which rank " + std::to_string(other - seen.begin()) + " on "
                                + other->host + " has; run on the same machines in the same order"
                                + (hosts.empty() ? "" : " (mpirun --host " + hosts + ")")
                                + ", or remove the folders of all to begin anew");
    }
    if (!own.processes.empty() && own.processes.back() >= static_cast<int>(seen.size()))
        throw Error(folder,
                    "rank " + std::to_string(rank) + " on " + own.host + " has no " + name + ", but "
                        + KeptScratch::name_of(own.processes.back())
                        + " of more processes; run as many as before, on the same machines in the same "
                          "order, or remove the folders of all to begin anew");
}

} // namespace

std::string form_of_kept() {
    constexpr int form = 6; // another one whenever something else is kept, or in another order
    std::string text = std::to_string(form).append(":");
    for (const std::size_t size :
         {sizeof(Index), sizeof(PointRow), sizeof(Box), sizeof(ScratchPoints::Cell), sizeof(Occurrences),
          sizeof(SetSizes), sizeof(NeighborOptions), sizeof(EstimateOptions), sizeof(NormalsReport),
          sizeof(CloudScanners), sizeof(OrientReport), sizeof(VoxelRange), sizeof(FacetCounts),
          sizeof(Piece::Digest), sizeof(Piece), sizeof(Survey), sizeof(PartComponents::Shared)})
        text.append(" ").append(std::to_string(size));
    return text;
}

void refuse_moved(const std::string& folder, Ranks& ranks) {
    Ranks::Bytes bytes;
    put_text(os::host_name(), bytes);
    put_vector(KeptScratch::processes_in(folder), bytes);
    std::vector<SeenByRank> seen;
    for (const Ranks::Bytes& got : ranks.gather(bytes)) {
        ByteReader reader(got);
        SeenByRank& of_rank = seen.emplace_back();
        of_rank.host = reader.take_text();
        of_rank.processes = reader.take_vector<int>();
    }
    for (int r = 0; r < ranks.size(); ++r)
        if (!sees(seen[static_cast<std::size_t>(r)], r)) refuse_moved(folder, seen, r);
}

KeptPasses::KeptPasses(KeptScratch* kept, Ranks& ranks) : kept_(kept), ranks_(ranks) {
    std::uint64_t common = passes_here();
    const std::vector<std::uint64_t> of_all = ranks.gather(common);
    for (const std::uint64_t of_one : of_all) common &= of_one;
    if (!kept_) return;
    refuse_lost(of_all);
    done_ = static_cast<Pass>(std::bit_width(common) - (common > 0 ? 1 : 0));
    std::size_t after = 0;
    for (std::size_t r = 0; r < kept_->records().size(); ++r) {
        const std::uint64_t key = kept_->records()[r].key;
        if (key <= last_pass && static_cast<Pass>(key) > done_) break;
        if (static_cast<Pass>(key) == done_) last_ = r;
        after = r + 1;
    }
    kept_->cut(done_ == Pass::none ? 0 : after);
    note_tiles();
    std::vector<std::string> used{pieces_name};
    if (done_ != Pass::none) {
        Kept kept_pass = kept_at(last_);
        for (std::string* const name : {&kept_pass.points, &kept_pass.beside, &kept_pass.state})
            used.push_back(std::move(*name));
    }
    kept_->remove_all_but(used);
}

/// A rank that has nothing has lost it if another one is past the first pass, which that one began once all
/// had the first. All would begin anew.
void KeptPasses::refuse_lost(const std::vector<std::uint64_t>& of_all) const {
    const auto without = std::ranges::find(of_all, 0);
    const auto is_past_first = [](std::uint64_t passes) {
        return passes >> (static_cast<std::uint64_t>(Pass::sorted) + 1) != 0;
    };
    if (without == of_all.end() || std::ranges::none_of(of_all, is_past_first)) return;
    const auto rank = static_cast<int>(without - of_all.begin());
    throw Error(kept_->folder(), "can only be gone on with by all ranks, and rank " + std::to_string(rank)
                                     + " finds nothing in its " + KeptScratch::name_of(rank)
                                     + "; give it its --scratch, or remove the folders of all to begin anew");
}

/// A bit for each that can be gone on with.
std::uint64_t KeptPasses::passes_here() const {
    std::uint64_t passes = 0;
    for (std::size_t r = 0; kept_ && r < kept_->records().size(); ++r) {
        const std::uint64_t key = kept_->records()[r].key;
        if (key > last_pass) continue;
        const Kept kept = kept_at(r);
        if (kept_->has_file(kept.points, kept.bytes_of_points)
            && (kept.beside.empty() || kept_->has_file(kept.beside, kept.bytes_beside))
            && kept_->has_file(kept.state, kept.bytes_of_state))
            passes |= std::uint64_t{1} << key;
    }
    return passes;
}

void KeptPasses::note_tiles() {
    for (std::size_t r = 0; r < kept_->records().size(); ++r) {
        const std::uint64_t key = kept_->records()[r].key;
        if (key <= last_pass) continue;
        const Bytes bytes = kept_->read(kept_->records()[r]);
        const auto end = ByteReader(bytes).take<std::size_t>();
        if (!kept_->has_file(pieces_name, end)) return cut_tiles(r);
        tiles_[key] = r;
        end_of_pieces_ = end;
    }
}

/// From that record on: what is written to the file from now on is not what they tell of.
void KeptPasses::cut_tiles(std::size_t first) {
    const bool cuts_pass = done_ != Pass::none && first <= last_;
    const Bytes pass = cuts_pass ? kept_->read(kept_->records()[last_]) : Bytes();
    kept_->cut(first);
    if (!cuts_pass) return;
    kept_->keep(static_cast<std::uint64_t>(done_), pass);
    last_ = first;
}

KeptPasses::Kept KeptPasses::kept_at(std::size_t record) const {
    const Bytes bytes = kept_->read(kept_->records()[record]);
    ByteReader reader(bytes);
    Kept kept;
    for (std::string* const name : {&kept.points, &kept.beside, &kept.state}) *name = reader.take_text();
    for (std::size_t* const bytes_of : {&kept.bytes_of_points, &kept.bytes_beside, &kept.bytes_of_state})
        *bytes_of = reader.take<std::size_t>();
    return kept;
}

KeptPasses::Bytes KeptPasses::state() const {
    const Kept kept = kept_at(last_);
    const ScratchBytes file({kept_->folder(), kept.state, kept.bytes_of_state});
    Bytes bytes;
    file.read(0, kept.bytes_of_state, bytes);
    return bytes;
}

void KeptPasses::keep(Pass pass, ScratchCloud& cloud, ScratchCloud* beside, const Bytes& state) {
    if (!kept_) return;
    cloud.flush_to_disk();
    if (beside) beside->flush_to_disk();
    const std::string name_beside = beside ? beside->file_name() : std::string();
    const std::string name = kept_->new_name("state");
    ScratchBytes file({kept_->folder(), name, 0});
    file.append("what a pass has found", state);
    file.flush_to_disk();
    Bytes bytes;
    for (const std::string& each : {cloud.file_name(), name_beside, name}) put_text(each, bytes);
    for (const std::size_t size : {cloud.bytes(), beside ? beside->bytes() : 0, file.size()})
        put(size, bytes);
    kept_->keep(static_cast<std::uint64_t>(pass), bytes);
    cloud.note_kept();
    if (beside) beside->note_kept();
    ranks_.any(false); // once all have it, none goes back to the one before
    const std::vector<std::string> used{pieces_name, cloud.file_name(), name_beside, name};
    kept_->remove_all_but(used);
}

std::optional<KeptPasses::Bytes> KeptPasses::tile(std::uint64_t key) const {
    const auto found = tiles_.find(key);
    if (found == tiles_.end()) return std::nullopt;
    const Bytes bytes = kept_->read(kept_->records()[found->second]);
    ByteReader reader(bytes);
    reader.take<std::size_t>();
    return reader.take_rest<char>();
}

void KeptPasses::keep_tile(std::uint64_t key, const Bytes& record, std::size_t end) {
    if (!kept_) return;
    Bytes bytes;
    put(end, bytes);
    append_bytes(record.data(), record.size(), bytes);
    kept_->keep(key, bytes);
    end_of_pieces_ = end;
}

ScratchPlace KeptPasses::pieces(const std::string& folder) const {
    return kept_ ? ScratchPlace{kept_->folder(), pieces_name, end_of_pieces_} : ScratchPlace{folder, {}, 0};
}

} // namespace hsdm
