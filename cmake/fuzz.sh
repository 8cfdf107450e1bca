#!/bin/sh
# Runs the fuzzers, as many at once as there are cores, and prints what each did:
#
#     sh cmake/fuzz.sh [SECONDS [NAME...]]     20 seconds each, all of them
#
# Each starts from the inputs that once failed (testdata/fuzz/regressions/NAME), from valid files and from what its
# own runs before have found (TREE/fuzz/NAME/corpus). It stops at the first input that breaks a promise, which is
# kept in TREE/fuzz/NAME/finds. HSDM_FUZZ_SEED=1 repeats one row of inputs; by default each run has its own.
# HSDM_FUZZ_CLOUDS ends the cloud fuzzer after so many. TREE is build/fuzz, or HSDM_FUZZ_TREE: any tree built with HSDM_BUILD_FUZZERS.
set -u
cd "$(dirname "$0")/.." || exit 1

all="cloud points_ply points_pcd points_table points_ptx points_las points_npy points_npz points_off points_obj points_stl points_om points_hoppe"
all="$all mesh_ply mesh_off mesh_obj mesh_stl mesh_om suite module_options"

if [ "${1:-}" = --one ]; then # SECONDS NAME: how this script calls itself
    seconds=$2 name=$3 place=$HSDM_FUZZ_TREE/fuzz/$3
    mkdir -p "$place/corpus" "$place/finds"
    set -- "$place/corpus" "$HSDM_FUZZ_TREE/fuzz/seeds/$name"
    if [ -d "testdata/fuzz/regressions/$name" ]; then set -- "$@" "testdata/fuzz/regressions/$name"; fi
    # Memory: readers and reconstructions of so little take a few megabytes; a request for more is a find.
    limits="-max_len=4096 -timeout=10 -rss_limit_mb=1024 -malloc_limit_mb=64 -seed=${HSDM_FUZZ_SEED:-0}"
    words=tests/fuzz/dictionaries/${name##points_}.dict
    [ -f "$words" ] || words=tests/fuzz/dictionaries/${name##mesh_}.dict
    if [ -f "$words" ]; then limits="$limits -dict=$words"; fi
    # A cloud covers so much that weighing what is rare would take longer than reconstructing it.
    if [ "$name" = cloud ]; then limits="$limits -entropic=0 -max_len=512 -runs=${HSDM_FUZZ_CLOUDS:--1}"; fi
    # shellcheck disable=SC2086
    "$HSDM_FUZZ_TREE/tests/fuzz/targets/hsdm_fuzz_$name" $limits -max_total_time="$seconds" -print_final_stats=1 \
        -artifact_prefix="$place/finds/" "$@" >"$place/log" 2>&1
    echo "$?" >"$place/status"
    exit 0
fi

HSDM_FUZZ_TREE=${HSDM_FUZZ_TREE:-build/fuzz}
export HSDM_FUZZ_TREE
seconds=${1:-20}
if [ $# -gt 1 ]; then
    shift
    all="$*"
fi
if [ "$HSDM_FUZZ_TREE" = build/fuzz ]; then cmake --preset fuzz >/dev/null || exit 1; fi
cmake --build "$HSDM_FUZZ_TREE" --target hsdm_fuzzers >"$HSDM_FUZZ_TREE/fuzzers.log" 2>&1 || {
    tail -n 60 "$HSDM_FUZZ_TREE/fuzzers.log"
    echo "0 passed, 1 failed"
    exit 1
}
rm -rf "$HSDM_FUZZ_TREE/fuzz/seeds"
"$HSDM_FUZZ_TREE/tests/fuzz/targets/hsdm_fuzz_seeds" "$HSDM_FUZZ_TREE/fuzz/seeds" || exit 1

for name in $all; do echo "$name"; done | xargs -P "$(nproc)" -n 1 sh cmake/fuzz.sh --one "$seconds"

passed=0 failed=0
printf '%-16s %12s %10s %10s  %s\n' fuzzer executions per_second branches finds
for name in $all; do
    place=$HSDM_FUZZ_TREE/fuzz/$name
    count=$(sed -nE 's/^stat::number_of_executed_units: *//p' "$place/log")
    speed=$(sed -nE 's/^stat::average_exec_per_sec: *//p' "$place/log")
    covered=$(sed -nE 's/.* cov: ([0-9]+) .*/\1/p' "$place/log" | tail -n 1)
    if [ "$(cat "$place/status")" = 0 ]; then
        find=none passed=$((passed + 1))
    else
        find=$(sed -nE 's/.*Test unit written to //p' "$place/log" | tail -n 1) failed=$((failed + 1))
        find="${find:-see $place/log}: $(sed -nE '/(ERROR|broken promise|runtime error): /{p;q}' "$place/log")"
    fi
    printf '%-16s %12s %10s %10s  %s\n' "$name" "${count:--}" "${speed:--}" "${covered:--}" "$find"
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
