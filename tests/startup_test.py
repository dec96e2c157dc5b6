#!/usr/bin/env python3
"""Tools that start thousands of times load no libraries for pictures: those cost more than a small frame.

Usage: startup_test.py BIN_DIR. The times themselves are in docs/cluster.md; here only what is loaded is read.
"""
import pathlib
import re
import subprocess
import sys

SMALL = ["trace", "merge", "info", "geodesic", "submit"]
LARGE = "postrender"  # it does load them: so this test can fail
# OpenImageIO and what Debian's brings along.
HEAVY = re.compile(r"lib(OpenImageIO|OpenColorIO|opencv_|openvdb|Qt\d|gdal|gstreamer|"
                   r"avcodec|avformat|avutil|avfilter|swscale|swresample)")


def libraries(program):
    """Names of all that the loader loads, also what libraries ask for."""
    result = subprocess.run(["ldd", program], capture_output=True, text=True, check=False)
    names = [line.split()[0] for line in result.stdout.splitlines() if line.strip()]
    if result.returncode != 0 or not any(name.startswith("libc.so") for name in names):
        sys.exit(f"cannot tell what {program} loads: {result.stdout}{result.stderr}")
    return names


def main():
    folder = pathlib.Path(sys.argv[1])
    faults = []
    for name in SMALL:
        heavy = [library for library in libraries(folder / f"nullcone-{name}") if HEAVY.match(library)]
        if heavy:
            faults.append(f"nullcone-{name} loads {', '.join(heavy)}")
    if not any(library.startswith("libOpenImageIO.") for library in libraries(folder / f"nullcone-{LARGE}")):
        faults.append(f"nullcone-{LARGE} does not load OpenImageIO: this test tells nothing any more")
    for fault in faults:
        print("FAULT:", fault)
    print(f"{len(SMALL) + 1} programs, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
