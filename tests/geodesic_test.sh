#!/usr/bin/env bash
# nullcone-geodesic from outside: one ray, families, light between two places, the ray of a pixel, pictures; facts of physics, and refusals.
# Usage: geodesic_test.sh BIN_DIR SOURCE_DIR
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/checks.sh"
tests=$source_dir/tests

# refused WORDS ARGUMENTS...: exit 2 with one line that holds the words.
refused() { local words=$1; shift; refused_with 2 "$words" "$geodesic" "$@"; }
ray() { run 0 "$geodesic" "$@"; [ -s err ] && fault "talks on standard error: $*"; }
# expect PYTHON-EXPRESSION over what geodesic_expect.py has: d or table from the file out, closed from `keep`.
expect() {
  checks=$((checks + 1))
  python3 "$tests/geodesic_expect.py" "$1" >why 2>&1 || fault "$1: $(tail -1 why)"
}
keep() { cp out kept; }
# picture FILE WORDS...: a whole SVG, well-formed, without NaN, not large, that holds the words.
picture() {
  local file=$1 words
  checks=$((checks + 1))
  python3 -c "import sys, xml.dom.minidom as m; m.parse(sys.argv[1])" "$file" 2>why || fault "$file: $(tail -1 why)"
  grep -qiE 'nan|inf[^o]' "$file" && fault "$file holds numbers that are none"
  [ "$(wc -c <"$file")" -lt 100000 ] || fault "$file has $(wc -c <"$file") bytes"
  for words in "${@:2}"; do grep -qF -- "$words" "$file" || fault "'$words' is not in $file"; done
}

flat=(--metric minkowski --event 1,2,3,4 --direction 0.6,0,-0.8)
goedel=(--metric goedel --event 0,0,0,0 --direction 1,0,0)
off=(--metric goedel --event 0.3,0.7,-0.4,0.2 --direction 0.48,0.6,0.64)
hole=(--metric kerr_schild --set spin=0.9 --event 0,20,0,0)

# Straight light in flat space, closed and integrated; a falling particle.
for paths in closed integrated; do
  ray "${flat[@]}" --at -3,0,5 --paths $paths --json
  expect "all(near(x, (1 + l, 2 + .6 * l, 3, 4 - .8 * l), 1e-14) for l, x in zip((-3, 0, 5), events(d)))"
done
ray "${flat[@]}" --at 5 --speed 0.5 --paths integrated --json
expect "near(events(d)[0], (6, 3.5, 3, 2), 1e-14) and abs(d['points'][0]['square'] - .75) < 1e-14"

# Light in the Goedel universe returns in x and y after 2 pi a / sqrt(1 + n_z^2), later by 2 pi a (sqrt2 - 1) for
# n_z = 0 (docs/physics.md); it touches 2a half way.
ray "${goedel[@]}" --at 3.141592653589793,6.283185307179586 --json
expect "near(events(d)[1], (2 * math.pi * (2**.5 - 1), 0, 0, 0), 1e-14)"
expect "abs(math.hypot(*events(d)[0][1:3]) - 2) < 1e-14"
ray --metric goedel --event 0,0,0,0 --direction 0.8,0,0.6 --at 5.3877869518474935 --json
expect "near(events(d)[0][1:3], (0, 0), 1e-11)"
# The closed form against integration: 1e-9 asked for, at 1e-12.
ray "${off[@]}" --at -20,-1,3,20 --json
keep
ray "${off[@]}" --at -20,-1,3,20 --paths integrated --accuracy reference --json
expect "all(near(a, b, 1e-9) for a, b in zip(events(d), events(closed)))"
expect "all(abs(p['square']) < 1e-10 and p['status'] == 'ok' for p in d['points']) and 'square' not in closed['points'][0]"
expect "all(abs(goedel_square(p['event'], p['tangent']) - p['square']) < 1e-12 for p in d['points'])"
# Each accuracy is as good as its name: ten times its tolerance for each unit of lambda is plenty. (draft is 1e-4.)
for pair in draft:1e-4 balanced:1e-8 1e-10:1e-10; do
  ray "${off[@]}" --at -20,-1,3,20 --paths integrated --accuracy "${pair%:*}" --json
  expect "all(near(a, b, 200 * ${pair#*:}) for a, b in zip(events(d), events(closed)))"
  for integrator in dopri5 verner65 prince_dormand87 fehlberg78; do
    ray "${off[@]}" --at 3 --paths integrated --accuracy "${pair%:*}" --integrator $integrator --json
    expect "near(events(d)[0], events(closed)[2], 200 * ${pair#*:})"
  done
