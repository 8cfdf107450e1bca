#pragma once
// A file for a moment: what is written to be read back and forgotten.

#include <string>

namespace hsdm {

/// The folder for temporary files: TMPDIR, else /tmp.
std::string temporary_folder();

/// A file of this process alone (mode 600) in the folder for temporary files (TMPDIR, else /tmp). It is
/// removed with the object, and by what ends the process by a signal too (abandon_files()), which does not
/// name it among the files that stand.
class ScratchFile {
public:
    /// The name ends with the extension, `.ply`. Throws Error if the file cannot be made.
    explicit ScratchFile(const std::string& extension);
    ~ScratchFile();
    ScratchFile(const ScratchFile&) = delete;
    ScratchFile& operator=(const ScratchFile&) = delete;

    const std::string& path() const { return path_; }

private:
    std::string path_;
};

} // namespace hsdm
