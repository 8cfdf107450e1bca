#include "hsdm/pipeline/kept_passes.hh"

#include <algorithm>
#include <bit>
#include <utility>

namespace hsdm {
namespace {

constexpr auto last_pass = static_cast<std::uint64_t>(Pass::strays);
constexpr const char* pieces_name = "pieces";

} // namespace

KeptPasses::KeptPasses(KeptScratch* kept, Ranks& ranks) : kept_(kept), ranks_(ranks) {
    std::uint64_t common = passes_here();
    for (const std::uint64_t of_one : ranks.gather(common)) common &= of_one;
    if (!kept_) return;
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
        used.push_back(std::move(kept_pass.points)), used.push_back(std::move(kept_pass.state));
    }
    kept_->remove_all_but(used);
}

/// A bit for each that can be gone on with.
std::uint64_t KeptPasses::passes_here() const {
    std::uint64_t passes = 0;
    for (std::size_t r = 0; kept_ && r < kept_->records().size(); ++r) {
        const std::uint64_t key = kept_->records()[r].key;
        if (key > last_pass) continue;
        const Kept kept = kept_at(r);
        if (kept_->has_file(kept.points, kept.bytes_of_points)
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
        if (!kept_->has_file(pieces_name, end)) break;
        tiles_[key] = r;
        end_of_pieces_ = end;
    }
}

KeptPasses::Kept KeptPasses::kept_at(std::size_t record) const {
    const Bytes bytes = kept_->read(kept_->records()[record]);
    ByteReader reader(bytes);
    const auto take_text = [&] {
        const auto text = reader.take_vector<char>();
        return std::string(text.begin(), text.end());
    };
    Kept kept;
    kept.points = take_text(), kept.state = take_text();
    kept.bytes_of_points = reader.take<std::size_t>(), kept.bytes_of_state = reader.take<std::size_t>();
    return kept;
}

KeptPasses::Bytes KeptPasses::state() const {
    const Kept kept = kept_at(last_);
    const ScratchBytes file({kept_->folder(), kept.state, kept.bytes_of_state});
    Bytes bytes;
    file.read(0, kept.bytes_of_state, bytes);
    return bytes;
}

void KeptPasses::keep(Pass pass, const ScratchCloud& cloud, const Bytes& state) {
    if (!kept_) return;
    cloud.flush_to_disk();
    const std::string name = kept_->new_name("state");
    ScratchBytes file({kept_->folder(), name, 0});
    file.append("what a pass has found", state);
    file.flush_to_disk();
    Bytes bytes;
    for (const std::string& text : {cloud.file_name(), name})
        put_vector(std::vector<char>(text.begin(), text.end()), bytes);
    put(cloud.bytes(), bytes), put(file.size(), bytes);
    kept_->keep(static_cast<std::uint64_t>(pass), bytes);
    ranks_.any(false); // once all have it, none goes back to the one before
    const std::vector<std::string> used{pieces_name, cloud.file_name(), name};
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