done
# Black holes: head on light is captured where the horizon is, and says so; what passes by is not.
ray "${hole[@]}" --direction 1,0,0 --at=-10,-60 --json
expect "[p['status'] for p in d['points']] == ['ok', 'captured'] and d['points'][1]['lambda'] > -25"
expect "1.3 < math.hypot(*events(d)[1][1:3]) < 1.7"
expect "abs(d['points'][0]['square']) < 1e-7"
ray "${hole[@]}" --direction 0,1,0 --at=-60,60
expect "[row['status'] for row in table] == ['ok', 'ok'] and abs(table[0]['E'] - table[1]['E']) < 1e-12"
ray "${hole[@]}" --set chart=ingoing --direction=-1,0,0 --at 60 --json
expect "d['points'][0]['status'] != 'ok' and d['points'][0]['lambda'] < 30"

# Tables: the same numbers as JSON; evenly spaced points.
ray "${goedel[@]}" --at 0,5 --points 11 --csv
expect "[row['lambda'] for row in table] == [i / 2 for i in range(11)] and all(row['status'] == 'ok' for row in table)"
expect "list(table[0])[:10] == ['lambda', 't', 'x', 'y', 'z', 'k_t', 'k_x', 'k_y', 'k_z', 'square']"
expect "all(abs(row['E'] - 1) < 1e-14 and abs(row['square']) < 1e-14 for row in table)"

# A fan: directions turn about e3, or in a plane of their own.
ray "${goedel[@]}" --fan 4 --at 1 --json
expect "[m['angle_deg'] for m in d['members']] == [0, 90, 180, 270] and d['family'] == 'angle_deg'"
expect "all(near(m['direction'], (math.cos(a), math.sin(a), 0), 1e-15) for m, a in
  ((m, math.radians(m['angle_deg'])) for m in d['members']))"
# The universe looks the same all round: the four points are a quarter turn apart.
expect "all(near((b[0], b[1], b[2]), (a[0], -a[2], a[1]), 1e-14) for a, b in
  zip(*(lambda e: (e, e[1:] + e[:1]))([events(m)[0] for m in d['members']])))"
ray "${goedel[@]}" --fan 3 --plane 1,0,2 --at 1 --speed 0.5
expect "[row['angle_deg'] for row in table] == [0, 120, 240] and all(abs(row['square'] - .75) < 1e-14 for row in table)"
ray "${flat[@]}" --fan 5 --plane 0,1,0 --at 1 --json
expect "all(abs(sum(n * n for n in m['direction']) - 1) < 1e-14 for m in d['members'])"

# Carried along a Killing flow: the same energy, null still, and each point where the flow carries it.
for field in K4 K5; do
  ray "${off[@]}" --at -2,0,1,4 --json
  keep
  ray "${off[@]}" --at -2,0,1,4 --killing $field --eta=-1.5,0,0.5 --json
  expect "[m['eta'] for m in d['members']] == [-1.5, 0, .5]"
  expect "all(near(x, y, 1e-14) for x, y in zip(events(d['members'][1]), events(closed)))"
  expect "all(abs(m['conserved']['E'] - 1) < 1e-12 and abs(m['conserved']['$field'] - closed['conserved']['$field']) < 1e-11
    for m in d['members'])"
  expect "all(abs(goedel_square(p['event'], p['tangent'])) < 1e-11 for m in d['members'] for p in m['points'])"
  expect "all(near(x, flow($field, y, m['eta']), 1e-10) for m in d['members'] for x, y in zip(events(m), events(closed)))"
done
ray "${off[@]}" --at 3 --json
keep
ray "${off[@]}" --at 3 --killing L --eta 0.7 --json
expect "near(events(d['members'][0])[0], (lambda t, x, y, z: (t, math.cos(.7) * x - math.sin(.7) * y,
  math.sin(.7) * x + math.cos(.7) * y, z))(*events(closed)[0]), 1e-12)"
