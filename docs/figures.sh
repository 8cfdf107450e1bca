#!/bin/sh
# sh docs/figures.sh: builds hsdm_figures and draws the figures of docs/sheets.md, docs/adaptive.md and docs/features.md into docs/images.
# With a folder as argument, into that. Takes the tree build/release (cmake --preset release).
set -eu
images=$(realpath "${1:-$(dirname "$0")/images}")
cd "$(dirname "$0")/.."
ninja -C build/release hsdm_figures
build/release/docs/figures/hsdm_figures "$images"
