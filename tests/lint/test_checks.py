#!/usr/bin/python3
"""What the checks of layers and circles promise: they find a breach that is planted, and let alone what is allowed."""
import json
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from tap import check, main  # noqa: E402

# A file, a line of it, and a piece of the reason for which the line is refused.
BREACHES = [
    ("core/math/vec3.h", '#include "core/linalg/pcg.h"', "core/math stands below core/linalg"),
    ("core/collide/grid.c", '#include "core/mesh/mesh.h"', "or beside it"),
    ("core/body/model.h", '#include "core/sim/world.h"', "core/body stands below core/sim"),
    ("core/constraint/term.c", '#include "core/sim/state/state.h"', "core/constraint stands below core/sim"),
    ("core/sim/state/state.c", '#include "core/sim/contact/contacts.h"', "state stands below contact"),
    ("core/sim/solve/islands.c", '#include "core/sim/link/links.h"', "solve stands below link"),
    ("core/sim/lod/levels.c", '#include "core/sim/step.h"', "lod stands below head"),
    ("core/sim/world.c", '#include "core/scene/document.h"', "core/sim stands below core/scene"),
    ("core/generate/surface/wall.c", '#include "core/generate/spheres/fit.h"', "only spheres.h is for others"),
    ("ui/jobs/works.c", '#include "core/generate/spheres/fit.h"', "only spheres.h is for others"),
    ("app/helpers/cgal.h", '#include "core/generate/spheres/fit.h"', "only spheres.h is for others"),
    ("core/io/off.c", '#include "core/author/edits.h"', "core/io stands below core/author"),
    ("core/scene/compile.c", '#include "models/registry.h"', "core knows nothing of models"),
    ("models/spline/spline.c", '#include "core/sim/world.h"', "models use core up to core/body"),
    ("models/spline/spline.c", '#include "core/constraint/term.h"', "models use core up to core/body"),
    ("models/spline/spline.c", "#include <glib.h>", "libc alone"),
    ("core/runtime/write.c", "#  include <libxml/tree.h>", "libc alone"),
    ("core/runtime/write.c", "#include <unistd.h>", "builds for Windows"),
    ("models/spline/spline.c", "#include <sys/mman.h>", "builds for Windows"),
    ("app/player.c", "#include <linux/limits.h>", "builds for Windows"),
    ("ui/render/stage.c", "#include <gtk/gtk.h>", "it knows no GTK"),
    ("ui/export/run.c", "#include <gtk/gtk.h>", "it knows no GTK"),
    ("ui/window.c", '#include "app/catalogue.h"', "ui knows nothing of app"),
    ("core/io/off.c", "  char *text = g_try_malloc(size);", "comes from spore_allocate"),
    ("ui/window.c", "  part = g_try_new0 (guint32, count);", "comes from spore_allocate"),
    ("core/newroom/file.c", "", "core/newroom has no place"),
    ("core/sim/newroom/file.c", "", "core/sim/newroom has no place"),
]
ALLOWED = [
    ("core/integrate/newton.c", '#include "core/nonlinear/system.h"'),
    ("core/sim/step.c", '#include "core/sim/contact/contacts.h"'),
    ("core/sim/lod/levels.c", '#include "core/sim/state/state.h"'),
    ("core/sim/state/state.h", '#include "core/sim/world.h"'),
    ("core/author/generators.c", '#include "core/generate/spheres/spheres.h"'),
    ("core/generate/spheres/fit.c", '#include "core/generate/spheres/fit.h"'),
    ("models/spline/spline.c", '#include "core/body/model.h"'),
    ("app/editor.cpp", '#include "ui/window.h"'),
    ("core/scene/document.c", "#include <glib.h>"),
    ("core/io/off.c", "  char *text = spore_allocate(size, 1);"),
]


def plant(root, files):
    """Writes files, a dictionary of names and texts, below a folder."""
    for name, text in files.items():
        path = pathlib.Path(root, name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text + "\n")


def run(script, *arguments):
    """(exit status, what it said) of a check."""
    done = subprocess.run([sys.executable, HERE / script, *arguments], stdout=subprocess.PIPE, text=True, check=False)
    return done.returncode, done.stdout


