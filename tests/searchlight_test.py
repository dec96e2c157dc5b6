"""docs/searchlight.md: runs its commands, calculates its pixels again from the scenes alone, and compares its tables and pictures.
Usage: searchlight_test.py BIN_DIR SOURCE_DIR"""
import json
import math
import os
import re
import shlex
import subprocess
import sys

import numpy as np
import OpenImageIO as oiio

from dataset_tools import Checks, Tools

source = os.path.abspath(sys.argv[2])
tools, checks = Tools(sys.argv[1]), Checks()
page = open(os.path.join(source, "docs", "searchlight.md"), encoding="utf-8").read()
TEXTURE = 1e-6  # floats: colours and (u, v) of the dataset
POWERS = 1e-5   # the fifth power of a shift in float, and of its table
PLANCK = 1e-4   # tables of black bodies


# Reading: the page, scenes, pictures.

def commands():
    lines = re.sub(r"\\\n\s*", "", page).splitlines()
    return [line.strip() for line in lines if line.startswith("    ")]


def table(first_column):
    """The rows of the table that begins with this heading, as texts."""
    rows = page[page.index("| " + first_column):].split("\n\n")[0].splitlines()[2:]
    return [[cell.strip() for cell in row.strip("|").split("|")] for row in rows]


def scene(name):
    return json.load(open(os.path.join(source, "scenes", name)))


def pixels(path):
    return oiio.ImageInput.open(path).read_image(0, 0, 0, 3, "float").astype(float)


def run(command):
    done = subprocess.run(command, shell=True, capture_output=True, text=True, timeout=300,
                          env=dict(os.environ, PATH=tools.folder + os.pathsep + os.environ["PATH"]))
    if done.returncode:
        sys.exit(f"{command}: status {done.returncode}: {done.stderr[:500]}")
    return done.stdout


def light(command, space):
    """What the command's picture shows, before exposure."""
    words = shlex.split(command)
    words[words.index("-o") + 1] = "light.exr"
    run(shlex.join(words + ["--set", "exposure.ev=0", "--set", "exposure.white_cd_m2=1", "--set", "output.space=" + space]))
    return pixels("light.exr")


# Special relativity, from the scene: directions of a pixel's samples, shifts, and what they meet.

def directions(camera, x, y):
    n, (width, height) = camera["samples"], camera["resolution"]
    azimuth, elevation = (math.radians(camera.get(key, 0)) for key in ("azimuth_deg", "elevation_deg"))
    forward = np.array([math.cos(elevation) * math.cos(azimuth), math.cos(elevation) * math.sin(azimuth), math.sin(elevation)])
    left = np.array([-math.sin(azimuth), math.cos(azimuth), 0])
    up, step = np.cross(forward, left), 2 * math.tan(math.radians(camera["fov_deg"]) / 2) / width
    for row in range(n):
        for column in range(n):
            d = forward + step * ((width / 2 - x - (column + 0.5) / n) * left + (height / 2 - y - (row + 0.5) / n) * up)
            yield d / np.linalg.norm(d)


def gamma(beta):
    return 1 / math.sqrt(1 - beta @ beta)


def shift(m, beta):
    """g = observed/emitted where an observer with velocity beta past the source looks towards m."""
    return 1 / (gamma(beta) * (1 - beta @ m))


def at_rest(m, beta):
    """Where that observer's direction m points in the frame of the street: aberration."""
    c = gamma(beta)
    return (m + (c * c / (c + 1) * (beta @ m) - c) * beta) / (c * (1 - beta @ m))


def crossings(thing, eye, m):
    """(distance, face, u, v) where a ray meets a box or quad at rest, as docs/scene.md has its texture."""
    centre, edges = np.array(thing["placing"]["worldline"]["event"][1:]), thing["shape"]["edges"]
    box = thing["shape"]["type"] == "box"
    for axis in range(3) if box else [2]:
        side = -np.sign(m[axis])
        distance = (centre[axis] + side * (edges[axis] / 2 if box else 0) - eye[axis]) / m[axis]
        at = [x / edge for x, edge in zip(eye + distance * m - centre, edges)] if box else (eye + distance * m - centre)[:2] / edges
        if distance <= 0 or any(abs(x) > 0.5 for k, x in enumerate(at) if k != axis):
            continue
        if not box:
            yield distance, 0, at[0] + 0.5, at[1] + 0.5
            continue
        right, upwards = [(side * at[1], at[2]), (-side * at[0], at[2]), (side * at[0], at[1])][axis]
        yield distance, (axis, side), (axis + right + 0.5) / 3, ((side > 0) + upwards + 0.5) / 2


