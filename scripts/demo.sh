#!/bin/bash
# The four pictures of the Gödel study, out of one traced dataset. Installs what is missing, builds, traces, post-renders.
set -eu
cd "$(dirname "$0")/.."
scripts/build.sh release tools
bin=build/release/bin out=out/demo
mkdir -p "$out"
"$bin/nullcone-trace" scenes/goedel_earth.json -o "$out/dataset.exr"
look() { "$bin/nullcone-postrender" "$out/dataset.exr" --quiet "$@"; }
look -o "$out/reference.png"
look --look scenes/looks/checkerboard.json -o "$out/checkerboard.png"
look --look scenes/looks/frequency.json -o "$out/frequency.png"
look --look scenes/looks/timeslice_centre.json --look scenes/looks/timeslice_right.json -o "$out/timeslice.png"
"$bin/nullcone-info" "$out/dataset.exr" --verify --quiet
echo "pictures and dataset:"
ls -1 "$PWD/$out"/{dataset.exr,reference.png,checkerboard.png,frequency.png,timeslice.png}
