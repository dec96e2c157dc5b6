#!/usr/bin/env python3
"""Kernels of several instruction sets must not share symbols: the linker would keep one copy, and an SSE2 machine
would run AVX-512 code. Reads `nm` of the release objects and fails on a weak symbol that two sets define.

usage: symbols_test.py ISA=OBJECT[,OBJECT...]... """
import subprocess
import sys


def weak_symbols(path):
    """Names of weak definitions (W, V, u) in an object file."""
    lines = subprocess.run(["nm", "--defined-only", path], capture_output=True, text=True, check=True).stdout.splitlines()
    found = {line.split()[-1] for line in lines if line.split()[-2] in "WVu"}
    return {name for name in found if not name.startswith("DW.ref.")}  # a pointer to the C++ runtime, no code


def main(paths):
    if len(paths) < 2:
        print("symbols_test: expected at least two objects")
        return 1
    owners, shared = {}, []
    for isa, objects in (argument.split("=", 1) for argument in paths):
        for path in objects.split(","):
            for symbol in weak_symbols(path):
                if owners.setdefault(symbol, isa) != isa:
                    shared.append((symbol, owners[symbol], path))
    for symbol, first, second in shared[:20]:
        name = subprocess.run(["c++filt", symbol], capture_output=True, text=True, check=True).stdout.strip()
        print(f"shared: {name[:200]}\n    {first}\n    {second}")
    print(f"{len(paths)} objects, {len(shared)} shared weak symbols")
    return 1 if shared else 0


sys.exit(main(sys.argv[1:]))
