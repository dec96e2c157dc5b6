#!/usr/bin/env bash
# nullcone-info from outside: what it says of windows, samples, interrupted runs and doubtful rays; what it refuses.
# Usage: info_test.sh BIN_DIR SOURCE_DIR
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/checks.sh"

refused() { refused_with "$@"; }
# expect PYTHON-EXPRESSION over d, the JSON in the file out.
expect() {
  checks=$((checks + 1))
  python3 -c "import json, math, sys
d = json.load(open('out'), parse_constant=lambda word: sys.exit('not JSON: ' + word))
if not ($1): sys.exit('false')" 2>why || fault "$1: $(tail -1 why)"
}
says() { grep -qE -- "$1" out || fault "'$1' is not in: $(head -c 400 out)"; }

python3 - "$source_dir/scenes/goedel_earth.json" <<'PYTHON' || fault "cannot make scenes"
import json, sys
scene = json.load(open(sys.argv[1]))
scene["camera"]["resolution"] = [132, 35]
json.dump(scene, open("scene.json", "w"))
scene["camera"].update(resolution=[20, 18], samples=3)
json.dump(scene, open("samples.json", "w"))
scene["records"] = {"channels": ["shift"]}
json.dump(scene, open("few.json", "w"))
lamp = {"name": "sun", "worldline": {"type": "static", "event": [0, 0.1, 0.1, 0.2]}}
json.dump(dict(scene, lights={"paths": 3, "lamps": [lamp]}), open("lit.json", "w"))
scene["camera"].update(resolution=[4000, 2000], samples=1)
json.dump(scene, open("large.json", "w"))
at = lambda *event: {"type": "local", "worldline": {"type": "static", "event": event}}
hole = {"metric": {"name": "kerr_schild"}, "observer": {"event": [0, 20, 0, 0]}, "accuracy": "draft",
        "camera": {"type": "perspective", "azimuth_deg": 180, "fov_deg": 40, "resolution": [24, 18]},
        "objects": [{"name": "big", "shape": {"type": "sphere", "radius": 0.1}, "placing": at(0, 0, 9, 0)},
                    {"name": "stars", "shape": {"type": "sky"}}]}
json.dump(hole, open("hole.json", "w"))
PYTHON
for name in scene samples few lit hole; do run 0 "$trace" $name.json -q -o $name.exr; done
run 0 "$trace" scene.json -q -o shard.exr --shard 2/3

# Windows, samples, channels, setting.
run 0 "$info" scene.exr --json
expect "d['window'] == {'first_line': 0, 'lines': 35, 'traced_lines': 35} and d['partial'] is False and d['samples'] == 1"
expect "d['channels'] == ['Z', 'A', 'id', 'order', 'uv.U', 'uv.V', 'shift', 't', 'tau', 'mu'] == list(d['hits']['ranges'])"
expect "d['setting']['paths']['type'] == 'closed' and d['setting']['observer']['event'][0] == 1.438 and d['seconds'] > 0"
expect "d['quality']['worst'] == [] and d['quality']['doubtful'] == d['quality']['error']['max'] == d['quality']['drift']['p99'] == 0"
expect "1 <= d['quality']['steps']['median'] <= d['quality']['steps']['max']"
run 0 "$info" shard.exr --json
expect "d['window'] == {'first_line': 16, 'lines': 16, 'traced_lines': 16} and d['height'] == 35"
expect "sum(d['status'].values()) == 132 * 16"
run 0 "$info" samples.exr --json
expect "d['samples'] == 3 and sum(d['status'].values()) == 9 * 20 * 18 and 'sample' in d['channels']"
run 0 "$info" few.exr --json --pixel 10,9
expect "len(d['rays']) == 9 and [r['sample'] for r in d['rays']] == list(range(9))"
expect "all(set(h) == {'Z', 'A', 'object', 'sample', 'shift'} for h in d['hits'])"

