#pragma once
// The passes of a run in tiles that are on disk, for a run after one that did not come to its end.

#include "hsdm/core/ranks.hh"
#include "hsdm/io/kept_scratch.hh"
#include "hsdm/pipeline/scratch_cloud.hh"

#include <map>
#include <optional>

namespace hsdm {

/// In their order; a run may leave some out.
enum class Pass : std::uint64_t {
    none,
    sorted,     ///< points are on scratch
    surveyed,   ///< and have been looked through
    cleaned,    ///< outliers of a cloud without normals are left out
    sided,      ///< the sides of its patches are known
    normals,    ///< and the normals
    resolution, ///< points are in the cube of the voxels that were chosen
    strays,     ///< outliers of a cloud with normals are left out
};

/// Tells builds apart that would read each other's state wrongly, as far as sizes do: a number of the form,
/// and how many bytes what is kept as it lies in memory takes.
std::string form_of_kept();

/// To be called by all ranks before any of them makes a KeptScratch in this folder, which each has for itself
/// or all see. Throws Error where one has nothing and what it needs lies on another machine, or is of more
/// ranks: they would begin anew.
void refuse_moved(const std::string& folder, Ranks& ranks);

/// Of a job that is kept, or of one that is not, which has done nothing.
class KeptPasses {
public:
    using Bytes = Ranks::Bytes;

    /// `kept`: null: nothing is. Agrees with all ranks on the last pass that each of them has; what comes
    /// after it is forgotten. For all ranks at the same time. Throws Error if one has lost what others have.
    KeptPasses(KeptScratch* kept, Ranks& ranks);

    bool is_kept() const { return kept_ != nullptr; }
    Pass done() const { return done_; }
    bool has(Pass pass) const { return pass <= done_; }
    /// What the last pass was kept with. done() is not none.
    Bytes state() const;
    /// Of all ranks at the same time. `cloud`, and the one beside it if there is one: their points stay,
    /// those of clouds before are forgotten.
    void keep(Pass pass, ScratchCloud& cloud, ScratchCloud* beside, const Bytes& state);

    /// The record of a tile, if there is one.
    std::optional<Bytes> tile(std::uint64_t key) const;
    void keep_tile(std::uint64_t key, const Bytes& record, std::size_t end);
    /// The file of pieces; so many bytes of it are told by records.
    ScratchPlace pieces(const std::string& folder) const;

private:
    /// The record of a pass. Its state is a file of its own, as long as nothing comes after it.
    struct Kept {
        std::string points, beside, state; ///< files
        std::size_t bytes_of_points, bytes_beside, bytes_of_state;
    };
    Kept kept_at(std::size_t record) const;
    std::uint64_t passes_here() const;
    void refuse_lost(const std::vector<std::uint64_t>& of_all) const;
    void note_tiles();
    void cut_tiles(std::size_t first);

    KeptScratch* kept_;
    Ranks& ranks_;
    Pass done_ = Pass::none;
    std::size_t last_ = 0;                       // its record
    std::map<std::uint64_t, std::size_t> tiles_; // records
    std::size_t end_of_pieces_ = 0;
};

} // namespace hsdm