# Far from a = 1 too, where differences need another step: from the axis, K4 leads to y = 2a sinh(eta/2).
for a in 1e-5 1e9; do
  ray "${goedel[@]}" --set a=$a --at 0 --killing K4 --eta 1 --json
  expect "near(events(d['members'][0])[0], (0, 0, 2 * $a * math.sinh(.5), 0), 1e-11 * $a)"
  expect "abs(d['members'][0]['conserved']['E'] - 1) < 1e-11"
done
ray "${off[@]}" --at 0,1 --killing K4 --eta=-8,8 --json # out to 70 a, where the isometry amplifies roundings
expect "all(abs(m['conserved']['E'] - 1) < 1e-8 for m in d['members'])"
ray --metric kerr_schild --event 0,20,3,1 --direction 0,1,0 --at=-10,10 --killing L_z --eta 0.5 --json
expect "all(p['status'] == 'ok' and abs(p['square']) < 1e-7 for p in d['members'][0]['points'])"
ray "${flat[@]}" --at 0 --killing p_x --eta 2 --json
expect "near(events(d['members'][0])[0], (1, 4, 3, 4), 1e-14)"

# All light between two places: reference cases, and facts.
connected() { ray --connect "$@" --json; }
connected --metric goedel --event 5,1.1,0.5,0 --source 0.4,-0.9,0
expect "[c['winding'] for c in d['connections']] == [0, 0] and [c['parity'] for c in d['connections']] == [1, -1] and d['complete']"
expect "near(d['connections'][0]['view'], (0.5289170255856152, -0.84867354150207, 0), 1e-12)"
expect "near([c['lambda'] for c in d['connections']], (2.1920722140414814, 4.091113093138105), 1e-12)"
expect "near([c['travel_time'] for c in d['connections']], (0.6308009691705107, 0.7036803829655589), 1e-12)"
expect "near([c['area_distance'] for c in d['connections']], (1.3350857044144149, 1.823906032166264), 1e-12)"
keep
# There and back differ in time and direction, but not in length and focusing.
connected --metric goedel --event 5,0.4,-0.9,0 --source 1.1,0.5,0
expect "near([c['travel_time'] for c in d['connections']], (1.898900186171587, 1.9717795999666354), 1e-12)"
expect "all(near([c[k] for c in d['connections']], [c[k] for c in closed['connections']], 1e-12) for k in ('lambda', 'area_distance'))"
# A ray that is sent that way arrives there.
ray --metric goedel --event 5,1.1,0.5,0 --direction=-0.5289170255856152,0.84867354150207,0 --at=-2.1920722140414814 --json
expect "near(events(d)[0], (5 - 0.6308009691705107, 0.4, -0.9, 0), 1e-12)"
connected --metric goedel --event 0,0,0,0 --source 1.8,0,6 --windings 6
expect "[c['winding'] for c in d['connections']] == [3, 3, 4, 4, 5, 5]"
expect "abs(d['connections'][0]['travel_time'] - 9.940244918339365) < 1e-11"
connected --metric goedel --event 0,0,0,0 --source 2.2,0,0 --windings 50
expect "d['connections'] == [] and d['complete']"  # beyond the horizon
connected --metric goedel --event 3,1,2,0 --source 1,2,0
expect "[c['area_distance'] for c in d['connections']] == [0]"  # its own image, a ring
connected --metric minkowski --event 5,1,2,3 --source 1,2,0 --windings 9
expect "[list(c.values()) for c in d['connections']] == [[3, 3, [0, 0, -1], 3, 1, 0]]"
connected --metric goedel --set a=1e15 --event 5,1,2,3 --source 1,-2,0
expect "near([d['connections'][0][k] for k in ('lambda', 'travel_time', 'area_distance')], (5, 5, 5), 1e-13)"
ray --connect --metric goedel --event 5,1.1,0.5,0 --source 0.4,-0.9,0
grep -q '^ *lambda *travel_time' out || fault "the table of connections has no head"
[ "$(wc -l <out)" = 3 ] || fault "the table of connections has $(wc -l <out) lines"

