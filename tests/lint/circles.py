#!/usr/bin/python3
"""circles.py BUILD [ROOT]: finds circles of files that call each other, and calls against the layers, in a build.

A file uses another one when its object names a symbol that the other one's object defines. A file that is compiled
several times, as a kernel is for each level of processor, counts once. Files that reach each other on such ways make a
circle: none of them can be understood or tested without the rest. Calls through tables and pointers do not count."""
import collections
import json
import pathlib
import subprocess
import sys

import layers

# How many circles a room may have. One in core/sim: the step and the tries of a step that did not hold.
CIRCLES = {"core/sim": 1}


def objects(build, root):
    """Pairs (object, source relative to the root) of what the build compiled below core, models, ui and app."""
    for command in json.loads((build / "compile_commands.json").read_text()):
        folder = pathlib.Path(command["directory"])
        source = (folder / command["file"]).resolve()
        if source.is_relative_to(root) and source.relative_to(root).parts[0] in layers.FOLDERS:
            yield folder / command["output"], str(source.relative_to(root))


def symbols(build, root):
    """(defined, used): for each symbol the set of sources that define it, and of those that need it from elsewhere."""
    source_of = {str(made): source for made, source in objects(build, root)}
    missing = [made for made in source_of if not pathlib.Path(made).exists()]
    if missing or not source_of:
        sys.exit(f"{build} is not built: {(missing or ['compile_commands.json names no source'])[0]}")
    listed = subprocess.run(["nm", "--print-file-name", "--format=posix", "--no-sort", *source_of], check=True,
                            stdout=subprocess.PIPE, text=True).stdout
    defined, used = collections.defaultdict(set), collections.defaultdict(set)
    for line in listed.splitlines():
        made, symbol, kind = line.split()[:3]
        if kind == "U":
            used[symbol].add(source_of[made.rstrip(":")])
        elif kind.isupper():
            defined[symbol].add(source_of[made.rstrip(":")])
    return defined, used


def references(build, root):
    """{file: {file that it uses: one symbol}}. A symbol that several files define, such as main, tells nothing."""
    defined, used = symbols(build, root)
    graph = {source: {} for owners in defined.values() for source in owners}
    for symbol, users in sorted(used.items()):
        if len(defined.get(symbol, ())) == 1:
            owner, = defined[symbol]
            for user in users - {owner}:
                graph.setdefault(user, {}).setdefault(owner, symbol)
    return graph


def reachable(graph, start):
    """All files that one file uses, those that these use, and so on."""
    seen, waiting = set(), [start]
    while waiting:
        for other in graph[waiting.pop()]:
            if other not in seen:
                seen.add(other)
                waiting.append(other)
    return seen


def circles(graph):
    """Lists of files that all reach each other, the largest first."""
    reach = {file: reachable(graph, file) for file in graph}
    found = {tuple(sorted(other for other in reach[file] if file in reach[other]))
             for file in graph if file in reach[file]}
    return sorted(found, key=lambda circle: (-len(circle), circle))


def room(file):
    """core/NAME, or models, ui, app."""
    parts = pathlib.PurePath(file).parts
    return "/".join(parts[:2]) if parts[0] == "core" else parts[0]


def describe(graph, circle):
    """The circle's files, and which of them uses which by what."""
    print(f"a circle of {len(circle)} files in {', '.join(sorted({room(file) for file in circle}))}:")
    for file in circle:
        uses = [f"{other} ({symbol})" for other, symbol in graph[file].items() if other in circle]
        print(f"  {file} -> {', '.join(uses)}")


def main(build, root=layers.ROOT):
    root = pathlib.Path(root).resolve()
    graph = references(pathlib.Path(build), root)
    faults = [f"{file}: calls {symbol} of {other}: {layers.breach(file, other)}"
              for file in sorted(graph) for other, symbol in graph[file].items() if layers.breach(file, other)]
    found = circles(graph)
    for circle in found:
        describe(graph, circle)
    count = collections.Counter(" and ".join(sorted({room(file) for file in circle})) for circle in found)
    faults += [f"{rooms}: {number} circles, {CIRCLES.get(rooms, 0)} allowed" for rooms, number in sorted(count.items())
               if number > CIRCLES.get(rooms, 0)]
    print("\n".join(faults + [f"{len(graph)} files, {sum(map(len, found))} of them in {len(found)} circles"]))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
