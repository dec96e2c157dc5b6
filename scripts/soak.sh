#!/bin/bash
# What takes longer than every change should wait: the crossing tests with more rays, more kills, a viewer that is
# asked wrongly and for long, fuzzing, and thread sanitizer.
#   NULLCONE_SOAK=10 scripts/soak.sh     how many times the usual number of rays (default 3)
set -eu
cd "$(dirname "$0")/.."
scripts/install-deps.sh --test
scripts/build.sh debug   # each file alone: none lives by the headers of its neighbours
scripts/build.sh release
scripts/build.sh release studies
NULLCONE_SOAK=${NULLCONE_SOAK:-3} build/release/bin/trace_test --gtest_filter='Crossings*'
NULLCONE_KILLS=40 bash tests/kill_test.sh build/release/bin .
NULLCONE_NOISE=30000 /usr/bin/python3 tests/view/hostile_test.py build/release/bin .   # strangers at the viewer's door
/usr/bin/python3 tests/view/memory_test.py build/release/bin . 10000 1280 1024
scripts/fuzz.sh "${NULLCONE_FUZZ_SECONDS:-600}"
scripts/build.sh tsan trace_test
TSAN_OPTIONS="suppressions=$PWD/scripts/tsan.supp" build/tsan/bin/trace_test --gtest_filter='*Thread*:GoedelEarth.HasThe*'
