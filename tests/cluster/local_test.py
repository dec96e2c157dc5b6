#!/usr/bin/env python3
"""nullcone-submit --local, in the same trouble as with Slurm, but without one; and who may work in a folder.

Usage: local_test.py TOOLS_DIR SOURCE_DIR [SCENARIO...]   (all of them; their names are those of the functions here)
"""
import collections
import concurrent.futures
import hashlib
import json
import os
import signal
import struct
import subprocess
import time

from cluster_trouble import fill, small_disk
from slurm_cluster import kill, main, waited

HERE = ["--local", "--jobs", "2", "--retry-delay", "0"]
NO_SLURM = {"PATH": "/nowhere"}


def start(place, tools, folder, *options, scene=None):
    return subprocess.Popen([tools / "nullcone-submit", scene or place.sequence, "-o", folder, *HERE, *options], text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, env={**os.environ, **NO_SLURM})


def ended(place, child, status, text=""):
    """It ends in time, so, and says so."""
    try:
        out, error = child.communicate(timeout=60)
    except subprocess.TimeoutExpired:
        child.kill()
        child.communicate()
        return place.check(False, "a submission does not end")
    return place.check(child.returncode == status and text in error, f"status {child.returncode}, expected {status}: {error[-400:]!r}")


def frames(folder):
    return len(list(folder.glob("data.????.exr")))


def undisturbed(place):
    tools, folder = place.tools("plain"), place.root / "plain"
    for calls in (place.FRAMES, 0):
        ended(place, start(place, tools, folder), 0)
        place.whole(folder, "undisturbed")
        place.check.equal("undisturbed: calls", len(place.calls(tools)), calls)
        (tools / "calls").unlink()
        (tools / "calls").touch()
    folder = place.root / "it's %d"
    ended(place, start(place, place.bin, folder, "--shards", "3", "--frames", "2-6", "--quiet"), 0)
    place.whole(folder, "shards", {frame: place.reference()[frame] for frame in range(2, 7)})


def in_parts(place):
    """A scene in several files is whole in the folder, and these are not needed any more."""
    parts, folder = place.root / "parts", place.root / "of parts"
    parts.mkdir()
    whole = json.loads(place.sequence.read_text())
    whole.pop("$schema")
    (parts / "objects.json").write_text(json.dumps(whole["objects"]))
    (parts / "look.json").write_text('{"$schema": "x", "exposure": {"ev": 1}} // of no account')
    scene = {**whole, "$schema": "x", "objects": [{"include": "objects.json"}], "look": {"include": "look.json"}}
    (parts / "scene.json").write_text(json.dumps(scene))
    ended(place, start(place, place.bin, folder, "--frames", "0-1", scene=parts / "scene.json"), 0)
    place.check.equal("in parts: the scene", json.loads((folder / "scene.json").read_text()), {**whole, "look": {"exposure": {"ev": 1}}})
    place.check.equal("in parts: the look", json.loads((folder / "look.json").read_text()), {"exposure": {"ev": 1}})
    place.whole(folder, "in parts", {frame: place.reference()[frame] for frame in range(2)})
    whole["objects"][0]["shape"]["radius"] = -1
    (parts / "objects.json").write_text(json.dumps(whole["objects"]))
    ended(place, start(place, place.bin, folder, scene=parts / "scene.json"), 2, "objects.json (frame 0): /0/shape/radius: is -1")


