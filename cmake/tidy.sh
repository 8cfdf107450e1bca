#!/bin/sh
# sh cmake/tidy.sh [COUNT]: clang-tidy (.clang-tidy) over the library's sources, or over the COUNT of them that changed
# last: all take half an hour. Fails if anything is found.
set -eu
cd "$(dirname "$0")/.."
tree=build/tidy count=${1:-1000}
cmake --preset debug -B "$tree" -DCMAKE_CXX_COMPILER=clang++-14 -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON >/dev/null
git log --name-only --pretty=format: -- 'libhsdm/*.cc' | awk 'NF && !seen[$0]++' |
    while read -r file; do if [ -f "$file" ]; then echo "$file"; fi; done | head -n "$count" |
    xargs -r -P "$(nproc)" -n 1 clang-tidy-14 -p "$tree" --quiet --warnings-as-errors='*'
