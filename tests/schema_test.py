#!/usr/bin/python3
"""Schemas of scenes and looks against the readers: what one takes the other takes, and what one refuses the other refuses.

Usage: schema_test.py SCHEMA_READER SOURCE_DIR
"""
import copy
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import time

import jsonschema

from schema import mutate, seeds

# What a schema cannot say: the reader's complaint, and what it is about.
UNSAID = [
    (r"names two of them", "different names"),
    (r"is not slower than light", "the length of a velocity"),
    (r"expected a direction, (found|not)", "the length of a direction"),
    (r"not parallel to z_axis", "directions beside one another"),
    (r"asks for more than 268435456 pixels", "products of pixels"),
    (r"asks for more than 268435456 rays", "products of pixels and samples"),
    (r"has only one sky", "how many skies a spacetime has"),
    (r"has no infinity to hold a sky", "whether it has any"),
    (r"is a second sky", "one sky of each side"),
    (r"expected the name of an object of the scene", "bodies of lamps"),
    (r"is the sky; expected an object that a lamp", "bodies of lamps"),
    (r"expected at most \d+ lamps with", "products of lamps and paths"),
    (r"expected a later time than before", "the order of keyframes"),
    (r"dataset has no such object", "objects of the dataset"),
    (r"dataset has no (such lamp|lamps)", "lamps of the dataset"),
    (r"the dataset has \d+ paths? a lamp", "paths of the dataset"),
    (r"all its keyframes by t, or all by tau", "clocks in one texture or spectrum"),
    (r"'.*' is no number of this look", "paths in the look"),
    (r"expected a number above 1.01 times from", "order of numbers"),
    (r"expected a number greater than from", "order of numbers"),
    (r"\[first, last\], and at most 100000", "order of numbers"),
    (r"expected a greater luminance than before", "order of points"),
    (r"expected a last luminance from 1e-20", "the last point"),
    (r"no light that could be seen as white", "chromaticities"),
    (r"unshifted, the eye sees nothing of this spectrum", "integrals of spectra"),
    (r"slices fade into one another", "how many slices hold at once"),
    (r"has a reflectance by wavelength", "light and reflectances"),
    (r"expected an object that is self-luminous", "objects by name"),
    (r"/time_slices/\d+: a texture and a spectrum of type materials", "what slices leave out"),
    (r"spectra within spectra, deeper than 8", "depth"),
    (r"more than 1000 spectra in one", "counts over many places"),
    (r"has no temperature", "keyframed reflectances"),
    (r"/include: cannot (open|read) |no such file", "which files there are"),
    (r"expected a file that holds|: line \d+: ", "what is in files"),
]
# The same by keyframes: which values numbers have at which times. Beside the range that the schema knows.
RANGE = re.compile(r"expected a number (from|greater than 0)|expected a (vertical|whole number|luminance)|"
                   r"expected (values from|two whole|3 numbers from|0 to (1|be shown)|at most 1e15|true, or nothing|\[wavelength)|"
                   r"; expected a whole")


