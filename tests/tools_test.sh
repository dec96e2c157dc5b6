#!/usr/bin/env bash
# The tools from outside: exit codes, one line a complaint, nothing else; JSON.
# Usage: tools_test.sh BIN_DIR SOURCE_DIR
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/checks.sh"

# refused STATUS WORDS COMMAND...
refused() { refused_with "$@"; }
silent() { run 0 "$@"; [ -s out ] || [ -s err ] && fault "is not silent: $*"; }
# expect PYTHON-EXPRESSION over d, the JSON in the file out.
expect() {
  checks=$((checks + 1))
  python3 -c "import json, math, sys
d = json.load(open('out'), parse_constant=lambda word: sys.exit('not JSON: ' + word))
if not ($1): sys.exit('false')" 2>why || fault "$1: $(tail -1 why)"
}
only() { [ "$(find "$1" -mindepth 1 -printf '%P ')" = "$2 " ] || fault "$1 holds '$(find "$1" -mindepth 1)', expected '$2'"; }

python3 - "$source_dir/scenes/goedel_earth.json" <<'PYTHON' || fault "cannot make scenes"
import json, sys
scene = json.load(open(sys.argv[1]))
scene["camera"]["resolution"] = [132, 35]
json.dump(scene, open("scene.json", "w"))
scene["objects"][0]["shape"]["radius"] = -1
json.dump(scene, open("negative.json", "w"))
scene["objects"][0]["shape"]["radius"] = 50
json.dump(scene, open("large.json", "w"))
scene["metric"]["name"] = "kerr"
json.dump(scene, open("kerr.json", "w"))
open("broken.json", "w").write('{\n "a": }')
PYTHON
: >empty; printf 'no picture' >text.exr; mkdir folder folder.exr

# Every tool: help, version, words that it does not know.
for tool in "$trace" "$info" "$geodesic"; do
  for option in --help --version; do
    run 0 "$tool" $option
    { [ -s out ] && [ ! -s err ]; } || fault "$tool $option belongs on standard output"
  done
  refused 2 "required" "$tool"
  refused 2 "see --help" "$tool" --nope
  refused 2 "see --help" "$tool" --threads
done

# nullcone-trace
run 0 "$trace" scene.json -o a.exr
{ [ ! -s out ] && [ "$(wc -l <err)" -eq 1 ]; } || fault "nullcone-trace sums up in one line on standard error"
cp a.exr before.exr
refused 2 "scene.json.none: cannot open" "$trace" scene.json.none -o a.exr
refused 2 "broken.json: line 2, column 7: not valid JSON" "$trace" broken.json -o a.exr
refused 2 "negative.json: /objects/0/shape/radius: " "$trace" negative.json -o a.exr
refused 2 "large.json: /objects/0: " "$trace" large.json -o a.exr
refused 2 "kerr.json: /metric/name: " "$trace" kerr.json -o a.exr
refused 2 "empty: is empty" "$trace" empty -o a.exr
refused 2 "folder: " "$trace" folder -o a.exr
refused 2 "larger than 64 MiB" "$trace" /dev/zero -o a.exr
refused 2 "expected one of" "$trace" scene.json -o a.exr --isa 6502
refused 2 "--output" "$trace" scene.json
refused 2 "ends in .exr" "$trace" scene.json -o a.png
refused 2 "ends in .exr" "$trace" scene.json -o ""
refused 2 "not expected" "$trace" scene.json -o a.exr --nope
refused 2 "not expected" "$trace" scene.json scene.json -o a.exr
for threads in -1 4097 1.5 many; do refused 2 "--threads" "$trace" scene.json -o a.exr --threads $threads; done
refused 1 "cannot write there" "$trace" scene.json -o none/a.exr
refused 1 "cannot write there" "$trace" scene.json -o /proc/a.exr
refused 2 "folder.exr: is a folder" "$trace" scene.json -o folder.exr
cmp -s a.exr before.exr || fault "a failed run changed the dataset that was there"
mkdir full && cp before.exr full/a.exr
refused 1 "full/a.exr: cannot write" bash -c "ulimit -f 16; exec '$trace' scene.json --quiet -o full/a.exr"
only full a.exr
cmp -s full/a.exr before.exr || fault "a full disk cost the dataset that was there"
silent "$trace" scene.json --quiet -o b.exr
silent bash -c "cat scene.json | '$trace' /dev/stdin --quiet -o b.exr"

