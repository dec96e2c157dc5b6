#!/bin/bash
# What takes longer than every change should wait: the crossing tests with more rays, more kills, fuzzing, and thread sanitizer.
#   NULLCONE_SOAK=10 scripts/soak.sh     how many times the usual number of rays (default 3)
set -eu
cd "$(dirname "$0")/.."
scripts/install-deps.sh --test
scripts/build.sh release
NULLCONE_SOAK=${NULLCONE_SOAK:-3} build/release/bin/trace_test --gtest_filter='Crossings*'
NULLCONE_KILLS=40 bash tests/kill_test.sh build/release/bin .
scripts/fuzz.sh "${NULLCONE_FUZZ_SECONDS:-600}"
scripts/build.sh tsan trace_test
TSAN_OPTIONS="suppressions=$PWD/scripts/tsan.supp" build/tsan/bin/trace_test --gtest_filter='*Thread*:GoedelEarth.HasThe*'
