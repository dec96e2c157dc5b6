#!/bin/bash
# Builds a preset (default: release); tools land in build/PRESET/bin/.
set -eu
cd "$(dirname "$0")/.."
preset=${1:-release}
scripts/install-deps.sh
[ -f "build/$preset/build.ninja" ] || cmake --preset "$preset" >/dev/null
cmake --build --preset "$preset" -- --quiet