# The ray of a pixel.
python3 - "$source_dir/scenes/goedel_earth.json" <<'PYTHON' || fault "cannot make scenes"
import json, sys
scene = json.load(open(sys.argv[1]))
scene["camera"]["resolution"] = [132, 35]
json.dump(scene, open("earth.json", "w"))
scene["objects"][0]["placing"]["worldline"] = {"type": "static", "event": [0, 0.7, 0.6, 0]}
scene["objects"][0]["placing"]["axes"] = "static"
json.dump(scene, open("rest.json", "w"))
camera = {"type": "perspective", "azimuth_deg": 180, "fov_deg": 60, "resolution": [61, 61]}
ball = {"name": "ball", "shape": {"type": "sphere", "radius": 2}, "placing": {"type": "coordinate", "centre": [-8, 3, 0]}}
sky = {"name": "stars", "shape": {"type": "sky"}}
hole = {"metric": {"name": "kerr_schild", "spin": 0.9}, "observer": {"event": [0, 20, 0, 0]}, "camera": camera,
        "objects": [ball, sky]}
json.dump(hole, open("hole.json", "w"))
json.dump(hole | {"observer": {"event": [0, 6, 0, 0], "frame": "normal"}}, open("normal.json", "w"))
json.dump(hole | {"observer": {"event": [0, 1.9, 0, 0], "frame": "normal"}}, open("ergo.json", "w"))
fast = {"name": "fast", "shape": {"type": "sphere", "radius": 1}, "placing": {"type": "local",
        "worldline": {"type": "geodesic", "event": [0, -1, -1, 0], "velocity": [0, 0.8, 0]}}}
dome = {"name": "dome", "shape": {"type": "sphere", "radius": 50, "dome": True},
        "placing": {"type": "coordinate", "centre": [0, 0, 0]}}
flat = hole | {"metric": {"name": "minkowski"}, "observer": {"event": [0, 5, 0, 0], "velocity": [0.5, 0, 0]},
               "objects": [ball, fast, dome]}
json.dump(flat, open("flat.json", "w"))
flat["observer"]["frame"] = "normal"
json.dump(flat | {"paths": "integrated"}, open("flat_normal.json", "w"))
open("broken.json", "w").write('{\n "a": }')
PYTHON
: >empty; mkdir folder.svg
run 0 "$trace" earth.json -q -o earth.exr
ray earth.json --pixel 36,17
expect "len(table) == 400 and [row['object'] for row in table if row['object']] == ['earth']"
ray earth.json --pixel 36,17 --json --points 50
keep
expect "len(d['points']) == 50 and d['pixel'] == [36, 17] and d['rays']['status'] == 'hit'"
expect "set(d['crossings'][0]) == {'object', 'lambda', 'order', 'uv', 'shift', 't', 'tau', 'mu'}"
expect "d['points'][-1]['lambda'] == d['crossings'][0]['lambda']"
expect "abs(d['points'][-1]['event'][0] - 1.438 - d['crossings'][0]['t']) < 1e-14"
expect "all(abs(p['H']) < 1e-14 and abs(p['conserved']['E'] + 1) < 1e-14 for p in d['points'])"
# What nullcone-info tells of the dataset (floats), and the dataset itself in place of the scene.
"$info" earth.exr --json --pixel 36,17 >told
expect "(lambda h, c: h['object'] == c['object'] and near((h['Z'], *h['uv'], h['shift'], h['t'], h['tau'], h['mu']),
  (c['lambda'], *c['uv'], c['shift'], c['t'], c['tau'], c['mu']), 2e-7))(json.load(open('told'))['hits'][0], d['crossings'][0])"
ray earth.exr --pixel 36,17 --json --points 50
expect "d == closed"
# Integrated: the same crossing.
ray rest.json --pixel 34,17 --json --points 50
keep
ray rest.json --pixel 34,17 --json --points 50 --paths integrated --accuracy reference
expect "near(events(d)[-1], events(closed)[-1], 1e-9) and abs(d['crossings'][0]['shift'] - closed['crossings'][0]['shift']) < 1e-9"
expect "all(abs(p['H']) < 1e-10 for p in d['points']) and d['rays']['error'] > 0"
ray earth.json --pixel 0,34
expect "not any(row['object'] for row in table) and table[-1]['lambda'] == 10"
ray hole.json --pixel 30,30 --json
expect "d['rays']['status'] == 'captured' and d['crossings'] == [] and d['points'][-1]['lambda'] < 25"
expect "abs(d['conserved']['E'] + math.sqrt(1 - 2 / math.sqrt(400 - .81))) < 1e-14"
expect "1.3 < math.hypot(*events(d)[-1][1:3]) < 1.8 and d['points'][0]['tangent'][0] < 0"
ray hole.json --pixel 20,30 --json
expect "d['crossings'][0]['object'] == 'stars' and d['crossings'][0]['lambda'] is None and d['points'][-1]['lambda'] > 50"
ray normal.json --pixel 2,30 --json --points 5
expect "abs(d['points'][0]['H']) < 1e-14 and abs(d['points'][1]['H']) < 1e-7"
# A camera that runs away from what it sees: light has the frequency sqrt(3) at rest where it is 1 for the camera.
ray flat.json --pixel 30,30 --json --points 3
expect "abs(d['points'][2]['tangent'][0] + math.sqrt(3)) < 1e-3 and abs(d['crossings'][0]['shift'] * math.sqrt(3) - 1) < 1e-3"