def met(street, m):
    """(name, u, v, square) of what is nearest."""
    eye = np.array(street["observer"]["event"][1:])
    found = [(*hit, thing["name"]) for thing in street["objects"] for hit in crossings(thing, eye, m)]
    _, face, u, v, name = min(found)
    counts = street["look"]["objects"][name]["texture"]["counts"]
    return name, u, v, (name, face, math.floor(u * counts[0]), math.floor(v * counts[1]))


def radiance(street, name, u, v):
    """Of the checkerboard, as docs/look.md has it; all colours are grey."""
    def linear(x):
        return x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4
    board = street["look"]["objects"][name]["texture"]
    odd = (math.floor(u * board["counts"][0]) + math.floor(v * board["counts"][1])) % 2
    if "colors" in board:
        return linear(board["colors"][odd][0])
    run_of = board["gradient"]
    first, last = linear(run_of["from"][0]), linear(run_of["to"][0])
    return (first + (last - first) * (u if run_of["along"] == "u" else v)) * (run_of["dark"] if odd else 1)


def seen(street, x, y, power=0):
    """(squares, mean of g^power times the radiance at rest) of a pixel's samples."""
    beta = np.array(street["observer"].get("velocity", [0, 0, 0]))
    squares, total = set(), []
    for m in directions(street["camera"], x, y):
        name, u, v, square = met(street, at_rest(m, beta))
        squares.add(square)
        total.append(shift(m, beta) ** power * radiance(street, name, u, v))
    return squares, np.mean(total)


# Black bodies.

def observer_1931():
    """The functions at every 1/4 nm, linear between those of the CIE: (nanometres, [x, y, z])."""
    text = open(os.path.join(source, "postrender", "cie1931.cpp"), encoding="utf-8").read()
    rows = np.array([[float(x) for x in row] for row in re.findall(r"\{([\d.]+), ([\d.]+), ([\d.]+)\}", text)])
    checks.same(rows.shape, (95, 3), "colour-matching functions: 360 to 830 nm")
    nm = np.linspace(360, 830, 4 * 470 + 1)
    return nm, np.array([np.interp(nm, np.linspace(360, 830, 95), column) for column in rows.T])


def black_body(T, observer):
    """X, Y, Z in cd/m^2."""
    nm, functions = observer
    h, c, k, x = 6.62607015e-34, 299792458.0, 1.380649e-23, 1e-9 * observer[0]
    planck = 1e-9 * 2 * h * c * c / x**5 / np.expm1(h * c / (x * k * T))
    values = 683 * functions * planck
    return (values[:, 1:] + values[:, :-1]).sum(axis=1) / 2 * (nm[1] - nm[0])


# Comparing.

def close(found, expected, tolerance, what):
    checks.true(bool(np.all(np.abs(np.asarray(found) / np.asarray(expected) - 1) < tolerance)), f"{what}: {found}, expected {expected}")


def printed(text, found, what):
    """A number of the page, to the digits that it has."""
    half = 0.5 * 10.0 ** -len(text.partition(".")[2])
    checks.true(abs(float(text) - found) < 1.02 * half, f"docs/searchlight.md, {what}: {text}, found {found:.7g}")


def told(text):
    checks.true(text in page.replace("\n", " ").replace("  ", " "), f"docs/searchlight.md does not say '{text}'")


def coordinates(text):
    return tuple(int(number) for number in text.split(","))


def compare_moving(label, street, x, y, geometry, wrong, right):
    """One pixel in figures 5 to 7; returns the square that it shows."""
    beta = np.array(street["observer"]["velocity"])
    squares, texture = seen(street, x, y)
    checks.same(len(squares), 1, f"{label}: squares in the pixel")
    close(geometry[y, x], texture, TEXTURE, f"{label}: geometry only")
    for name, picture, power in (("wrong", wrong, 1), ("right", right, 4)):
        close(picture[y, x], seen(street, x, y, power)[1], POWERS, f"{label}: {name}")
        mean = np.mean([shift(m, beta) ** power for m in directions(street["camera"], x, y)])
        close(picture[y, x] / geometry[y, x], mean, POWERS, f"{label}: {name}/geometry")
    return squares.pop()


