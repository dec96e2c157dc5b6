#!/usr/bin/env bash
# Sequences in nullcone-trace: frames are the datasets of plain scenes, what is finished stays, and what is missing is listed.
# Usage: trace_frames_test.sh BIN_DIR SOURCE_DIR
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/checks.sh"
merge=$bin/nullcone-merge

python3 - "$source_dir/scenes/goedel_earth.json" <<'PYTHON' || fault "cannot make scenes"
import copy, json, sys
scene = json.load(open(sys.argv[1]))
del scene["look"]
scene["camera"]["resolution"] = [66, 48]
scene["observer"]["event"] = [0, 0.125, 0, 0]
def as_written(x): return int(x) if x == int(x) else x
for i in range(5):  # by hand
    plain = copy.deepcopy(scene)
    plain["observer"]["event"][0] = as_written(0.5 * i)
    plain["camera"]["azimuth_deg"] = as_written(24 + 2.5 * i)
    json.dump(plain, open(f"plain{i}.json", "w"))
scene["frames"] = {"count": 5, "from": 0, "to": 2, "time": "coordinate"}
scene["camera"]["azimuth_deg"] = {"keyframes": [[0, 24], [2, 34]]}
def write(name, change=lambda s: None):
    out = copy.deepcopy(scene)
    change(out)
    json.dump(out, open(name, "w"))
write("s.json")
write("look.json", lambda s: s.update(look={"exposure": {"ev": 1}}))
write("other.json", lambda s: s["camera"]["azimuth_deg"]["keyframes"].__setitem__(1, [2, 35]))
write("long.json", lambda s: (s["frames"].update(count=400), s["camera"].update(resolution=[660, 96])))
write("count.json", lambda s: s["frames"].update(count=0))
write("key.json", lambda s: s["frames"].update(step=1))
write("text.json", lambda s: s["objects"][0].update(name={"keyframes": [[0, 1]]}))
write("order.json", lambda s: s["camera"]["azimuth_deg"].update(keyframes=[[1, 0], [0, 1]]))
write("twice.json", lambda s: s["observer"]["event"].__setitem__(0, 1.438))
write("late.json", lambda s: s["camera"].update(elevation_deg={"keyframes": [[1.5, 0], [2, 100]]}))
write("lonely.json", lambda s: s.pop("frames"))
def slow(s):
    s.update(paths="integrated", objects=s["objects"][:1])
    s["objects"][0]["placing"]["worldline"] = {"type": "static", "event": [0, 0, 0.2, 0]}
    s["camera"]["resolution"] = [4000, 96]
write("slow.json", slow)
PYTHON

expect() { checks=$((checks + 1)); [ "$2" = "$3" ] || fault "$1: '$2', expected '$3'"; }
# traced N M: so many frames were traced and skipped, by the summary.
traced() { checks=$((checks + 1)); grep -q " $1 traced, $2 skipped," err || fault "expected $1 traced, $2 skipped: $(tail -c 200 err)"; }
# missing LIST OPTIONS...: what --missing prints for s.json.
missing() {
  local list=$1
  shift
  run 0 "$trace" "${@:-s.json}" --missing
  expect "--missing of ${*:-s.json}" "$(cat out)" "$list"
}
same_dataset() {
  "$info" "$1" --json >one 2>err && "$info" "$2" --json >two 2>err || fault "cannot read $1, $2: $(cat err)"
  python3 - <<'PYTHON' || fault "$1 and $2 differ"
import json, sys
one, two = (json.load(open(name)) for name in ("one", "two"))
sys.exit(any(one[key] != two[key] for key in ("payload", "scene_sha256", "scene")))
PYTHON
  checks=$((checks + 1))
}

# Frames are what the plain scenes give, and their datasets trace again.
all=(s.json --frames 0-4 -o 'd.####.exr')
missing 0-4 "${all[@]}"
run 0 "$trace" "${all[@]}" --threads 2; traced 5 0
expect "lines of talk" "$(wc -l <err)" 6
for i in 0 1 2 3 4; do
  run 0 "$trace" plain$i.json -q -o plain.exr
  same_dataset plain.exr d.000$i.exr
done
run 0 "$trace" --from d.0003.exr -q -o again.exr; same_dataset again.exr d.0003.exr
run 0 "$trace" s.json --frame 3 -q -o one.exr; same_dataset one.exr d.0003.exr
run 0 "$trace" s.json --frames 1-4:2 -o 'odd.#.exr'; traced 2 0; same_dataset odd.3.exr d.0003.exr
missing "" "${all[@]}"