class Held:
    """Both verdicts of many documents."""

    def __init__(self, reader, source, folder):
        self.reader, self.folder = reader, folder
        self.files = {name: json.loads((source / "scenes" / name).read_text()) for name in ("scene.schema.json", "look.schema.json")}
        self.schema = mutate.Schema(self.files)
        self.validators = {
            kind: jsonschema.Draft202012Validator(schema, resolver=jsonschema.RefResolver(name, schema, store=self.files))
            for kind, name, schema in (("scene", *self.file("scene")), ("look", *self.file("look")))}
        self.faults, self.unsaid = [], dict.fromkeys([pattern for pattern, _ in UNSAID] + ["keyframes"], 0)
        self.documents = []  # (what, kind, document)
        self.told, self.words = {}, 0

    def file(self, kind):
        name = kind + ".schema.json"
        return name, self.files[name]

    def add(self, what, kind, document):
        self.documents.append((what, kind, document))

    def read(self):
        """The reader's complaint of each; empty: it takes it."""
        lines = [json.dumps({"scene": document} if kind == "scene" else
                            {"look": document, "objects": seeds.OBJECTS, "lights": seeds.LAMPS, "paths": seeds.PATHS})
                 for _, kind, document in self.documents]
        run = subprocess.run([self.reader, str(self.folder)], input="\n".join(lines), stdout=subprocess.PIPE, text=True, check=True)
        answers = run.stdout.splitlines()
        assert len(answers) == len(lines), f"{len(answers)} answers to {len(lines)} documents"
        return ["" if answer == "accepted" else answer for answer in answers]

    def is_unsaid(self, document, complaint):
        for pattern, _ in UNSAID:
            if re.search(pattern, complaint):
                self.unsaid[pattern] += 1
                return True
        if RANGE.search(complaint) and has_keyframes(document, complaint):
            self.unsaid["keyframes"] += 1
            return True
        return False

    def check_told(self, kind, document, complaint):
        """What the reader says that it would take there, the schema must know."""
        told = re.match(r"(scene|look): (/[^:]*): ('.*' is unknown; |unknown key; )?expected one of ([^;\"]+)$", complaint)
        if not told or self.told.get(told[2]) == told[4] or told[2].endswith("/by"):  # which clocks suit is said later
            return
        self.told[told[2]] = told[4]
        path = ["look"] if kind == "scene" and told[1] == "look" else []
        path += [int(step) if step.isdigit() else step for step in told[2][1:].split("/")]
        try:
            bare = mutate.without(document, path)
        except (KeyError, IndexError, TypeError):  # it stands elsewhere
            return
        of_keys = told[3] == "unknown key; "
        parts = [part for _, part in mutate.along(self.schema, *self.file(kind), bare, path[:-1] if of_keys else path)]
        known = {word for part in parts for word in (part.get("properties", {}) if of_keys else [*part.get("enum", []), part.get("const")])}
        for word in told[4].split(", "):
            self.words += 1
            if word not in known:
                self.faults.append(f"{kind} {told[2]}: the reader takes '{word}', of which the schema knows nothing")

    def compare(self):
        for (what, kind, document), complaint in zip(self.documents, self.read()):
            self.check_told(kind, document, complaint)
            fits = self.validators[kind].is_valid(document)
            if fits == (complaint == "") or fits and self.is_unsaid(document, complaint):
                continue
            why = complaint or "; ".join(e.message[:100] for e in self.validators[kind].iter_errors(document))
            self.faults.append(f"{what}: the {'reader' if fits else 'schema'} alone refuses it: {why[:300]}")


def has_keyframes(document, complaint):
    """Whether numbers with keyframes stand where the complaint points."""
    pointer = re.match(r"[^:]*: (/[^:]*):", complaint)
    for step in pointer[1].strip("/").split("/") if pointer else []:
        if isinstance(document, list) and step.isdigit() and int(step) < len(document):
            document = document[int(step)]
        elif isinstance(document, dict) and step in document and "keyframes" not in document:
            document = document[step]
        else:
            break
    return '"keyframes"' in json.dumps(document)


def entries(name, at, pointer=""):
    """Every entry of the schema that a document may have: (where, subschema)."""
    if isinstance(at, dict):
        for key, part in at.get("properties", {}).items():
            if isinstance(part, dict):
                yield f"{name}#{pointer}/properties/{key}", part
    for key, part in at.items() if isinstance(at, dict) else enumerate(at) if isinstance(at, list) else ():
        if key not in ("if", "not", "contains", "default", "included", "by_frame_only"):  # what is asked, not what may be there
            yield from entries(name, part, f"{pointer}/{key}")


def check_references(held, name, at, pointer=""):
    """VS Code (vscode-json-languageservice 5) lets what is referred to overwrite the keywords beside the reference."""
    if isinstance(at, dict) and isinstance(at.get("$ref"), str):
        twice = set(at) & set(held.schema.follow(name, at["$ref"])[1]) - {"$ref", "description", "default", "$comment"}
        held.faults += [f"{name}#{pointer}: '{word}' beside a reference that has it too" for word in twice]
    for key, part in at.items() if isinstance(at, dict) else enumerate(at) if isinstance(at, list) else ():
        check_references(held, name, part, f"{pointer}/{key}")


