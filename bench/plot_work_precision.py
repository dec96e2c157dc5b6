#!/usr/bin/env python3
"""Draws the work-precision picture of docs/accuracy.md: plot_work_precision.py work_precision.csv out.svg

One panel a spacetime, one line an integrator, one dot a tolerance; the widest kernel of the CSV. Standard library
only."""
import csv
import math
import sys

TITLES = {
    "minkowski": "Minkowski, λ = 10",
    "goedel": "Gödel, λ = 10",
    "schwarzschild_r20": "Schwarzschild, r = 20",
    "schwarzschild_r1000": "Schwarzschild, r = 1000",
    "kerr_r20": "Kerr 0.9, r = 20",
    "kerr_r1000": "Kerr 0.9, r = 1000",
}
COLORS = {"dopri5": "#0072b2", "verner65": "#009e73", "prince_dormand87": "#d55e00", "fehlberg78": "#999999"}
WIDTH, HEIGHT, LEFT, TOP, GAP_X, GAP_Y = 300, 250, 62, 78, 24, 62
X_RANGE, Y_RANGE = (-7, -4), (-16, -2)  # powers of ten: seconds a ray, relative error


def read(path):
    """place -> integrator -> rows in the order of tolerances."""
    curves = {}
    with open(path, encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        if row["kernel"] == rows[0]["kernel"]:
            curves.setdefault(row["place"], {}).setdefault(row["integrator"], []).append(row)
    return curves


class Panel:
    """Where a panel stands, and what goes into it."""

    def __init__(self, column, line, title):
        self.x0 = LEFT + column * (WIDTH + GAP_X)
        self.y0 = TOP + line * (HEIGHT + GAP_Y)
        self.parts = [f'<rect x="{self.x0}" y="{self.y0}" width="{WIDTH}" height="{HEIGHT}" fill="#fff" '
                      'stroke="#888"/>',
                      f'<text x="{self.x0 + 8}" y="{self.y0 - 8}" font-weight="bold">{title}</text>']
        self.grid(column)

    def x(self, seconds):
        return self.x0 + WIDTH * (math.log10(seconds) - X_RANGE[0]) / (X_RANGE[1] - X_RANGE[0])

    def y(self, error):
        log = min(max(math.log10(max(error, 1e-300)), Y_RANGE[0]), Y_RANGE[1])
        return self.y0 + HEIGHT * (Y_RANGE[1] - log) / (Y_RANGE[1] - Y_RANGE[0])

    def grid(self, column):
        for power, text in zip(range(X_RANGE[0], X_RANGE[1] + 1), ("0.1 µs", "1 µs", "10 µs", "100 µs")):
            x = self.x(10.0**power)
            anchor = "start" if power == X_RANGE[0] else "end" if power == X_RANGE[1] else "middle"
            self.parts.append(f'<line x1="{x:.1f}" y1="{self.y0}" x2="{x:.1f}" y2="{self.y0 + HEIGHT}" stroke="#ddd"/>'
                              f'<text x="{x:.1f}" y="{self.y0 + HEIGHT + 16}" text-anchor="{anchor}">{text}</text>')
        for power in range(Y_RANGE[0], Y_RANGE[1] + 1, 2):
            y = self.y(10.0**power)
            self.parts.append(f'<line x1="{self.x0}" y1="{y:.1f}" x2="{self.x0 + WIDTH}" y2="{y:.1f}" stroke="#ddd"/>')
            if column == 0:
                self.parts.append(f'<text x="{self.x0 - 6}" y="{y + 4:.1f}" text-anchor="end">10<tspan dy="-4" '
                                  f'font-size="9">{power}</tspan></text>')

    def curve(self, name, rows):
        points = [(self.x(1 / float(r["rays_per_s"])), self.y(float(r["error_median"]))) for r in rows]
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        color = COLORS[name]
        self.parts.append(f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="1.8"/>')
        for (x, y), row in zip(points, rows):
            marked = row["rtol"] in ("1e-08", "1e-12")
            self.parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{4.2 if marked else 2.4}" fill="{color}">'
                              f'<title>{name}, rtol {row["rtol"]}</title></circle>')


def legend():
    parts, x = [], LEFT
    for name, color in COLORS.items():
        parts.append(f'<line x1="{x}" y1="18" x2="{x + 24}" y2="18" stroke="{color}" stroke-width="3"/>'
                     f'<text x="{x + 30}" y="22">{name}</text>')
        x += 150
    parts.append(f'<text x="{LEFT}" y="44">across: time a ray on one core; up: median relative error of the end point; '
                 'a dot a tolerance, the large ones 1e-8 and 1e-12</text>')
    return parts


def main():
    if len(sys.argv) != 3:
        sys.exit("usage: plot_work_precision.py work_precision.csv out.svg")
    width = LEFT + 3 * WIDTH + 2 * GAP_X + 14
    height = TOP + 2 * HEIGHT + GAP_Y + 34
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" '
           f'font-size="11.5" fill="#222"><rect width="{width}" height="{height}" fill="#fff"/>', *legend()]
    places = [p for p in ("goedel", "schwarzschild_r20", "kerr_r20", "minkowski", "schwarzschild_r1000", "kerr_r1000")]
    curves = read(sys.argv[1])
    for number, place in enumerate(places):
        panel = Panel(number % 3, number // 3, TITLES[place])
        for name, rows in curves.get(place, {}).items():
            panel.curve(name, rows)
        out += panel.parts
    with open(sys.argv[2], "w", encoding="utf-8") as file:
        file.write("\n".join([*out, "</svg>", ""]))


main()
