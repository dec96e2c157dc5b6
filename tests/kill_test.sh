#!/usr/bin/env bash
# Runs of nullcone-trace, killed at random moments: under the output's name stands nothing, the previous whole dataset or
# a new whole one; SIGTERM and SIGINT leave a whole partial file beside it; what SIGKILL leaves, the next run removes.
# Usage: kill_test.sh BIN_DIR SOURCE_DIR   (NULLCONE_KILLS: how many kills a signal, default 15)
set -u
bin=$(cd "$1" && pwd) || exit 2
source_dir=$(cd "$2" && pwd) || exit 2
kills=${NULLCONE_KILLS:-15}
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 2
faults=0
declare -A ends=()

fault() { faults=$((faults + 1)); printf 'FAULT: %s\n' "$1"; }
now() { date +%s%N; }
trace() { exec "$bin/nullcone-trace" scene.json -q --threads 2 -o out/a.exr 2>err; }
parts() { find out -name 'a.exr.part-*' | wc -l; }

python3 - "$source_dir/scenes/goedel_earth.json" <<'PYTHON' || exit 2
import json, sys
scene = json.load(open(sys.argv[1]))
scene["camera"]["resolution"] = [1320, 150]
json.dump(scene, open("scene.json", "w"))
PYTHON
mkdir out

# What a run takes when nobody disturbs it: the kills fall into this time, and somewhat after it.
start=$(now)
(trace) || { fault "an undisturbed run fails: $(cat err)"; exit 1; }
whole=$(($(now) - start))

# judge SIGNAL STATUS: what is under the name, what is beside it, and how the run ended.
judge() {
  if [ -e out/a.exr ]; then
    "$bin/nullcone-info" out/a.exr --verify --quiet >why 2>&1 || fault "$1: half a dataset: $(head -c 300 why)"
  elif [ "$previous" = 1 ]; then
    fault "$1: the previous dataset is gone"
  fi
  case $1:$2 in
    KILL:0 | KILL:137 | TERM:0 | TERM:3 | INT:0 | INT:3) ;;
    TERM:143 | INT:130) ;;  # before main could ask for the signal
    *) fault "$1: exit status $2: $(head -c 300 err)" ;;
  esac
  if [ "$2" = 3 ]; then  # what it has is kept
    "$bin/nullcone-info" out/a.partial.exr --verify --quiet >why 2>&1 || fault "$1: no whole partial file: $(head -c 300 why)"
    rm -f out/a.partial.exr
  fi
  [ "$1" = KILL ] || [ "$2" -ge 128 ] || [ "$(parts)" -eq 0 ] || fault "$1: parts are left: $(ls out)"
  [ "$(parts)" -le 1 ] || fault "$1: parts of earlier runs are still there: $(ls out)"
  ends[$1:$2]=$((${ends[$1:$2]:-0} + 1))
}

for ((i = 0; i < kills; ++i)); do
  for signal in KILL TERM; do
    [ "$signal" = TERM ] && [ $((i % 5)) -eq 0 ] && signal=INT
    previous=$((i % 2))
    [ "$previous" = 0 ] && rm -f out/a.exr
    [ "$previous" = 1 ] && [ ! -e out/a.exr ] && (trace)
    # A background job of a script ignores SIGINT, unless job control is on.
    set -m
    (trace) &
    set +m
    job=$!
    after=$((whole / 1000 * (RANDOM % 1200) / 1000))
    sleep "$(printf '%d.%06d' $((after / 1000000)) $((after % 1000000)))"
    kill -"$signal" "$job" 2>/dev/null
    wait "$job" 2>/dev/null
    judge "$signal" $?
  done
done

(trace) || fault "the last run fails: $(cat err)"
[ "$(ls out)" = a.exr ] || fault "the last run leaves: $(ls out)"
for end in "${!ends[@]}"; do printf '%s: %d\n' "$end" "${ends[$end]}"; done | sort
# Few kills (under sanitizers) may all come too late.
[ "$kills" -lt 5 ] || [ $((${ends[TERM:3]:-0} + ${ends[INT:3]:-0})) -gt 0 ] || fault "no SIGTERM or SIGINT hit a run that was tracing"
[ "$kills" -lt 5 ] || [ "${ends[KILL:137]:-0}" -gt 0 ] || fault "no SIGKILL hit a run"
printf '%d faults\n' "$faults"
[ "$faults" -eq 0 ]