def compare_street(pictures):
    """Figures 4 to 7: every row of the page's table."""
    still, street = scene("street_at_rest.json"), scene("street.json")
    beta, ahead = np.array(street["observer"]["velocity"]), {}
    rest, *moving = (light(command, "linear_rec709") for command in pictures)
    for label, pixel, still_pixel, what, g, at_rest_told, *numbers in table("place"):
        x, y = coordinates(pixel)
        square = compare_moving(label, street, x, y, *moving)
        checks.true(f"`{square[0]}`" in what, f"{label}: shows {square}")
        rays = list(directions(street["camera"], x, y))
        ahead[label] = math.degrees(math.acos(at_rest(rays[0], beta)[0]))
        printed(g, np.mean([shift(m, beta) for m in rays]), label)
        values = [picture[y, x, 1] for picture in moving]
        for text, number in zip(numbers, [*values, values[2] / values[0]], strict=True):
            printed(text, number, label)
        if still_pixel == "–":
            continue
        x, y = coordinates(still_pixel)
        squares, texture = seen(still, x, y)
        checks.same(squares, {square}, f"{label}: the square at rest")
        close(rest[y, x], texture, TEXTURE, f"{label}: at rest")
        printed(at_rest_told, rest[y, x, 1], label)
    told(f"F and G are seen {ahead['F']:.0f}° and {ahead['G']:.0f}° from straight ahead")


def compare_sun(pictures):
    """Figures 8 and 9."""
    flyby = scene("sun_flyby.json")
    away = -np.array(flyby["objects"][0]["placing"]["worldline"]["velocity"])  # of the observer, past the sun
    T = flyby["look"]["objects"]["sun"]["spectrum"]["temperature_K"]
    doppler, both = (light(command, "xyz") for command in pictures)
    observer, luminance = observer_1931(), {}
    for label, pixel, *numbers in table("part"):
        x, y = coordinates(pixel)
        g = [shift(m, away) for m in directions(flyby["camera"], x, y)]
        bodies = [black_body(one * T, observer) for one in g]
        for name, picture, power in (("both", both, 0), ("Doppler only", doppler, -5)):
            expected, found = sum(one**power * body for one, body in zip(g, bodies)) / len(g), picture[y, x]
            close(found[1], expected[1], PLANCK, f"{label}: luminance, {name}")
            for axis in (0, 1):
                difference = found[axis] / found.sum() - expected[axis] / expected.sum()
                checks.true(abs(difference) < PLANCK, f"{label}: chromaticity, {name}: off by {difference:.2g}")
        close(doppler[y, x] / both[y, x], np.mean(g) ** -5, PLANCK, f"{label}: Doppler only / both")
        found = [np.mean(g), np.mean(g) * T, doppler[y, x, 1] / 1e9, both[y, x, 1] / 1e9, *(both[y, x, :2] / both[y, x].sum())]
        for text, number in zip(numbers, found, strict=True):
            printed(text, number, label)
        luminance[label] = both[y, x, 1]
    told(f"{luminance['R'] / luminance['W']:.1f} times as bright as the receding one (R and W)")
    still = black_body(T, observer)
    told(f"At rest the sun would have {still[1] / 1e9:.4f} · 10⁹ cd/m², x = {still[0] / still.sum():.4f}, y = {still[1] / still.sum():.4f}")


def compare_settings(pictures):
    """Pictures that are compared have the same exposure and tone."""
    looks = [json.loads(run(command + " --explain")) for command in pictures]
    for look in looks[1:]:
        checks.same([look[key] for key in ("exposure", "tone", "objects", "background")],
                    [looks[0][key] for key in ("exposure", "tone", "objects", "background")], "settings of pictures that are compared")


def compare_pictures(pictures):
    for command in pictures:
        path = shlex.split(command)[shlex.split(command).index("-o") + 1]
        made, kept = pixels(path), pixels(os.path.join(source, path))
        checks.true(made.shape == kept.shape and np.array_equal(made, kept), f"{path} is not what its command makes")


def compare_look():
    """The look of the series has the scene's textures."""
    series = scene("looks/street_radiance.json")["objects"]
    for name in ("street.json", "street_at_rest.json"):
        own = scene(name)["look"]["objects"]
        textures = [{key: entry["texture"] for key, entry in objects.items()} for objects in (series, own)]
        checks.same(*textures, f"textures of {name}")
    checks.same({entry["spectrum"]["type"] for entry in series.values()}, {"total_radiance"}, "spectra of the street")


os.symlink(os.path.join(source, "scenes"), "scenes")
os.mkdir("docs")
for command in commands():
    run(command)
made = [command for command in commands() if command.startswith("nullcone-postrender")]
checks.same((len(made), len(table("place")), len(table("part"))), (6, 8, 6), "pictures of the series, and marked pixels")
compare_look()
compare_settings(made[:4])
compare_settings(made[4:])
compare_pictures(made)
compare_street(made[:4])
compare_sun(made[4:])
checks.finish()
