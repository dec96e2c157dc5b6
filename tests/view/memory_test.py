#!/usr/bin/env python3
"""The memory of nullcone-view does not grow, whatever is asked for again and again.

Usage: memory_test.py TOOLS_DIR SOURCE_DIR [FRAMES [WIDTH HEIGHT]]
"""
import json
import pathlib
import sys
import time

from serve import Server

TOOLS, SOURCE = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
FRAMES = int(sys.argv[3]) if len(sys.argv) > 3 else 2000
SIZE = [int(x) for x in sys.argv[4:6]] or [264, 30]
# MiB after the first fifth: threads find their arenas, tables of spectra their bounds; and pictures that are just there.
MOST_GROWTH = 8.0 + 24 * SIZE[0] * SIZE[1] / 1e6


def resident(pid):
    status = pathlib.Path(f"/proc/{pid}/status").read_text()
    return int(status.split("VmRSS:")[1].split()[0]) / 1024


def ask(server, method, path, body):
    status = server.request(method, path, b"" if body is None else body, timeout=60)[0]
    if status == 429:  # faster than a viewer may be
        time.sleep(0.05)
        return ask(server, method, path, body)
    if status != 200:
        raise SystemExit(f"{status} for {path}")


def main():
    scene = json.loads((SOURCE / "scenes/goedel_earth.json").read_text())
    scene["camera"]["resolution"] = SIZE
    sizes = []
    with Server(TOOLS, SOURCE, scene=scene) as server:
        for i in range(FRAMES):
            look = {"objects": {"earth": {"spectrum": {"type": "black_body", "temperature_K": 1000 + 7 * i}}}}
            if i % 3 == 0:
                look["objects"]["earth"]["texture"] = {"type": "checkerboard", "counts": [1 + i % 50, 9], "colors": [[1, 1, 1], [0, 0, i % 7 / 7]]}
            ask(server, "POST", f"api/frame?scale={(1, 2, 2, 4)[i % 4]}&format={('raw', 'raw', 'jpeg', 'png')[i // 4 % 4]}", look)
            if i % 20 == 0:
                ask(server, "POST", "api/trace?scale=2", {"scene": {"camera": {"azimuth_deg": i % 360}}, "look": look})
                ask(server, "GET", f"api/channel?name={('shift', 't', 'status')[i % 3]}", None)
                ask(server, "GET", "api/images?object=earth", None)
                ask(server, "POST", f"api/pixel?x={i % SIZE[0]}&y={i % SIZE[1]}", look)
                ask(server, "POST", "api/look", look)
                ask(server, "POST", "api/picture", look)
            if i % max(1, FRAMES // 10) == FRAMES // 10 - 1:
                sizes.append(resident(server.process.pid))
        print(f"{FRAMES} frames of {SIZE[0]} x {SIZE[1]}, MiB:", " ".join(f"{size:.1f}" for size in sizes))
    return sizes[-1] > sizes[1] + MOST_GROWTH


if __name__ == "__main__":
    sys.exit(main())
