#!/bin/sh
# sh docs/blender.sh: draws the picture of docs/blender.md, a scan and its mesh in Blender's window, by xvfb-run. Takes what is in
# build/release; the rest goes to build/blender.
set -eu
cd "$(dirname "$0")/.."
addon=$PWD/build/release/blender/hsdm_blender.zip
generate=build/release/tests/support/hsdm_generate
for tool in "$addon" "$generate" "$(command -v blender || echo blender)" "$(command -v xvfb-run || echo xvfb-run)"; do
    if ! [ -e "$tool" ]; then
        echo "blender: no $tool; sh cmake/bootstrap.sh build, and apt-get install --no-install-recommends blender xvfb xauth" >&2
        exit 1
    fi
done
mkdir -p build/blender
$generate part --points 60000 --noise 0.002 --normal-noise 5 -o build/blender/part.ply
rm -f docs/images/blender.png
PATH=/usr/bin:$PATH PYTHONPATH=$PWD/build/release/python BLENDER_USER_RESOURCES=$PWD/build/blender/home \
    xvfb-run -a -s "-screen 0 1040x660x24" blender --factory-startup --enable-event-simulate --window-geometry 0 0 1040 660 \
    --python docs/blender.py -- "$addon" "$PWD/build/blender/part.ply" "$PWD/docs/images/blender.png" >build/blender/log 2>&1 || true
if [ ! -s docs/images/blender.png ]; then
    cat build/blender/log >&2
    echo "blender: docs/images/blender.png could not be drawn" >&2
    exit 1
fi