def meshes(place):
    """Files of meshes are copied into the folder; others than those that were submitted are refused, there and beside the scene."""
    made, folder = place.root / "made", place.root / "with meshes"
    (made / "parts").mkdir(parents=True)
    rock = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
    (made / "rock.obj").write_text(rock)
    corners = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    triangle = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "buffers": [{"byteLength": 36, "uri": "triangle.bin"}],
                "bufferViews": [{"buffer": 0, "byteLength": 36}],
                "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}]}
    (made / "parts/triangle.gltf").write_text(json.dumps(triangle))
    (made / "parts/triangle.bin").write_bytes(corners)
    objects = [{"name": name, "shape": {"type": "mesh", "file": file, "scale": 0.1},
                "placing": {"type": "coordinate", "centre": [0.5, y, 0]}} for name, file, y in
               [("rock", "rock.obj", 0), ("sail", "parts/triangle.gltf", 0.3)]]
    scene = place.write_scene("made/scene", objects=objects, look={}, frames={"count": 3, "from": 0, "to": 1})

    def submit(status=0, text="", *options):
        ended(place, start(place, place.bin, folder, *options, scene=scene), status, text)

    def payloads():
        return {frame: place.payload(folder / f"data.{frame:04}.exr") for frame in range(3)}

    submit()
    for name in ("rock.obj", "parts/triangle.gltf", "parts/triangle.bin"):
        place.check((folder / name).read_bytes() == (made / name).read_bytes(), f"meshes: {name} is not copied")
    shapes = [entry["shape"] for entry in json.loads((folder / "scene.json").read_text())["objects"]]
    digest = lambda name: hashlib.sha256((made / name).read_bytes()).hexdigest()
    place.check.equal("meshes: hashes", shapes, [{**objects[0]["shape"], "sha256": digest("rock.obj")},
        {**objects[1]["shape"], "sha256": digest("parts/triangle.gltf"),
         "buffers": [{"file": "triangle.bin", "sha256": digest("parts/triangle.bin")}]}])
    before = payloads()
    times = {path: path.stat().st_mtime_ns for path in folder.glob("data.*.exr")}
    copied = (folder / "rock.obj").stat().st_mtime_ns
    submit()
    place.check.equal("meshes: nothing changed", {path: path.stat().st_mtime_ns for path in folder.glob("data.*.exr")}, times)
    place.check.equal("meshes: copied again", (folder / "rock.obj").stat().st_mtime_ns, copied)
    place.run("nullcone-trace", folder / "scene.json", "--frame", "1", "-o", folder / "data.####.exr")

    # Another mesh, or only another buffer, is another scene.
    for name, other in (("rock.obj", rock.replace("v 0 0 1", "v 0 0 3").encode()), ("parts/triangle.bin", struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 3, 0))):
        (made / name).write_bytes(other)
        kept = {path: path.read_bytes() for path in folder.iterdir() if path.is_file()}
        submit(2, "is of another scene; expected another folder, or --replace")
        place.check.equal("meshes: refused", {path: path.read_bytes() for path in kept}, kept)
        submit(0, "", "--replace")
        place.check((folder / name).read_bytes() == other, f"meshes: {name} is not copied again")
        now = payloads()
        place.check(all(now[frame] != before[frame] for frame in now), f"meshes: frames are those of the other {name}")
        before = now

    # Changed in the folder after the submission: no job traces it.
    (folder / "data.0001.exr").unlink()
    (folder / "rock.obj").write_text(rock)
    place.refused(2, "scene.json (frame 1): /objects/0/shape/sha256: the file 'rock.obj' is another",
                  "nullcone-trace", folder / "scene.json", "--frame", "1", "-o", folder / "data.####.exr")
    place.refused(2, "the file 'rock.obj' is another", "nullcone-submit", folder / "scene.json", "-o", folder, *HERE)
    place.check(not (folder / "data.0001.exr").exists(), "meshes: a frame of another mesh was traced")
    submit()  # the folder's copy is mended
    place.check.equal("meshes: mended", payloads(), before)

    # While the jobs are at work: no frame of the other mesh.
    waits = place.root / "waits"
    waits.touch()
    tools = place.tools("meshes", f"[ $frame = 0 ] || while [ -e {waits} ]; do sleep 0.1; done")
    child = start(place, tools, place.root / "changed", "--tries", "1", scene=scene)
    place.check(waited(lambda: frames(place.root / "changed") == 1 and len(place.calls(tools)) == 3), "meshes: the first frame is not there")
    (place.root / "changed/rock.obj").write_text(rock)
    waits.unlink()
    (made / "rock.obj").unlink()  # what was submitted is in the folder
    ended(place, child, 2, "): /objects/0/shape/sha256: the file 'rock.obj' is another")
    (made / "rock.obj").write_text(rock)
    place.check.equal("meshes: frames of one mesh alone", frames(place.root / "changed"), 1)

    # Nothing of the folder's own is written over.
    triangle["buffers"][0]["uri"] = "cluster/001.array.sh"
    (made / "cluster").mkdir()
    (made / "cluster/001.array.sh").write_bytes(corners)
    (made / "own.gltf").write_text(json.dumps(triangle))
    objects[1]["shape"]["file"] = "own.gltf"
    scene = place.write_scene("made/scene", objects=objects, look={}, frames={"count": 3, "from": 0, "to": 1})
    folder = place.root / "own"
    submit(2, "is a name of the folder's own")
    place.check(not (folder / "cluster/001.array.sh").exists(), "meshes: a script is written over")


def kills(place):
    tools, folder = place.tools("kills", "sleep 0.1"), place.root / "kills"
    child = start(place, tools, folder, "--tries", "50")
    hits = collections.Counter()
    end = time.monotonic() + 20
    while child.poll() is None and time.monotonic() < end and hits.total() < 20:
        time.sleep(place.random.uniform(0, 0.2))
        processes = sorted(place.processes("/nullcone-trace", folder))
        number = place.random.choice([signal.SIGKILL, signal.SIGTERM])
        hits[number.name] += bool(processes and kill(place.random.choice(processes), number))
    print("  hits:", dict(hits))
    place.check(min(hits["SIGKILL"], hits["SIGTERM"]) > 3, f"kills: {hits} only")
    ended(place, child, 0)
    place.whole(folder, "kills")


