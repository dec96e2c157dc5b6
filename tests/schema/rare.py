"""Documents that mutations do not find."""
from schema import mutate, seeds


def add(held):
    deep = {"type": "equal_energy"}
    for _ in range(9):
        deep = {"type": "sum", "of": [deep]}
    slices = [{"channel": "t", "from": -9, "to": 9, "fade": 18, "intensity": 1}] * 20
    many = {"type": "sum", "of": [{"type": "equal_energy"}] * 1001}
    spectral = {"ball": {"surface": {"type": "lambertian"}, "spectrum": {"type": "equal_energy"}}}
    for what, look in {
        "deep": {"objects": {"ball": {"spectrum": deep}}},
        "many": {"objects": {"ball": {"spectrum": many}}},
        "slices": {"objects": {"ball": {"time_slices": slices}}},
        "light": {"objects": spectral},
        "scale": {"objects": spectral, "lights": {name: {"on": False} for name in seeds.LAMPS}, "legend": {"scale": {"object": "ball"}}},
        "dark": {"objects": {"ball": {"spectrum": {"type": "constant", "from_nm": 1e4, "luminance_cd_m2": 1}}}},
        "last": {"tone": {"curve": "table", "points": [[0, 0]]}},
        "zero": {"tone": {"curve": "table", "points": [[0, 0.5], [1, 1]]}},
        "white": {"white_point": {"xy": [0.735, 0.265]}},
        "ratio": {"legend": {"scale": {"object": "ball", "from": 2, "to": 2}}},
        "band": {"objects": {"ball": {"spectrum": {"type": "constant", "from_nm": 500, "to_nm": 500}}}},
        "frames": {"objects": {"ball": {"texture": {"type": "image", "file": "#", "sequence": {"frames": [0, 100000]}}}}},
        "lines": {"objects": {"ball": {"surface": {"type": "lambertian"}, "spectrum": {"type": "sum", "of": [
            {"type": "lit", "light": {"type": "lines", "lines": [[500, 1]]}, "reflectance": {"type": "equal_energy"}}]}}}},
        "warm": {"objects": {"ball": {"surface": {"type": "lambertian"}, "spectrum": {
            "type": "black_body", "temperature_K": {"keyframes": [[0, 1000]], "by": "t"}}}}},
        "no material": {"objects": {"ball": {"time_slices": [{"channel": "t", "spectrum": {"type": "materials", "spectra": [{"type": "equal_energy"}]}}]}}},
        "order": {"exposure": {"ev": {"keyframes": [[0, 1], [0, 2]]}}},
        "clocks": {"objects": {"ball": {"spectrum": {"type": "gaussian", "centre_nm": {"keyframes": [[0, 500]], "by": "t"},
                                                     "fwhm_nm": {"keyframes": [[0, 50]], "by": "tau"}}}}},
        "stranger": {"objects": {"nobody": {}}},
        "no lamp": {"lights": {"nobody": {}}},
        "no path": {"lights": {"sun": {"paths": [seeds.PATHS]}}},
        "no number": {"legend": {"temperature": "nobody"}},
        "points": {"tone": {"curve": "table", "points": [[1, 0.5], [1, 0.5]]}},
        "no file": {"sensor": {"file": "none.csv"}},
        "keys": {"objects": {"ball": {"opacity": {"keyframes": [[0, 0], [1, 2]], "by": "t"}}}},
        "one key": {"objects": {"ball": {"spectrum": {"type": "equal_energy", "radiance": {"keyframes": [[0, 1]], "by": "t"}}}}},
        "stars": {"objects": {"sky": {"stars": {"random": [{"count": 3000000}, {"count": 3000000}]}}}},
        "magnitudes": {"objects": {"sky": {"stars": {"random": [{"count": 3, "magnitudes": [5, 4]}]}}}},
        "axis": {"objects": {"ball": {"texture": {"type": "image", "file": "a", "rotate_deg": {"axis": [0, 0, 0], "angle_deg": 0}}}}},
    }.items():
        held.add(what, "look", look)
    flat = seeds.SCENES["flat"]
    for what, path, value in [
        ("names", ("objects", 1, "name"), "ball"), ("velocity", ("observer", "velocity"), [0.9, 0.9, 0]),
        ("parallel", ("objects", 0, "placing", "y_axis"), [0, -2, 0]), ("pixels", ("camera", "resolution"), [100000, 100000]),
        ("rays", ("camera", "resolution"), [16384, 16384]), ("sky", ("objects", 3, "shape", "side"), 2),
        ("second", ("objects", 2), {"name": "sky2", "shape": {"type": "sky"}}), ("body", ("lights", "lamps", 0, "body"), "sky"),
        ("nobody", ("lights", "lamps", 0, "body"), "nobody"),
        ("paths", ("lights", "paths"), 16),
        ("lamps", ("lights", "lamps"), [{**flat["lights"]["lamps"][0], "name": f"sun{i}"} for i in range(30)]),
    ]:
        held.add(what, "scene", mutate.changed(flat, path, value))
    shapes, joined = seeds.SCENES["shapes"], {"type": "sphere", "radius": 1}
    for _ in range(16):
        joined = {"type": "union", "of": [joined, {"type": "sphere", "radius": 1}]}
    for what, path, value in [
        ("ring", ("objects", 3, "shape", "inner_radius"), 0.5), ("nested", ("objects", 5, "shape"), joined),
        ("bodies", ("objects", 5, "shape"), {"type": "union", "of": [{"type": "sphere", "radius": 1}] * 65}),
        ("up", ("camera", "up"), [2, 2, 0]), ("open", ("objects", 1, "shape", "open"), True),
        ("upwards", ("camera",), {"type": "sphere", "resolution": [2, 1], "forward": [0, 0, -2]}),
        ("cube", ("camera",), {"type": "cube_map", "resolution": [6, 2]}),
    ]:
        held.add(what, "scene", mutate.changed(shapes, path, value))
    for what, path, value in [
        ("coordinate time", ("frames", "time"), "coordinate"),
        ("proper time", ("observer", "proper_time"), 1), ("no proper time", ("observer", "proper_time"), None),
    ]:
        held.add(what, "scene", mutate.changed(seeds.SCENES["falling"], path, value))
    held.add("axis", "scene", mutate.changed(seeds.SCENES["tetrahedron"], ("observer", "worldline", "event"), [0, 0, 0, 1]))
    held.add("list", "scene", mutate.changed(flat, ("camera",), {"include": "list.json"}))
    dark = mutate.without(mutate.without(flat, ("lights",)), ("look",))
    held.add("dark", "scene", dark)
    held.add("no sky", "scene", mutate.changed(dark, ("metric",), {"name": "goedel"}))
