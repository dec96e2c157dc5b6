"""Datasets and their flat companions as other programs read them: by OpenImageIO, number for number, and made again here.
Usage: companions_test.py BIN_DIR SOURCE_DIR"""
import json
import math
import os
import re
import struct
import subprocess
import sys

from dataset_tools import Checks, Tools, black_hole_scene, deep, flat, flat_scene, goedel_scene, headers, lit_scene, values

source = os.path.abspath(sys.argv[2])
tools, checks = Tools(sys.argv[1]), Checks()
GROUPS = {"uv": ["uv.U", "uv.V"], "duv": ["duv.Ux", "duv.Vx", "duv.Uy", "duv.Vy"],
          **{group: [group + axis for axis in (".X", ".Y", ".Z")] for group in "NKP"}}


def murmur3(text):
    """MurmurHash3_x86_32 with seed 0, from its published description."""
    data, h = text.encode(), 0
    for i in range(0, len(data), 4):
        block = data[i:i + 4]
        k = int.from_bytes(block, "little") * 0xcc9e2d51 & 0xffffffff
        h ^= (k << 15 | k >> 17) * 0x1b873593 & 0xffffffff
        if len(block) == 4:
            h = ((h << 13 | h >> 19) & 0xffffffff) * 5 + 0xe6546b64 & 0xffffffff
    h ^= len(data)
    h = (h ^ h >> 16) * 0x85ebca6b & 0xffffffff
    h = (h ^ h >> 13) * 0xc2b2ae35 & 0xffffffff
    return h ^ h >> 16


def identity(name):
    h = murmur3(name)
    return h ^ 1 << 23 if h >> 23 & 255 in (0, 255) else h


def compare_records(path, pixels):
    """Every channel of a deep sample, and every ray, against nullcone-info --pixel."""
    spec, data = deep(path)
    rays = flat(path, 2)[1]
    report = tools.info(path)
    names, n = {o["id"]: o["name"] for o in report["objects"]}, report["samples"]
    for x, y in pixels:
        told = tools.pixel(path, x, y)
        pixel = (y - spec.y) * spec.width + x - spec.x
        found = [values(spec, data, pixel, k) for k in range(data.samples(pixel))]
        checks.same(len(found), len(told["hits"]), f"{path} {x},{y}: crossings")
        for sample, hit in zip(found, told["hits"]):
            expected = {}
            for lamp, paths in hit.pop("lights", {}).items():
                for i in range(report["light_paths"]):
                    names_of = {key: f"light.{lamp}.{i}.{key}" for key in ("E", "shift", "t", "tau")}
                    unlit = {"E": 0, **{key: sample[names_of[key]] for key in ("shift", "t", "tau")}}  # of no light nothing is told
                    found_light = paths[i] if i < len(paths) else unlit
                    expected.update({names_of[key]: value for key, value in found_light.items()})
            for key, value in hit.items():
                expected.update(zip(GROUPS[key], value) if key in GROUPS else [(key, value)])
            sample = {key: value if math.isfinite(value) else None for key, value in sample.items()}
            sample["object"] = names[sample.pop("id")]
            checks.same(sample, expected, f"{path} {x},{y}")
        several = told["rays"] if isinstance(told["rays"], list) else [dict(told["rays"], sample=0)]
        for ray in several:
            row, column = (y - spec.y) * n + ray["sample"] // n, x * n + ray["sample"] % n
            for key in ("steps", "error", "drift"):
                checks.same(rays[key][row, column].item(), ray[key], f"{path} {x},{y}: {key}")
            checks.same(code["status"][rays["status"][row, column]], ray["status"], f"{path} {x},{y}: status")


def covered(samples, names, n):
    """[(name, share)] of a pixel, greatest first: front to back along each ray."""
    left, shares = {}, {}
    for s in samples:
        ray = s.get("sample", 0)
        hidden = left.get(ray, 1.0) * s["A"]
        left[ray] = left.get(ray, 1.0) - hidden
        shares[s["id"]] = shares.get(s["id"], 0) + hidden / n**2
    return [(names[i - 1], share) for i, share in sorted(shares.items(), key=lambda entry: (-round(entry[1], 9), entry[0])) if share > 0]


def worst_of(rays, x, y, n):
    """The pixel's worst ray: doubtful ones first, then by error; of equals the one nearest the centre."""
    middle = (n - 1) // 2
    grid = [(y * n + row, x * n + column) for row, column in [(middle, middle)] + [(r, c) for r in range(n) for c in range(n)]]
    return max(grid, key=lambda at: (code["status"][rays["status"][at]] in ("step_limit", "not_finite"), rays["error"][at]))


