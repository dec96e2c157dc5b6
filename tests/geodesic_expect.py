"""Whether the expression in argv[1] is true of what nullcone-geodesic printed into the file `out`.

It may use d, the JSON there, or table, the rows of the CSV; closed, the JSON in the file `kept`; and the facts below.
"""
import csv, json, math, os, sys
text = open("out").read()
d, table = None, []
if text.startswith("{"):
    d = json.loads(text, parse_constant=lambda word: sys.exit("not JSON: " + word))
else:
    table = [{k: float(v) if k not in ("status", "object") and v else v for k, v in row.items()}
             for row in csv.DictReader(open("out"))]
closed = json.load(open("kept")) if os.path.exists("kept") else None
def near(a, b, limit):
    return len(a) == len(b) and all(abs(x - y) <= limit for x, y in zip(a, b))
def events(report):
    return [p["event"] for p in report["points"]]
def goedel_square(x, k):  # g(k, k) for a = 1, from (dt + A)^2 - h - dz^2
    N = 4 + x[1]**2 + x[2]**2
    return ((k[0] + (x[1]*k[2] - x[2]*k[1]) / 2**.5)**2 - k[3]**2 - k[1]**2 - k[2]**2
            + (x[1]*k[1] + x[2]*k[2])**2 / N - (x[1]*k[2] - x[2]*k[1])**2 / 4)
def flow(K, x, eta, steps=2000):  # classical Runge-Kutta: 1e-12 for these fields and parameters
    for _ in range(steps):
        h = eta / steps
        add = lambda y, s, k: [a + s * b for a, b in zip(y, k)]
        k1 = K(x); k2 = K(add(x, h/2, k1)); k3 = K(add(x, h/2, k2)); k4 = K(add(x, h, k3))
        x = [a + h/6 * (p + 2*q + 2*r + s) for a, p, q, r, s in zip(x, k1, k2, k3, k4)]
    return x
def K4(p):  # docs/physics.md, for a = 1
    t, x, y, z = p
    s = math.sqrt(1 + (x*x + y*y) / 4)
    return [x / (2**.5 * s), -x*y / (4*s), (1 + (x*x + y*y) / 4 + x*x / 4) / s, 0]
def K5(p):
    t, x, y, z = p
    s = math.sqrt(1 + (x*x + y*y) / 4)
    return [y / (2**.5 * s), -(1 + (x*x + y*y) / 4 + y*y / 4) / s, x*y / (4*s), 0]
if not eval("(" + sys.argv[1] + ")"): sys.exit("false")
