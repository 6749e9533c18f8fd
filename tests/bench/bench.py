#!/usr/bin/python3
"""bench.py --build DIR [NAME...] [--json F]: measures, prints a table of ours, peer and floor, and their ratio. Nothing here
asserts a time: what is behind its promise is marked, and the exit status stays 0."""
import argparse
import json
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "e2e"))
import authoring
import collide
import commands
import editor
import fluid
import fold
import kernel
import sofa
import kernels
import peers
import precision
import solids
import solvers
import surface
import table
import table1

BENCHES = {**kernel.BENCHES, **sofa.BENCHES, **kernels.BENCHES, **collide.BENCHES, **surface.BENCHES, **fold.BENCHES, **solvers.BENCHES, **solids.BENCHES, **peers.BENCHES, **precision.BENCHES, **fluid.BENCHES, **table1.BENCHES, **commands.BENCHES, **authoring.BENCHES, **editor.BENCHES}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", choices=[[], *BENCHES])
    parser.add_argument("--build", required=True, type=lambda p: pathlib.Path(p).resolve())
    parser.add_argument("--json")
    parser.add_argument("--organs", metavar="FOLDER", help="meshes in millimetres for the bench `authoring`; without it, shapes of its own")
    options = parser.parse_args()
    authoring.organs = options.organs
    rows = []
    table.show_head()
    with tempfile.TemporaryDirectory(prefix="spore-bench-") as folder:
        for name in options.names or BENCHES:
            for r in BENCHES[name](options.build, pathlib.Path(folder)):
                table.show(r)
                rows.append(r)
    if options.json:
        pathlib.Path(options.json).write_text(json.dumps(rows, indent=1) + "\n")


main()
