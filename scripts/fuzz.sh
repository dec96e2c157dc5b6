#!/bin/bash
# Fuzzes the readers of files with clang's libFuzzer under AddressSanitizer and UndefinedBehaviorSanitizer.
#   scripts/fuzz.sh [SECONDS]     for each target (default 600); new inputs land in out/fuzz/
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/install-deps.sh --fuzz
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz -- --quiet
for target in dataset json; do
  mkdir -p "out/fuzz/$target"
  # Memory is bounded, whatever a file says of itself.
  "build/fuzz/bin/${target}_fuzz" -max_total_time="${1:-600}" -rss_limit_mb=2048 -timeout=20 -max_len=40000 -print_final_stats=1 \
    -artifact_prefix="out/fuzz/$target-" "out/fuzz/$target" "tests/fuzz/corpus/$target" 2>&1 | tail -n 12
done
