#!/usr/bin/env python3
"""What a scheduler costs: small frames by one process in a row, and by an array on a private Slurm of two nodes with 1 CPU each.

Usage: throughput.py TOOLS_DIR SOURCE_DIR [FRAMES [WIDTHxHEIGHT]]   (250 frames of 1320x150; three times each, in alternation)
The process uses as many threads as the Slurm has CPUs. The array's time ends with its last step, which verifies all frames.
"""
import json
import shutil
import sys
import time

from slurm_cluster import Checks, Slurm, Workplace

TIMES = 3


def main():
    tools, source, *rest = sys.argv[1:]
    frames = int(rest[0]) if rest else 250
    checks = Checks()
    place = Workplace(tools, source, checks)
    scene = json.loads((place.source / "scenes/goedel_sequence.json").read_text())
    scene["frames"]["count"] = frames
    scene["camera"]["resolution"] = [int(length) for length in (rest[1] if len(rest) > 1 else "1320x150").split("x")]
    del scene["look"]
    sequence = place.root / "small.json"
    sequence.write_text(json.dumps(scene))
    folder = place.root / "data"

    def in_a_row():
        folder.mkdir()
        place.run("nullcone-trace", sequence, "--frames", f"0-{frames - 1}", "-o", folder / "data.####.exr", "--threads", 2, "-q",
                  timeout=3600)

    def as_array():
        place.run("nullcone-submit", sequence, "-o", folder, "-q", timeout=3600)
        slurm.over(folder, 3600)
        checks.equal("status", json.loads(place.run("nullcone-submit", "--status", folder, "--json").stdout)["done"], frames)

    def seconds(work):
        shutil.rmtree(folder, ignore_errors=True)
        begun = time.monotonic()
        work()
        return time.monotonic() - begun

    try:
        with Slurm(place, "MaxArraySize=1001") as slurm:
            ratios = []
            for _ in range(TIMES):
                alone, array = seconds(in_a_row), seconds(as_array)
                ratios.append(array / alone)
                print(f"in a row {alone:.1f} s, as an array {array:.1f} s, ratio {ratios[-1]:.3f}", flush=True)
            print(f"{frames} frames of {'x'.join(map(str, scene['camera']['resolution']))}: ratio {sorted(ratios)[TIMES // 2]:.3f} (median)")
    finally:
        place.close()
    sys.exit(bool(checks.faults))


if __name__ == "__main__":
    main()
