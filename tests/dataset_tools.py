"""What tests of datasets from outside share: running the tools, scenes, headers byte by byte, arrays by OpenImageIO."""
import atexit
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile

import OpenImageIO as oiio

SKY = {"name": "stars", "shape": {"type": "sky"}}


def at(*event):
    return {"type": "local", "worldline": {"type": "static", "event": list(event)}}


def flat_scene(resolution, samples):
    """A sheer glass before a ball, which covers pixels by half, before the sky; all channels."""
    glass = {"name": "glass", "opacity": 0.25, "shape": {"type": "quad", "edges": [1, 1]},
             "placing": dict(at(0, 2.5, 0.3, 0), z_axis=[1, 0, 0], y_axis=[0, 0, 1])}
    return {"metric": {"name": "minkowski"}, "observer": {"event": [0, 0, 0, 0]},
            "camera": {"type": "perspective", "fov_deg": 40, "resolution": resolution, "samples": samples},
            "records": {"channels": ["order", "uv", "shift", "t", "tau", "mu", "duv", "N", "K", "P"]},
            "objects": [glass, {"name": "ball", "shape": {"type": "sphere", "radius": 0.5}, "placing": at(0, 3, -0.1, 0)}, SKY]}


def lit_scene(resolution, samples):
    """The same in the light of a lamp behind the camera and of a sphere beside the ball, which is not there to be seen."""
    lamp = lambda name, *event, **more: {"name": name, "worldline": {"type": "static", "event": list(event)}, **more}
    return {**flat_scene(resolution, samples),
            "lights": {"paths": 2, "lamps": [lamp("sun", 0, -1, 1, 1), lamp("bulb", 0, 2.5, -1, 0, shape={"type": "sphere", "radius": 0.1}, samples=4)]}}


def black_hole_scene(resolution):
    """Integrated paths: errors and drifts that are not 0."""
    return {"metric": {"name": "kerr_schild", "spin": 0.9}, "observer": {"event": [0, 20, 0, 0]},
            "camera": {"type": "perspective", "azimuth_deg": 180, "fov_deg": 40, "resolution": resolution},
            "records": {"order": 7, "max_hits": 5}, "accuracy": "draft",
            "objects": [{"name": "small", "shape": {"type": "sphere", "radius": 0.5}, "placing": at(0, 0, 9, 0)}, SKY]}


def goedel_scene(source, resolution):
    scene = json.load(open(os.path.join(source, "scenes", "goedel_earth.json")))
    scene["camera"]["resolution"] = resolution
    return scene


class Tools:
    """The tools of a folder; from now on in a folder of our own."""

    def __init__(self, folder):
        self.folder = os.path.abspath(folder)
        work = tempfile.mkdtemp()
        atexit.register(shutil.rmtree, work)
        os.chdir(work)

    def run(self, name, *options, status=0):
        done = subprocess.run([os.path.join(self.folder, "nullcone-" + name), *map(str, options)], capture_output=True, text=True, timeout=120)
        if done.returncode != status:
            sys.exit(f"nullcone-{name} {options}: status {done.returncode}, expected {status}: {done.stderr[:500]}")
        return done.stdout

    def trace(self, scene, path):
        json.dump(scene, open(path + ".json", "w"))
        self.run("trace", path + ".json", "-q", "-o", path)
        return path

    def info(self, *options):
        return json.loads(self.run("info", *options, "--json"))

    def pixel(self, path, x, y):
        return self.info(path, "--pixel", f"{x},{y}")


class Checks:
    """Counts what was compared; faults are printed, one a line."""

    def __init__(self):
        self.count = self.faults = 0

    def same(self, found, expected, what):
        self.true(found == expected, f"{what}: found {found!r:.300}, expected {expected!r:.300}")

    def true(self, holds, what):
        self.count += 1
        if not holds:
            self.faults += 1
            print("FAULT:", what)

    def finish(self):
        print(f"{self.count} checks, {self.faults} faults")
        sys.exit(self.faults != 0)


def headers(path):
    """Attributes {name: (type, bytes)} of each part, read byte by byte as the OpenEXR specification says."""
    data = open(path, "rb").read()
    place = 8

    def word():
        nonlocal place
        end = data.index(b"\0", place)
        text, place = data[place:end].decode(), end + 1
        return text

    parts = []
    multi_part = struct.unpack_from("<I", data, 4)[0] & 0x1000
    while not parts or (multi_part and data[place] != 0):
        parts.append({})
        while name := word():
            kind, size = word(), struct.unpack_from("<i", data, place)[0]
            parts[-1][name] = (kind, data[place + 4:place + 4 + size])
            place += 4 + size
    return parts


def deep(path):
    """The deep part's specification and data."""
    file = oiio.ImageInput.open(path)
    file.seek_subimage(1, 0)
    return file.spec(), file.read_native_deep_image(1, 0)


def flat(path, subimage=0):
    """The channels of a flat part, each [line, column], in their own types: OpenImageIO would make uint a float."""
    file = oiio.ImageInput.open(path)
    file.seek_subimage(subimage, 0)
    spec = file.spec()
    kinds = list(spec.channelformats) or [spec.format] * spec.nchannels
    return spec, {name: file.read_image(subimage, 0, c, c + 1, str(kind))[:, :, 0]
                  for c, (name, kind) in enumerate(zip(spec.channelnames, kinds))}


def values(spec, data, pixel, k):
    """All channels of a deep sample, uint as whole numbers."""
    return {name: (data.deep_value_uint if str(kind) == "uint" else data.deep_value)(pixel, c, k)
            for c, (name, kind) in enumerate(zip(spec.channelnames, spec.channelformats))}
