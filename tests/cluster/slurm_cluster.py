"""What tests of nullcone-submit share: a private Slurm, a small sequence and its frames as one process gives them, trouble."""
import concurrent.futures
import contextlib
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent


class Checks:
    def __init__(self):
        self.count, self.faults = 0, []

    def __call__(self, good, what):
        self.count += 1
        if not good:
            self.faults.append(what)
            print("FAULT:", what, flush=True)
        return good

    def equal(self, what, found, expected):
        return self(found == expected, f"{what}: {found!r}, expected {expected!r}")


def waited(condition, seconds=30.0):
    """Whether it became true in time."""
    end = time.monotonic() + seconds
    while not (good := condition()) and time.monotonic() < end:
        time.sleep(0.05)
    return bool(good)


class Workplace:
    """Tools, a folder of our own, and the sequence that all scenarios trace."""

    FRAMES = 24
    RESOLUTION = [1056, 120]  # some 0.1 s a frame

    def __init__(self, binaries, source, checks):
        self.bin, self.source = pathlib.Path(binaries).resolve(), pathlib.Path(source).resolve()
        self.check = checks
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="nullcone-"))  # a short name: sockets live there
        signal.signal(signal.SIGTERM, lambda *_: sys.exit("ended by SIGTERM"))  # cleaning up before
        self.random = random.Random(int(os.environ.get("NULLCONE_SEED", "9")))
        self.sequence = self.write_scene("sequence")
        self.payloads = {}

    def write_scene(self, name, **changes):
        scene = json.loads((self.source / "scenes/goedel_sequence.json").read_text())
        scene["frames"]["count"] = self.FRAMES
        scene["camera"]["resolution"] = self.RESOLUTION
        scene["look"] = {"objects": {"earth": {"texture": {"type": "color", "rgb": [0.5, 0.5, 0.5]}}}}
        scene.update(changes)
        path = self.root / (name + ".json")
        path.write_text(json.dumps(scene))
        return path

    def run(self, *words, status=0, timeout=60):
        """A tool of ours, or a program; one of another exit status is a fault."""
        words = [str(word) for word in words]
        if words[0].startswith("nullcone-"):
            words[0] = str(self.bin / words[0])
        try:
            done = subprocess.run(words, capture_output=True, text=True, errors="backslashreplace",
                                  stdin=subprocess.DEVNULL, cwd=self.root, timeout=timeout)
        except subprocess.TimeoutExpired:
            self.check(False, f"does not end within {timeout} s: {' '.join(words)}")
            return subprocess.CompletedProcess(words, -1, "", "")
        if status is not None:
            self.check(done.returncode == status,
                       f"status {done.returncode}, expected {status}: {' '.join(words)} ({done.stderr[-300:]})")
        return done

    def refused(self, status, text, *words, **options):
        """That status, nothing on standard output, and one line of complaint that holds the text."""
        done = self.run(*words, status=status, **options)
        said = f"{' '.join(map(str, words))}: {done.stdout[:200]!r} {done.stderr[:400]!r}"
        self.check(done.stdout == "" and done.stderr.count("\n") == 1 and done.stderr.endswith("\n"), "not one line: " + said)
        self.check(text in done.stderr, f"'{text}' is not in " + said)
        return done

    # Datasets.

    def payload(self, path):
        return json.dumps(json.loads(self.run("nullcone-info", path, "--json").stdout or "{}").get("payload"))

    def reference(self):
        """Payloads of the frames as one undisturbed process gives them."""
        if not self.payloads:
            folder = self.root / "reference"
            folder.mkdir()
            self.run("nullcone-trace", self.sequence, "--frames", f"0-{self.FRAMES - 1}", "-o", folder / "data.####.exr", "-q")
            self.payloads = {i: self.payload(folder / f"data.{i:04}.exr") for i in range(self.FRAMES)}
            self.check(len(set(self.payloads.values())) == self.FRAMES and "null" not in self.payloads.values(),
                       "the reference's frames are not all there and different")
        return self.payloads

    def whole(self, folder, what, expected=None):
        """Every frame is there, verified, and what the reference says; nothing else lies beside it."""
        expected = self.reference() if expected is None else expected

        def look_at(frame):
            path = folder / f"data.{frame:04}.exr"
            if self.check(path.exists(), f"{what}: frame {frame} is missing"):
                self.run("nullcone-info", "--verify", path)
                self.check(self.payload(path) == expected[frame], f"{what}: frame {frame} is not what one process gives")

        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as several:
            list(several.map(look_at, expected))
        names = {f"data.{frame:04}.exr" for frame in expected} | {"scene.json", "look.json", "cluster", "pictures"}
        self.check.equal(what + ": leaves", sorted(set(os.listdir(folder)) - names), [])
        self.check(not (folder / "cluster/lock").exists(), what + ": a lock is left")
        failed = folder / "cluster/failed.txt"
        self.check(not failed.exists(), what + ": tells of failures")

    def missing(self, folder, scene=None):
        return self.run("nullcone-trace", scene or self.sequence, "--frames", f"0-{self.FRAMES - 1}", "-o",
                        folder / "data.####.exr", "--missing").stdout.strip()

    # Tools that get into trouble.

    def tools(self, name, trouble=""):
        """A folder of our tools whose nullcone-trace writes down each call, "MEMORY FRAME", and says `trouble` to a shell
        before it works, which knows $frame, $memory (of the task, MB) and $calls (the file of calls)."""
        folder = self.root / ("tools-" + name)
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        for tool in self.bin.glob("nullcone-*"):
            if tool.name == "nullcone-submit":
                shutil.copy2(tool, folder)  # it looks for its companions where it lies itself
            elif tool.name != "nullcone-trace":
                (folder / tool.name).symlink_to(tool)
        script = folder / "nullcone-trace"
        script.write_text(f"""#!/bin/bash
PATH=/usr/bin:/bin calls='{folder}/calls' memory=${{SLURM_MEM_PER_NODE:-0}}
for ((i = 1; i < $#; ++i)); do [ "${{!i}}" != --frame ] || {{ ((++i)); frame=${{!i}}; }}; done
echo "$memory $frame" >>"$calls"
{trouble}
exec '{self.bin}/nullcone-trace' "$@"
""")
        script.chmod(0o755)
        return folder

    @staticmethod
    def calls(tools):
        """(memory, frame) of each call of its nullcone-trace."""
        path = tools / "calls"
        return [tuple(map(int, line.split())) for line in path.read_text().splitlines()] if path.exists() else []

    def processes(self, *words):
        """Processes whose command lines hold all of the words: {number: words}."""
        out = {}
        for entry in pathlib.Path("/proc").iterdir():
            with contextlib.suppress(OSError):
                line = (entry / "cmdline").read_bytes().decode(errors="replace").split("\0") if entry.name.isdigit() else []
                if line and all(any(str(word) in part for part in line) for word in words):
                    out[int(entry.name)] = line
        return out

    def close(self):
        shutil.rmtree(self.root, ignore_errors=True)