# What is finished is skipped, whatever the look; the rest is traced again.
run 0 "$trace" "${all[@]}"; traced 0 5
run 0 "$trace" "${all[@]}" --overwrite; traced 5 0
cp d.0001.exr whole.exr
python3 -c 'import os; f = open("d.0001.exr", "r+b"); n = os.path.getsize("d.0001.exr") * 3 // 4; f.seek(n); b = f.read(1); f.seek(n); f.write(bytes([b[0] ^ 1]))'
truncate -s -100 d.0002.exr; cp one.exr d.0004.exr
missing 1-2,4 "${all[@]}"
missing 3-8,12-14 "${all[@]}" --shards 3
for threads in 1 4; do missing 1-2,4 "${all[@]}" --threads $threads; done
run 0 "$trace" "${all[@]}"; traced 3 2; same_dataset whole.exr d.0001.exr
missing "" "${all[@]}"
missing "" look.json --frames 0-4 -o 'd.####.exr'
missing 1-4 other.json --frames 0-4 -o 'd.####.exr'

# Shards: their names, their tasks; a whole frame counts for all of its shards.
shards=(s.json --frames 0-1 -o 'h.#.exr')
run 0 "$trace" "${shards[@]}" --shard 2/3; traced 2 0
run 0 "$trace" s.json --frame 0 --shard 1/3 -o 'h.#.shard-1-of-3.exr'; traced 1 0
[ -e h.0.shard-1-of-3.exr ] && [ -e h.1.shard-2-of-3.exr ] || fault "shards are $(ls h.*)"
missing 2-3,5 "${shards[@]}" --shards 3
missing 0-1 "${shards[@]}"
run 0 "$trace" "${shards[@]}" --shard 3/3; traced 2 0
run 0 "$merge" h.0.shard-*-of-3.exr -q -o h.0.exr; same_dataset h.0.exr d.0000.exr
rm h.0.shard-*; missing 3 "${shards[@]}" --shards 3
run 0 "$trace" "${shards[@]}" --shard 1/3; traced 1 1
missing "" "${shards[@]}" --shards 3

# An interrupted run leaves whole frames, and the next goes on, also within a frame.
for signal in TERM INT; do
  rm -f l.*
  set -m
  "$trace" long.json --frames 0-399 -o 'l.###.exr' --threads 1 -q 2>err &
  job=$!
  set +m
  for ((i = 0; i < 1000; ++i)); do [ -e l.003.exr ] && break; sleep 0.01; done
  kill -$signal $job; wait $job; expect "status after SIG$signal" $? 3
  grep -q "interrupted after" err || fault "says nothing of the interruption: $(cat err)"
  there=$(find . -name 'l.???.exr' | wc -l)
  missing "$there-$((there + 4))" long.json --frames "$there-$((there + 4))" -o 'l.###.exr'
  run 0 "$trace" long.json --frames "0-$((there + 1))" -o 'l.###.exr'; traced 2 "$there"
  [ -z "$(ls l.*partial* l.*part-* 2>/dev/null)" ] || fault "parts are left: $(ls l.*)"
done
run 0 "$trace" long.json --frame "$there" -q -o one.exr; same_dataset one.exr "l.$(printf %03d "$there").exr"
# A signal may come several times, from a batch system and from who passes it on: it is the same wish.
set -m
"$trace" slow.json --frame 0 -o w.exr --threads 1 -q 2>err & job=$!
set +m
sleep 0.2
for signal in TERM TERM INT; do kill -$signal $job; sleep 0.1; done
wait $job; expect "status after three signals in a row" $? 3
run 0 "$info" w.partial.exr --verify
# A second later it means: at once. Reading a pipe into which nobody writes does not stop by itself.
mkfifo w.0.exr
"$trace" s.json --frames 0-4 -o 'w.#.exr' --missing & job=$!
sleep 0.2
kill -TERM $job; sleep 1.2; kill -TERM $job; sleep 0.3; kill -KILL $job 2>/dev/null
wait $job; expect "status after a late second signal" $? 143
# --missing stops too, and then says nothing: half a list would be taken for the whole.
"$trace" s.json --frames 0-4 -o 'w.#.exr' --missing --threads 1 >out & job=$!
exec 7<>w.0.exr
sleep 0.2
kill -TERM $job; sleep 0.1; echo "no dataset" >&7
wait $job; expect "status of --missing after SIGTERM" $? 3
expect "what it says" "$(cat out)" ""
exec 7>&-
rm w.*
# A partial file of another scene does not hinder.
cp d.0000.exr e.1.partial.exr
run 0 "$trace" s.json --frame 1 -o 'e.#.exr'; traced 1 0; same_dataset e.1.exr d.0001.exr

