"""Documents near a given one: by what the schema says of each place, and at random."""
import copy
import random

WRONG = [None, True, "no such word", 7.25, [], {}, [[]], -1e300]


class Schema:
    """The two files, as one: references go from one to the other."""

    def __init__(self, files):
        self.files = files  # name: document

    def follow(self, name, reference):
        file, _, pointer = reference.partition("#")
        name = file or name
        at = self.files[name]
        for step in pointer.strip("/").split("/") if pointer else []:
            at = at[step]
        return name, at

    def here(self, name, schema, value, seen=None):
        """All subschemas (with their file) that speak of a value; of alternatives those that it may be meant as."""
        if not isinstance(schema, dict) or meant_otherwise(schema, value):
            return
        yield name, schema
        if "$ref" in schema:
            yield from self.here(*self.follow(name, schema["$ref"]), value)
        for word in ("allOf", "anyOf", "oneOf"):
            for part in schema.get(word, []):
                yield from self.here(name, part, value)
        for word in ("then", "else"):
            yield from self.here(name, schema.get(word), value)

    def below(self, subschemas, key):
        """Those that speak of what stands under a key, or at an index."""
        for name, schema in subschemas:
            if isinstance(key, str):
                if key in schema.get("properties", {}):
                    yield name, schema["properties"][key]
                elif "additionalProperties" in schema:
                    yield name, schema["additionalProperties"]
            else:
                first = schema.get("prefixItems", [])
                if key < len(first):
                    yield name, first[key]
                elif "items" in schema:
                    yield name, schema["items"]


def meant_otherwise(schema, value):
    if isinstance(value, dict):
        for key, inner in schema.get("properties", {}).items():
            if isinstance(inner, dict) and key in value:
                if "const" in inner and inner["const"] != value[key] or key == "type" and value[key] not in inner.get("enum", [value[key]]):
                    return True
    return False


def places(schema, name, top, document):
    """(path, value, subschemas) of every place in a document."""
    def walk(path, value, given):
        found = [one for part_name, part in given for one in schema.here(part_name, part, value)]
        yield path, value, found
        items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
        for key, inner in items:
            yield from walk(path + (key,), inner, list(schema.below(found, key)))

    yield from walk((), document, [(name, top)])


def along(schema, name, top, document, path):
    """The subschemas of one place, which need not be there."""
    given = [(name, top)]
    for step in path:
        found = [one for part_name, part in given for one in schema.here(part_name, part, document)]
        given = list(schema.below(found, step))
        try:
            document = document[step]
        except (KeyError, IndexError, TypeError):
            document = None
    return [one for part_name, part in given for one in schema.here(part_name, part, document)]


def at(document, path):
    for step in path:
        document = document[step]
    return document


def changed(document, path, value):
    if not path:
        return copy.deepcopy(value)
    out = copy.deepcopy(document)
    at(out, path[:-1])[path[-1]] = copy.deepcopy(value)
    return out


def without(document, path):
    out = copy.deepcopy(document)
    del at(out, path[:-1])[path[-1]]
    return out


def example(schema, name, part, depth=0):
    """Some value that the subschema might take."""
    if not isinstance(part, dict) or depth > 6:
        return 1
    if "const" in part:
        return part["const"]
    if "default" in part:
        return part["default"]
    if "enum" in part:
        return part["enum"][0]
    if "minimum" in part or "maximum" in part or "exclusiveMinimum" in part:
        low, high = part.get("minimum", part.get("exclusiveMinimum", -1e3)), part.get("maximum", 1e3)
        return int(high) if "multipleOf" in part else 1 if low < 1 < high else low
    kind = part.get("type")
    if kind in ("boolean", "string", "number", "null"):
        return {"boolean": True, "string": "ball", "number": 1, "null": None}[kind]
    if kind == "array" and ("items" in part or "prefixItems" in part):
        first = [example(schema, name, one, depth + 1) for one in part.get("prefixItems", [])]
        return first + [example(schema, name, part.get("items"), depth + 1)] * (part.get("minItems", 1) - len(first))
    if "else" in part:
        return example(schema, name, part["else"], depth + 1)
    for word in ("anyOf", "oneOf"):
        if word in part and "properties" not in part:
            return example(schema, name, part[word][0], depth + 1)
    if "properties" in part:
        out = {key: example(schema, name, part["properties"].get(key), depth + 1) for key in part.get("required", [])}
        for alternative in part.get("anyOf", [])[:1]:
            inner = example(schema, *schema.follow(name, alternative["$ref"]), depth + 1) if "$ref" in alternative else {}
            out.update(inner if isinstance(inner, dict) else {})
        for key, value in part["properties"].items():
            if isinstance(value, dict) and ("const" in value or key == "type"):
                out.setdefault(key, example(schema, name, value, depth + 1))
        return out
    if "$ref" in part:
        return example(schema, *schema.follow(name, part["$ref"]), depth + 1)
    return 1


