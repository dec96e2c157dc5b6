"""Scenarios without trouble: submitting, also again and at once, looking on, cancelling, single pictures, wrong input."""
import json
import os
import re
import shutil
import subprocess

from slurm_cluster import waited

QUICK = ["--retry-delay", "1"]


def undisturbed(place, slurm):
    folder = place.root / "plain"
    told = place.run("nullcone-submit", place.sequence, "-o", folder, *QUICK, "--sbatch=--comment=ours").stdout
    place.check("round 1" in told and "job " in told, f"tells {told!r}")
    ids = [number for _, number in slurm.written(folder)]
    place.check(ids and "Comment=ours" in place.run("scontrol", "show", "job", ids[0]).stdout, "--sbatch is not passed on")
    slurm.over(folder)
    place.whole(folder, "undisturbed")
    place.check((folder / "cluster/001/finish.log").exists(), "no finish.log")
    place.check.equal("rounds", len(list((folder / "cluster").glob("*.plan.json"))), 1)


def shards(place, slurm):
    """In a folder with an unpleasant name, through a launcher; more tasks than an array may have."""
    folder, seen = place.root / "it's 50% $HOME %j", place.root / "launched"
    launcher = place.root / "launch er"
    launcher.write_text(f"#!/bin/sh\necho \"$*\" >>'{seen}'\nexec \"$@\"\n")
    launcher.chmod(0o755)
    frames = 6
    place.run("nullcone-submit", place.sequence, "-o", folder, "--frames", f"0-{frames - 1}", "--shards", "3", "--per-task", "1",
              "--launcher", f"'{launcher}'", *QUICK)
    kinds = [kind for kind, _ in slurm.written(folder)]
    place.check.equal("17 or 18 tasks, arrays of 8", kinds, ["array"] * 3 + ["finish"])
    slurm.over(folder)
    place.whole(folder, "shards", {frame: place.reference()[frame] for frame in range(frames)})
    lines = seen.read_text().splitlines() if seen.exists() else []
    place.check(any("--task" in line for line in lines) and any("--finish" in line for line in lines),
                f"the launcher started {lines}")


def again(place, slurm):
    """What is there is not traced again, whatever the look; a scene that differs is refused."""
    tools = place.tools("again")
    folder, submit = place.root / "again", (tools / "nullcone-submit", place.sequence, "-o", place.root / "again", *QUICK)
    place.run(*submit)
    slurm.over(folder)
    times = {path: path.stat().st_mtime_ns for path in folder.glob("data.*")}
    place.check.equal("frames traced", sorted(frame for _, frame in place.calls(tools)), list(range(place.FRAMES)))

    hotter = place.write_scene("hotter", look={"objects": {
        "earth": {"spectrum": {"type": "black_body", "temperature_K": 6000}}}})
    for scene in (place.sequence, hotter):
        told = place.run(tools / "nullcone-submit", scene, "-o", folder).stdout
        place.check("all 24 frames are there" in told, f"again: tells {told!r}")
        place.check.equal("again: jobs", slurm.jobs(folder), [])
    place.check.equal("again: frames traced", len(place.calls(tools)), place.FRAMES)
    place.check("temperature_K" in (folder / "scene.json").read_text(), "the new look did not come to the folder")
    other = place.write_scene("other", max_lookback=9)
    place.refused(2, "of another scene", tools / "nullcone-submit", other, "-o", folder)
    place.check.equal("again: times", {path: path.stat().st_mtime_ns for path in folder.glob("data.*")}, times)


