#!/bin/bash
# Builds and runs the benchmarks; writes out/bench/DATE.json (all numbers) and out/bench/README.md (a page to read).
#   bench/run.sh [FILTER]     FILTER: a regular expression over the names of cases, as --benchmark_filter has it
#   NULLCONE_BENCH_BIN: folder of programs bench_* that are built already; NULLCONE_BENCH_OUT: instead of out/bench;
#   NULLCONE_BENCH_REPETITIONS, NULLCONE_BENCH_MIN_TIME: how long to measure (5 times at least 0.5 s a case)
# Compare ratios of one run, not times of two: machines are noisy.
set -eu
cd "$(dirname "$0")/.."

# What is compared: text | program | case | case beside it | most, if any. The ratio is time to time.
ratios='
writing a dataset to bare OpenEXR, one crossing a pixel | bench_dataset | dataset_write/picture:0 | openexr_write/picture:0 | 1.5
writing a dataset to bare OpenEXR, four crossings a pixel | bench_dataset | dataset_write/picture:1 | openexr_write/picture:1 | 1.5
writing a dataset to bare OpenEXR, the demo | bench_dataset | dataset_write/picture:2 | openexr_write/picture:2 | 1.5
reading a dataset to bare OpenEXR, one crossing a pixel | bench_dataset | dataset_read/picture:0 | openexr_read/picture:0 | 1.5
reading a dataset to bare OpenEXR, four crossings a pixel | bench_dataset | dataset_read/picture:1 | openexr_read/picture:1 | 1.5
reading a dataset to bare OpenEXR, the demo | bench_dataset | dataset_read/picture:2 | openexr_read/picture:2 | 1.5
tracing the demo, one lane to AVX-512 | bench_trace | earth/onelane | earth/avx512 |
tracing the demo, SSE2 to AVX2 | bench_trace | earth/sse2 | earth/avx2 |
tracing the demo, SSE2 to AVX-512 | bench_trace | earth/sse2 | earth/avx512 |
tracing three spheres at rest, SSE2 to AVX2 | bench_trace | three_spheres/sse2 | three_spheres/avx2 |
tracing three spheres at rest, SSE2 to AVX-512 | bench_trace | three_spheres/sse2 | three_spheres/avx512 |
tracing the demo, AVX-512 on one thread to two | bench_trace | earth/avx512 | earth/2_threads |
a ray of a camera on 998000 triangles to 960 | bench_mesh | mesh_camera/998000 | mesh_camera/960 | 3
a random ray on 998000 triangles to 960 | bench_mesh | mesh_random/998000 | mesh_random/960 | 3
a scene of 100488 triangles to one of 960 | bench_mesh | mesh_scene/100488 | mesh_scene/960 |
a scene of 998000 triangles to one of 960 | bench_mesh | mesh_scene/998000 | mesh_scene/960 | 3
evaluating a path, one lane to AVX-512 | bench_trace | evaluation/onelane | evaluation/avx512 |
frames on one thread to two | bench_postrender | frames/black_body_mipmap/1 | frames/black_body_mipmap/2 |
shading with SSE2 to AVX2 | bench_postrender | shade/black_body_mipmap/sse2 | shade/black_body_mipmap/avx2 |
a frame on one thread to copying it | bench_postrender | frames/black_body_mipmap/1 | copy |
'

bin=${NULLCONE_BENCH_BIN:-build/release/bin} out=${NULLCONE_BENCH_OUT:-out/bench}
[ -n "${NULLCONE_BENCH_BIN:-}" ] || scripts/build.sh release
mkdir -p "$out"
raw=$(mktemp -d)
trap 'rm -rf "$raw"' EXIT
for program in "$bin"/bench_*; do
  [ -x "$program" ] || { echo "bench: no programs bench_* in $bin" >&2; exit 1; }
  name=$(basename "$program")
  echo "== $(date +%H:%M:%S) $name" >&2
  "$program" --benchmark_filter="${1:-.}" --benchmark_repetitions="${NULLCONE_BENCH_REPETITIONS:-5}" \
    --benchmark_min_time="${NULLCONE_BENCH_MIN_TIME:-0.5}" --benchmark_enable_random_interleaving=true \
    --benchmark_report_aggregates_only=true --benchmark_format=json >"$raw/$name.json" \
    || { echo "bench: $name fails" >&2; exit 1; }
done

compiler=$(sed -n 's/^CMAKE_CXX_COMPILER:[^=]*=//p' "$bin/../CMakeCache.txt" 2>/dev/null || true)
commit=$(git describe --always --dirty 2>/dev/null || echo unknown)
compiler=$("${compiler:-c++}" --version 2>/dev/null | head -1) commit=$commit ratios=$ratios \
  python3 - "$raw" "$out" <<'PYTHON'
# Of the JSONs that Google Benchmark wrote: one file of all numbers, and a page to read.
import datetime
import json
import os
import pathlib
import platform
import subprocess
import sys

UNITS = {"ns": 1.0, "us": 1e3, "ms": 1e6, "s": 1e9}


