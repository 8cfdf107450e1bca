#pragma once
// testdata/hashes.txt: a line `geometry features SUITE NAME` for each case of the measurement suites.

#include "hashes/mesh_hash.hh"

#include <map>
#include <string>
#include <vector>

namespace hsdm::test {

struct KeptHash {
    std::string name; ///< SUITE NAME
    MeshHash hash;
};

/// As the file has it.
std::string line_of(const KeptHash& kept);
/// By name. Throws std::runtime_error for a file that is not there or holds another line.
std::map<std::string, MeshHash> read_hashes(const std::string& path);
/// With a head that says what the lines are. Throws std::runtime_error.
void write_hashes(const std::string& path, const std::vector<KeptHash>& hashes);

} // namespace hsdm::test