# Comments, and a scene in several files: the same as in one, and nothing of them is needed afterwards.
mkdir parts parts/more; ln -s "$PWD/scene.json" parts/outside.json
python3 - <<'PYTHON' || fault "cannot make parts"
import json
scene = json.load(open("scene.json"))
json.dump(scene["objects"][1:], open("parts/squares.json", "w"))
json.dump(scene["objects"][0] | {"$schema": "x", "transparent": None}, open("parts/more/earth.json", "w"))
json.dump(scene["camera"] | {"roll_deg": 3}, open("parts/camera.json", "w"))
parts = {"$schema": "no/matter.json", **scene, "camera": {"include": "camera.json", "roll_deg": None}}
parts["objects"] = [{"include": "more/earth.json", "transparent": None}, {"include": "squares.json"}]
open("parts/scene.json", "w").write("// a scene\n" + json.dumps(parts, indent=1) + " /* in parts */")
for name, change in {"radius": {"shape": {"radius": -1}}, "name": {"name": "square_left"}, "none": {"include": "nowhere.json"},
                     "out": {"include": "outside.json"}, "seven": {"include": 7}}.items():
    open(f"parts/{name}.json", "w").write(json.dumps({"include": "scene.json", "objects": [
        {"include": "more/earth.json", "transparent": None} | change, {"include": "squares.json"}]}))
wrong = json.load(open("parts/squares.json"))
wrong[1]["shape"]["edges"] = [1]
json.dump(wrong, open("parts/squares_wrong.json", "w"))
open("parts/wrong.json", "w").write(json.dumps(scene | {"objects": [scene["objects"][0], {"include": "squares_wrong.json"}]}))
PYTHON
silent "$trace" parts/scene.json -q -o parts.exr
silent "$trace" scene.json -q -o whole.exr
hash() { "$info" "$1" --json | python3 -c "import json, sys; d = json.load(sys.stdin); print(d['scene_sha256'], d['payload'], d['scene'])"; }
[ "$(hash parts.exr)" = "$(hash whole.exr)" ] || fault "a scene in parts is another one than in one file"
refused 2 "parts/radius.json: /objects/0/shape/radius: is -1" "$trace" parts/radius.json -o p.exr
refused 2 "parts/squares.json: /0/name: 'square_left' names two" "$trace" parts/name.json -o p.exr
refused 2 "parts/squares_wrong.json: /1/shape/edges: " "$trace" parts/wrong.json -o p.exr
refused 2 "parts/squares_wrong.json: /1/shape/edges: " "$geodesic" parts/wrong.json --pixel 0,0
refused 2 "parts/none.json: /objects/0/include: cannot open 'parts/nowhere.json'" "$trace" parts/none.json -o p.exr
refused 2 "parts/outside.json' leads out of the folder" "$trace" parts/out.json -o p.exr
refused 2 "parts/seven.json: /objects/0/include: expected the name" "$trace" parts/seven.json -o p.exr
refused 2 "from a pipe cannot include" bash -c "cat parts/scene.json | '$trace' /dev/stdin -o p.exr"
rm -r parts
silent "$trace" parts.exr -q -o again.exr
[ "$(hash again.exr)" = "$(hash whole.exr)" ] || fault "a dataset of a scene in parts does not trace again without them"

# Same numbers for any number of threads, and traced again from the dataset's own header.
payload() { "$info" "$1" --json | python3 -c "import json, sys; d = json.load(sys.stdin); print(d['payload'], d['scene_sha256'])"; }
silent "$trace" scene.json -q --threads 1 -o one.exr
silent "$trace" scene.json -q --threads 2 -o two.exr
silent "$trace" one.exr -q -o again.exr
silent "$trace" again.exr -q -o again.exr
for other in two again; do
  [ "$(payload $other.exr)" = "$(payload one.exr)" ] || fault "the payload of $other.exr differs from that of one.exr"
done
silent bash -c "exec '$trace' scene.json -q -o closed.exr >&- 2>&- <&-"
silent "$info" closed.exr --verify --quiet
left=$(find . -name '*part-*')
[ -z "$left" ] || fault "half-written files are left: $left"