def stopped(place):
    """SIGTERM and SIGINT to the submitter end all soon; SIGKILL too; the same command goes on."""
    slow, folder = place.root / "slow", place.root / "stopped"
    tools = place.tools("stopped", f"[ ! -e {slow} ] || {{ echo >>{slow}; sleep 20; }}")
    for number, status in [(signal.SIGTERM, 3), (signal.SIGINT, 3), (signal.SIGKILL, -9)]:
        there = frames(folder)
        child = start(place, tools, folder)
        place.check(waited(lambda: frames(folder) >= there + 3), f"stopped: nothing begins before {number.name}")
        slow.touch()  # all that begin now would take long
        place.check(waited(lambda: slow.stat().st_size == 2), "stopped: nobody is at work")
        child.send_signal(number)
        begun = time.monotonic()
        ended(place, child, status, "interrupted; the same command goes on" if status == 3 else "")
        place.check(waited(lambda: not place.processes("/nullcone-trace", folder), 3), f"{number.name}: processes are left")
        place.check(time.monotonic() - begun < 3, f"{number.name}: ends late")
        slow.unlink()
    place.check(0 < frames(folder) < place.FRAMES, "stopped: all frames are there already")
    ended(place, start(place, tools, folder), 0)
    place.whole(folder, "stopped")
    calls = collections.Counter(frame for _, frame in place.calls(tools))
    place.check(calls.total() == place.FRAMES + 3 * 2, f"stopped: frames were traced again: {calls}")


def full_disk(place):
    tools = place.tools("disk", "sleep 0.1")
    with small_disk(place) as mounted:
        if mounted is None:
            return
        folder = mounted / "disk"
        child = start(place, tools, folder, "--tries", "9")
        place.check(waited(lambda: frames(folder) >= 3), "disk: nothing begins")
        filler = fill(mounted)
        calls = len(place.calls(tools))
        place.check(waited(lambda: len(place.calls(tools)) > calls + 4), "disk: nothing is tried")
        place.check(frames(folder) < place.FRAMES, "disk: it was not full")
        filler.unlink()
        child.communicate(timeout=60)  # where it found no room for its plan it has ended
        place.check(child.returncode in (0, 1), f"disk: status {child.returncode}")
        ended(place, start(place, tools, folder), 0)
        place.whole(folder, "disk")


def hopeless(place):
    tools = place.tools("hopeless", '[ "$frame" != 5 ] || { echo "no such star" >&2; exit 1; }\n'
                                    '[ "$frame" != 6 ] || kill -KILL $$')
    folder = place.root / "hopeless"
    ended(place, start(place, tools, folder), 1, "no such star")
    calls = collections.Counter(frame for _, frame in place.calls(tools))
    place.check.equal("hopeless: tries", calls, collections.Counter({**dict.fromkeys(range(place.FRAMES), 1), 5: 3, 6: 3}))
    place.check.equal("hopeless: missing", place.missing(folder), "5-6")
    text = (folder / "cluster/failed.txt").read_text()
    place.check("frame 5: failed 3 times" in text and "frame 6: failed 3 times" in text and "signal 9" in text, f"failed.txt: {text!r}")
    ended(place, start(place, place.bin, folder), 0)
    place.whole(folder, "hopeless")


def locks(place):
    """Who lives is not disturbed, also on another host; who is dead, or long gone, blocks nobody."""
    folder, other = place.root / "locks", place.root / "elsewhere"
    lock = folder / "cluster/lock"
    submit = lambda where: ("nullcone-submit", place.sequence, "-o", where, "--frames", "0-1", *HERE)
    child = start(place, place.tools("locks", "sleep 60"), folder)
    place.check(waited(lock.exists) and waited(lambda: place.processes("/nullcone-trace", folder)), "locks: nothing begins")
    text = lock.read_text()
    lines = text.splitlines()
    place.check(lines[0] == os.uname().nodename and lines[1] == str(child.pid), f"a lock says {text!r}")
    foreign = "\n".join(["elsewhere", lines[1], "another-start/1", *lines[3:]]) + "\n"
    (other / "cluster").mkdir(parents=True)
    (other / "cluster/lock").write_text(foreign)
    with concurrent.futures.ThreadPoolExecutor() as both:  # each has some seconds of patience
        both.submit(place.refused, 1, f"process {child.pid} on {os.uname().nodename}", *submit(folder))
        both.submit(place.refused, 1, "on elsewhere", *submit(other))
    place.check(child.poll() is None and lock.read_text() == text, "locks: the holder was disturbed")
    child.kill()
    child.communicate()
    place.check(waited(lambda: not place.processes("/nullcone-trace", folder), 3), "locks: processes are left")
    place.check(lock.exists(), "locks: a process that was killed leaves no lock")

    for what, old in [("of a dead process", text), ("of another host", foreign), ("torn", text[:3]), ("empty", ""), ("of nobody", "\0\n" * 9)]:
        lock.write_text(old)
        if what != "of a dead process":
            os.utime(lock, (time.time() - 3600,) * 2)
        begun = time.monotonic()
        place.run(*submit(folder))
        place.check(time.monotonic() - begun < 5, f"a lock {what} blocks")
        place.check(not lock.exists(), f"a lock {what} is left")
        lock.unlink(missing_ok=True)
        (folder / "data.0001.exr").unlink(missing_ok=True)
    place.run(*submit(folder))
    place.check.equal("locks: beside them", sorted(path.name for path in lock.parent.glob("lock*")), [])
    place.whole(folder, "locks", {frame: place.reference()[frame] for frame in range(2)})


if __name__ == "__main__":
    main([undisturbed, in_parts, meshes, kills, stopped, full_disk, hopeless, locks])
