#!/usr/bin/env bash
# Scenes with meshes: whose files changed in between is not put together, gone on with, or traced again; and files that are no meshes.
# Usage: mesh_files_test.sh BIN_DIR SOURCE_DIR
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/checks.sh"
merge=$bin/nullcone-merge

scene() {  # scene FILE MESH [PYTHON]: a picture of two bands with one mesh in it
  python3 - "$@" <<'PYTHON'
import json, sys
name, mesh, *change = sys.argv[1:]
s = {"metric": {"name": "minkowski"}, "observer": {"event": [0, 0, 0, 0]},
     "camera": {"type": "perspective", "fov_deg": 40, "resolution": [48, 32]},
     "objects": [{"name": "rock", "shape": {"type": "mesh", "file": mesh},
                  "placing": {"type": "local", "worldline": {"type": "static", "event": [0, 4, 0, 0]}}}]}
if change: exec(change[0])
json.dump(s, open(name, "w"))
PYTHON
}
rock() { printf 'v 0 0 0\nv 1 0 0\nv 0 %s 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n' "$1"; }
hash_of() { sha256sum "$1" | cut -d' ' -f1; }
in_dataset() {  # in_dataset FILE TEXT: in the scene of its manifest
  checks=$((checks + 1))
  "$info" "$1" --json | python3 -c 'import json, sys; print(json.dumps(json.load(sys.stdin)["scene"]))' | grep -qF "$2" || fault "$1 has no $2"
}

rock 1 >rock.obj
scene a.json rock.obj
run 0 "$trace" -q a.json -o a.exr
run 0 "$info" --verify a.exr
in_dataset a.exr "\"sha256\": \"$(hash_of rock.obj)\""

# Again from its header, from any folder, but only with the same mesh beside it.
mkdir elsewhere
run 0 env -C elsewhere "$trace" -q --from ../a.exr -o ../again.exr
run 0 cmp <("$info" a.exr --json | grep sha256) <("$info" again.exr --json | grep sha256)
cp a.exr elsewhere
refused_with 2 "elsewhere/rock.obj: cannot open the file" "$trace" -q --from elsewhere/a.exr -o x.exr
rock 1.5 >elsewhere/rock.obj
refused_with 2 "elsewhere/a.exr: /objects/0/shape/sha256: the file 'rock.obj' is another: expected SHA-256 $(hash_of rock.obj), found $(hash_of elsewhere/rock.obj)" \
  "$trace" -q --from elsewhere/a.exr -o x.exr

# Windows of the picture, with another mesh in between.
run 0 "$trace" -q a.json --shard 1/2 -o s1.exr
run 0 "$trace" -q a.json --shard 2/2 -o s2.exr
run 0 "$merge" -q s1.exr s2.exr -o whole.exr
rock 1.5 >rock.obj
run 0 "$trace" -q a.json --shard 2/2 -o t2.exr
refused_with 2 "t2.exr: was traced with another mesh file 'rock.obj' (of s1.exr)" "$merge" -q s1.exr t2.exr -o x.exr
scene other.json rock.obj 's["observer"]["event"][1] = 0.5'
run 0 "$trace" -q other.json --shard 2/2 -o t2.exr
refused_with 2 "t2.exr: has another scene" "$merge" -q s1.exr t2.exr -o x.exr

# A partial file of the other mesh; a sequence.
cp s1.exr p.partial.exr
refused_with 2 "p.partial.exr: cannot go on from it: it was traced with another mesh file 'rock.obj'" "$trace" -q a.json --shard 1/2 --resume -o p.exr
scene sequence.json rock.obj 's["frames"] = {"count": 2, "from": 0, "to": 1}'
run 0 "$trace" sequence.json --frames 0-1 -o f.#.exr
grep -q "2 traced, 0 skipped" err || fault "frames: $(cat err)"
run 0 "$trace" sequence.json --frames 0-1 -o f.#.exr
grep -q "0 traced, 2 skipped" err || fault "frames that are there: $(cat err)"
rock 1 >rock.obj
run 0 "$trace" sequence.json --frames 0-1 -o f.#.exr --missing
[ "$(cat out)" = 0-1 ] || fault "missing with another mesh: $(cat out)"
run 0 "$trace" sequence.json --frames 0-1 -o f.#.exr
grep -q "2 traced, 0 skipped" err || fault "frames of another mesh: $(cat err)"

# A scene may say itself which mesh it means.
scene pinned.json rock.obj "s['objects'][0]['shape']['sha256'] = '$(hash_of rock.obj)'"
run 0 "$trace" -q pinned.json -o b.exr
run 0 cmp <("$info" a.exr --json | grep sha256) <("$info" b.exr --json | grep sha256)
rock 2 >rock.obj
refused_with 2 "pinned.json: /objects/0/shape/sha256: the file 'rock.obj' is another" "$trace" -q pinned.json -o b.exr

# Files that are no meshes: one line, soon.
bad() {  # bad FILE WORDS
  scene bad.json "$1"
  refused_with 2 "$1: $2" "$trace" -q bad.json -o x.exr
}
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\n' >corners.obj
(cat corners.obj && echo 'v 0 nan 0') >nan.obj
(cat corners.obj && echo 'f 1 2 4') >index.obj
python3 - <<'PYTHON'
import gzip, zipfile
text = open("rock.obj").read()
with zipfile.ZipFile("zip.obj", "w") as archive: archive.writestr("rock.obj", text)
open("zip.glb", "wb").write(open("zip.obj", "rb").read())
with open("huge.obj", "wb") as out:
    out.write(open("zip.obj", "rb").read())
    out.truncate(2 << 30)
open("gzip.obj", "wb").write(gzip.compress(text.encode()))
open("wide.obj", "wb").write(text.encode("utf-16"))
PYTHON
echo '<!DOCTYPE html><title>404</title>' >page.obj
mkdir folder.obj
bad corners.obj "has no faces; expected a Wavefront OBJ file with triangles"
bad nan.obj "line 4: expected finite numbers"
bad index.obj "line 4: names number 4 of 3 positions so far"
bad huge.obj "is larger than 1 GiB"
bad zip.obj "line 1: is not text; expected a Wavefront OBJ file"
bad gzip.obj "line 1: is not text; expected a Wavefront OBJ file"
bad wide.obj "line 1: is not text; expected a Wavefront OBJ file"
bad zip.glb "is not text, and does not begin with glTF; expected a glTF 2.0 file"
bad page.obj "has no faces; expected a Wavefront OBJ file with triangles"
bad folder.obj "is a folder; expected a mesh"
bad absent.obj "cannot open the file"
finish
