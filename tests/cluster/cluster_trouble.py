"""Scenarios with trouble: kills, a full disk, damaged frames, too little memory, a frame that always fails."""
import collections
import contextlib
import os
import shlex
import shutil
import signal
import subprocess
import time

from slurm_cluster import kill, waited

QUICK = ["--retry-delay", "1"]


class Killer:
    """What happens to tasks on a bad day; each returns whether there was one to hit."""

    def __init__(self, place, slurm, folder):
        self.place, self.slurm, self.folder = place, slurm, folder
        self.kinds = [self.trace_killed, self.trace_terminated, self.task_killed, self.task_and_trace_killed, self.cancelled,
                      self.requeued]
        self.hits = collections.Counter()

    def one(self, processes):
        return self.place.random.choice(sorted(processes)) if processes else None

    def traces(self):
        return self.place.processes("/nullcone-trace", self.folder)

    def tasks(self):
        return self.place.processes("/nullcone-submit", "--task", self.folder)

    def trace_killed(self):
        process = self.one(self.traces())
        return process and kill(process)

    def trace_terminated(self):
        process = self.one(self.traces())
        return process and kill(process, signal.SIGTERM)

    def task_killed(self):
        process = self.one(self.tasks())
        return process and kill(process)

    def task_and_trace_killed(self):
        hit = self.task_killed()
        for process in self.traces():
            kill(process)
        return hit

    def task(self, command):
        """Of an array, that runs."""
        task = self.one([task for task, _ in self.slurm.jobs(self.folder, "RUNNING") if "_" in task])
        return task and subprocess.run([*command, task], capture_output=True).returncode == 0

    def cancelled(self):
        return self.task(["scancel"])

    def requeued(self):
        return self.task(["scontrol", "requeue"])

    def strike(self):
        least = min(self.hits[kind.__name__] for kind in self.kinds)
        kind = self.place.random.choice([kind for kind in self.kinds if self.hits[kind.__name__] <= least + 1])
        self.hits[kind.__name__] += bool(kind())

    def done(self):
        return all(self.hits[kind.__name__] >= 2 for kind in self.kinds)


def kills(place, slurm):
    """Random kills; the chain of rounds goes on by itself, unless a task was cancelled before it began to work."""
    folder, tools = place.root / "kills", place.tools("kills", "sleep 0.2")  # time to hit
    submit = (tools / "nullcone-submit", place.sequence, "-o", folder, "--shards", "2", "--per-task", "6", "--tries", "50",
              "--retry-delay", "0")
    place.run(*submit)
    killer = Killer(place, slurm, folder)
    end = time.monotonic() + 30
    while not killer.done() and time.monotonic() < end and slurm.jobs(folder):
        time.sleep(place.random.uniform(0, 0.4))
        killer.strike()
    print("  hits:", dict(killer.hits))
    place.check(killer.done(), f"kills: {killer.hits} only")
    slurm.over(folder)
    told = "".join(path.read_text() for path in sorted((folder / "cluster").glob("*/finish.log")))
    if "cancelled while they waited" in told:
        place.run(*submit)
        slurm.over(folder)
    place.whole(folder, "kills")


def last_step_killed(place, slurm):
    """The step after the array is killed while it merges shards: the next submission does its work."""
    folder, frames = place.root / "last_step", 6
    submit = ("nullcone-submit", place.sequence, "-o", folder, "--frames", f"0-{frames - 1}", "--shards", "3", "--per-task", "9")
    place.run(*submit)
    hit = lambda: any([kill(process) for process in place.processes("/nullcone-submit", "--finish", folder)])
    place.check(waited(hit), "last step: it does not run")
    slurm.over(folder)
    told = place.run("nullcone-submit", "--status", folder).stdout
    place.check("frames missing" in told, f"last step: status {told!r}")
    place.check("all 6 frames are there" in place.run(*submit).stdout, "last step: shards were not merged")
    place.whole(folder, "last step", {frame: place.reference()[frame] for frame in range(frames)})


@contextlib.contextmanager
def small_disk(place):
    """A folder on a file system of its own, which is soon full; None where we may not mount one."""
    folder = place.root / "mounted"
    folder.mkdir()
    done = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64m", "nullcone", folder], capture_output=True, text=True)
    if done.returncode:
        print("  SKIPPED: no file system may be mounted here:", done.stderr.strip())
        yield None
        return
    try:
        yield folder
    finally:
        subprocess.run(["umount", "-l", folder], check=True)


def fill(folder):
    filler = folder / "filler"
    with open(filler, "wb", buffering=0) as out:
        for size in (1 << 20, 1 << 12, 1):
            with contextlib.suppress(OSError):
                while True:
                    out.write(bytes(size))
    return filler


def disk(place, slurm):
    """Full for a while: no half frame under a frame's name, and what failed is traced when there is room again."""
    tools = place.tools("disk", "sleep 0.1")
    with small_disk(place) as mounted:
        if mounted is None:
            return
        folder = mounted / "disk"
        submit = (tools / "nullcone-submit", place.sequence, "-o", folder, "--per-task", "4", "--tries", "9", *QUICK)
        place.run(*submit)
        place.check(waited(lambda: len(list(folder.glob("data.????.exr"))) >= 3), "disk: nothing begins")
        filler = fill(mounted)
        calls = len(place.calls(tools))
        place.check(waited(lambda: len(place.calls(tools)) > calls + 4), "disk: nothing is tried")
        for path in folder.glob("data.????.exr"):
            place.run("nullcone-info", "--verify", path)
        place.run("nullcone-submit", "--status", folder)
        there = len(list(folder.glob("data.????.exr")))
        place.check(there < place.FRAMES, "disk: it was not full")
        filler.unlink()
        slurm.over(folder)
        place.run(*submit)  # a step that found no room for its plan ended the chain
        slurm.over(folder)
        place.whole(folder, "disk")

        # Full from the beginning: one line.
        shutil.rmtree(folder)
        fill(mounted)
        place.refused(1, "disk/cluster", *submit)
        filler.unlink()