# Pictures: silent, whole, small.
for arguments in "--fan 12 --at 0,6.283185307179586" "--killing K4 --eta -1,0,1 --at 0,6.3" "--at 5" "--fan 1 --at 2" \
                 "--at 0,1e-9" "--at 0,1e15" "--set a=1e9 --at 0,1e9" "--at 0"; do
  rm -f a.svg
  # shellcheck disable=SC2086
  ray "${goedel[@]}" $arguments --plot a.svg
  [ -s out ] && fault "--plot alone talks on standard output"
  picture a.svg "goedel" "λ = 0"
done
ray "${goedel[@]}" --killing K4 --eta=-1,0,1 --at 0,6.3 --plot a.svg --json
expect "len(d['members']) == 3"
picture a.svg "η = -1" "Killing field K4" "Gödel radius 2a"
ray "${hole[@]}" --direction 1,0,0 --fan 40 --at=-60 --plot a.svg
picture a.svg "horizon" "spin = 0.9" "chart = outgoing"
ray --metric ellis_wormhole --event 0,5,0,0 --direction 1,0,0 --at=-15 --plot a.svg
picture a.svg "throat"
ray earth.json --pixel 36,17 --plot a.svg
picture a.svg "earth" "square_left" "crossing" "observer" "Pixel 36,17"
ray flat.json --pixel 2,30 --plot a.svg
picture a.svg "fast" "dome"
cp "$work/hole.json" "a<b>&'c.json"
ray "a<b>&'c.json" --pixel 2,30 --plot a.svg
picture a.svg "of a&lt;b&gt;&amp;'c.json" # a name is text, not markup
checks=$((checks + 1))
[ -z "$(find . -name '*part-*')" ] || fault "half-written files are left"

# Refusals.
refused "--metric: is required" --at 1
for option in --event --direction --at; do
  arguments=()
  for pair in --event:0,0,0,0 --direction:1,0,0 --at:1; do
    [ "${pair%%:*}" = $option ] || arguments+=("${pair%%:*}" "${pair#*:}")
  done
  refused "$option: is required" --metric goedel "${arguments[@]}"
done
refused "--pixel: needs a SCENE" "${goedel[@]}" --at 1 --pixel 1,1
refused "--pixel: is required" earth.json
for extra in "--metric goedel" "--set a=1" "--event 0,0,0,0" "--direction 1,0,0" "--speed 0.5" "--at 1" "--fan 3" \
             "--plane 0,0,1" "--killing K4" "--eta 1"; do
  # shellcheck disable=SC2086
  refused "${extra%% *}: does not go with a scene" earth.json --pixel 1,1 $extra
done
for pixel in 132,0 0,35 -1,0 0,-1 1 1,2,3 1.5,0 x,y "1, 2" ,1 1, "" 99999999999,0 1e1,0 nan,0; do
  refused "--pixel" earth.json --pixel "$pixel"
done
refused "none.json: cannot open" none.json --pixel 1,1
refused "empty: is empty" empty --pixel 1,1
refused "broken.json: line 2, column 7" broken.json --pixel 1,1
ray ergo.json --pixel 1,1  # nobody can rest there, but normal observers can look
refused "--paths: the observer's frame" flat_normal.json --pixel 1,1 --paths closed
refused "has no closed-form paths" "${hole[@]}" --direction 1,0,0 --at 1 --paths closed
refused "has no closed-form paths" hole.json --pixel 1,1 --paths closed
for accuracy in nan 0 -1 1 1e-16 best 1e-8x ""; do
  [ -z "$accuracy" ] || refused "--accuracy" "${goedel[@]}" --at 1 --paths integrated --accuracy "$accuracy"
