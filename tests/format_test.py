"""Holds docs/format.md against the code and against fresh files: channels, statuses, attributes, manifest, fingerprints.
Usage: format_test.py BIN_DIR SOURCE_DIR"""
import hashlib
import json
import os
import re
import struct
import sys

from dataset_tools import Checks, Tools, black_hole_scene, deep, flat, flat_scene, goedel_scene, headers, lit_scene

source = os.path.abspath(sys.argv[2])
tools = Tools(sys.argv[1])
checks = Checks()


def tables(text):
    """{section or first column's title: rows as lists of cells without backquotes}."""
    out, section, rows = {}, "", None
    for line in text.splitlines():
        if line.startswith("## "):
            section = line[3:].replace("`", "")
        if not line.startswith("|"):
            rows = None
        elif rows is None:
            title = line.split("|")[1].strip().replace("`", "")
            rows = out.setdefault(f"{section}: {title}", [])
        elif not line.startswith("|---"):
            rows.append([cell.strip().replace("`", "") for cell in re.split(r"(?<!\\)\|", line.strip("|"))])
    return out


doc = tables(open(os.path.join(source, "docs", "format.md")).read())
code = json.loads(tools.run("info", "--format"))


def compare_channels(part):
    told = {row[0]: row[1:] for row in doc[f"Channels of {part}: channel"]}
    checks.same(list(told), [channel["name"] for channel in code[part]], f"channels of {part} in their order")
    for channel in code[part]:
        row = told.get(channel["name"], [""] * 5)
        checks.same(row[:4], [channel["type"], channel["unit"], channel["range"], str(channel["since"])], f"{part}: {channel['name']}")
        checks.true(len(row[4]) > 3, f"{part}: {channel['name']} has no meaning")


compare_channels("hits")
compare_channels("light")
compare_channels("rays")
statuses = doc["Channels of rays: status"]
checks.same([(int(row[0]), row[1]) for row in statuses], list(enumerate(code["status"])), "statuses")
text = open(os.path.join(source, "docs", "format.md")).read()
checks.same(int(re.search(r"version (\d+) of the format", text)[1]), code["format"], "version of the format")
checks.same(int(re.search(r"bands of (\d+) scan lines", text)[1]), code["band_lines"], "scan lines of a band")

KINDS = {"boolean": bool, "integer": int, "number": (int, float), "string": str, "list": list, "list of strings": list, "object": dict,
         "2 numbers": list, "3 numbers": list, "4 numbers": list, "number or string": (int, float, str)}


def compare_keys(found, rows, what):
    """Every key that a file has stands in the table with its type, and every key of the table is in some file."""
    told = {row[0]: row[1] for row in rows}
    for key, value in found:
        kind = told.get(key, told.get(re.sub(r"\.[^.]*$", ".*", key)))
        checks.true(kind is not None, f"{what}: '{key}' is not in docs/format.md")
        if kind:
            checks.true(isinstance(value, KINDS[kind]), f"{what}: '{key}' is {value!r}, not {kind}")
            if kind[0].isdigit():
                checks.same(len(value), int(kind[0]), f"{what}: length of '{key}'")
    names = {key for key, _ in found} | {re.sub(r"\.[^.]*$", ".*", key) for key, _ in found}
    for key in told:
        checks.true(key in names, f"{what}: no file has '{key}', which docs/format.md tells of")


def leaves(value, path=""):
    if not isinstance(value, dict):
        return [(path, value)]
    return [leaf for key, entry in value.items() for leaf in leaves(entry, f"{path}.{key}" if path else key)]


def compare_attributes(path):
    for part, attributes in zip(("preview", "hits", "rays"), headers(path)):
        rows = [row for row in doc["Attributes of the header: part"] if row[0] in (part, "all")]
        told = {name: row[2] for row in rows for name in row[1].split(", ")}
        checks.same(set(attributes), set(told), f"attributes of part {part}")
        for name, kind in told.items():
            checks.true(not kind or attributes.get(name, (kind,))[0] == kind, f"type of {part}: {name}")


def hash_of_file(path):
    data = open(path, "rb").read()
    digits = headers(path)[0]["nullconeSha256"][1]
    checks.same(data.count(digits), 1, "places of the file's own hash")
    data = data.replace(digits, b"0" * 64)
    blocks = [hashlib.sha256(data[at : at + (1 << 20)]).hexdigest() for at in range(0, len(data), 1 << 20)]
    checks.same(hashlib.sha256("".join(blocks).encode()).hexdigest(), digits.decode(), f"{path}: hash of the file")


