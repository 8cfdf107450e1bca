#!/bin/sh
# sh cmake/count_tests.sh LOG STATUS: shows what failed in a log of ctest and ends with the line
# `N passed, N failed` (`, N skipped` where any was), counted from the tests that ran. Fails if any failed, if
# none ran, or if ctest itself did (STATUS).
set -eu
log=$1
status=$2

count() {
    grep -cE "^ *[0-9]+/[0-9]+ Test +#[0-9]+: .*$1" "$log" || true
}

ran=$(count '')
passed=$(count ' Passed +[0-9.]+ sec')
skipped=$(count '\*\*\*Skipped')
failed=$((ran - passed - skipped))
if [ "$status" -ne 0 ] && [ "$failed" -eq 0 ]; then
    cat "$log"
    failed=1 # ctest did not get as far as running them all
fi
if [ "$failed" -gt 0 ] && [ "$ran" -gt 0 ]; then
    sed -n '/tests passed/,$!p' "$log" | grep -vE ' Passed +[0-9.]+ sec$|^ *Start +[0-9]+:' || true
fi
if [ "$ran" -eq 0 ]; then
    failed=1
fi
line="$passed passed, $failed failed"
if [ "$skipped" -gt 0 ]; then line="$line, $skipped skipped"; fi
echo "$line"
[ "$failed" -eq 0 ]