# nullcone-info
run 0 "$info" a.exr --json
[ -s err ] && fault "--json talks on standard error"
expect "d['width'] == 132 and d['height'] == 35 and d['metric'] == 'goedel'"
expect "d['hits']['count'] == d['status']['hit'] > 100 and d['hits']['max_per_pixel'] == 1"
expect "sum(d['status'].values()) == 132 * 35 and d['status']['step_limit'] == d['status']['not_finite'] == 0"
expect "[o['name'] for o in d['objects']] == ['earth', 'square_left', 'square_right']"
expect "sum(o['hits'] for o in d['objects']) == d['hits']['count']"
expect "all(len(d['payload'][part]) == 64 for part in ('hits', 'rays'))"
expect "isinstance(d['isa'], str) and d['core_seconds'] >= 0 and d['scene']['camera']['resolution'] == [132, 35]"
run 0 "$info" a.exr
grep -q '^  picture *132 x 35 pixels' out || fault "nullcone-info without --json gives lines for people"
run 0 "$info" a.exr --json --pixel 0,34
expect "d['pixel'] == [0, 34] and set(d) == {'pixel', 'rays', 'hits'} and d['hits'] == []"
expect "d['rays']['status'] == 'lookback_reached' and d['rays']['steps'] > 0 and d['rays']['error'] == 0"
hit=
for x in $(seq 0 131); do
  "$info" a.exr --json --pixel "$x,17" >out
  grep -q '"object"' out && hit=$x && break
done
cp out hit.json
[ -n "$hit" ] || fault "no pixel of the middle line holds a crossing"
expect "{'Z', 'object', 'uv', 'shift', 't', 'tau', 'mu'} <= set(d['hits'][0]) and d['rays']['status'] == 'hit'"
expect "d['hits'][0]['object'] == 'earth' and d['hits'][0]['Z'] > 0 and d['hits'][0]['t'] < 0 and len(d['hits'][0]['uv']) == 2"
for pixel in 132,0 0,35 -1,0 0,-1 1 1,2,3 1.5,0 x,y 99999999999,0; do
  refused 2 "--pixel" "$info" a.exr --pixel $pixel
done
refused 2 "none.exr: cannot open" "$info" none.exr
for file in scene.json text.exr empty folder folder.exr /dev/zero /dev/null; do
  refused 2 "$file: is not an OpenEXR file" "$info" "$file"
done
head -c 20000 a.exr >short.exr
refused 2 "short.exr: damaged" "$info" short.exr --json
run 1 "$info" short.exr --verify
{ [ "$(wc -l <out)" -eq 1 ] && grep -q 'short.exr: damaged' out; } || fault "--verify names a damaged file as one fault"
silent "$info" a.exr --verify --quiet
python3 - <<'PYTHON'
import json, struct
bytes_ = bytearray(open("a.exr", "rb").read())
distance = json.load(open("hit.json"))["hits"][0]["Z"]  # change its last bit: the deep part is not compressed
at = bytes_.find(struct.pack("<f", distance), 3000)
bytes_[at] ^= 1
open("flipped.exr", "wb").write(bytes_)
PYTHON
run 1 "$info" flipped.exr --verify
{ [ "$(wc -l <out)" -eq 2 ] && grep -q 'flipped.exr: hits: SHA-256' out && grep -q 'flipped.exr: file: SHA-256' out; } ||
  fault "--verify names one fault a line"
# A header with a text that is nested too deep to print.
python3 - <<'PYTHON'
data = open("a.exr", "rb").read()
from_, to = data.index(b'"scene":"') + 9, data.index(b'","scene_sha256"')
deep = b"[" * ((to - from_) // 2) + b"]" * ((to - from_) - (to - from_) // 2)
open("deep.exr", "wb").write(data[:from_] + deep + data[to:])
PYTHON
refused 2 "nested deeper than 64" "$info" deep.exr --json
refused 2 "nested deeper than 64" "$trace" deep.exr -q -o c.exr
refused 1 "standard output: cannot write" bash -c "exec '$info' a.exr --json >/dev/full"
refused 1 "standard output: cannot write" bash -c "exec '$info' a.exr --json >&-"
run 0 bash -c "set +o pipefail; '$info' a.exr --json | head -c 1"

# nullcone-geodesic
ray() { local status=$1; shift; run "$status" "$geodesic" --metric goedel --event 0,0,0,0 --direction 1,0,0 --json "$@"; }
no_ray() { refused 2 "$1" "$geodesic" --metric goedel --event "$2" --direction "$3" --at "$4" "${@:5}"; }
ray 0 --at 1
# docs/physics.md: the closed form to 16 digits; a few roundings of numbers near 1.
expect "all(abs(a - b) < 4e-15 for a, b in zip(d['points'][0]['event'], (0.8605440030049165, 0.7587754593008128, 0.5862211106967756, 0)))"
expect "d['metric'] == 'goedel' and set(d['points'][0]) == {'lambda', 'event', 'tangent', 'status'}"
expect "d['points'][0]['lambda'] == 1 and d['points'][0]['status'] == 'ok' and abs(d['conserved']['E'] - 1) < 1e-14"
ray 0 --at=-2,-.5,0,3
expect "[p['lambda'] for p in d['points']] == [-2, -0.5, 0, 3] and d['points'][2]['event'] == [0, 0, 0, 0]"
expect "d['points'][0]['event'][0] < d['points'][1]['event'][0] < 0"
ray 0 --at 1 --set a=2
expect "0.8605 < d['points'][0]['event'][0] < 1"
run 0 "$geodesic" --metric minkowski --event 1,-2,3,-.5 --direction -.6,0,.8 --at -2 --speed 0.5 --json
expect "all(abs(a - b) < 1e-14 for a, b in zip(d['points'][0]['event'], (-1, -1.4, 3, -1.3)))"
# The energy g_t.k (section 1 again) from each point's own numbers; orbits stay within |x| < 2, and 40 units of
# lambda in the phase leave 40 roundings.
ray 0 --at 0,0.7,5,-40
expect "all(abs(k[0] + (x[1] * k[2] - x[2] * k[1]) / math.sqrt(2) - d['conserved']['E']) < 1e-13
  for x, k in ((p['event'], p['tangent']) for p in d['points']))"
