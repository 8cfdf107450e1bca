#include "hashes/kept_hashes.hh"

#include <fstream>
#include <iomanip>
#include <sstream>
#include <stdexcept>

namespace hsdm::test {

std::string line_of(const KeptHash& kept) {
    std::ostringstream line;
    line << std::hex << std::setfill('0') << std::setw(16) << kept.hash.geometry << ' ' << std::setw(16)
         << kept.hash.features << ' ' << kept.name;
    return line.str();
}

std::map<std::string, MeshHash> read_hashes(const std::string& path) {
    std::ifstream in(path);
    if (!in) throw std::runtime_error(path + ": cannot be read");
    std::map<std::string, MeshHash> hashes;
    for (std::string text; std::getline(in, text);) {
        if (text.starts_with('#')) continue;
        std::istringstream line(text);
        KeptHash kept;
        line >> std::hex >> kept.hash.geometry >> kept.hash.features >> std::ws;
        if (!std::getline(line, kept.name)) throw std::runtime_error(path + ": holds the line: " + text);
        hashes[kept.name] = kept.hash;
    }
    return hashes;
}

void write_hashes(const std::string& path, const std::vector<KeptHash>& hashes) {
    std::ofstream out(path);
    out << "# Bits of results on the measurement suites: hash of positions and facets, hash of normals, "
           "classes and\n"
           "# sharp edges, suite, case. HSDM_WRITE_HASHES=FILE hsdm_hashes writes this file; see "
           "CONTRIBUTING.md.\n";
    for (const KeptHash& kept : hashes) out << line_of(kept) << '\n';
    if (!out.flush()) throw std::runtime_error(path + ": cannot be written");
}

} // namespace hsdm::test
