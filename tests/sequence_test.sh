#!/usr/bin/env bash
# Sequences and the command line of nullcone-postrender from outside.
# Usage: sequence_test.sh BIN_DIR SOURCE_DIR
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/checks.sh"
post=$bin/nullcone-postrender

python3 - "$source_dir/scenes/goedel_earth.json" <<'PYTHON' || fault "cannot make scenes"
import json, sys
scene = json.load(open(sys.argv[1]))
scene["camera"]["resolution"] = [165, 31]
for name in scene["look"]["objects"]:
    scene["look"]["objects"][name]["texture"] = {"type": "color", "rgb": [1, 0.5, 0.25]}
for i in range(4):
    scene["camera"]["azimuth_deg"] = 24 + 5 * i
    json.dump(scene, open(f"scene{i}.json", "w"))
body = {"spectrum": {"type": "black_body",
                     "temperature_K": {"keyframes": [[0, 3000], [9, 9000]], "interpolation": "smooth"}}}
look = {"objects": {"earth": body, "square_left": {"texture": {"type": "image", "file": "grey.ppm.png"}}},
        "exposure": {"white_cd_m2": 1e9, "ev": {"keyframes": [[0, 0], [9, 2]]}},
        "legend": {"time": {"step": 0.1}, "temperature": "earth"}}
json.dump(look, open("look.json", "w"))
for i in range(4):
    look["exposure"]["ev"] = i
    json.dump(look, open(f"look.{i:02}.json", "w"))
import struct, zlib
def chunk(kind, data): return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
open("grey.ppm.png", "wb").write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 2, 2, 8, 2, 0, 0, 0)) +
    chunk(b"IDAT", zlib.compress(b"\0" + b"\x80" * 6 + b"\0" + b"\x40" * 6)) + chunk(b"IEND", b""))
PYTHON
for i in 0 1 2 3; do run 0 "$trace" scene$i.json -q -o "data.000$i.exr"; done
cp data.0000.exr data.exr
mkdir a b

# rendered N: so many frames were not skipped, by the summary on standard error.
rendered() { checks=$((checks + 1)); grep -q " $1 rendered," err || fault "expected $1 rendered frames: $(tail -c 200 err)"; }
frames() { find "$1" -type f -printf '%f\n' | sort | tr '\n' ' '; }
same() { cmp -s "$1" "$2" || fault "$1 and $2 differ"; }

