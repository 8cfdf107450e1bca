#pragma once
// Finding, checking and running the processing modules of plugin.hh.

#include "hsdm/mesh_types.hh"
#include "hsdm/modules/plugin_record.hh"
#include "hsdm/modules/stage_options.hh"

#include <string>
#include <utility>
#include <vector>

namespace hsdm {

struct PluginInfo;

/// A module that was loaded. Modules stay loaded until the process ends: properties they add to a mesh are
/// objects of their code.
class Plugin {
public:
    /// Checks the shared library, then loads it. Throws Error `FILE: what, and what to do` if it is no
    /// regular file, others than this user and root could have put it there, it is no module, or was built
    /// for another interface, hsdm, compiler or OpenMesh, all before any of its code runs; and if it cannot
    /// be loaded.
    explicit Plugin(const std::string& path);

    /// Path of the shared library, as given.
    const std::string& path() const { return path_; }
    /// The name by which modules are requested.
    const std::string& name() const { return record_.name; }
    const std::string& description() const { return record_.description; } ///< one line
    const std::vector<StageOption>& options() const { return options_; }   ///< as declared

    /// Runs the module on the mesh; returns its one-line summary. Throws OptionError for an argument that is
    /// not as the module's options have it or that it refuses, Error if it fails otherwise or leaves a mesh
    /// that is not sound: links that lead nowhere, a position that is not finite, no face where there were
    /// some. The mesh may then be changed in part and must not be walked over. Normals it leaves that are not
    /// finite become zero. O(half-edges) beside the module's work.
    std::string process(PolyMesh& mesh, const StageArguments& arguments = {}) const;

private:
    std::string path_;
    PluginRecord record_;
    std::vector<StageOption> options_;
    const PluginInfo* info_ = nullptr;
};

/// Where modules are looked for, in this order: the folders of the environment variable HSDM_PLUGIN_PATH
/// (separated by ':', which as part of a name is written `\:`), then the one that hsdm was configured to be
/// installed into. None is derived from where the program lies.
std::vector<std::string> plugin_folders();

/// Path of the module NAME.so in the first folder that has one; a name with a '/' is a path. Empty if there
/// is none.
std::string module_path(const std::string& name, const std::vector<std::string>& folders = plugin_folders());

/// The module at module_path(). Throws Error; where
/// nothing is found, it names the folders and the modules there are.
Plugin load_plugin(const std::string& name, const std::vector<std::string>& folders = plugin_folders());

/// What a folder offers, one entry per shared library; a folder that is not looked into is one with a
/// problem.
struct PluginListing {
    std::string path;                 ///< of the shared library or the folder
    std::string name;                 ///< by which it is asked for
    std::string description;          ///< one line
    std::vector<StageOption> options; ///< as declared
    std::string problem;              ///< empty, or why the module cannot be used
};

/// All modules of the folders, by folder and name; of two with the same file name the first counts. Loads
/// none, so that no code of theirs runs. Regular files only.
std::vector<PluginListing> list_plugins(const std::vector<std::string>& folders = plugin_folders());

/// `name` or `name:key=value,key=value`. A colon in the name is written `\:`; of a path it may stand as it
/// is, if there is a file so far. A comma in a value is written `\,`.
struct PluginRequest {
    std::string name;         ///< or path
    StageArguments arguments; ///< in the order given
};
/// Throws OptionError for an empty name or key and a part without '='.
PluginRequest parse_plugin_request(const std::string& text);

} // namespace hsdm
