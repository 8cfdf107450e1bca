#!/bin/sh
# sh cmake/tidy.sh TREE [COUNT]: clang-tidy (.clang-tidy) over the library's sources, or over the COUNT of them that
# changed last: all take half an hour. TREE was built with clang++-14. Fails if anything is found.
set -eu
cd "$(dirname "$0")/.."
tree=$1 count=${2:-1000}
git log --name-only --pretty=format: -- 'libhsdm/*.cc' | awk 'NF && !seen[$0]++' |
    while read -r file; do if [ -f "$file" ]; then echo "$file"; fi; done | head -n "$count" |
    xargs -r -P "$(nproc)" -n 1 clang-tidy-14 -p "$tree" --quiet --warnings-as-errors='*'