def build(root, files, twice=()):
    """Plants files and compiles the C ones as a build folder does; those of `twice` two times. Returns the folder."""
    plant(root, files)
    folder = pathlib.Path(root, "build")
    commands = [{"directory": str(folder), "file": f"../{name}", "output": f"{name}{part}.o"}
                for name in files if name.endswith(".c") for part in ([0, 1] if name in twice else [0])]
    for command in commands:
        made = folder / command["output"]
        made.parent.mkdir(parents=True, exist_ok=True)
        subprocess.run(["cc", "-c", "-I..", "-o", command["output"], command["file"]], cwd=folder, check=True)
    (folder / "compile_commands.json").write_text(json.dumps(commands))
    return folder


@check
def each_planted_line_is_found():
    """Each line against the layers is found, with its place and the reason."""
    for path, line, reason in BREACHES:
        with tempfile.TemporaryDirectory() as root:
            plant(root, {path: "/* A file. */\n" + line})
            status, said = run("layers.py", root)
            place = f"{path}:2: " if line else f"{path}: "
            assert status == 1 and said.startswith(place) and reason in said, (path, line, said)
            assert said.count("\n") == 1, (path, line, said)


@check
def allowed_lines_pass():
    """What goes along the layers passes."""
    with tempfile.TemporaryDirectory() as root:
        files = {}
        for path, line in ALLOWED:
            files[path] = files.get(path, "") + line + "\n"
        plant(root, files)
        status, said = run("layers.py", root)
        assert status == 0, said


@check
def a_planted_circle_is_found():
    """Two files that call each other are a circle, even by way of a third; a file that they call is not in it."""
    with tempfile.TemporaryDirectory() as root:
        folder = build(root, {"core/linalg/a.c": "void b(void); void a(void) { b(); }",
                              "core/linalg/b.c": "void c(void); void base(void); void b(void) { c(); base(); }",
                              "core/linalg/c.c": "void a(void); void c(void) { a(); }",
                              "core/base/base.c": "void base(void) {}"})
        status, said = run("circles.py", str(folder), root)
        assert status == 1 and "a circle of 3 files in core/linalg" in said, said
        assert "core/linalg/b.c -> core/linalg/c.c (c)" in said and "core/linalg: 1 circles, 0 allowed" in said, said
        assert "4 files, 3 of them in 1 circles" in said, said


@check
def a_call_up_is_found():
    """A call against the direction is found where no include shows it: of core's rooms, of the folders of core/sim."""
    with tempfile.TemporaryDirectory() as root:
        folder = build(root, {"core/sim/step.c": "void step(void) {}",
                              "core/sim/contact/contacts.c": "void contacts(void) {}",
                              "core/sim/state/state.c": "void contacts(void); void state(void) { contacts(); }",
                              "core/math/mat3.c": "void step(void); void mat3(void) { step(); }"})
        status, said = run("circles.py", str(folder), root)
        assert status == 1, said
        assert "core/sim/state/state.c: calls contacts of core/sim/contact/contacts.c: in core/sim, state" in said, said
        assert "core/math/mat3.c: calls step of core/sim/step.c: core/math stands below core/sim" in said, said


@check
def no_circle_where_there_is_none():
    """Calls in one direction pass; a kernel that is compiled for two levels of processor is one file."""
    with tempfile.TemporaryDirectory() as root:
        kernel = "void base(void); __attribute__((weak)) void kernel(void) { base(); }"
        folder = build(root, {"core/linalg/kernel.c": kernel, "core/base/base.c": "void base(void) {}",
                              "core/linalg/pcg.c": "void kernel(void); void pcg(void) { kernel(); }"},
                       twice={"core/linalg/kernel.c"})
        status, said = run("circles.py", str(folder), root)
        assert status == 0 and "3 files, 0 of them in 0 circles" in said, said


@check
def an_unbuilt_folder_is_refused():
    """A folder that is not built whole is refused, rather than found free of circles."""
    with tempfile.TemporaryDirectory() as root:
        folder = build(root, {"core/base/base.c": "void base(void) {}"})
        (folder / "core/base/base.c0.o").unlink()
        done = subprocess.run([sys.executable, HERE / "circles.py", folder, root], stderr=subprocess.PIPE, text=True,
                              check=False)
        assert done.returncode != 0 and "is not built" in done.stderr, done.stderr


main()
