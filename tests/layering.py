#!/usr/bin/python3
"""Checks that every include follows the direction of the architecture, and that the kernel needs libc alone."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
KERNEL = {"base", "math", "linalg", "nonlinear", "integrate", "mesh", "collide", "constraint", "haptic", "sim", "measure"}
# What each room may include, besides itself.
ALLOWED = {
    "base": set(),
    "math": {"base"},
    "linalg": {"base", "math"},
    "nonlinear": {"base", "math", "linalg"},
    "integrate": {"base", "math", "linalg", "nonlinear"},
    "mesh": {"base", "math"},
    "collide": {"base", "math"},
    "constraint": {"base", "math", "linalg", "mesh", "collide"},
    "haptic": {"base", "math"},
    "sim": {"base", "math", "linalg", "nonlinear", "integrate", "mesh", "collide", "constraint", "haptic"},
    "measure": KERNEL,
    "scene": KERNEL,
    "io": KERNEL | {"scene"},
    "generate": KERNEL | {"scene", "io"},
    "author": KERNEL | {"scene", "io", "generate"},
}
FOREIGN = re.compile(r"glib|gio|gtk|libxml|json-glib|epoxy|png|assimp|CGAL")


def room_of(path):
    parts = path.relative_to(ROOT).parts
    return parts[1] if parts[0] == "core" else parts[0]


def faults(path):
    room = room_of(path)
    for number, line in enumerate(path.read_text().splitlines(), 1):
        match = re.match(r'\s*#\s*include\s+([<"])([^">]+)', line)
        if not match:
            continue
        system, name = match.group(1) == "<", match.group(2)
        place = f"{path.relative_to(ROOT)}:{number}"
        if system and room in KERNEL | {"models"} and FOREIGN.search(name):
            yield f"{place}: the kernel includes {name}"
        if not system and name.startswith("core/"):
            other = name.split("/")[1]
            if room in ALLOWED and other != room and other not in ALLOWED[room]:
                yield f"{place}: core/{room} includes {name}"
            if room == "models" and other not in KERNEL:
                yield f"{place}: a model includes {name}"
        if not system and name.startswith(("ui/", "app/", "models/")) and room in ALLOWED:
            yield f"{place}: core includes {name}"
        if not system and name.startswith("app/") and room == "ui":
            yield f"{place}: ui includes {name}"
        if "ui/render" in str(path) and "gtk" in name:
            yield f"{place}: the renderer includes GTK"


def main():
    sources = [p for folder in ("app", "core", "models", "ui") for p in (ROOT / folder).rglob("*.[ch]")]
    found = [fault for path in sources for fault in faults(path)]
    print("\n".join(found) if found else f"{len(sources)} files follow the layers")
    return 1 if found else 0


sys.exit(main())
