#!/bin/sh
# sh cmake/api.sh: writes the reference of the public headers (HSDM_PUBLIC_HEADERS) to build/api/html. Fails on any
# warning, such as a name without a docstring.
set -eu
cd "$(dirname "$0")/.."
headers=$(sed -n '/^set(HSDM_PUBLIC_HEADERS$/,/)/{s/^set(.*//;s/).*//;p}' libhsdm/CMakeLists.txt)
[ -n "$headers" ] || { echo "api: no HSDM_PUBLIC_HEADERS in libhsdm/CMakeLists.txt" >&2 && exit 1; }
rm -rf build/api
mkdir -p build
# shellcheck disable=SC2086  # a list of names, to be split
{ cat docs/Doxyfile && echo "INPUT = $(printf 'libhsdm/hsdm/%s ' $headers)"; } | doxygen -
