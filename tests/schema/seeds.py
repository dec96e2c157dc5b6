"""Documents that between them hold every entry that a scene or a look may have. Mutations begin here."""
import hashlib
import json

# Files of meshes.
FILES = {
    "tetra.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 1\nf 1//1 3//1 2//1\nf 1//1 2//1 4//1\nf 1//1 4//1 3//1\nf 2//1 3//1 4//1\n",
    "triangle.bin": "\0" * 12 + "\0\0@@" + "\0" * 12 + "\0\0@@" + "\0" * 4,  # three corners, two of them 3 away
    "triangle.gltf": json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 0}}]}], "buffers": [{"byteLength": 36, "uri": "triangle.bin"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}]}),
}
HASHES = {name: hashlib.sha256(text.encode()).hexdigest() for name, text in FILES.items()}

STATIC = {"type": "static", "event": [0, 1, 2, 3]}
FALLING = {"type": "geodesic", "event": [0, 4, 0, 0], "velocity": [0.5, 0, 0.25]}
THERE = {"type": "coordinate", "centre": [3, 0, 0]}
BALL = {"name": "ball", "shape": {"type": "sphere", "radius": 0.5}, "placing": THERE}

SCENES = {
    "flat": {
        "$schema": "scene.schema.json",
        "metric": {"name": "minkowski"},
        "observer": {"event": [0, 0, 0, 0], "velocity": [0.5, 0, 0], "frame": "static"},
        "camera": {"type": "panorama", "azimuth_deg": 24, "elevation_deg": 3, "roll_deg": -5, "fov_deg": [220, 25],
                   "resolution": [264, 30], "samples": 2},
        "max_lookback": 10,
        "paths": "closed",
        "objects": [
            {"name": "ball", "shape": {"type": "sphere", "radius": 0.5, "dome": True},
             "placing": {"type": "coordinate", "centre": [3, 0, 0], "z_axis": [0, 1, 0], "y_axis": [1, 0, 0]},
             "opacity": 0.5, "transparent": True},
            {"name": "board", "shape": {"type": "quad", "edges": [1, 2]},
             "placing": {"type": "local", "worldline": STATIC, "axes": "static", "z_axis": [0, 0, 2], "y_axis": [0, 1, 1]}},
            {"name": "box", "shape": {"type": "box", "edges": [1, 2, 3]},
             "placing": {"type": "local", "worldline": FALLING, "axes": "gyroscope"}, "transparent": False},
            {"name": "sky", "shape": {"type": "sky", "side": 1}},
        ],
        "lights": {
            "windings": 1, "paths": 3, "shadows": False, "cap": 1e9,
            "lamps": [
                {"name": "sun", "worldline": STATIC, "shape": {"type": "point"}, "body": "ball"},
                {"name": "moon", "worldline": FALLING, "shape": {"type": "sphere", "radius": 0.25}, "samples": 4},
                {"name": "panel", "worldline": STATIC, "shape": {"type": "quad", "edges": [1, 1]}, "samples": 9,
                 "axes": "static", "z_axis": [1, 0, 0], "y_axis": [0, 0, 1]},
            ],
        },
        "records": {"max_hits": 3, "order": 1, "channels": ["Z", "uv", "duv", "light"], "differentials": True},
        "look": {"lights": {"sun": {"paths": [0, 2]}}},
    },
    "hole": {
        "metric": {"name": "kerr_schild", "mass": 2, "spin": -0.5, "chart": "ingoing"},
        "observer": {"event": [0, 20, 0, 3], "frame": "normal"},
        "camera": {"type": "perspective", "fov_deg": 60, "resolution": [64, 48]},
        "paths": "integrated",
        "accuracy": {"rtol": 1e-9, "atol": 1e-12, "integrator": "dopri5"},
        "objects": [BALL],
    },
    "dust": {
        "metric": {"name": "goedel", "a": 2},
        "observer": {"event": [0, 0, 0, 0]},
        "camera": {"type": "sphere", "resolution": [64, 32]},
        "accuracy": "draft",
        "objects": [BALL],
    },
    "wormhole": {
        "metric": {"name": "ellis_wormhole", "throat": 2},
        "observer": {"event": [0, 20, 0, 3]},
        "camera": {"type": "perspective", "fov_deg": 60, "resolution": [64, 48]},
        "objects": [{"name": "here", "shape": {"type": "sky"}}, {"name": "beyond", "shape": {"type": "sky", "side": 2}}],
    },
    "sequence": {
        "frames": {"count": 3, "from": -1, "to": 1.5, "time": "coordinate"},
        "metric": {"name": "goedel", "a": {"keyframes": [[0, 1], [1, 2]]}},
        "observer": {"event": [None, 0, {"keyframes": [[-1, 0], [1, 0.5]], "interpolation": "smooth", "by": "time"}, 0]},
        "camera": {"type": "panorama", "fov_deg": [{"keyframes": [[0, 100]]}, 25], "resolution": [64, 48]},
        "objects": [{"name": "ball", "shape": {"type": "sphere", "radius": {"keyframes": [[0, 1], [1, 2]]}}, "placing": THERE}],
        "look": {"exposure": {"ev": {"keyframes": [[0, -4], [2, 0]], "by": "frame"}}},
    },
    "own_time": {
        "frames": {"count": 2, "from": 0, "to": 1, "time": "proper"},
        "metric": {"name": "minkowski"},
        "observer": {"event": [{"keyframes": [[0, 0], [1, 2]]}, 0, 0, 0]},
        "camera": {"type": "perspective", "fov_deg": 60, "resolution": [64, 48]},
        "objects": [BALL],
    },
    "shapes": {
        "metric": {"name": "minkowski"},
        "observer": {"event": [0, 0, 0, 0]},
        "camera": {"type": "fisheye", "fov_deg": 180, "resolution": [64, 48], "forward": [1, 1, 0], "up": [0, 0, -2]},
        "max_lookback": {"lambda": 20, "t": 10},
        "objects": [
            {"name": "egg", "shape": {"type": "ellipsoid", "semi_axes": [1, 2, 3], "dome": False},
             "placing": {"type": "local", "worldline": FALLING, "spin": {"axis": [0, 1, 0], "rate_deg": -90}}},
            {"name": "can", "shape": {"type": "cylinder", "radius": 0.5, "height": 2, "open": False, "dome": True}, "placing": THERE},
            {"name": "disk", "shape": {"type": "disk", "radius": 0.5}, "placing": THERE},
            {"name": "ring", "shape": {"type": "ring", "radius": 0.5, "inner_radius": 0.25}, "placing": THERE},
            {"name": "rock", "shape": {"type": "mesh", "file": "tetra.obj", "sha256": HASHES["tetra.obj"], "scale": 0.5, "normals": "smooth", "dome": True},
             "placing": THERE},
            {"name": "stone", "shape": {"type": "mesh", "file": "triangle.gltf", "buffers": [{"file": "triangle.bin", "sha256": HASHES["triangle.bin"]}]},
             "placing": THERE},
            {"name": "room", "shape": {"type": "box", "edges": [1, 2, 3], "dome": True}, "placing": THERE},
            {"name": "whole", "shape": {"type": "difference", "dome": False, "of": [
                {"type": "box", "edges": [1, 1, 2], "centre": [0, 0, 1], "z_axis": [0, 1, 0], "y_axis": [1, 0, 0]},
                {"type": "sphere", "radius": 0.5, "centre": [0.5, 0, 0], "z_axis": [1, 0, 0], "y_axis": [0, 0, 1]},
                {"type": "union", "of": [
                    {"type": "ellipsoid", "semi_axes": [1, 2, 3], "centre": [0, 1, 0], "z_axis": [1, 0, 0], "y_axis": [0, 0, 1]},
                    {"type": "cylinder", "radius": 0.25, "height": 2, "open": False, "centre": [0, 0, 0.5], "z_axis": [1, 0, 0],
                     "y_axis": [0, 0, 1]}]}]}, "placing": THERE},
        ],
    },
    "cube": {
        "metric": {"name": "kerr_schild"},
        "observer": {"worldline": {"type": "accelerated", "event": [0, 20, 0, 3], "velocity": [0.5, 0, 0.25], "acceleration": [0, 0.5, 0]},
                     "proper_time": 3, "frame": "normal"},
        "camera": {"type": "cube_map", "resolution": [48, 8], "azimuth_deg": 30},
        "max_lookback": {"t": 50},
        "objects": [BALL],
    },
    "tetrahedron": {
        "metric": {"name": "goedel"},
        "observer": {"worldline": {"type": "circular", "event": [0, 3, 0, 0], "speed": "closed", "clockwise": True}},
        "camera": {"type": "tetrahedron_map", "resolution": [32, 16], "forward": [1, 0, 0.5]},
        "max_lookback": {"lambda": 20},
        "objects": [BALL],
    },
    "travellers": {
        "metric": {"name": "minkowski"},
        "observer": {"worldline": {"type": "tabulated", "events": [[0, 0, 0, 0], [2, 1, 0, 0], [4, 1, 1, 0]]}, "proper_time": 1},
        "camera": {"type": "perspective", "fov_deg": 60, "resolution": [64, 48]},
        "objects": [
            {"name": "rocket", "shape": {"type": "sphere", "radius": 0.5},
             "placing": {"type": "local", "axes": "gyroscope", "spin": {"rate_deg": 20},
                         "worldline": {"type": "accelerated", "event": [0, 20, 0, 3], "velocity": [0.5, 0, 0.25], "acceleration": [0, 0.5, 0]}}},
            {"name": "moon", "shape": {"type": "sphere", "radius": 0.5},
             "placing": {"type": "local", "worldline": {"type": "circular", "event": [0, 9, 0, 0], "speed": 0.5, "clockwise": True}, "axes": "static"}},
            {"name": "twin", "shape": {"type": "sphere", "radius": 0.5},
             "placing": {"type": "local", "worldline": {"type": "piecewise", "event": [0, 0, 30, 0], "pieces": [
                 {"velocity": [0.5, 0, 0], "duration": 4}, {"duration": 2}, {"velocity": [-0.5, 0, 0], "duration": 4}]}}},
            {"name": "train", "shape": {"type": "sphere", "radius": 0.5},
             "placing": {"type": "local", "worldline": {"type": "tabulated", "events": [[-50, 0, 0, 40], [0, 1, 0, 40], [50, 2, 1, 40]]}}},
        ],
    },
    "film": {
        "metric": {"name": "goedel"},
        "observer": {"event": [0, 0, 0, 0]},
        "camera": {"type": "orthographic", "resolution": [64, 48], "extent": 2.5, "azimuth_deg": 30},
        "objects": [BALL],
    },
    "journey": {
        "frames": {"count": 2, "from": 0, "to": 1, "time": "proper"},
        "metric": {"name": "minkowski"},
        "observer": {"worldline": {"type": "circular", "event": [0, 3, 0, 0], "speed": {"keyframes": [[0, 0.25], [1, 0.5]]}}, "proper_time": None},
        "camera": {"type": "perspective", "fov_deg": 60, "resolution": [64, 48], "forward": [{"keyframes": [[0, 1], [1, 2]]}, 0, 0.5]},
        "max_lookback": {"t": {"keyframes": [[0, 10], [1, 20]]}},
        "objects": [BALL],
    },
    "falling": {
        "frames": {"count": 2, "from": 0, "to": 1, "time": "proper"},
        "metric": {"name": "kerr_schild"},
        "observer": {"worldline": {"type": "geodesic", "event": [0, 20, 0, 3], "velocity": [0, 0.25, 0]}, "proper_time": 0},
        "camera": {"type": "sphere", "resolution": [64, 32]},
        "objects": [BALL],
    },
    "included": {
        "include": "none.json",
        "camera": {"include": "none.json", "fov_deg": None},
        "objects": [{"include": "list.json"}],
    },
}

