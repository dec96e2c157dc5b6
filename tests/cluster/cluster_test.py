#!/usr/bin/env python3
"""nullcone-submit with a real Slurm, in trouble: every frame is there in the end, verified, and what one process gives.

Usage: cluster_test.py TOOLS_DIR SOURCE_DIR [SCENARIO...]   (all of them; their names are those of the functions here)
"""
import shutil
import sys
import time

import cluster_asking
import cluster_trouble
from slurm_cluster import Checks, Slurm, Workplace

SCENARIOS = {scenario.__name__: scenario for scenario in cluster_asking.SCENARIOS + cluster_trouble.SCENARIOS}


def main():
    tools, source, *names = sys.argv[1:]
    if unknown := [name for name in names if name not in SCENARIOS]:
        sys.exit(f"no scenario {unknown[0]}; expected {', '.join(SCENARIOS)}")
    if not shutil.which("sbatch") or not shutil.which("munged", path="/usr/sbin:/usr/bin"):
        sys.exit("expected a Slurm to start: install slurm-wlm and munge")
    checks = Checks()
    place = Workplace(tools, source, checks)
    try:
        place.reference()
        with Slurm(place) as slurm:
            for name in names or SCENARIOS:
                begun, faults = time.monotonic(), len(checks.faults)
                SCENARIOS[name](place, slurm)
                checks.equal(f"{name}: processes that are left", place.processes("/nullcone-trace", place.root), {})
                print(f"{name}: {time.monotonic() - begun:.1f} s, {len(checks.faults) - faults} faults", flush=True)
    finally:
        place.close()
    print(f"{checks.count} checks, {len(checks.faults)} faults")
    sys.exit(bool(checks.faults))


if __name__ == "__main__":
    main()
