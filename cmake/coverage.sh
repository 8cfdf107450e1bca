#!/bin/sh
# sh cmake/coverage.sh TREE [PERCENT]: for a tree built with HSDM_COVERAGE whose tests ran with the environment
# LLVM_PROFILE_FILE=$PWD/TREE/profile/%4m.profraw, prints how many lines and branches of the library ran, by folder.
# Fails if less than PERCENT of the lines did.
set -eu
cd "$(dirname "$0")/.."
tree=$1 least=${2:-0}
llvm-profdata-14 merge -sparse "$tree"/profile/*.profraw -o "$tree/profile/all.profdata"
set -- "$tree/tests/hsdm_tests"
for program in "$tree"/libhsdm/libhsdm.so "$tree/apps/hsdm/hsdm" "$tree/tests/cli/hsdm_cli_tests"; do
    if [ -x "$program" ]; then set -- "$@" -object "$program"; fi
done
llvm-cov-14 report -instr-profile "$tree/profile/all.profdata" "$@" libhsdm/hsdm | awk -v least="$least" '
    function share(missed, all) { return all > 0 ? 100 * (all - missed) / all : 100 }
    function row(name) {
        printf "%-12s %7d %6.1f %% %8d %6.1f %%\n", name, lines[name], share(unrun[name], lines[name]),
            branches[name], share(untaken[name], branches[name])
    }
    function add(name) {
        lines[name] += $8; unrun[name] += $9; branches[name] += $11; untaken[name] += $12
    }
    NF == 13 && $1 ~ /\.(cc|hh)$/ {
        folder = $1
        sub(/.*libhsdm\/hsdm\//, "", folder)
        if (!sub(/\/.*/, "", folder)) folder = "."
        if (!(folder in lines)) folders[++count] = folder
        add(folder)
        add("all")
    }
    END {
        printf "%-12s %7s %8s %8s %8s\n", "folder", "lines", "run", "branches", "taken"
        for (i = 1; i <= count; ++i) row(folders[i])
        row("all")
        if (count == 0 || share(unrun["all"], lines["all"]) < least) {
            print "fewer than " least " % of the lines ran"
            exit 1
        }
    }'