IN_TIME = {"keyframes": [[-1, 0.25], [0, 0.5]], "by": "tau", "interpolation": "smooth"}
BLACK = {"type": "black_body", "temperature_K": 5000}

LOOKS = {
    "objects": {
        "$schema": "look.schema.json",
        "objects": {
            "ball": {
                "surface": {"type": "self_luminous"},
                "texture": {"type": "image", "file": "a.png", "filter": "anisotropic", "alpha": True, "offset": [0, 0.5],
                            "scale": [-1, 1], "rotate_deg": [0, 10, IN_TIME]},
                "spectrum": {"type": "black_body", "temperature_K": 5000, "luminance_cd_m2": 100},
                "opacity": 0.5, "intensity": 2,
                "blink": {"channel": "tau", "period": 2, "duty": 0.25, "phase": 0.5, "fade": 0.125, "off": "transparent"},
                "time_slices": [
                    {"channel": "t", "from": -2, "to": -1, "fade": [0.25, 0.5], "texture": {"type": "color", "rgb": [1, 0.25, 0]}},
                    {"channel": "tau", "from": 0, "fade": 0.5, "spectrum": {"type": "rgb"}, "intensity": 0.5},
                    {"channel": "t", "blink": {"channel": "t", "period": 1}},
                ],
            },
            "board": {
                "surface": {"type": "lambertian"},
                "texture": {"type": "checkerboard", "counts": [4, 2], "colors": [[0, 0, 0], [1, 1, 1]], "offset": [0.5, 0]},
                "spectrum": {"type": "tabulated", "file": "table.csv", "beyond": "hold"},
            },
            "box": {
                "texture": {"type": "checkerboard", "counts": [4, 2], "scale": [2, 2], "rotate_deg": {"axis": [0, 0, 1], "angle_deg": 30},
                            "gradient": {"along": "u", "from": [1, 0, 0], "to": [0, 0, 1], "dark": 0.25}},
            },
            "sky": {"texture": {"type": "image", "file": "a_##.png", "sequence": {
                "frames": [0, 9], "rate": 2, "clock": "tau", "from": -1, "loop": True, "blend": False}}},
            "stones": {"texture": {"type": "materials", "file": "m.png", "filter": "mipmap", "offset": [0, 0], "scale": [1, 1],
                                   "rotate_deg": [0, 0, 0]},
                       "spectrum": {"type": "materials", "spectra": [BLACK, {"type": "equal_energy", "radiance": 2}]}},
        },
        "lights": {"sun": {"spectrum": BLACK}},
    },
    "stars": {
        "objects": {
            "ball": {"texture": {"type": "cube_map", "filter": "mipmap", "faces": {
                "right": "a.png", "left": "a.png", "up": "a.png", "down": "a.png", "front": "a.png", "back": "a.png"}}},
            "sky": {"stars": {
                "file": "stars.csv", "rotate_deg": {"axis": [0, 0, 1], "angle_deg": 30}, "intensity": 2, "size_px": 1,
                "most_magnified": 100, "random": [
                    {"count": 10, "seed": 5, "magnitudes": [1, 6], "slope": 0.5, "temperatures_K": [4000, 8000]},
                    {"count": 10, "around_deg": [180, 0], "spread_deg": 0.5}]}},
            "box": {"stars": {"random": [{"count": 3}], "rotate_deg": [0, 0, 5]}},
            "board": {"texture": {"type": "cube_map", "file": "a.png", "filter": "bilinear", "rotate_deg": [0, 10, IN_TIME]}},
        },
    },
    "spectra": {
        "objects": {
            "ball": {"spectrum": {"type": "channels", "spectra": [
                BLACK, {"type": "gaussian", "centre_nm": 550, "fwhm_nm": 20, "radiance": 2, "luminance_cd_m2": 5},
                {"type": "power_law", "index": 2, "radiance": 1, "at_nm": 500, "luminance_cd_m2": 5}]}},
            "board": {"spectrum": {"type": "lines", "lines": [[589, 2], [589.5, 1]], "luminance_cd_m2": 1}},
            "box": {"spectrum": {"type": "sum", "luminance_cd_m2": 3, "of": [
                {"type": "constant", "radiance": 1, "from_nm": 400, "to_nm": 700, "luminance_cd_m2": 5},
                {"type": "equal_energy", "radiance": 1, "luminance_cd_m2": 5},
                {"type": "tabulated", "file": "table.csv", "luminance_cd_m2": 4}]}},
            "sky": {"spectrum": {"type": "lit", "light": BLACK, "reflectance": {"type": "equal_energy"}, "luminance_cd_m2": 2}},
            "stones": {"spectrum": {"type": "dominant_wavelength", "wavelength_nm": 500, "purity": 0.5, "radiance": 1,
                                    "luminance_cd_m2": 2}},
        },
    },
    "in_time": {
        "objects": {
            "ball": {"texture": {"type": "color", "rgb": [IN_TIME, 0, 1]}, "opacity": IN_TIME, "intensity": IN_TIME,
                     "spectrum": {"type": "black_body", "temperature_K": {"keyframes": [[0, 3000], [1, 5000]], "by": "t"}}},
            "board": {"texture": {"type": "checkerboard", "counts": [{"keyframes": [[0, 1], [1, 5]], "by": "t"}, 2],
                                  "colors": [[0, 0, 0], [1, 1, 1]], "rotate_deg": {"axis": [0, 0, 1], "angle_deg": IN_TIME}},
                      "spectrum": {"type": "display"}},
            "box": {"spectrum": {"type": "total_radiance"}, "opacity": {"keyframes": [[0, 0], [5, 1]]}},
        },
        "lights": {"sun": {"on": True, "spectrum": {"type": "power_law", "index": IN_TIME}, "intensity": 3, "paths": [0, 1],
                           "blink": {"channel": "t", "period": 1}, "time_slices": [
                               {"channel": "tau", "from": 0, "to": 1, "fade": 0.25, "intensity": 0},
                               {"channel": "t", "spectrum": BLACK},
                               {"channel": "t", "blink": {"channel": "t", "period": 1}}]},
                   "moon": {"on": False}},
    },
    "developed": {
        "ambient": {"intensity": 0.5, "spectrum": {"type": "display"}},
        "effects": {"doppler": False, "searchlight": True, "radiance_exponents": {"spectral": 5, "integrated": 4},
                    "irradiance_exponents": {"spectral": 3, "integrated": 2}},
        "sensor": "ccd",
        "pixel_filter": {"type": "gaussian", "width": 2},
        "exposure": {"white_cd_m2": 1e5, "ev": {"keyframes": [[0, -1], [9, 1]], "interpolation": "linear", "by": "frame"}},
        "white_point": {"temperature_K": 3000},
        "tone": {"curve": "exponential", "k": 2},
        "gamut": "clip",
        "output": {"space": "display_p3", "jpeg_quality": 90},
        "background": [0, 0.25, 0.5],
        "legend": {"corner": "top_left", "size": 2, "temperature": "ball", "scale": {"object": "ball", "from": 0.5, "to": 2},
                   "time": {"label": "t", "unit": "s", "start": 0, "step": 0.5, "digits": 1}},
        "objects": {"ball": {"spectrum": BLACK}},
    },
    "percentile": {"exposure": {"white_cd_m2": {"auto": "percentile", "percentile": 98}}, "tone": {"curve": "filmic", "white": 4},
                   "white_point": "equal_energy", "sensor": {"file": "table.csv"}, "legend": {"time": True}},
    "average": {"exposure": {"white_cd_m2": {"auto": "log_average", "key": 0.25}}, "white_point": {"xy": [0.3, 0.3]},
                "tone": {"curve": "table", "points": [[0, 0], [0.5, 0.25], [2, 1]], "interpolation": "smooth"}},
    "plain": {"exposure": {"white_cd_m2": "auto"}, "tone": {"curve": "linear"}, "ambient": {"spectrum": BLACK}},
    "curve": {"tone": {"curve": "table", "file": "tone.csv", "interpolation": "linear"}},
    "included": {"objects": {"include": "none.json", "ball": {"include": "none.json", "opacity": None}}},
    "by_that_name": {"objects": {"include": {"opacity": 0.5}}},
}

OBJECTS = ["ball", "board", "box", "sky", "stones", "include"]
LAMPS = ["sun", "moon"]
PATHS = 3
