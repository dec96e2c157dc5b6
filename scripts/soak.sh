#!/bin/bash
# What takes longer than every change should wait: the crossing tests with ten times the rays, and thread sanitizer.
set -eu
cd "$(dirname "$0")/.."
scripts/install-deps.sh --test
scripts/build.sh release
NULLCONE_SOAK=10 build/release/bin/trace_test --gtest_filter='Crossings*'
scripts/build.sh tsan
TSAN_OPTIONS="suppressions=$PWD/scripts/tsan.supp" ctest --preset tsan --no-tests=error -R 'Threads|threads' --output-on-failure