def check_schemas(held, documents):
    """They are schemas, tell of every entry, and the documents hold them all."""
    found, told = set(), {}
    for kind, document in documents:
        name = kind + ".schema.json"
        for path, _, parts in mutate.places(held.schema, name, held.files[name], document):
            found.update(id(part) for _, part in parts)
            if path and isinstance(path[-1], str) and parts:
                key = "/".join("*" if isinstance(step, int) else step for step in path)
                told[f"{kind} {key}"] = told.get(f"{kind} {key}") or any("description" in part for _, part in parts)
    held.faults += [f"{place}: has no description" for place, yes in told.items() if not yes]
    for name, document in held.files.items():
        jsonschema.Draft202012Validator.check_schema(document)
        check_references(held, name, document)
        held.faults += [f"{where}: is in none of the documents" for where, part in entries(name, document) if id(part) not in found]


def shipped(source):
    """(path, kind, document) of every scene and look."""
    for path in sorted((source / "scenes").glob("*.json")):
        if not path.name.endswith(".schema.json"):
            yield path, "scene", json.loads(path.read_text())
    for path in sorted((source / "scenes/looks").glob("*.json")):
        yield path, "look", json.loads(path.read_text())


def fewer(document, kind):
    """With three objects at most, by names that the others have too: what is true of three is true of thirty."""
    out = copy.deepcopy(document)
    look = out.get("look", {}) if kind == "scene" else out
    if kind == "scene":
        out["objects"] = out["objects"][:3]
        names = [o["name"] for o in out["objects"]]
        look["objects"] = {name: one for name, one in look.get("objects", {}).items() if name in names}
        if "lights" in out:
            for lamp in out["lights"]["lamps"]:
                lamp.pop("body", None)
    else:
        look["objects"] = dict(zip(seeds.OBJECTS, list(look.get("objects", {}).values())[:3]))
    return out


def check_shipped(held, source):
    for path, kind, document in shipped(source):
        named = document.get("$schema", "")
        if (path.parent / named).resolve() != (source / f"scenes/{kind}.schema.json").resolve():
            held.faults.append(f"{path}: does not name its schema")
        for error in held.validators[kind].iter_errors(document):
            held.faults.append(f"{path}: {error.json_path}: {error.message[:200]}")


def rare(held):
    """What mutations do not find."""
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
    held.add("list", "scene", mutate.changed(flat, ("camera",), {"include": "list.json"}))
    dark = mutate.without(mutate.without(flat, ("lights",)), ("look",))
    held.add("dark", "scene", dark)
    held.add("no sky", "scene", mutate.changed(dark, ("metric",), {"name": "goedel"}))


def main():
    reader, source = sys.argv[1], pathlib.Path(sys.argv[2])
    begun = time.time()
    with tempfile.TemporaryDirectory() as folder:
        held = Held(reader, source, pathlib.Path(folder))
        for name, text in (("top.json", "{}"), ("table.csv", "400,1\n700,0.5\n"), ("tone.csv", "0,0\n1,1\n"), ("list.json", "[]")):
            (pathlib.Path(folder) / name).write_text(text)
        check_shipped(held, source)
        own = [("scene", one) for one in seeds.SCENES.values()] + [("look", one) for one in seeds.LOOKS.values()]
        small = [(kind, fewer(one, kind)) for _, kind, one in shipped(source)]
        check_schemas(held, own)
        for kind, document in own + small:
            held.add("as it is", kind, document)
        rare(held)
        tried = set()
        for kind, document in own + small:
            name = kind + ".schema.json"
            for way, here, place, result in mutate.by_schema(held.schema, name, held.files[name], document):
                if (way, here) not in tried:
                    tried.add((way, here))
                    held.add(f"{way} {place}", kind, result)
        for kind, count in (("scene", RANDOM), ("look", RANDOM)):
            documents = [one for of, one in own + small if of == kind]
            for told, document in mutate.at_random(len(kind), documents, count):
                held.add(f"random {told}", kind, document)
        held.compare()
    held.faults += [f"the exception '{pattern}' never occurs" for pattern, count in held.unsaid.items() if count == 0]
    for fault in held.faults[:60]:
        print("FAULT:", fault)
    print(f"{len(held.documents)} documents, {sum(held.unsaid.values())} by exceptions, {held.words} words and keys, {len(held.faults)} faults, {time.time() - begun:.1f} s")
    return 1 if held.faults else 0


RANDOM = 1000
if __name__ == "__main__":
    sys.exit(main())
