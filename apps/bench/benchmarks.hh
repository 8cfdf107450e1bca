// The benchmarks of hsdm_bench: each reads its own arguments, of which the first is its name, and returns a
// status.
#pragma once

namespace hsdm::bench {

/// Seconds on a clock that runs evenly.
double now();

int creases(int argc, char** argv);
int growth(int argc, char** argv);
int input(int argc, char** argv);
int judge_mesh(int argc, char** argv);
int neighbors(int argc, char** argv);
int normals(int argc, char** argv);
int phases(int argc, char** argv);
int robustness(int argc, char** argv);
int scans(int argc, char** argv);
int silences(int argc, char** argv);
int threads(int argc, char** argv);
int uneven(int argc, char** argv);
int walls(int argc, char** argv);
int yard(int argc, char** argv);

} // namespace hsdm::bench
