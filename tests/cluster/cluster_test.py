#!/usr/bin/env python3
"""nullcone-submit with a real Slurm, in trouble: every frame is there in the end, verified, and what one process gives.

Usage: cluster_test.py TOOLS_DIR SOURCE_DIR [SCENARIO...]   (all of them; their names are those of the functions here)
"""
import shutil
import sys

import cluster_asking
import cluster_trouble
import slurm_cluster

if __name__ == "__main__":
    if not shutil.which("sbatch") or not shutil.which("munged", path="/usr/sbin:/usr/bin"):
        sys.exit("expected a Slurm to start: install slurm-wlm and munge")
    slurm_cluster.main(cluster_asking.SCENARIOS + cluster_trouble.SCENARIOS, slurm_cluster.Slurm)
