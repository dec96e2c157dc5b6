#!/bin/bash
# Traces every scene that is no sequence and develops it with its own look, into out/gallery/; says how long each took.
#   scripts/gallery.sh [SCENE...]        names in scenes/ without .json; all by default
set -eu
cd "$(dirname "$0")/.."
scripts/build.sh release tools
bin=build/release/bin out=out/gallery
mkdir -p "$out"
if [ $# = 0 ]; then
  for file in scenes/*.json; do
    grep -q '"frames"' "$file" || case $file in *.schema.json) ;; *) set -- "$@" "$(basename "$file" .json)" ;; esac
  done
fi
milliseconds() { echo $(($(date +%s%N) / 1000000)); }
for scene; do
  begun=$(milliseconds)
  "$bin/nullcone-trace" "scenes/$scene.json" -o "$out/$scene.exr" --quiet
  traced=$(milliseconds)
  "$bin/nullcone-postrender" "$out/$scene.exr" -o "$out/$scene.png" --quiet
  printf '%-24s traced in %6d ms, developed in %5d ms\n' "$scene" $((traced - begun)) $(($(milliseconds) - traced))
done
echo "pictures: $PWD/$out"