def at_once(place, slurm):
    """Three submissions at the same moment: each piece is traced once."""
    tools, folder = place.tools("at_once", "sleep 0.2"), place.root / "at_once"
    submit = (tools / "nullcone-submit", place.sequence, "-o", folder, *QUICK)
    children = [subprocess.Popen([*submit, "--frames", "0-11"], text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
                for _ in range(3)]
    ends = [(child.communicate(timeout=60), child.returncode) for child in children]
    for (_, said), status in ends:
        place.check(status == 0 or (status == 1 and said.count("\n") == 1), f"at once: status {status}: {said!r}")
    place.check.equal("at once: submitted", sum("round 1" in out for (out, _), _ in ends), 1)
    told = place.run(*submit, "--frames", "8-23").stdout  # what others have already stays theirs
    place.check("round 2: 12 frames" in told, f"at once: tells {told!r}")
    slurm.over(folder)
    place.whole(folder, "at once")
    place.check.equal("at once: frames traced", sorted(frame for _, frame in place.calls(tools)), list(range(place.FRAMES)))


def dry_run(place, slurm):
    folder = place.root / "it's $(dry) %j"
    for options in ([], ["--shards", "3", "--partition", "a b", "--launcher", "singularity exec image.sif", "--time", "7"]):
        text = place.run("nullcone-submit", place.sequence, "-o", folder, "--dry-run", *options).stdout
        place.check("sbatch" in text and "--task" in text and "--finish" in text, f"--dry-run prints {text[:300]}")
        done = subprocess.run(["bash", "-n"], input=text, text=True, capture_output=True)
        place.check(done.returncode == 0 and not done.stderr, f"bash does not accept it: {done.stderr}")
    place.check(not folder.exists(), "--dry-run writes")

    folder = place.root / "scripts"
    place.run("nullcone-submit", place.sequence, "-o", folder, "--frames", "0-3", "--trial", "none", "--scripts-only")
    scripts = sorted((folder / "cluster").glob("*.sh"))
    place.check.equal("scripts", [path.name for path in scripts], ["001.array.sh", "001.finish.sh", "001.submit.sh"])
    for path in scripts:
        place.run("bash", "-n", path)
    place.check.equal("--scripts-only: jobs", slurm.jobs(folder), [])
    before = {path: path.stat().st_mtime_ns for path in folder.rglob("*")}
    place.run("nullcone-submit", place.sequence, "-o", folder, "--dry-run")
    place.check.equal("--dry-run in a folder", {path: path.stat().st_mtime_ns for path in folder.rglob("*")}, before)
    place.run("sh", scripts[2])
    slurm.over(folder)
    place.whole(folder, "scripts", {frame: place.reference()[frame] for frame in range(4)})


def status(place, slurm):
    """Numbers that fit one another, while it runs and after; --watch ends with the work."""
    folder = place.root / "status"
    tools = place.tools("status", "sleep 0.2")
    place.refused(2, "nothing was submitted", "nullcone-submit", "--status", folder)
    place.run(tools / "nullcone-submit", place.sequence, "-o", folder, "--per-task", "4", "--quiet")
    watch = subprocess.Popen([place.bin / "nullcone-submit", "--status", folder, "--watch", "0.3"], text=True,
                             stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    seen = []

    def look():
        state = json.loads(place.run("nullcone-submit", "--status", folder, "--json").stdout or "{}")
        seen.append(state)
        files = len(list(folder.glob("data.????.exr")))
        sum_ = state["done"] + state["running"] + state["waiting"] + state["failed"]
        place.check(state["frames"] == place.FRAMES and sum_ <= place.FRAMES and state["done"] <= files, f"status: {state}")
        place.check(sum_ == place.FRAMES or not state["working"] or files > state["done"], f"status: frames are lost: {state}")
        place.check.equal("status: frames of hosts", sum(host["frames"] for host in state["hosts"].values()), state["done"])
        return not state["working"]

    waited(look, 60)
    slurm.over(folder)
    done = [state["done"] for state in seen]
    place.check(done == sorted(done) and len(set(done)) > 3, f"status: done {done}")
    place.check(any(0 < state["running"] <= 2 for state in seen) and any(state["waiting"] > 0 for state in seen),
                "status: nobody ran or waited")
    place.check(all(state["frames_per_minute"] > 0 for state in seen if state["done"] > 3), "status: no rate")
    last = seen[-1]
    numbers = [last[key] for key in ("done", "running", "waiting", "failed", "tries_failed", "round", "seconds_left")]
    place.check.equal("status in the end", numbers, [place.FRAMES, 0, 0, 0, 0, 1, 0])
    place.check(len(last["slowest"]) > 2 and last["slowest"][0]["core_seconds"] >= last["slowest"][1]["core_seconds"] and
                last["slowest"][0]["host"] == os.uname().nodename, f"status: slowest {last['slowest']}")
    out, error = watch.communicate(timeout=30)
    place.check.equal("--watch ends", (watch.returncode, error), (0, ""))
    place.check("24 of 24 frames done" in out, f"--watch prints {out[-300:]}")
    place.whole(folder, "status")


def cancel(place, slurm):
    """--cancel leaves no job, and the same command goes on; so does it after tasks that waited were cancelled, which ends it."""
    folder, tools = place.root / "cancel", place.tools("cancel", "sleep 0.3")
    submit = (tools / "nullcone-submit", place.sequence, "-o", folder, "--per-task", "4", *QUICK)
    place.run(*submit)
    place.check(waited(lambda: any(folder.glob("data.*"))), "cancel: nothing begins")
    place.run("nullcone-submit", "--cancel", folder)
    place.check(waited(lambda: not slurm.jobs(folder), 15), f"cancel: jobs are left: {slurm.jobs(folder)}")
    place.check(waited(lambda: not place.processes("nullcone-trace", folder), 5), "cancel: processes are left")
    there = len(list(folder.glob("data.????.exr")))
    place.check(there < place.FRAMES, "cancel: all frames are there already")
    place.run("nullcone-submit", "--cancel", folder)  # nothing to do

    place.run(*submit)
    place.check(waited(lambda: len(list(folder.glob("data.????.exr"))) > there), "cancel: nothing goes on")
    waiting = [task for task, state in slurm.jobs(folder, "PENDING") if "_" in task]
    place.check(waiting, "cancel: no task waits")
    place.run("scancel", *waiting)
    slurm.over(folder)
    place.check(place.missing(folder), "cancel: nothing is missing")
    place.check("cancelled" in (folder / "cluster/002/finish.log").read_text(), "cancel: finish.log does not say why it ends")

    place.run(*submit)
    place.run("scancel", next(number for kind, number in reversed(slurm.written(folder)) if kind == "finish"))
    slurm.over(folder)
    place.run(*submit)  # finds all, or what the rest was
    slurm.over(folder)
    place.whole(folder, "cancel")


def held(place, slurm):
    """Tasks that somebody must release are told, with the words that release them."""
    folder = place.root / "held"
    submit = ("nullcone-submit", place.sequence, "-o", folder, "--frames", "0-1", "--trial", "none", "--per-task", "1")
    place.run(*submit, "--sbatch=--hold")
    told = place.run("nullcone-submit", "--status", folder).stdout
    line = next((line for line in told.splitlines() if "scontrol release" in line), "")
    place.check(line.startswith("3 held"), f"held: status tells {told!r}")
    tasks = line.partition("scontrol release ")[2].split()
    place.check.equal("held: as JSON", json.loads(place.run("nullcone-submit", "--status", folder, "--json").stdout)["held"], tasks)
    place.check("jobs that wait" in place.run(*submit).stdout, "held: submitted again")
    for task in tasks:
        place.run("scontrol", "release", task)
    slurm.over(folder)
    place.whole(folder, "held", {frame: place.reference()[frame] for frame in range(2)})
    place.check("held" not in place.run("nullcone-submit", "--status", folder).stdout.partition("\n")[2], "held: still held")


def single(place, slurm):
    """A scene of one frame, in shards."""
    scene = json.loads((place.source / "scenes/goedel_earth.json").read_text())
    scene["camera"]["resolution"] = place.RESOLUTION
    path, folder = place.root / "single.json", place.root / "single"
    path.write_text(json.dumps(scene))
    place.run("nullcone-trace", path, "-q", "-o", place.root / "single.exr")
    place.run("nullcone-submit", path, "-o", folder, "--shards", "4", "--per-task", "1", *QUICK)
    slurm.over(folder)
    place.whole(folder, "single", {0: place.payload(place.root / "single.exr")})


def pictures(place, slurm):
    """Pictures and a movie come after the frames; a new look makes them again, and traces nothing."""
    tools, folder = place.tools("pictures"), place.root / "pictures"
    options = ("-o", folder, "--frames", "0-11", "--pictures", *(["--movie", "m.mp4"] if shutil.which("ffmpeg") else []))
    made = lambda: {path.name: path.stat().st_mtime_ns for path in [*folder.glob("pictures/*"), *folder.glob("m.mp4")]}
    place.run(tools / "nullcone-submit", place.sequence, *options)
    slurm.over(folder)
    first = made()
    names = [f"{frame:04}.png" for frame in range(12)] + (["m.mp4"] if shutil.which("ffmpeg") else [])
    place.check.equal("pictures", sorted(first), sorted(names))
    place.check(all(path.read_bytes().startswith(b"\x89PNG") for path in folder.glob("pictures/*.png")), "pictures are none")
    place.run(tools / "nullcone-submit", place.sequence, *options)
    place.check.equal("pictures: jobs when all is there", slurm.jobs(folder), [])

    redder = place.write_scene("redder", look={"objects": {"earth": {"texture": {"type": "color", "rgb": [1, 0, 0]}}}})
    place.run(tools / "nullcone-submit", redder, *options)
    slurm.over(folder)
    second = made()
    place.check(all(second[name] > first[name] for name in names if name in second) and second.keys() == first.keys(),
                f"a new look did not make all pictures again: {sorted(second)}")
    place.check.equal("pictures: frames traced", len(place.calls(tools)), 12)
    shutil.rmtree(folder / "pictures")
    (folder / "m.mp4").unlink(missing_ok=True)
    place.whole(folder, "pictures", {frame: place.reference()[frame] for frame in range(12)})


def wrong_input(place, slurm):
    """One line each, and nothing is written."""
    scene, folder = place.sequence, place.root / "wrong"
    submit = ("nullcone-submit", scene, "-o", folder)
    broken, plain = place.root / "broken.json", place.root / "file"
    broken.write_text('{"frames":')
    plain.write_text("")
    late = place.write_scene("late", camera={"type": "panorama", "resolution": place.RESOLUTION, "azimuth_deg": 24,
                                                          "fov_deg": {"keyframes": [[0, 220], [3, 720]]}})
    rock = place.write_scene("rock", objects=[{"name": "rock", "shape": {"type": "mesh", "file": "rock.obj"},
                                               "placing": {"type": "coordinate", "centre": [0.5, 0, 0]}}], look={})
    for text, *words in [
            ("rock.obj: cannot open the file", submit[0], rock, *submit[2:]), ("SCENE", "nullcone-submit"), ("--output", "nullcone-submit", scene), ("--output", *submit[:3], ""),
            ("#", *submit[:3], place.root / "a#b"), ("is a file", *submit[:3], plain), ("none.json", submit[0], "none.json", *submit[2:]),
            ("broken.json", submit[0], broken, *submit[2:]), ("late.json", submit[0], late, *submit[2:]),
            ("there is no frame 24", *submit, "--frames", "0-24"), ("'x' is no frame", *submit, "--frames", "x"),
            ("--frames", *submit, "--frames", ""), ("shards", *submit, "--shards", "151"), ("--shards", *submit, "--shards", "0"),
            ("--shards", *submit, "--shards", "1e3"), ("--threads", *submit, "--threads", "-1"), ("--tries", *submit, "--tries", "0"),
            ("--per-task", *submit, "--per-task", "0"), ("--retry-delay", *submit, "--retry-delay", "-1"),
            ("--memory", *submit, "--memory", "lots"), ("--time", *submit, "--time", "-1"), ("--trial", *submit, "--trial", "there"),
            ("--isa", *submit, "--isa", "mmx"), ("--fps", *submit, "--fps", "0"), ("none.json", *submit, "--look", "none.json"),
            ("--movie", *submit, "--movie", "movie.txt"), ("--jobs", *submit, "--jobs", "2"), ("--json", *submit, "--json"),
            ("--watch", *submit, "--watch"), ("--partition", *submit, "--partition", ""), ("--nonsense", *submit, "--nonsense"),
            ("another", *submit, "another"), ("--dry-run", *submit, "--dry-run", "--scripts-only"), ("--local", *submit, "--local", "--dry-run"),
            ("SCENE", *submit, "--status", folder), ("--shards", "nullcone-submit", "--cancel", folder, "--shards", "2"), ("command line", "nullcone-submit", "--status", folder, "--cancel", folder),
            ("wrong", "nullcone-submit", "--status", folder), ("wrong", "nullcone-submit", "--cancel", folder),
            ("--status", "nullcone-submit", "--status", ""), ("file", "nullcone-submit", "--status", plain),
            ("wrong", "nullcone-submit", "--task", folder, "--round", "1", "--bundle", "0"),
            ("wrong", "nullcone-submit", "--finish", folder, "--round", "1")]:
        place.refused(2, text, *words)
        place.check(not folder.exists(), f"{words} writes")
        shutil.rmtree(folder, ignore_errors=True)
    # Slurm's own complaints, and folders that cannot be.
    place.refused(1, "Invalid partition", *submit, "--trial", "none", "--partition", "nowhere")
    place.refused(1, "sbatch", *submit, "--trial", "none", "--sbatch=--nonsense")
    place.refused(1, "cannot make", *submit[:3], "/proc/none")
    place.check.equal("refused: jobs", slurm.jobs(folder), [])


def garbled(place, slurm):
    """Bookkeeping that is damaged: told in one line with its name, or passed over; never a crash."""
    folder = place.root / "garbled"
    submit = ("nullcone-submit", place.sequence, "-o", folder, "--frames", "0-1", "--trial", "none", *QUICK)
    place.run(*submit)
    slurm.over(folder)
    calls = [submit, ("nullcone-submit", "--status", folder), ("nullcone-submit", "--status", folder, "--json"),
             ("nullcone-submit", "--cancel", folder)]
    events, jobs, plan = (folder / "cluster" / name for name in ("001/0.jsonl", "001.jobs", "001.plan.json"))

    def passed_over(what):
        (folder / "data.0001.exr").unlink(missing_ok=True)
        for call in calls:
            done = place.run(*call, status=None)
            place.check(done.returncode in (0, 1, 2) and done.stderr.count("\n") <= 1, f"{what}: {call}: {done}")
        slurm.over(folder)

    whole = events.read_bytes()
    for text in (b"", b"\xff\x00\n" * 99, whole[:len(whole) // 2], b'{"event":"end"}\n{"event":"begin","piece":-1}\n[[[[', b"{" * 100_000,
                 whole.replace(b'"piece":0', b'"piece":99999999999')):
        events.write_bytes(text)
        passed_over(f"events {text[:30]}")
    for text in ("", "array\n", "array 999999 0\nfinish 999999\n", "array --help 0\nfinish ;\n", "\0" * 100, "array 1 -7\nfinish 2\n"):
        jobs.write_text(text)
        passed_over(f"jobs {text[:30]!r}")
    place.run(*submit)
    slurm.over(folder)
    place.whole(folder, "garbled", {frame: place.reference()[frame] for frame in range(2)})

    last = sorted((folder / "cluster").glob("*.plan.json"))[-1]
    good = last.read_text()
    (folder / "data.0001.exr").unlink()  # where nothing is missing, nobody asks for plans
    for text in ("", "{", "[]", good.replace('"round"', '"square"'), good.replace('"pieces": "', '"pieces": "9-1,'), "\xff", "[" * 100_000,
                 re.sub('"bundles": [0-9]+', '"bundles": -1', good)):
        place.check(text != good, "the plan is not damaged")
        last.write_text(text, encoding="latin-1")
        for call in calls[:3]:
            place.refused(2, last.name, *call)
    last.write_text(good)
    (folder / "scene.json").write_text("{")
    place.refused(2, "scene.json", *calls[1])
    place.run(*submit)
    slurm.over(folder)
    place.run(*calls[1])


SCENARIOS = [undisturbed, shards, again, at_once, dry_run, status, cancel, held, single, pictures, wrong_input, garbled]