done
refused "--integrator" "${goedel[@]}" --at 1 --integrator euler
refused "--event: no observer is at rest there" --metric kerr_schild --event 0,1.5,0,0 --direction 1,0,0 --at 1
refused "--event: no observer is at rest there" --metric ellis_wormhole --event 0,0,0,0 --direction 1,0,0 --at 1
for fan in 0 -1 1.5 x 10001; do refused "--fan" "${goedel[@]}" --at 1 --fan $fan; done
for plane in 1,0,0 0,0,0 nan,0,0 0,1 x; do refused "--plane" "${goedel[@]}" --at 1 --fan 3 --plane $plane; done
refused "--plane: needs --fan" "${goedel[@]}" --at 1 --plane 0,0,1
refused "--plane: is required" --metric goedel --event 0,0,0,0 --direction 0,0,1 --at 1 --fan 3
refused "expected one of E, L, p_z, K4, K5" "${goedel[@]}" --at 1 --killing K9 --eta 1
refused "expected one of E, L_z" "${hole[@]}" --direction 0.6,0,0.8 --at 1 --killing Q --eta 1  # quadratic: no field
refused "--eta: is required" "${goedel[@]}" --at 1 --killing K4
refused "--killing: is required" "${goedel[@]}" --at 1 --eta 1
refused "--fan: does not go with --killing" "${goedel[@]}" --at 1 --killing K4 --eta 1 --fan 3
for eta in nan inf x "1,,2" 1e999 ""; do [ -z "$eta" ] || refused "--eta" "${goedel[@]}" --at 1 --killing K4 --eta "$eta"; done
refused "--eta: the field does not carry so far" "${goedel[@]}" --at 1 --killing K4 --eta 1e6
refused "--eta: the field does not carry so far" --metric goedel --event 0,1e5,0,0 --direction 0,1,0 --at 1 --killing K4 --eta 1
for points in 0 1 -5 1.5 x 1000001; do refused "--points" "${goedel[@]}" --at 0,1 --points $points; done
refused "--points: needs at least two values" "${goedel[@]}" --at 1 --points 5
refused "--csv" "${goedel[@]}" --at 1 --json --csv
between=(--connect --metric goedel --event 0,0,0,0 --source 1,0,0)
for windings in 0 -1 1.5 x 1001; do refused "--windings" "${between[@]}" --windings $windings; done
for source in 1,2 1,2,3,4 nan,0,0 x; do refused "--source" --connect --metric goedel --event 0,0,0,0 --source $source; done
for event in 1,2,3 inf,0,0,0; do refused "--event" --connect --metric goedel --event $event --source 1,0,0; done
refused "--source: is required with --connect" --connect --metric goedel --event 0,0,0,0
refused "--event: is required with --connect" --connect --metric goedel --source 0,0,0
refused "--metric: is required with --connect" --connect --event 0,0,0,0 --source 0,0,0
refused "--source: needs --connect" "${goedel[@]}" --at 1 --source 1,0,0
refused "--windings: needs --connect" "${goedel[@]}" --at 1 --windings 2
refused "--source: no observer is at rest there" --connect --metric kerr_schild --event 0,9,0,0 --source 1,0,0
for other in "--direction 1,0,0" "--speed .5" "--at 1" "--points 9" "--paths closed" "--accuracy draft" "--integrator dopri5" \
             "--fan 3" "--plane 0,0,1" "--killing K4" "--eta 1" "--plot a.svg" "--csv" "--pixel 1,1" "earth.json"; do
  # shellcheck disable=SC2086
  refused "does not go with --connect" "${between[@]}" $other
done
echo before >before.svg
for file in a.png .svg none/a.svg folder.svg /proc/a.svg before.svg/a.svg; do
  refused "--plot $file" "${goedel[@]}" --at 1 --plot $file
done
refused "--pixel" earth.json --pixel 999,1 --plot before.svg
refused "--direction" --metric goedel --event 0,0,0,0 --direction 2,0,0 --at 1 --plot before.svg
checks=$((checks + 2))
[ "$(cat before.svg)" = before ] || fault "a refused run changed the picture that was there"
[ -z "$(find . -name '*part-*')" ] || fault "half-written files are left"
run 1 bash -c "ulimit -f 1; exec '$geodesic' ${goedel[*]} --fan 40 --at 0,6 --plot before.svg --json"
[ -s out ] && fault "reports although the picture could not be written"
[ "$(cat before.svg)" = before ] || fault "a full disk cost the picture that was there"

finish