def read_cases(path):
    """name -> {"ns": median of the real time, "spread": deviation to mean, "rate": text}."""
    text = path.read_text()
    if not text.strip():  # the filter left nothing
        return {}
    cases = {}
    for entry in json.loads(text)["benchmarks"]:
        name = entry["run_name"].removesuffix("/real_time").removesuffix("/manual_time").removesuffix("/process_time")
        case = cases.setdefault(name, {"ns": None, "spread": None, "rate": ""})
        if entry.get("error_occurred"):
            case["rate"] = "fails: " + entry.get("error_message", "")
            continue
        what = entry.get("aggregate_name", "median")
        if what == "median":
            case["ns"] = entry["real_time"] * UNITS[entry["time_unit"]]
            case["rate"] = rate_of(entry)
        elif what == "cv":
            case["spread"] = entry["real_time"]
    return cases


def rate_of(entry):
    """Items and bytes a second, as text."""
    rates = []
    if "items_per_second" in entry:
        rates.append(f"{entry['items_per_second'] / 1e6:.4g} M/s")
    if "bytes_per_second" in entry:
        rates.append(f"{entry['bytes_per_second'] / 1e9:.3g} GB/s")
    return ", ".join(rates)


def time_text(ns):
    """A time with a unit that suits it."""
    unit = next((u for u in ("s", "ms", "us") if ns >= UNITS[u]), "ns")
    return f"{ns / UNITS[unit]:.4g} {unit}"


def machine():
    """What the numbers depend on."""
    found = {"processor": platform.processor() or "unknown", "cores": str(os.cpu_count()), "memory": "unknown"}
    try:
        listed = subprocess.run(["lscpu"], capture_output=True, text=True, env={**os.environ, "LC_ALL": "C"})
        lines = (line.split(":", 1) for line in listed.stdout.splitlines() if ":" in line)
        cpu = {key.strip(): value.strip() for key, value in lines}
        found["processor"] = f"{cpu.get('Model name', 'unknown')}, {cpu.get('L2 cache', '?')} L2"
    except OSError:
        pass
    for line in open("/proc/meminfo", encoding="ascii"):
        if line.startswith("MemTotal:"):
            found["memory"] = f"{int(line.split()[1]) / 2**20:.1f} GiB"
    found |= {"system": platform.platform(), "compiler": os.environ.get("compiler") or "unknown",
              "commit": os.environ.get("commit") or "unknown"}
    return found


def ratio_rows(programs):
    """Rows of the table of ratios; what cannot be had is skipped aloud."""
    rows = []
    for line in os.environ.get("ratios", "").strip().splitlines():
        text, program, case, beside, most = (word.strip() for word in line.split("|"))
        times = [programs.get(program, {}).get(name, {}).get("ns") for name in (case, beside)]
        if not all(times):
            missing = [name for name, ns in zip((case, beside), times) if not ns]
            print(f"bench: no ratio '{text}': no case {' and '.join(missing)} in {program}", file=sys.stderr)
            continue
        ratio = times[0] / times[1]
        verdict = "" if not most else ("yes" if ratio <= float(most) else "**no**")
        rows.append([text, f"{ratio:.2f}", f"at most {most}" if most else "", verdict])
    return rows


def table(head, rows):
    """A table in Markdown."""
    lines = ["| " + " | ".join(cells) + " |" for cells in [head, ["---"] * len(head), *rows]]
    return "\n".join(lines) + "\n"


def case_rows(cases, before):
    """Rows of one program's table; the last column compares with an earlier run."""
    rows = []
    for name, case in sorted(cases.items()):
        if case["ns"] is None:
            rows.append([f"`{name}`", "", "", case["rate"], ""])
            continue
        spread = "" if case["spread"] is None else f"{100 * case['spread']:.0f} %"
        old = before.get(name, {}).get("ns")
        rows.append([f"`{name}`", time_text(case["ns"]), spread, case["rate"], f"{case['ns'] / old:.2f}" if old else ""])
    return rows


def page(run, before):
    """The whole page; `before` is an earlier run or None."""
    out = ["# Benchmarks, " + run["date"], ""]
    out += [f"- {key}: {value}" for key, value in run["machine"].items()]
    out += ["", "## Ratios (time to time, in this run)", "", table(["what", "ratio", "expected", "holds"], run["ratios"])]
    earlier = "earlier run"
    if before:
        same = all(before["machine"].get(k) == run["machine"][k] for k in ("processor", "cores", "compiler"))
        note = "" if same else " (another machine or compiler: do not compare)"
        out += [f"The last column compares with {before['date']}, commit {before['machine']['commit']}{note}: time "
                "now to time then. Between runs a shared machine changes by tens of percent.", ""]
    for program, cases in run["programs"].items():
        old = before["programs"].get(program, {}) if before else {}
        out += [f"## {program}", "", table(["case", "time", "spread", "rate", earlier], case_rows(cases, old))]
    return "\n".join(out)


def main():
    raw, out = (pathlib.Path(argument) for argument in sys.argv[1:3])
    date = datetime.datetime.now().strftime("%Y-%m-%d_%H%M%S")
    programs = {path.stem: read_cases(path) for path in sorted(raw.glob("*.json"))}
    run = {"date": date, "machine": machine(), "ratios": ratio_rows(programs), "programs": programs}
    earlier = sorted(out.glob("[0-9]*.json"))
    before = json.loads(earlier[-1].read_text()) if earlier else None
    (out / f"{date}.json").write_text(json.dumps(run, indent=1) + "\n")
    (out / "README.md").write_text(page(run, before))


main()
PYTHON
echo "page: $(realpath "$out/README.md")"