expect "all(math.isfinite(x) for p in d['points'] for x in p['event'] + p['tangent']) and len(d['conserved']) >= 3"
ray 0 --at 1e308
expect "d['points'][0]['status'] in ('ok', 'not_finite')"
for value in nan inf -inf 1e999 "" x "1," ",1" "1,,2" "1 2" 0x; do no_ray "--at" 0,0,0,0 1,0,0 "$value"; done
for value in 0,0,0 0,0,0,0,0 nan,0,0,0 0,0,0,inf 0,,0,0 ""; do no_ray "--event" "$value" 1,0,0 1; done
for value in 0,0,0 2,0,0 1,1,0 nan,0,0 1,0 1,0,0,0 inf,0,0 1e200,0,0; do no_ray "--direction" 0,0,0,0 "$value" 1; done
for value in a a= =1 a=x a=nan a=inf a=0 a=-1 b=1 a=1e999 a=1x; do no_ray "--set $value" 0,0,0,0 1,0,0 1 --set "$value"; done
for value in 1 -0.1 nan inf 2; do no_ray "--speed" 0,0,0,0 1,0,0 1 --speed "$value"; done
no_ray "--paths" 0,0,0,0 1,0,0 1 --paths guessed
refused 2 "metric kerr?: unknown; expected one of" "$geodesic" --metric $'kerr\n' --event 0,0,0,0 --direction 1,0,0 --at 1
refused 2 "--at" "$geodesic" --metric goedel --event 0,0,0,0 --direction 1,0,0
refused 1 "standard output: cannot write" bash -c \
  "exec '$geodesic' --metric goedel --event 0,0,0,0 --direction 1,0,0 --at 1 --json >/dev/full"

# Spacetimes, checked; and what a black hole does to a large object.
check=$bin/nullcone-check-metric
run 0 "$check" ellis_wormhole --set throat=2 --events 40
run 0 "$check" kerr_schild --set spin=0.9 --set chart=ingoing --events 40 --json
expect "len(d) > 0"
refused 2 "metric nosuch: unknown" "$check" nosuch
refused 2 "--set spin=2" "$check" kerr_schild --set spin=2
refused 2 "--set chart=sideways" "$check" kerr_schild --set chart=sideways
refused 2 "--events" "$check" goedel --events nan
python3 - <<'PYTHON'
import json
scene = {"metric": {"name": "kerr_schild"}, "observer": {"event": [0, 20, 0, 0]}, "camera": {"type": "perspective",
  "azimuth_deg": 180, "fov_deg": 40, "resolution": [24, 18]}, "accuracy": "draft", "objects": [{"name": "big",
  "shape": {"type": "sphere", "radius": 2}, "placing": {"type": "local", "worldline": {"type": "static",
  "event": [0, 0, 9, 0]}}}]}
json.dump(scene, open("big.json", "w"))
scene["objects"][0]["shape"]["radius"] = 0.05
json.dump(scene, open("small.json", "w"))
PYTHON
run 0 "$trace" big.json -o big.exr
grep -q "big.json: /objects/0: note: 'big' is not small against the curvature" err || fault "no note: $(cat err)"
run 0 "$trace" small.json -o small.exr
grep -q "note" err && fault "a note on a small object: $(cat err)"
silent "$trace" big.json -o big.exr --quiet

finish