def around(value, schema):
    """Numbers below, at and above each bound."""
    for word in ("minimum", "maximum", "exclusiveMinimum", "exclusiveMaximum"):
        if word in schema:
            bound = schema[word]
            step = max(abs(bound) * 1e-3, 1 if "multipleOf" in schema else 1e-3 if abs(bound) > 1e-2 else abs(bound) or 1e-9)
            yield from (bound, bound - step, bound + step)
    if "multipleOf" in schema and isinstance(value, (int, float)):
        yield from (value + 0.5, float(value))


def by_schema(schema, name, top, document):
    """(kind, key of the place, document): every way in which one place may be otherwise."""
    for path, value, found in places(schema, name, top, document):
        here = tuple(sorted({id(part) for _, part in found}))
        def one(kind, result, part=None):
            return kind, (here, id(part)), "/".join(map(str, path)), result
        for i, wrong in enumerate(WRONG):
            yield one(f"wrong{i}", changed(document, path, wrong))
        if isinstance(value, dict):
            for key in value:
                yield one("drop " + key, without(document, path + (key,)))
            yield one("unknown", changed(document, path, {**value, "unknown_key": 1}))
            yield one("misspelt", changed(document, path, {**value, "tpye": "x"}))
            for part_name, part in found:
                for key, inner in part.get("properties", {}).items():
                    if key not in value and inner is not True:
                        yield one("add " + key, changed(document, path, {**value, key: example(schema, part_name, inner)}))
            yield one("include", changed(document, path, {**value, "include": 7}))
        if isinstance(value, list):
            yield one("longer", changed(document, path, value + value[-1:]))
            yield one("shorter", changed(document, path, value[:-1]))
            yield one("empty", changed(document, path, []))
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            yield one("keys", changed(document, path, {"keyframes": [[0, value]]}))
            yield one("keys by t", changed(document, path, {"keyframes": [[0, value], [1, value]], "by": "t"}))
            yield one("keys by time", changed(document, path, {"keyframes": [[0, value]], "by": "time"}))
            yield one("text", changed(document, path, str(value)))
            yield one("negative", changed(document, path, -value))
        for part_name, part in found:
            for i, number in enumerate(around(value, part)):
                yield one(f"bound{i}", changed(document, path, number), part)
            for word in part.get("enum", []):
                if word != value:
                    yield one(f"word {word}", changed(document, path, word))
                if isinstance(word, str):
                    yield one(f"misspelt {word}", changed(document, path, word + "e"))
            for word in ("anyOf", "oneOf"):
                for i, alternative in enumerate(part.get(word, [])):
                    if "$ref" in alternative:
                        other = example(schema, *schema.follow(part_name, alternative["$ref"]))
                        yield one(f"{word}{i}", changed(document, path, other), part)


def at_random(seed, documents, count):
    """(description, document): some places of one document otherwise, often as in another."""
    dice = random.Random(seed)
    values = [value for document in documents for value in everything(document)]
    for _ in range(count):
        document = copy.deepcopy(dice.choice(documents))
        told = []
        for _ in range(dice.choice((1, 1, 1, 2, 3))):
            paths = [path for path in everywhere(document) if path]
            if not paths:
                break
            path = dice.choice(paths)
            container, key = at(document, path[:-1]), path[-1]
            way = dice.randrange(8)
            told.append(f"{way} {'/'.join(map(str, path))}")
            if way == 0:
                del container[key]
            elif way == 1:
                other = at(document, dice.choice(paths))
                container[key] = copy.deepcopy(other)
            elif way in (2, 3, 4):
                container[key] = copy.deepcopy(dice.choice(values))
            elif way == 5 and isinstance(container[key], (int, float)):
                container[key] = container[key] * dice.choice((-1, 0, 0.5, 2, 10, 1e6, 1e-6)) + dice.choice((0, 0, 1))
            elif way == 6 and isinstance(container, list):
                container.insert(key, copy.deepcopy(container[key]))
            elif way == 7 and isinstance(container, dict):
                container[dice.choice(("type", "x", "event", "fov_deg", "include", "radius", "from"))] = container.pop(key)
        yield " ".join(told), document


def everywhere(document, path=()):
    yield path
    items = document.items() if isinstance(document, dict) else enumerate(document) if isinstance(document, list) else ()
    for key, inner in items:
        yield from everywhere(inner, path + (key,))


def everything(document):
    for path in everywhere(document):
        yield at(document, path)
