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

from schema import mutate, rare, seeds
from schema.unsaid import RANGE, UNSAID, has_keyframes


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


def main():
    reader, source = sys.argv[1], pathlib.Path(sys.argv[2])
    begun = time.time()
    with tempfile.TemporaryDirectory() as folder:
        held = Held(reader, source, pathlib.Path(folder))
        for name, text in (("top.json", "{}"), ("table.csv", "400,1\n700,0.5\n"), ("tone.csv", "0,0\n1,1\n"), ("list.json", "[]"), *seeds.FILES.items()):
            (pathlib.Path(folder) / name).write_text(text)
        check_shipped(held, source)
        own = [("scene", one) for one in seeds.SCENES.values()] + [("look", one) for one in seeds.LOOKS.values()]
        small = [(kind, fewer(one, kind)) for _, kind, one in shipped(source)]
        check_schemas(held, own)
        for kind, document in own + small:
            held.add("as it is", kind, document)
        rare.add(held)
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
