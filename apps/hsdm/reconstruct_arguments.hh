#pragma once
// The options of `hsdm reconstruct`, as given; `hsdm regress` reads its cases through the same door.

#include "command.hh"
#include "progress_bar.hh"

#include "hsdm/io/kept_scratch.hh"
#include "hsdm/io/read_points.hh"
#include "hsdm/io/write_mesh.hh"
#include "hsdm/pipeline/reconstruct_in_tiles.hh"
#include "hsdm/reconstruct.hh"

#include <optional>
#include <vector>

namespace hsdm::command {

/// What one mesh is made of.
struct CloudFiles {
    std::string input;              ///< as given; of several the first
    std::vector<std::string> files; ///< whose points are one cloud
    /// For messages: the input, or what joined files are called.
    std::string name() const;
};

struct ReconstructArguments {
    std::vector<std::string> inputs;
    bool join = false;
    ReadOptions read;

    std::optional<int> depth;
    std::optional<double> voxel_size;
    std::string max_error;
    Method method = Method::automatic;
    NormalSource normals = NormalSource::automatic;
    Holes holes = Holes::automatic;
    Grid grid = Grid::automatic;
    std::string levels;
    bool merge_layers = false;
    bool confidence = false;
    double trim = 0;
    std::string min_component;
    double crease_degrees = 35;
    int smoothing = 3;
    std::vector<std::string> stages;
    bool strict = false;
    std::string memory, scratch;
    bool resume = false;
    int threads = 0;
    std::string debug_dir;

    std::string output, out_dir, format;
    bool ascii = false, plain = false;
    LengthUnit units = LengthUnit::none;
    bool recentre = false;
    std::string features, report, html;
    bool intersections = false;
    bool quiet = false, verbose = false;
    Progress progress = Progress::automatic;

    /// Options of the library; set after parsing. Throws UsageError for options that do not fit each other.
    ReconstructOptions options() const;
    /// What bounds the memory, if something is to: --memory and --scratch. Throws UsageError.
    std::optional<TileOptions> tiles() const;
    /// The same of each of several processes that do it together, which need no bound.
    TileOptions tiles_of_rank() const;
    /// What tells the job of this cloud from others, for --resume: the program, the files as they are, and
    /// options that tiles depend on. Throws Error.
    std::vector<KeptScratch::Trait> job(const CloudFiles& cloud, int processes) const;
    /// Throws UsageError and OptionError for what cannot be done in tiles.
    void check_for_tiles(const TileOptions& tiles) const;
    /// A cloud for each input, or one of all that are joined, of folders those in them. Throws UsageError,
    /// and Error for a folder without.
    std::vector<CloudFiles> clouds() const;
    /// First and last depth of --levels A:B; nothing if it was not given. Throws UsageError.
    std::optional<std::pair<int, int>> level_range() const;

private:
    void check_resume() const;
};

/// Adds the options on how a cloud is reconstructed, shared by `reconstruct` and `regress`.
void add_method_options(CLI::App& app, ReconstructArguments& arguments);
/// How text files are read: shared too.
void add_text_options(CLI::App& app, ReconstructArguments& arguments);
/// How a mesh is written, whatever the format: shared too.
void add_writing_options(CLI::App& app, ReconstructArguments& arguments);
/// Inputs, outputs and messages.
void add_file_options(CLI::App& app, ReconstructArguments& arguments);

/// What the `args` of a suite's case stand for, through the same parser; the library's options are theirs.
/// Throws Error that begins with the case's name.
struct CaseOptions {
    ReconstructOptions reconstruct;
    ReadOptions read;
    std::vector<std::string> stages;
    bool strict = false;               ///< a warning is a miss
    bool ascii = false, plain = false; ///< of the mesh that is written, if one is
};
CaseOptions case_options(const std::string& name, const std::vector<std::string>& words);

} // namespace hsdm::command