# Lamps.
run 0 "$info" lit.exr --verify
run 0 "$info" lit.exr --json
expect "d['format'] == 3 and d['light_paths'] == 3 and [set(lamp) for lamp in d['lights']] == [{'name', 'tau_origin', 'lit', 'capped'}] and d['lights'][0]['name'] == 'sun'"
expect "[c for c in d['channels'] if c.startswith('light.')] == [f'light.sun.{i}.{c}' for i in range(3) for c in ('E', 'shift', 't', 'tau')]"
expect "all(d['hits']['ranges'][f'light.sun.{i}.E'][0] >= 0 for i in range(3))"
run 0 "$info" lit.exr --json --pixel 10,9
expect "all(set(h['lights']) == {'sun'} and len(h['lights']['sun']) <= 3 for h in d['hits'])"
run 0 "$info" lit.exr
says '^lamps, 3 paths each; lit: '
says '^  sun +-?[0-9]'
says '^  light.sun.2.E +[0-9].* 1/scene\^2$'
run 0 "$info" few.exr --json
expect "d['format'] == 2 and d['lights'] == [] and d['light_paths'] == 0"

# The worst rays of a black hole.
run 0 "$info" hole.exr --json
expect "len(d['quality']['worst']) == 10 and d['quality']['worst'][0]['error'] == d['quality']['error']['max'] > 0"
expect "[w['error'] for w in d['quality']['worst']] == sorted((w['error'] for w in d['quality']['worst']), reverse=True)"
expect "0 < d['quality']['error']['median'] <= d['quality']['error']['p99'] <= d['quality']['error']['max']"
expect "set(d['quality']['worst'][0]) == {'pixel', 'sample', 'status', 'steps', 'error', 'drift'}"
pixel=$(python3 -c "import json; print(*json.load(open('out'))['quality']['worst'][0]['pixel'], sep=',')")
error=$(python3 -c "import json; print(json.load(open('out'))['quality']['worst'][0]['error'])")
run 0 "$info" hole.exr --json --pixel "$pixel"
expect "d['rays']['error'] == $error"
run 0 "$info" hole.exr --json --worst 3
expect "len(d['quality']['worst']) == 3"
run 0 "$info" hole.exr --json --worst 100000
expect "3 < len(d['quality']['worst']) <= 24 * 18 and all(w['error'] > 0 for w in d['quality']['worst'])"
run 0 "$info" hole.exr --json --worst 0
expect "d['quality']['worst'] == []"

# For people.
run 0 "$info" shard.exr
says '^  picture +132 x 35 pixels, a ray each$'
says '^  window +scan lines 16 to 31 of 35$'
says '^  earth +1 +[0-9]+'
says '^  shift +0\.[0-9]+ +1\.[0-9]+$'
run 0 "$info" samples.exr
says '^  picture +20 x 18 pixels, 3 x 3 rays each$'
run 0 "$info" hole.exr
says '^worst rays$'
run 0 "$info" hole.exr --pixel 0,0
says '^  inf +1 +stars'
grep -q '[{}"]' out && fault "JSON in what people read"
for file in scene shard samples few lit hole; do
  run 0 "$info" $file.exr
  grep -nE '[{}"]| $|[^a-z]null[^a-z]' out && fault "$file.exr: JSON, or blanks at the end of a line, in what people read"
done

# An interrupted run says so.
"$trace" large.json -q --threads 1 -o large.exr 2>err & job=$!
sleep 0.3; kill -TERM $job; wait $job
[ $? -eq 3 ] || fault "the large run was not interrupted: $(cat err)"
run 0 "$info" large.partial.exr --json
expect "d['partial'] is True and d['window']['traced_lines'] < d['window']['lines'] == 2000"
expect "d['status']['not_traced'] == 4000 * (2000 - d['window']['traced_lines']) and d['quality']['doubtful'] == 0"
run 0 "$info" large.partial.exr
says 'INTERRUPTED after [0-9]+ of 2000'
run 0 "$info" large.partial.exr --verify --quiet
grep -q 'large.partial.exr: true, but interrupted: [0-9]* of 2000 scan lines' err || fault "--verify: $(cat err)"
[ -s out ] && fault "--verify calls an interrupted file faulty"
run 0 "$info" large.partial.exr --json --pixel 5,1999
expect "d['rays']['status'] == 'not_traced' and d['hits'] == []"
# All of it would take 190 MB; OpenEXR itself keeps the counts, 32 MB. Sanitizers take their own.
lean() {
  [ -n "${NULLCONE_SANITIZED:-}" ] && return
  python3 -c "import resource, subprocess, sys
subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL, check=True)
used = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
sys.exit(used > 120_000 and f'{used} KiB')" "$@" 2>why || fault "$* holds the dataset: $(tail -1 why)"
}
lean "$info" large.partial.exr

