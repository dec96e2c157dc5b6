#!/usr/bin/env python3
"""GYOTO (Debian: gyoto-bin) beside Nullcone on this machine: Kerr 0.9, the same screen of impact parameters.

  scripts/build.sh release studies
  gyoto.py [--work-precision build/release/bin/work_precision] [--side 24]

GYOTO's rays a second come from its library alone (the integration without anything around it) where the headers of
libgyoto8-dev and libudunits2-dev are found (or in $GYOTO_INCLUDE, a list of folders); its errors too, against itself at
1e-14. Without them the program is timed, at two resolutions, and the errors are those measured on 2026-11-22.
Of Nullcone's runs the fastest counts whose median and 90 % errors are not larger than GYOTO's."""
import argparse
import csv
import io
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import tempfile

TOLERANCES = ("1e-6", "1e-8", "1e-10", "1e-12")
NEEDED = 25
# (place, tolerance) -> median and 90 % relative error of GYOTO 1.4.4, runge_kutta_fehlberg78.
MEASURED = {
    (20, "1e-6"): (4.67e-7, 1.89e-6), (20, "1e-8"): (9.77e-9, 2.03e-8), (20, "1e-10"): (1.62e-10, 4.16e-10),
    (20, "1e-12"): (3.33e-12, 3.32e-11), (1000, "1e-6"): (3.88e-6, 1.58e-5), (1000, "1e-8"): (4.27e-8, 2.72e-7),
    (1000, "1e-10"): (1.50e-9, 8.18e-9), (1000, "1e-12"): (2.55e-11, 1.45e-10),
}
SCENE = """<?xml version="1.0" encoding="UTF-8" standalone="no"?>
<Scenery>
  <Metric kind="KerrBL" plugin="stdplug"><Spin>0.9</Spin></Metric>
  <Screen>
    <Time unit="geometrical_time">10000</Time><Distance unit="geometrical">{radius}</Distance>
    <FieldOfView unit="radian">{field}</FieldOfView><Resolution>32</Resolution>
    <Inclination unit="degree">80</Inclination><PALN unit="degree">180</PALN><Argument unit="degree">-90</Argument>
    <AngleKind>Rectilinear</AngleKind>
  </Screen>
  <Astrobj kind="FixedStar" plugin="stdplug">
    <Radius>1e-6</Radius><Position>{end} 3.0 0</Position><RMax>{end}</RMax>
    <Spectrum kind="PowerLaw"><Exponent>0</Exponent><Constant>1</Constant></Spectrum>
    <Opacity kind="PowerLaw"><Exponent>0</Exponent><Constant>1</Constant></Opacity>
  </Astrobj>
  <Integrator>runge_kutta_fehlberg78</Integrator><AbsTol>{rtol}</AbsTol><RelTol>{rtol}</RelTol>
  <Adaptive/><NThreads>0</NThreads><Quantities>Intensity</Quantities>
</Scenery>
"""
SCREENS = {
    20: {"radius": 20, "field": 1.28700221758657, "end": 31},
    1000: {"radius": 1000, "field": 0.029997750202, "end": 1001},
}


def build_rays(folder):
    """The program of bench/gyoto.cpp, or None where GYOTO's headers are missing."""
    given = os.environ.get("GYOTO_INCLUDE", "/usr/include/x86_64-linux-gnu/Gyoto:/usr/include/x86_64-linux-gnu")
    includes = [word for path in given.split(":") for word in ("-isystem", path)]
    program = folder / "gyoto_rays"
    source = pathlib.Path(__file__).with_name("gyoto.cpp")
    library = next(pathlib.Path("/usr/lib").glob("*/libgyoto.so.8"), "-lgyoto")
    command = ["g++", "-O2", "-std=c++17", *includes, str(source), "-o", str(program), str(library)]
    if subprocess.run(command, capture_output=True).returncode == 0:
        return program
    print("gyoto.py: no headers of GYOTO: its program is timed, its errors are those of 2026-11-22", file=sys.stderr)
    return None


def program_seconds(scene, side):
    """CPU time of the program at one resolution, the best of three."""
    best = float("inf")
    for _ in range(3):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(["gyoto", "-s", f"-r{side}", scene, "!" + scene + ".fits"], check=True, capture_output=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        best = min(best, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return best


def program_rate(folder, radius, rtol):
    """Rays a second of the program; what it needs to start drops out."""
    scene = folder / "scene.xml"
    scene.write_text(SCENE.format(rtol=rtol, **SCREENS[radius]))
    few, many = 24, 72
    return (many * many - few * few) / (program_seconds(str(scene), many) - program_seconds(str(scene), few))


def gyoto_run(folder, rays, radius, rtol, side):
    """(rays a second, median error, 90 % error)"""
    if not rays:
        return program_rate(folder, radius, rtol), *MEASURED[radius, rtol]
    best, errors = 0.0, None
    for _ in range(3):
        out = subprocess.run([rays, str(radius), str(side), rtol], check=True, capture_output=True, text=True).stdout
        rate, median, most_of_all = (float(word) for word in out.split()[:3])
        best, errors = max(best, rate), (median, most_of_all)
    return best, *errors


def nullcone_runs(program, radius):
    """Rows of the study for the widest kernel."""
    out = subprocess.run([program, "--rays", "4096", "--repeats", "5", "--only", f"kerr_r{radius}"], check=True,
                         capture_output=True, text=True).stdout
    rows = list(csv.DictReader(io.StringIO(out)))
    return [row for row in rows if row["kernel"] == rows[0]["kernel"]]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work-precision", default="build/release/bin/work_precision")
    parser.add_argument("--side", type=int, default=24)
    options = parser.parse_args()
    if not shutil.which("gyoto"):
        sys.exit("gyoto.py: skipped: no gyoto here (Debian: gyoto-bin)")
    print("| observer | GYOTO's tolerance | its rays/s/core | median, 90 % error | Nullcone, not worse | rays/s/core | "
          f"ratio (at least {NEEDED}) |\n|---|---|---|---|---|---|---|")
    worst = float("inf")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        rays = build_rays(folder)
        for radius in SCREENS:
            rows = nullcone_runs(options.work_precision, radius)
            for rtol in TOLERANCES:
                rate, median, most = gyoto_run(folder, rays, radius, rtol, options.side)
                as_good = [r for r in rows if float(r["error_median"]) <= median and float(r["error_90"]) <= most]
                ours = max(as_good, key=lambda row: float(row["rays_per_s"]))
                ratio = float(ours["rays_per_s"]) / rate
                worst = min(worst, ratio)
                cells = [f"r = {radius}", rtol, f"{rate:,.0f}", f"{median:.1e}, {most:.1e}",
                         f"{ours['integrator']} {ours['rtol']}: {float(ours['error_median']):.1e}, "
                         f"{float(ours['error_90']):.1e}", f"{float(ours['rays_per_s']):,.0f}", f"{ratio:.0f}"]
                print("| " + " | ".join(cells) + " |", flush=True)
    sys.exit(0 if worst >= NEEDED else 1)


main()