def fingerprints(path, manifest):
    """As docs/format.md describes them, from what OpenImageIO reads."""
    spec, data = deep(path)
    rays = flat(path, 2)[1]
    hits_hash, rays_hash = hashlib.sha256(), hashlib.sha256()
    width, lines, n = manifest["width"], manifest["lines"], manifest["samples"]
    for first in range(0, lines, 16):
        last = min(first + 16, lines)
        pixels = range(first * width, last * width)
        hits_hash.update(struct.pack(f"<{len(pixels)}I", *(data.samples(i) for i in pixels)))
        for name in manifest["channels"]:
            c = spec.channelnames.index(name)
            whole = str(spec.channelformats[c]) == "uint"
            column = [(data.deep_value_uint if whole else data.deep_value)(i, c, k) for i in pixels for k in range(data.samples(i))]
            hits_hash.update(struct.pack(f"<{len(column)}{'I' if whole else 'f'}", *column))
        for name in ("status", "steps", "error", "drift"):
            rays_hash.update(rays[name][n * first:n * last].tobytes())
    checks.same(hits_hash.hexdigest(), manifest["hits_sha256"], f"{path}: hits_sha256")
    checks.same(rays_hash.hexdigest(), manifest["rays_sha256"], f"{path}: rays_sha256")


files = [tools.trace(goedel_scene(source, [66, 18]), "goedel.exr"), tools.trace(flat_scene([14, 21], 3), "flat.exr"),
         tools.trace(black_hole_scene([24, 20]), "hole.exr"), tools.trace(lit_scene([7, 11], 2), "lit.exr")]
kDome = {"type": "fisheye", "fov_deg": 100, "resolution": [9, 11], "samples": 2}
files += [tools.trace({**flat_scene([9, 9], 2), "camera": kDome, "max_lookback": {"t": 2.9}}, "dome.exr"), tools.trace({**lit_scene([9, 9], 2), "camera": kDome}, "lit_dome.exr")]
files += [tools.trace({**flat_scene([9, 9], 2), "camera": {"type": "orthographic", "extent": 4, "resolution": [9, 11]}}, "film.exr")]
formats = {"lit.exr": 3, "dome.exr": 4, "lit_dome.exr": 4, "film.exr": 4}
for path in files:
    tools.run("info", "--verify", path)
everything, settings = [], []
for path in files:
    manifest = json.loads(headers(path)[0]["nullconeManifest"][1])
    everything += [(key, value) for key, value in manifest.items()]
    everything += [(f"objects[].{key}", value) for entry in manifest["objects"] for key, value in entry.items()]
    everything += [(f"lights[].{key}", value) for entry in manifest.get("lights", []) for key, value in entry.items()]
    settings += leaves({key: value for key, value in manifest["setting"].items() if value})
    light = [f"light.{lamp['name']}.{n}.{c['name']}" for lamp in manifest.get("lights", []) for n in range(manifest["light_paths"]) for c in code["light"]]
    checks.same(manifest["channels"], [c["name"] for c in code["hits"] if c["name"] in manifest["channels"]] + light, "order of channels")
    checks.same(manifest["format"], formats.get(path, 2), "format of a fresh file")
    checks.same(set(deep(path)[0].channelnames), set(manifest["channels"]), f"{path}: channels of the deep part")
    compare_attributes(path)
    hash_of_file(path)
    fingerprints(path, manifest)
compare_keys(everything, doc["The manifest: key"], "manifest")
compare_keys(settings, doc["The manifest: key of setting"], "setting")

tools.run("info", "--flat", "flat.exr", "-o", "companion.exr")
standard = {name for row in doc["Attributes of the header: part"] if row[0] == "all" for name in row[1].split(", ")} - {"name", "chunkCount"}
attributes = headers("companion.exr")[0]
told = {row[0]: row[1] for row in doc["The flat companion: attribute"]}
checks.same(set(attributes) - standard, set(told), "attributes of the flat companion")
for name, kind in told.items():
    checks.same(attributes.get(name, ("none",))[0], kind, f"type of {name}")
checks.finish()
