#!/bin/bash
# Builds a preset (default: release); tools land in build/PRESET/bin/. With a target (tools), only that.
#   scripts/build.sh [PRESET] [TARGET]
set -eu
cd "$(dirname "$0")/.."
preset=${1:-release}
scripts/install-deps.sh
[ -f "build/$preset/build.ninja" ] || cmake --preset "$preset" >/dev/null
cmake --build --preset "$preset" --target "${2:-all}" -- --quiet