def kill(process, number=signal.SIGKILL):
    with contextlib.suppress(ProcessLookupError):
        os.kill(process, number)
        return True
    return False


class Slurm:
    """A private Slurm as long as it is entered. Arrays hold few tasks, so that there are several soon."""

    def __init__(self, place, *lines):
        self.place, self.folder, self.lines = place, place.root / "slurm", lines or ("MaxArraySize=8",)

    def __enter__(self):
        for name in [name for name in os.environ if name.startswith(("SLURM", "SBATCH", "SQUEUE"))]:
            del os.environ[name]  # of a Slurm in which we run
        subprocess.run(["bash", HERE / "slurm.sh", "up", self.folder, *self.lines], check=True, stdout=subprocess.DEVNULL)
        os.environ["SLURM_CONF"] = str(self.folder / "slurm.conf")
        return self

    def __exit__(self, *_):
        subprocess.run(["bash", HERE / "slurm.sh", "down", self.folder], check=True)
        del os.environ["SLURM_CONF"]

    def jobs(self, folder, states=None):
        """(task, state) of a folder's jobs: those that wait or run, or those in these states."""
        done = self.place.run("squeue", "-h", "-r", "-o", "%i|%T|%j", *(["-t", states] if states else []))
        rows = (line.split("|", 2) for line in done.stdout.splitlines())
        return [(task, state) for task, state, name in rows if name == "nullcone-" + folder.name]

    def over(self, folder, seconds=90):
        """Waits until nothing waits or runs: a step that submits more runs while it does so."""
        if not waited(lambda: not self.jobs(folder), seconds):
            self.place.check(False, f"{folder.name}: after {seconds} s still at work: {self.jobs(folder)}")
            self.place.run("nullcone-submit", "--cancel", folder)

    def written(self, folder):
        """What RRR.jobs tell: [(array or finish, its number)]."""
        files = sorted((folder / "cluster").glob("*.jobs"))
        return [tuple(line.split()[:2]) for path in files for line in path.read_text().splitlines()]


def main(scenarios, around=contextlib.nullcontext):
    """Runs the scenarios that the command line names, or all: TOOLS_DIR SOURCE_DIR [SCENARIO...]. Each is called with the
    workplace, and with what around(workplace) gives where that is not None. Ends the program."""
    known = {scenario.__name__: scenario for scenario in scenarios}
    tools, source, *names = sys.argv[1:]
    if unknown := [name for name in names if name not in known]:
        sys.exit(f"no scenario {unknown[0]}; expected {', '.join(known)}")
    checks = Checks()
    place = Workplace(tools, source, checks)
    try:
        place.reference()
        with around(place) as more:
            for name in names or known:
                begun, faults = time.monotonic(), len(checks.faults)
                known[name](place, *([] if more in (None, place) else [more]))
                checks.equal(f"{name}: processes that are left", place.processes("/nullcone-trace", place.root), {})
                print(f"{name}: {time.monotonic() - begun:.1f} s, {len(checks.faults) - faults} faults", flush=True)
    finally:
        place.close()
    print(f"{checks.count} checks, {len(checks.faults)} faults")
    sys.exit(bool(checks.faults))