def damaged(place, slurm):
    """Frames are judged by what is in them: those that are damaged, and only those, are traced again."""
    folder, tools = place.root / "damaged", place.tools("damaged")
    submit = (tools / "nullcone-submit", place.sequence, "-o", folder, "--trial", "none", "--per-task", "12", *QUICK)
    place.run(*submit)
    slurm.over(folder)
    place.check.equal("damaged: at first", place.missing(folder), "")
    frame = lambda number: folder / f"data.{number:04}.exr"

    with open(frame(3), "r+b") as file:
        middle = os.path.getsize(frame(3)) // 2
        file.seek(middle)
        byte = file.read(1)[0]
        file.seek(middle)
        file.write(bytes([byte ^ 1]))
    os.truncate(frame(7), os.path.getsize(frame(7)) - 100)
    frame(12).write_bytes(b"")
    frame(20).unlink()
    before = {number: frame(number).stat().st_mtime_ns for number in range(place.FRAMES) if frame(number).exists()}
    place.check.equal("damaged: missing", place.missing(folder), "3,7,12,20")
    place.run(*submit)
    slurm.over(folder)
    changed = {number for number in range(place.FRAMES) if frame(number).stat().st_mtime_ns != before.get(number)}
    place.check.equal("damaged: traced again", changed, {3, 7, 12, 20})
    place.check.equal("damaged: calls", sorted(frame for _, frame in place.calls(tools))[place.FRAMES:],
                      sorted([*range(place.FRAMES), 3, 7, 12, 20])[place.FRAMES:])
    place.whole(folder, "damaged")

    shutil.copy(frame(5), frame(9))  # a dataset that is whole, but not of this frame
    place.check.equal("of another frame", place.missing(folder), "9")
    place.refused(2, "data.0009.exr", *submit)
    place.run(*submit, "--replace")
    slurm.over(folder)
    place.whole(folder, "replaced")


def memory(place, slurm):
    """Tasks whose process is killed as the kernel does when memory runs out ask for more in the next round."""
    tools = place.tools("memory", '[ "$memory" -eq 0 ] || [ "$memory" -ge 300 ] || kill -KILL $$')
    folder = place.root / "memory"
    place.run(tools / "nullcone-submit", place.sequence, "-o", folder, "--frames", "0-5", *QUICK)
    slurm.over(folder)
    asked = sorted({memory for memory, _ in place.calls(tools)} - {0})
    place.check(len(asked) == 3 and asked[0] < asked[1] < 300 <= asked[2] < 1000, f"memory: asked for {asked} MB")
    place.whole(folder, "memory", {number: place.reference()[number] for number in range(6)})

    # Never more than a node has (slurm.sh: 4000 MB): such a job would never run.
    tools, folder = place.tools("all_memory", '[ "$frame" != 1 ] || kill -KILL $$'), place.root / "all_memory"
    place.run(tools / "nullcone-submit", place.sequence, "-o", folder, "--frames", "0-1", "--memory", "2500", "--trial", "none", *QUICK)
    slurm.over(folder)
    place.check.equal("memory: asked for", [memory for memory, frame in place.calls(tools) if frame == 1], [2500, 4000, 4000])
    place.check("ended by signal 9" in (folder / "cluster/failed.txt").read_text(), "memory: failed.txt does not tell")


def hopeless(place, slurm):
    """A frame that always fails is tried three times and told, and all others are there."""
    tools = place.tools("hopeless", '[ "$frame" != 5 ] || { seq -f "line %g" 50; echo "no such star" >&2; exit 1; }')
    folder = place.root / "hopeless"
    submit = (tools / "nullcone-submit", place.sequence, "-o", folder, "--per-task", "6", *QUICK)
    place.run(*submit)
    slurm.over(folder)
    frames = collections.Counter(frame for _, frame in place.calls(tools))
    place.check.equal("hopeless: tries", frames, collections.Counter({**dict.fromkeys(range(place.FRAMES), 1), 5: 3}))
    place.check.equal("hopeless: missing", place.missing(folder), "5")
    text = (folder / "cluster/failed.txt").read_text()
    place.check("frame 5: failed 3 times" in text and "no such star" in text and "line 50" in text and "line 1\n" not in text and
                text.count("frame ") < 5, f"failed.txt says {text!r}")
    command = next((line.split(":", 1)[1] for line in text.splitlines() if line.strip().startswith("again:")), "false")
    place.check("no such star" in place.run("bash", "-c", command, status=1).stderr, "the command does not reproduce it")
    place.check("frame 5" in (folder / "cluster/003/finish.log").read_text(), "finish.log does not tell")
    told = place.run("nullcone-submit", "--status", folder).stdout
    place.check("1 failed" in told and "frames missing" in told, f"hopeless: status {told!r}")
    place.run("nullcone-submit", "--status", folder, "--watch", status=1)

    (tools / "nullcone-trace").unlink()
    (tools / "nullcone-trace").symlink_to(place.bin / "nullcone-trace")
    place.run("bash", "-c", shlex.join(map(str, submit)))
    slurm.over(folder)
    place.whole(folder, "hopeless")


SCENARIOS = [kills, last_step_killed, disk, damaged, memory, hopeless]
