#!/usr/bin/python3
"""layers.py [ROOT]: checks that every include follows the direction of the architecture, that the kernel needs libc
alone, and that memory which may be refused is asked for by one door. Prints each breach; the exit status is 1 where
there is one. circles.py applies the same rules to calls."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent

# The rooms of core from the bottom to the top. A room may use the rooms of the lines above it here.
LAYERS = [
    {"base"},
    {"math"},
    {"linalg"},
    {"nonlinear", "integrate", "mesh", "collide", "haptic"},
    {"body"},
    {"constraint"},
    {"sim"},
    {"exercise"},
    {"measure", "runtime", "scene"},
    {"io", "generate"},
    {"author"},
]
# The rooms of one line do not use each other, but for these.
BESIDE = {("integrate", "nonlinear"), ("scene", "runtime"), ("generate", "io")}
# These rooms and the models need libc alone.
KERNEL = set.union(*LAYERS[:7]) | {"exercise", "measure", "runtime"}
# The models use core up to this room.
MODELS_SEE = "body"
# The folders of core/sim. Each may use the ones after it; the head, files in core/sim itself, may use all.
SIM = ["lod", "effect", "tool", "topology", "link", "solve", "contact", "state"]
# What every folder of core/sim may include of the head: what the world is made from, and its members. These headers
# declare no function of the head that a folder may call: circles.py looks after that.
SIM_PUBLIC = {"core/sim/world.h", "core/sim/world_private.h"}
# The folders of core/generate. Each has one header of its own name, and no other is included from outside the folder.
GENERATE = {"common", "spheres", "tetrahedra", "centreline", "labels", "surface", "sheet"}
# The header that a program outside includes: it names all that is public of the library.
UMBRELLA = "models/spore.h"
# The folders at the top that hold sources, and which others each may use.
FOLDERS = {"core": set(), "models": {"core"}, "ui": {"core", "models"}, "app": {"core", "models", "ui"}}
# Headers of libraries that the kernel does not know.
FOREIGN = re.compile(r"glib|gio|gtk|libxml|json-glib|epoxy|png|assimp|CGAL")
# Headers that Windows has not: the kernel, the models and spore-player build for Windows, too.
UNIX = re.compile(r"^(linux|sys|gnu|asm|arpa|netinet)/|^(unistd|fcntl|poll|dlfcn|spawn|pwd|glob|termios)\.h$")
PLAYER = {pathlib.PurePath("app/player.c"), pathlib.PurePath("app/player_report.c")}
# Memory that GLib may refuse to give.
ASKS_GLIB = re.compile(r"\bg_try_(new|malloc|realloc|renew)")

SUFFIXES = {".c", ".h", ".cpp", ".hpp"}


def rank(room):
    """Number of the layer of a room of core; None where the table lacks the room."""
    return next((number for number, rooms in enumerate(LAYERS) if room in rooms), None)


def sim_rank(parts):
    """Where a file of core/sim stands in the order of folders; the head is first."""
    return 0 if len(parts) < 4 else SIM.index(parts[2]) + 1 if parts[2] in SIM else None


def core_breach(parts, other):
    """Why a file of core may not use another file of core, both as tuples of folders and name; None: it may."""
    room, room_used = parts[1], other[1]
    if rank(room) is None or rank(room_used) is None:
        return None  # said once for each file, by `misplaced`
    if room != room_used:
        allowed = rank(room_used) < rank(room) or (room, room_used) in BESIDE
        return None if allowed else f"core/{room} stands below core/{room_used}, or beside it"
    if room == "sim" and None not in (sim_rank(parts), sim_rank(other)) and sim_rank(other) < sim_rank(parts):
        above = other[2] if len(other) > 3 else "head"
        return f"in core/sim, {parts[2]} stands below {above}"
    return None


def breach(path, other):
    """Why the file `path` may not use the file `other` (both relative to the root); None where it may."""
    parts, used = pathlib.PurePath(path).parts, pathlib.PurePath(other).parts
    if parts[0] not in FOLDERS or used[0] not in FOLDERS:
        return None
    if parts[0] != used[0]:
        if used[0] not in FOLDERS[parts[0]]:
            return f"{parts[0]} knows nothing of {used[0]}"
        if parts[0] == "models" and rank(used[1]) is not None and rank(used[1]) > rank(MODELS_SEE):
            return f"models use core up to core/{MODELS_SEE}"
        return None
    return core_breach(parts, used) if parts[0] == "core" else None


def private_of_generate(path, other):
    """Whether `other` is a header inside a folder of core/generate that a file outside of the folder may not see."""
    used = pathlib.PurePath(other).parts
    return (len(used) == 4 and used[:2] == ("core", "generate") and used[3] != used[2] + ".h" and
            pathlib.PurePath(path).parts[:3] != used[:3])


def misplaced(path):
    """Why the table has no place for a file; None where it has one."""
    parts = pathlib.PurePath(path).parts
    if parts[0] != "core" or len(parts) < 3:
        return None
    if rank(parts[1]) is None:
        return f"core/{parts[1]} has no place in tests/lint/layers.py"
    for room, known in (("sim", SIM), ("generate", GENERATE)):
        if parts[1] == room and len(parts) > 3 and parts[2] not in known:
            return f"core/{room}/{parts[2]} has no place in tests/lint/layers.py"
    return None


def include_breach(path, name, system):
    """Why the file `path` may not include `name`; None where it may."""
    parts = pathlib.PurePath(path).parts
    if system:
        kernel = parts[0] == "models" or parts[0] == "core" and parts[1] in KERNEL
        if FOREIGN.search(name) and kernel:
            return "the kernel needs libc alone"
        if UNIX.search(name) and (kernel or pathlib.PurePath(path) in PLAYER):
            return "it builds for Windows, too"
        return "it knows no GTK" if parts[:2] in (("ui", "render"), ("ui", "export")) and "gtk" in name else None
    if private_of_generate(path, name):
        return f"only {name.rsplit('/', 2)[1]}.h is for others"
    public = name in SIM_PUBLIC and parts[:2] == ("core", "sim") or str(path) == UMBRELLA
    return None if public else breach(path, name)


def sources(root):
    """All sources below a root, relative to it."""
    return sorted(p.relative_to(root) for folder in FOLDERS for p in (root / folder).rglob("*") if p.suffix in SUFFIXES)


def faults(root, path):
    """What is wrong with one file, a line each."""
    if misplaced(path):
        yield f"{path}: {misplaced(path)}"
    for number, line in enumerate((root / path).read_text().splitlines(), 1):
        match = re.match(r'\s*#\s*include\s+([<"])([^">]+)', line)
        reason = match and include_breach(path, match.group(2), match.group(1) == "<")
        if reason:
            yield f"{path}:{number}: includes {match.group(2)}: {reason}"
        if ASKS_GLIB.search(line):
            yield f"{path}:{number}: memory that may be refused comes from spore_allocate, which tests can make fail"


def main(root=ROOT):
    root = pathlib.Path(root)
    paths = sources(root)
    found = [fault for path in paths for fault in faults(root, path)]
    print("\n".join(found) if found else f"{len(paths)} files follow the layers")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
