#!/usr/bin/env bash
# Pictures in pieces: shards and their merging, interrupted runs and their resuming, and tracing again from a header.
# Usage: windows_test.sh BIN_DIR SOURCE_DIR
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/checks.sh"
merge=$bin/nullcone-merge

scene() {  # scene FILE WIDTH HEIGHT [PYTHON]: the demo's scene, another size, changed by a statement about s
  python3 - "$source_dir/scenes/goedel_earth.json" "$@" <<'PYTHON'
import json, sys
source, name, width, height, *change = sys.argv[1:]
s = json.load(open(source))
s["camera"]["resolution"] = [int(width), int(height)]
if change: exec(change[0])
json.dump(s, open(name, "w"))
PYTHON
}
payload() { "$info" "$1" --json | python3 -c 'import json, sys; d = json.load(sys.stdin); print(d["payload"])'; }
same_payload() { checks=$((checks + 1)); [ "$(payload "$1")" = "$(payload "$2")" ] || fault "$1 and $2 have other records"; }

scene a.json 264 120 's["camera"]["samples"] = 2; s["records"] = {"channels": ["uv", "shift", "t"]}
s["lights"] = {"lamps": [{"name": "sun", "worldline": {"type": "static", "event": [0, 0.1, 0.1, 0.2]}}]}'
run 0 "$trace" -q a.json -o a.exr

# Shards: any number of them, in any order.
shards=(1 3 8)
[ -n "${NULLCONE_SANITIZED:-}" ] && shards=(3)
for n in "${shards[@]}"; do
  parts=()
  for ((i = 1; i <= n; ++i)); do
    run 0 "$trace" -q a.json --shard "$i/$n" -o "s$i.exr"
    run 0 "$info" "s$i.exr" --verify
    parts=("s$i.exr" "${parts[@]}")
  done
  run 0 "$merge" -q "${parts[@]}" -o whole.exr
  run 0 "$info" whole.exr --verify
  same_payload a.exr whole.exr
done
refused_with 2 "expected i/n with i from 1 to n" "$trace" -q a.json --shard 0/3 -o x.exr
refused_with 2 "expected i/n with i from 1 to n" "$trace" -q a.json --shard 4/3 -o x.exr
refused_with 2 "expected i/n with i from 1 to n" "$trace" -q a.json --shard 1/3x -o x.exr
refused_with 2 "the picture has 8 bands" "$trace" -q a.json --shard 1/9 -o x.exr

for i in 1 2 3; do run 0 "$trace" -q a.json --shard "$i/3" -o "s$i.exr"; done
refused_with 2 "s3.exr: a gap before it: nobody holds scan lines 32 to 79" "$merge" -q s1.exr s3.exr -o x.exr
refused_with 2 "s2.exr: a gap before it: nobody holds scan lines 0 to 31" "$merge" -q s2.exr s3.exr -o x.exr
refused_with 2 "s2.exr: a gap after it: nobody holds scan lines 80 to 119" "$merge" -q s1.exr s2.exr -o x.exr
run 0 "$trace" -q a.json --shard 2/4 -o t2.exr
refused_with 2 "s2.exr: overlaps t2.exr: both hold scan lines 32 to 63" "$merge" -q s1.exr t2.exr s2.exr s3.exr -o x.exr
refused_with 2 "overlaps" "$merge" -q s1.exr s2.exr s3.exr s2.exr -o x.exr
scene b.json 264 120 's["camera"]["samples"] = 2; s["observer"]["event"][0] = 1.5'
run 0 "$trace" -q b.json --shard 2/3 -o stranger.exr
refused_with 2 "stranger.exr: has another scene" "$merge" -q s1.exr stranger.exr s3.exr -o x.exr
refused_with 2 "format2.exr: has another scene" "$merge" -q s1.exr "$source_dir/tests/data/format2.exr" s3.exr -o x.exr
refused_with 2 "format1.exr: is of an older format" "$merge" -q s1.exr "$source_dir/tests/data/format1.exr" -o x.exr
python3 -c "
b = bytearray(open('s2.exr', 'rb').read())
b[-100] ^= 4
open('damaged.exr', 'wb').write(b)"
refused_with 2 "damaged.exr" "$merge" -q s1.exr damaged.exr s3.exr -o x.exr
[ -e x.exr ] && fault "a refused merge has written something"

# Tracing again from the header.
run 0 "$trace" -q --from a.exr -o again.exr
same_payload a.exr again.exr
run 0 "$trace" -q --from s2.exr -o again.exr  # the whole scene, of which it holds a part
same_payload a.exr again.exr
refused_with 2 "is not an OpenEXR file" "$trace" -q --from a.json -o x.exr
refused_with 2 "expected either a SCENE or --from" "$trace" -q --from a.exr a.json -o x.exr
refused_with 2 "expected either a SCENE or --from" "$trace" -q -o x.exr

# Interrupted runs: what is there is kept, and the next run goes on. Slow enough to be interrupted.
size=(1000 240)
[ -n "${NULLCONE_SANITIZED:-}" ] && size=(120 96)
scene slow.json "${size[@]}" 's["paths"] = "integrated"; s["objects"] = s["objects"][:1]; s["objects"][0]["placing"]["worldline"] = {"type": "static", "event": [0, 0, 0.2, 0]}'
run 0 "$trace" -q slow.json -o slow.exr
interruptions=0
runs=60 pause=0.3
[ -n "${NULLCONE_SANITIZED:-}" ] && runs=6 pause=1
for ((i = 0; i < runs; ++i)); do
  "$trace" -q slow.json -o piece.exr --resume --threads 1 2>err &
  job=$!
  sleep "$pause"
  kill -TERM "$job" 2>/dev/null
  wait "$job"
  status=$?
  [ "$status" -eq 0 ] && break
  [ "$status" -eq 143 ] && continue  # before main could ask for the signal
  [ "$status" -eq 3 ] || fault "an interrupted run exits with $status: $(head -c 300 err)"
  interruptions=$((interruptions + 1))
  [ -e piece.exr ] && fault "an interrupted run has written piece.exr"
  run 0 "$info" piece.partial.exr --verify
done
[ -n "${NULLCONE_SANITIZED:-}" ] || [ "$interruptions" -gt 0 ] || fault "no run was interrupted"
[ "$status" -eq 0 ] || run 0 "$trace" -q slow.json -o piece.exr --resume
[ -e piece.partial.exr ] && fault "the partial file is still there"
run 0 "$info" piece.exr --verify
same_payload slow.exr piece.exr
[ "$(find . -name '*.part-*' | wc -l)" -eq 0 ] || fault "parts are left: $(ls)"

# What a run cannot go on from is refused by name, and stays.
"$trace" -q slow.json -o piece.exr --threads 1 2>err & job=$!
sleep 0.4
kill -INT "$job"; kill -TERM "$job" 2>/dev/null
wait "$job"
if [ -e piece.partial.exr ]; then
  refused_with 2 "piece.partial.exr: was interrupted" "$merge" -q piece.partial.exr -o x.exr
  refused_with 2 "piece.partial.exr: cannot go on from it: it has another scene" "$trace" -q b.json --resume -o piece.exr
  refused_with 2 "piece.partial.exr: cannot go on from it: it has another window" "$trace" -q slow.json --shard 1/2 --resume -o piece.exr
  [ -e piece.partial.exr ] || fault "a refused run has removed the partial file"
fi
printf '%d interruptions\n' "$interruptions"
finish
