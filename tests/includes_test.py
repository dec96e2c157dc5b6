#!/usr/bin/env python3
"""Reads every #include of the source tree; fails on a forbidden arrow, a missing header or a circle.

Usage: includes_test.py SOURCE_DIR. Files over 300 lines are named, but do not fail.
"""
import pathlib
import re
import sys

# Which rooms a room may include, besides itself.
ALLOWED = {
    "core/base": set(),
    "core/scene": {"core/base"},
    "core/record": {"core/base"},
    "core/trace": {"core/base", "core/scene", "core/record"},
    "metrics": {"core/base", "core/scene", "core/record", "core/trace"},
    "postrender": {"core/base", "core/record"},
    "apps": {"core/base", "core/scene", "core/record", "core/trace", "metrics", "postrender"},
    "bench": {"core/base", "core/scene", "core/record", "core/trace", "metrics", "postrender", "apps"},
    "tests": {"core/base", "core/scene", "core/record", "core/trace", "metrics", "postrender", "apps"},
}
PACK = "core/base/pack.h"
ENDINGS = {".h", ".hpp", ".cpp", ".cc", ".in", ".inl"}
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(["<])([^">]+)[">]', re.MULTILINE)
COMMENT = re.compile(r'"(?:\\.|[^"\\\n])*"|//[^\n]*|/\*.*?\*/', re.DOTALL)
LONG = 300


def room_of(path):
    """The room of a path relative to the source directory, or None for what stands outside."""
    for room in ALLOWED:
        if path.startswith(room + "/"):
            return room
    return None


def sources(root):
    for top in sorted({room.split("/")[0] for room in ALLOWED}):
        for path in sorted((root / top).rglob("*")):
            if path.suffix in ENDINGS and path.is_file():
                yield path.relative_to(root).as_posix()


def includes_of(root, name):
    text = (root / name).read_text(encoding="utf-8")
    # Comments go, texts in quotes stay.
    code = COMMENT.sub(lambda m: m.group() if m.group().startswith('"') else "\n" * m.group().count("\n"), text)
    return INCLUDE.findall(code)


def resolve(root, name, target):
    """A quoted include stands beside the file or below the source directory; None if in neither."""
    beside = (pathlib.PurePosixPath(name).parent / target).as_posix()
    for candidate in (target, beside):
        if (root / candidate).is_file():
            return pathlib.Path(root / candidate).resolve().relative_to(root.resolve()).as_posix()
    return None


def faults_of(root, name, found):
    """Faults of one file's includes; `found` collects the files that it includes."""
    room = room_of(name)
    if room is None:
        yield f"{name}: stands in no known room; expected one of {', '.join(ALLOWED)}"
        return
    for mark, target in includes_of(root, name):
        if target.startswith("xsimd/") and name != PACK:
            yield f"{name}: includes xsimd; only {PACK} may"
        inner = resolve(root, name, target)
        if mark == "<":
            if room_of(target):
                yield f"{name}: includes <{target}>; expected quotes"
            continue
        if inner is None:
            yield f'{name}: includes "{target}", which does not exist'
            continue
        found.append(inner)
        to = room_of(inner)
        if to is None:
            yield f"{name}: includes {inner}, which stands in no room"
        elif to != room and to not in ALLOWED[room]:
            yield f"{name}: includes {inner}, but {room} must not include {to}"


def circle(graph):
    """One circle of includes as a list of files, or None."""
    state = {}
    for start in graph:
        stack = [(start, iter(graph.get(start, ())))]
        if state.setdefault(start, "open") == "done":
            continue
        while stack:
            name, rest = stack[-1]
            following = next(rest, None)
            if following is None:
                state[name] = "done"
                stack.pop()
            elif state.get(following) == "open":
                names = [entry[0] for entry in stack]
                return names[names.index(following):] + [following]
            elif following not in state:
                state[following] = "open"
                stack.append((following, iter(graph.get(following, ()))))
    return None


def main(arguments):
    if len(arguments) != 2 or not (pathlib.Path(arguments[1]) / "core").is_dir():
        print("usage: includes_test.py SOURCE_DIR", file=sys.stderr)
        return 2
    root = pathlib.Path(arguments[1])
    graph, faults = {}, []
    for name in sources(root):
        faults += faults_of(root, name, graph.setdefault(name, []))
        lines = (root / name).read_text(encoding="utf-8").count("\n")
        if lines > LONG:
            print(f"note: {name} has {lines} lines")
    if not graph:
        faults.append("no source files found")
    round_trip = circle(graph)
    if round_trip:
        faults.append("a circle: " + " -> ".join(round_trip))
    for fault in faults:
        print(fault)
    print(f"{len(graph)} files, {sum(map(len, graph.values()))} includes, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