# One dataset, many frames; the same bytes on one thread as on two, and as single pictures.
one_look=(data.exr --look look.json --frames 0-9)
run 0 "$post" "${one_look[@]}" -o 'a/o.###.png' --threads 1; rendered 10
run 0 "$post" "${one_look[@]}" -o 'b/o.###.png' --threads 2; rendered 10
[ "$(frames a)" = "$(printf 'o.00%d.png ' 0 1 2 3 4 5 6 7 8 9)" ] || fault "frames are $(frames a)"
for f in a/*; do same "$f" "b/${f#a/}"; done
cmp -s a/o.000.png a/o.009.png && fault "keyframes change nothing"
for kind in jpg exr; do
  run 0 "$post" "${one_look[@]}" -o "o.#.$kind" --threads 1
  mkdir -p "$kind" && mv o.?."$kind" "$kind"
  sleep 1  # no times in files
  run 0 "$post" "${one_look[@]}" -o "o.#.$kind" --threads 2
  for f in o.?."$kind"; do same "$f" "$kind/$f"; done
done

# What is whole, newer and of the same look is skipped.
again=("$post" "${one_look[@]}" -o 'a/o.###.png')
run 0 "${again[@]}"; rendered 0
run 0 "${again[@]}" --overwrite; rendered 10
rm a/o.003.png; run 0 "${again[@]}"; rendered 1
head -c 700 b/o.004.png >a/o.004.png; run 0 "${again[@]}"; rendered 1; same a/o.004.png b/o.004.png
cp data.exr a/o.005.png; run 0 "${again[@]}"; rendered 1; same a/o.005.png b/o.005.png
run 0 "${again[@]}" --set exposure.white_cd_m2=2e9; rendered 10
run 0 "${again[@]}" --bits 16 --set exposure.white_cd_m2=2e9; rendered 10
run 0 "${again[@]}"; rendered 10
for f in a/*; do same "$f" "b/${f#a/}"; done
# Keys that leave half of the frames as they are.
run 0 "${again[@]}" --set 'background=[0,0,{"keyframes":[[4,0],[9,1]]}]'; rendered 5
run 0 "${again[@]}"; rendered 5
touch grey.ppm.png; run 0 "${again[@]}"; rendered 10
touch look.json; run 0 "${again[@]}"; rendered 10
touch data.exr; run 0 "${again[@]}"; rendered 10
run 0 "$post" "${one_look[@]}" -o "o.#.exr"; rendered 10
cp o.7.exr whole.exr; truncate -s -100 o.7.exr; run 0 "$post" "${one_look[@]}" -o "o.#.exr"; rendered 1; same o.7.exr whole.exr

# Many datasets with one look, many looks with one dataset, both; single pictures of them.
run 0 "$post" 'data.####.exr' --look look.json --frames 0-3 -o 'd.#.png' --threads 2; rendered 4
for i in 0 1 2 3; do
  run 0 "$post" "data.000$i.exr" --look look.json --frames $i -o 'one.#.png'; same one.$i.png d.$i.png
  run 0 "$post" 'data.####.exr' --look look.json --frame $i -o single.png
done
run 0 "$post" data.exr --look 'look.##.json' --frames 3,0-1 -o 'l.#.png'; rendered 3
run 0 "$post" 'data.####.exr' --look 'look.##.json' --frames 0-3:3 -o 'dl.#.png'; rendered 2
same dl.0.png l.0.png
[ -e dl.1.png ] && fault "a step of 3 made frame 1"
run 0 "$post" 'data.####.exr' --look look.json --look 'look.##.json' --frames 0-3 -o 'stack.#.png'; rendered 4

# Reports: a line a frame and a summary.
run 0 "$post" "${one_look[@]}" -o 'a/o.###.png' --set gamut=clip --json -q
[ -s err ] && fault "--quiet is not quiet"
python3 - <<'PYTHON' || fault "the report is wrong: $(cat out)"
import json
lines = [json.loads(line) for line in open("out")]
assert [line["frame"] for line in sorted(lines[:-1], key=lambda x: x["frame"])] == list(range(10))
assert not any(line["skipped"] for line in lines[:-1]) and lines[-1]["rendered"] == 10 and lines[-1]["whole"]
PYTHON

# A look in full gives the same picture.
for frame in 0 7; do
  run 0 "$post" data.exr --look look.json --set tone.curve=exponential --frame $frame --explain
  mkdir -p elsewhere && cp out elsewhere/full.json
  run 0 "$post" data.exr --look look.json --set tone.curve=exponential --frame $frame -o want.png
  run 0 "$post" data.exr --look elsewhere/full.json -o found.png
  same want.png found.png
  run 0 "$post" data.exr --look elsewhere/full.json --explain
  cmp -s out elsewhere/full.json || fault "a look in full changes when it is explained again"
done

# A run that is interrupted leaves whole pictures, and the next goes on.
run 0 "$post" data.exr --frames 0-399 -o 'b/i.#.png' --set 'exposure.ev={"keyframes":[[0,0],[399,3]]}'
for signal in TERM INT; do
  rm -f a/*
  set -m
  "$post" data.exr --frames 0-399 -o 'a/i.#.png' --set 'exposure.ev={"keyframes":[[0,0],[399,3]]}' -q 2>err &
  job=$!
  set +m
  for ((i = 0; i < 500; ++i)); do [ -e a/i.5.png ] && break; sleep 0.01; done
  kill -$signal $job; wait $job; status=$?
  checks=$((checks + 1))
  [ $status -eq 3 ] || fault "SIG$signal: status $status, expected 3"
  grep -q "interrupted after" err || fault "says nothing of the interruption: $(cat err)"
  [ "$(find a -name '*part*' | wc -l)" -eq 0 ] || fault "parts are left: $(frames a)"
  for f in a/*; do same "$f" "b/${f#a/}"; done
  there=$(find a -type f | wc -l)
  run 0 "$post" data.exr --frames 0-399 -o 'a/i.#.png' --set 'exposure.ev={"keyframes":[[0,0],[399,3]]}'
  rendered $((400 - there))
done

# Films: their numbered files count, not the pattern, and they need not all be there at once.
for i in 1 2; do cp grey.ppm.png f_0$i.png; done
cat >film.json <<'JSON'
{"objects": {"square_left": {"texture": {"type": "image", "file": "f_##.png", "sequence": {"frames": [1, 3], "clock": "frame"}}}}}
JSON
film=("$post" data.exr --look film.json --frames 0-1)
run 0 "${film[@]}" -o 'a/f.#.png'; rendered 2
run 0 "${film[@]}" -o 'a/f.#.png'; rendered 0
touch f_02.png; run 0 "${film[@]}" -o 'a/f.#.png'; rendered 2
mv f_02.png f_02.kept; run 2 "${film[@]}" -o 'a/f.#.png'
grep -q "f_02.png" err || fault "does not name the picture that is missing: $(cat err)"
mv f_02.kept f_02.png

# As many keyframes as may be are read once each, not once a node.
python3 -c 'import json; print(json.dumps({"objects": {"earth": {"texture": {"type": "checkerboard", "counts": [
    {"by": "t", "keyframes": [[i, 1 + i % 9] for i in range(4096)]}, 2], "colors": [[0, 0, 0], [1, 1, 1]]}}}}))' >keys.json
run 0 timeout 10 "$post" data.exr --look keys.json -q -o a/keys.png

# Wrong input: one line, nothing written, before any work.
rm -rf bad && mkdir bad
bad=(--look look.json -o 'bad/o.#.png')
refused_with 2 "expected ####" "$post" data.exr --look look.json -o bad/o.png --frames 0-3
refused_with 2 "--frames: is missing" "$post" data.exr "${bad[@]}"
refused_with 2 "--frames: is missing" "$post" 'data.####.exr' --look look.json -o bad/o.png
refused_with 2 "several frames would be written" "$post" 'data.####.exr' --look look.json -o bad/o.png --frames 0-3
refused_with 2 "is an input too" "$post" 'data.####.exr' --look look.json -o 'data.####.exr' --frames 0-3
refused_with 2 "is an input too" "$post" data.exr -o ./data.exr
refused_with 2 "data.0004.exr: is not there; nor are 2 more: data.0005.exr, data.0006.exr" "$post" 'data.####.exr' "${bad[@]}" --frames 0-6
refused_with 2 "look.05.json: is not there" "$post" data.exr --look 'look.##.json' -o 'bad/o.#.png' --frames 5
for list in '' 0- 5-1 0-9:0 x 1,1 0-1000000 -1; do refused_with 2 "--frames" "$post" data.exr "${bad[@]}" --frames "$list"; done
refused_with 2 "two places" "$post" data.exr -o 'bad/#/o.#.png' --frames 0-3
refused_with 2 "--output: is required" "$post" data.exr --frames 0-3
refused_with 2 "DATA: is required" "$post" -o x.png
refused_with 2 "the folder is not there" "$post" data.exr -o 'none/o.#.png' --frames 0-3
refused_with 2 "unknown kind of picture" "$post" data.exr -o 'bad/o.#.gif' --frames 0-3
refused_with 2 "/exposure/ev/keyframes/1: expected a later time" "$post" data.exr "${bad[@]}" --frames 0-3 --set 'exposure.ev.keyframes=[[1,0],[0,1]]'
refused_with 2 "/exposure/ev: is 100" "$post" data.exr "${bad[@]}" --frames 0-3 --set 'exposure.ev={"keyframes":[[0,100],[1,200]]}'
refused_with 2 "--frame excludes --frames" "$post" data.exr "${bad[@]}" --frames 0-3 --frame 2
refused_with 2 "--show" "$post" data.exr --show shift -o 'bad/o.#.png' --frames 0-3
refused_with 2 "expected bash or zsh" "$post" --completion fish
refused_with 2 "one look to explain" "$post" data.exr --look look.json --look look.json --explain
printf 'no dataset' >data.0002.exr
refused_with 2 "data.0002.exr: is not an OpenEXR file" "$post" 'data.####.exr' --look look.json -q -o 'bad/o.#.png' --frames 2-2
[ -z "$(ls bad)" ] || fault "refused runs leave $(ls bad)"
refused_with 2 "needs ffmpeg" env PATH=/nowhere "$post" data.exr "${bad[@]}" --frames 0-3 --movie bad/m.mp4
refused_with 2 "expected .mp4 or .mkv" "$post" data.exr "${bad[@]}" --frames 0-3 --movie bad/m.gif
refused_with 2 "--movie" "$post" data.exr -o bad/o.png --movie bad/m.mp4
refused_with 2 "--movie: the folder is not there" "$post" data.exr "${bad[@]}" --frames 0-3 --movie bad/none/m.mp4
refused_with 2 "expected .png or .jpg for them, not .tif" "$post" data.exr --look look.json -o 'bad/o.#.tif' --frames 0-3 --movie bad/m.mp4
[ -z "$(ls bad)" ] || fault "refused movies leave $(ls bad)"
for option in --look --show --set; do refused_with 2 "$option: is empty" "$post" data.exr -o bad/o.png "$option" ''; done
for option in --look --movie; do refused_with 2 "$option: is empty" "$post" data.exr "${bad[@]}" --frames 0-3 "$option" ''; done
refused_with 2 "--bits: is 0" "$post" data.exr -o bad/o.png --bits 0
refused_with 2 "--bits: a channel in an .exr file has 32 bits" "$post" data.exr --show status -o bad/o.exr --bits 16
refused_with 2 "--output: the folder is not there: bad/7" "$post" data.exr -o 'bad/#/o.png' --frames 7-9
mkdir bad/o.png
refused_with 2 "--output: bad/o.png is a folder" "$post" data.exr -o bad/o.png
rmdir bad/o.png
for number in 1e400 NaN -inf; do refused_with 2 "expected a finite number" "$post" data.exr -o bad/o.png --set exposure.ev=$number; done
refused_with 2 "expected one of alpha, file, filter, offset, rotate_deg, scale, sequence, type" "$post" data.exr --look look.json -o bad/o.png --set objects.square_left.texture.file_name=x

# What a look names is an input; so is the dataset of a channel.
ln -s . link
cp grey.ppm.png grey.before
for picture in grey.ppm.png "$PWD/link/grey.ppm.png"; do refused_with 2 "is an input too" "$post" data.exr --look look.json -o "$picture"; done
refused_with 2 "is an input too" "$post" data.exr --look film.json -o f_02.png
refused_with 2 "is an input too" "${film[@]}" -o 'f_0#.png'
refused_with 2 "is an input too" "$post" 'data.####.exr' --look film.json --frames 0-3 -o 'f_0#.png'
refused_with 2 "is an input too" "$post" data.exr --show status -o data.exr
printf '1,0\n2,1\n' >tone.csv && ln -s ../tone.csv bad/tone.png
refused_with 2 "is an input too" "$post" data.exr --set 'tone={"curve":"table","file":"bad/tone.png"}' -o bad/tone.png
rm bad/tone.png
same grey.ppm.png grey.before
[ -z "$(ls bad)" ] || fault "refused runs leave $(ls bad)"

# Reports that cannot be written.
run 1 bash -c '"$@" >/dev/full' - "$post" data.exr --look look.json --frames 0-3 --json -q -o 'a/full.#.png'
grep -q "standard output: cannot write" err || fault "says nothing of the report that is lost: $(cat err)"

# The movie is whole or not there.
if command -v ffmpeg >/dev/null; then
  run 0 "$post" "${one_look[@]}" -o 'a/o.###.png' --movie 'a movie.mp4' --fps 10
  sizes=$(ffprobe -v error -count_frames -show_entries stream=nb_read_frames,width,height,r_frame_rate -of csv=p=0 'a movie.mp4')
  [ "$sizes" = "166,32,10/1,10" ] || fault "the movie is $sizes, expected 166,32,10/1,10"
fi
mkdir fake && printf '#!/bin/sh\ncat >/dev/null\necho first >&2\necho broken frame >&2\nexit 1\n' >fake/ffmpeg && chmod +x fake/ffmpeg
run 1 env PATH="$PWD/fake:$PATH" "$post" "${one_look[@]}" -q -o 'a/o.###.png' --movie m.mkv
grep -q 'm.mkv: ffmpeg cannot make the movie: broken frame' err || fault "ffmpeg's complaint is lost: $(cat err)"
printf '#!/bin/sh\nexit 0\n' >fake/ffmpeg
run 1 env PATH="$PWD/fake:$PATH" "$post" "${one_look[@]}" -q -o 'a/o.###.png' --movie m.mkv
[ "$(find . -name 'm.mkv*')" = "" ] || fault "a failed movie leaves $(find . -name 'm.mkv*')"

# Completion: what --set may hold, and bash itself.
complete() { "$post" data.exr --look look.json --complete-set "$1" | tr '\n' ' '; }
expect() { checks=$((checks + 1)); [ "$2" = "$3" ] || fault "$1: '$2', expected '$3'"; }
expect objects "$(complete objects.)" "objects.earth. objects.square_left. objects.square_right. "
expect gamut "$(complete gamut=)" "gamut=hue_preserving gamut=clip "
expect effects "$(complete effects.)" "effects.doppler= effects.irradiance_exponents. effects.radiance_exponents. effects.searchlight= "
expect pointer "$(complete /objects/earth/sp | tr ' ' '\n' | grep spec)" "/objects/earth/spectrum/"
cat >complete.sh <<'BASH'
source <("$1" --completion bash)
COMP_WORDS=("$1" data.exr --set objects.square_l) COMP_CWORD=3
_nullcone_postrender 2>/dev/null; echo "${COMPREPLY[*]}"
COMP_WORDS=("$1" data.exr --set gamut = cl) COMP_CWORD=5
_nullcone_postrender 2>/dev/null; echo "${COMPREPLY[*]}"
COMP_WORDS=("$1" data.exr --fra) COMP_CWORD=2
_nullcone_postrender 2>/dev/null; echo "${COMPREPLY[*]}"
BASH
expect bash "$(bash complete.sh "$post" | tr '\n' '|')" "objects.square_left.|clip|--frame --frames|"
run 0 "$post" --completion zsh
if command -v zsh >/dev/null; then run 0 zsh -n out; fi

finish