# Wrong input: one line, before any work, nothing written.
bad=(--frames 0-4 -o 'bad.#.exr')
refused_with 2 "count.json: /frames/count: is 0" "$trace" count.json "${bad[@]}"
refused_with 2 "key.json: /frames/step: unknown key" "$trace" key.json "${bad[@]}"
refused_with 2 "/objects/0/name: expected" "$trace" text.json "${bad[@]}"
refused_with 2 "order.json: /camera/azimuth_deg/keyframes/1: expected a later time" "$trace" order.json "${bad[@]}"
refused_with 2 "twice.json: /observer/event/0: is the time of the frame" "$trace" twice.json "${bad[@]}"
refused_with 2 "late.json (frame 4): /camera/elevation_deg: is 100" "$trace" late.json "${bad[@]}"
refused_with 2 "there is no frame 5; expected 0 to 4" "$trace" s.json --frames 0-5 -o 'bad.#.exr'
refused_with 2 "there is no frame 5; expected 0 to 4" "$trace" s.json --frame 5 -o bad.exr
for frame in -1 '' 0-3; do refused_with 2 "--frame" "$trace" s.json --frame "$frame" -o bad.exr; done
refused_with 2 "expected ####" "$trace" s.json --frames 0-4 -o bad.exr
refused_with 2 "two places" "$trace" s.json --frames 0-4 -o 'bad.#.#.exr'
refused_with 2 "ends in .exr" "$trace" s.json --frames 0-4 -o 'bad.#.png'
refused_with 2 "'x' is no frame" "$trace" s.json --frames x -o 'bad.#.exr'
refused_with 2 "'' is no frame" "$trace" s.json --frames '' -o 'bad.#.exr'
refused_with 2 "plain0.json: is no sequence" "$trace" plain0.json "${bad[@]}"
refused_with 2 "expected a SCENE beside --frames" "$trace" --from d.0000.exr "${bad[@]}"
refused_with 2 "--overwrite: expected --frames" "$trace" s.json --overwrite -o bad.exr
refused_with 2 "--missing: expected --frames" "$trace" s.json --missing -o bad.exr
refused_with 2 "as many shards" "$trace" s.json "${bad[@]}" --missing --shards 4
refused_with 2 "as many shards" "$trace" s.json "${bad[@]}" --shard 1/4
refused_with 2 "s.json: /frames: this is a sequence" "$trace" s.json -o bad.exr
mkdir parts
echo '{"include": "s.json", "camera": {"include": "parts/camera.json"}}' >in_parts.json
echo '{"elevation_deg": {"keyframes": [[1.5, 0], [2, 100]]}}' >parts/camera.json
refused_with 2 "parts/camera.json (frame 4): /elevation_deg: is 100" "$trace" in_parts.json --frames 0-4 -o 'bad.#.exr'
echo '{"elevation_deg": {"keyframes": [[2, 0], [1, 1]]}}' >parts/camera.json
refused_with 2 "parts/camera.json: /elevation_deg/keyframes/1: expected a later time" "$trace" in_parts.json --frames 0-4 -o 'bad.#.exr'
refused_with 2 "lonely.json: /camera/azimuth_deg: has keyframes" "$trace" lonely.json -o bad.exr
refused_with 2 "s.json: /frames: this is a sequence" "$geodesic" s.json --pixel 3,3
refused_with 1 "none/bad.0.exr: cannot write there" "$trace" s.json --frames 0-4 -o 'none/bad.#.exr'
[ -z "$(ls -d bad* none 2>/dev/null)" ] || fault "refused runs leave $(ls -d bad* none)"

# The sequence of the scenes that come along can be read, frame by frame.
missing 0,249 "$source_dir/scenes/goedel_sequence.json" --frames 0,249 -o 'g.#.exr'

finish