# What it refuses, one line each.
refused 2 "DATA: is required" "$info"
refused 2 "DATA: is required" "$info" --json
refused 2 "DATA: is required" "$info" ""
refused 2 "outside the window: scan lines 16 to 31" "$info" shard.exr --pixel 0,15
refused 2 "outside the window: scan lines 16 to 31" "$info" shard.exr --pixel 0,32
refused 2 "outside the picture of 132 x 35" "$info" shard.exr --pixel 0,35
run 0 "$info" shard.exr --pixel 131,31
for worst in -1 x 1.5 100001 ""; do refused 2 "--worst" "$info" hole.exr --worst "$worst"; done
refused 2 "--worst" "$info" hole.exr --worst 3 --pixel 0,0
refused 2 "--pixel" "$info" hole.exr --verify --pixel 0,0
refused 2 "--flat" "$info" hole.exr -o flat.exr
refused 2 "--output" "$info" hole.exr --flat
refused 2 "--flat" "$info" hole.exr --ranks 2
for ranks in 0 -1 65 x; do refused 2 "--ranks" "$info" hole.exr --flat -o flat.exr --ranks $ranks; done
for option in --json --verify "--pixel 0,0"; do refused 2 "--flat" "$info" hole.exr --flat -o flat.exr $option; done
refused 2 "--format" "$info" hole.exr --format
refused 2 "--format" "$info" --format --flat -o flat.exr
[ -e flat.exr ] && fault "a refused --flat has written"

# The flat companion: whole or not there.
mkdir folder folder.exr flats
cp hole.exr before.exr
refused 2 "hole.exr: is the dataset itself" "$info" --flat hole.exr -o hole.exr
refused 2 "./hole.exr: is the dataset itself" "$info" --flat hole.exr -o ./hole.exr
ln -s hole.exr link.exr
refused 2 "link.exr: is the dataset itself" "$info" --flat hole.exr -o link.exr
cmp -s hole.exr before.exr || fault "a refused --flat has changed the dataset"
refused 2 "none.exr: cannot open" "$info" --flat none.exr -o flats/a.exr
refused 2 "folder.exr: is not an OpenEXR file" "$info" --flat folder.exr -o flats/a.exr
refused 2 "ends in .exr" "$info" --flat hole.exr -o flats/a.png
refused 2 "ends in .exr" "$info" --flat hole.exr -o ""
refused 2 "folder.exr: is a folder" "$info" --flat hole.exr -o folder.exr
refused 1 "cannot write there" "$info" --flat hole.exr -o none/a.exr
size=$(stat -c %s hole.exr)
for cut in 10 400 2000 $((size / 2)) $((size - 1)); do
  head -c "$cut" hole.exr >short.exr
  refused 2 "short.exr: " "$info" --flat short.exr -o flats/a.exr
done
for blocks in 1 8; do  # while writing the header, or the lines
  refused 1 "flats/a.exr: cannot write" bash -c "ulimit -f $blocks; exec '$info' --flat scene.exr -q -o flats/a.exr"
done
[ -z "$(ls -A flats)" ] || fault "a failed --flat leaves $(ls -A flats)"
run 0 "$info" --flat hole.exr -o flats/a.exr
[ -s out ] || [ -s err ] && fault "--flat talks"
cp flats/a.exr first.exr
run 0 "$info" --flat hole.exr -o flats/a.exr
cmp -s flats/a.exr first.exr || fault "the same dataset gives another flat picture"
refused 2 "flats/a.exr: is an OpenEXR file, but not a nullcone dataset" "$info" flats/a.exr
refused 2 "not a nullcone dataset" "$info" --flat flats/a.exr -o b.exr
run 0 "$info" --flat shard.exr -o flats/a.exr
run 0 "$info" --flat few.exr -o flats/a.exr
run 0 "$info" --flat lit.exr -o flats/a.exr
lean "$info" --flat large.partial.exr -o flats/a.exr

finish