def compare_companion(path, companion, ranks=6, options=()):
    """Every pixel of the flat picture, made again from the dataset; how many show more than one opaque object."""
    tools.run("info", "--flat", path, "-o", companion, *options)
    report = tools.info(path)
    spec, data = deep(path)
    flat_spec, picture = flat(companion)
    rays = flat(path, 2)[1]
    names, n = [o["name"] for o in report["objects"]], report["samples"]
    layers = max(1, (min(ranks, len(names)) + 1) // 2)
    pairs = [(f"CryptoObject{i:02}.{a}", f"CryptoObject{i:02}.{b}") for i in range(layers) for a, b in ("RG", "BA")]
    own = [name for name in spec.channelnames if name != "A"]
    types = {name: str(kind) for name, kind in zip(flat_spec.channelnames, flat_spec.channelformats)}
    expected = {name: str(kind) for name, kind in zip(spec.channelnames, spec.channelformats)}
    expected.update({"status": "uint", "steps": "uint", "error": "float", "drift": "float"}, **dict.fromkeys("RGBA", "half"))
    expected.update({name: "float" for pair in pairs for name in pair})
    checks.same(types, expected, f"{companion}: channels and types")
    for key in ("x", "y", "width", "height", "full_x", "full_y", "full_width", "full_height"):
        checks.same(getattr(flat_spec, key), getattr(spec, key), f"{companion}: {key}")
    middle = (n - 1) // 2 * (n + 1)
    edges = 0
    for pixel in range(spec.width * spec.height):
        y, x = divmod(pixel, spec.width)
        samples = [values(spec, data, pixel, k) for k in range(data.samples(pixel))]
        seen = [s for s in samples if s.get("sample", middle) == middle]
        first = next((s for s in seen if s["A"] >= 1), seen[0] if seen else dict.fromkeys(own, 0) | {"Z": math.inf, "A": 0})
        for name in own:
            checks.same(picture[name][y, x].item(), first[name], f"{companion} {x},{y}: {name}")
        checks.true(abs(picture["A"][y, x] - first["A"]) < 1e-3, f"{companion} {x},{y}: A")
        checks.true(max(picture[c][y, x] for c in "RGB") > 0 or not seen, f"{companion} {x},{y}: black")
        at = worst_of(rays, x, y, n)
        for name in ("status", "steps", "error", "drift"):
            checks.same(picture[name][y, x].item(), rays[name][at].item(), f"{companion} {x},{y}: {name}")
        found = [(struct.unpack("<I", picture[h][y, x].tobytes())[0], picture[share][y, x].item()) for h, share in pairs]
        expected = covered(samples, names, n)
        for (h, share), (name, wanted) in zip(found, expected + [(None, 0)] * (len(pairs) - len(expected))):
            checks.same(h, identity(name) if name else 0, f"{companion} {x},{y}: hash of {name}")
            checks.true(abs(share - wanted) < 1e-6, f"{companion} {x},{y}: {share} of {name}, expected {wanted}")  # rounding to float
        checks.true(sum(share for _, share in found) <= 1 + 1e-6, f"{companion} {x},{y}: covers more than itself")
        edges += sum(name != "glass" for name, _ in expected) > 1
    return edges


def compare_metadata(companion, names):
    attributes = {name: value[1].decode() for name, value in headers(companion)[0].items() if value[0] == "string"}
    key = "cryptomatte/" + f"{identity('CryptoObject'):08x}"[:7]
    checks.same(key, "cryptomatte/3ae39a5", "key of the layer")  # as other programs write it
    checks.same([attributes.get(f"{key}/{entry}") for entry in ("name", "hash", "conversion")],
                ["CryptoObject", "MurmurHash3_32", "uint32_to_float32"], "Cryptomatte's attributes")
    checks.same(json.loads(attributes[f"{key}/manifest"]), {name: f"{identity(name):08x}" for name in names}, "Cryptomatte's manifest")
    checks.same(json.loads(attributes["nullconeObjects"]), names, "nullconeObjects")


def compare_example(path, x, y):
    """examples/histogram.py prints the very numbers of nullcone-info."""
    lines = subprocess.run([sys.executable, os.path.join(source, "examples", "histogram.py"), path, f"{x},{y}"],
                           capture_output=True, text=True, check=True).stdout.splitlines()
    hits = tools.pixel(path, x, y)["hits"]
    found = [tuple(map(float, re.fullmatch(r"shift (\S+)  t (\S+)", line).groups())) for line in lines if line.startswith("shift")]
    checks.same(found, [(hit["shift"], hit["t"]) for hit in hits], f"examples/histogram.py {path} {x},{y}")
    counted = sum(int(line.split()[-1]) for line in lines if not line.startswith("shift"))
    spec, data = deep(path)
    row = range((y - spec.y) * spec.width, (y - spec.y + 1) * spec.width)
    checks.same(counted, sum(data.samples(i) for i in row), f"examples/histogram.py {path}: counts")
    return len(found)


code = json.loads(tools.run("info", "--format"))
for text, expected in (("", 0), ("hello", 0x248bfa47), ("hello, world", 0x149bbb7f), ("The quick brown fox jumps over the lazy dog", 0x2e4ff723)):
    checks.same(murmur3(text), expected, f"MurmurHash3 of '{text}'")

goedel, ball, hole = (tools.trace(goedel_scene(source, [66, 35]), "goedel.exr"), tools.trace(flat_scene([15, 21], 4), "ball.exr"),
                      tools.trace(black_hole_scene([24, 20]), "hole.exr"))
lit = tools.trace(lit_scene([9, 13], 2), "lit.exr")
tools.run("trace", "goedel.exr.json", "-q", "-o", "shard.exr", "--shard", "2/2")
compare_records(goedel, [(x, 17) for x in range(0, 66, 3)])
compare_records("shard.exr", [(x, y) for x in range(0, 66, 9) for y in (16, 17, 34)])
compare_records(ball, [(x, y) for x in range(0, 15, 2) for y in range(0, 21, 3)])
compare_records(lit, [(x, y) for x in range(0, 9, 2) for y in range(0, 13, 2)])
compare_records(hole, [(x, y) for x in range(0, 24, 4) for y in range(0, 20, 4)])
for path in (goedel, "shard.exr", hole):
    checks.same(compare_companion(path, "flat.exr"), 0, f"{path}: pixels with more than one object")
checks.true(compare_companion(ball, "flat.exr") > 10, "no pixel of the sampled ball's edge is covered in part")
compare_companion(lit, "lit_flat.exr")
compare_metadata("flat.exr", ["glass", "ball", "stars"])
compare_companion(ball, "flat.exr", 1, ["--ranks", "1"])
checks.true(sum(compare_example(goedel, x, 17) for x in range(66)) > 5, "the example has seen no crossing")
checks.true(compare_example(ball, 7, 10) >= 16, "the example has seen no samples")
checks.finish()
