#!/bin/bash
# Everything that must hold: format, build with warnings as errors, all tests, and once more under sanitizers.
set -eu
cd "$(dirname "$0")/.."
step() { echo "== $(date +%H:%M:%S) $*"; }

step "packages"
scripts/install-deps.sh --test

step "format"
git ls-files '*.h' '*.cpp' | xargs clang-format --dry-run --Werror

step "build, warnings as errors"
cmake --preset release >/dev/null
cmake --build --preset release -- --quiet

step "build and tests under AddressSanitizer and UndefinedBehaviorSanitizer"
cmake --preset asan >/dev/null
cmake --build --preset asan -- --quiet
ctest --preset asan --no-tests=error -j "$(nproc)" --output-on-failure

step "tests"
ctest --preset release --no-tests=error -j "$(nproc)" --output-on-failure
