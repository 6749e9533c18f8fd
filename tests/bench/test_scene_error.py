#!/usr/bin/python3
"""test_scene_error.py BENCH_SCENE_ERROR SCENE: what the benchmark says of a scene's error is of the order of its method."""
import json
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from tap import check, main


def measure(program, scene, step_s):
    """Of the only body of the scene in its first 0.4 s, before anything touches it."""
    done = subprocess.run([program, scene, "0.4", "16", str(step_s)], capture_output=True, text=True, check=True)
    (body,) = json.loads(done.stdout)
    return body


@check
def half_the_step_is_half_the_error(program, scene):
    """Implicit Euler at half its step strays about half as far, and the reference is resolved far beyond either."""
    whole, half = measure(program, scene, 0.004), measure(program, scene, 0.002)
    assert 1.4 < whole["final"] / half["final"] < 2.6 and 1.4 < whole["max"] / half["max"] < 2.6, (whole, half)
    assert whole["compared"] == half["compared"] == "spheres"
    assert max(whole["reference"], half["reference"]) < half["final"] / 100, (whole, half)
    assert 0 < half["growth"] < 1e-6, half


main(*sys.argv[1:])
