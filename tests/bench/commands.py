"""What the commands take, from their start to their end."""
import json
import pathlib
import signal
import subprocess
import time

import shapes
from table import row

SCENES = pathlib.Path(__file__).resolve().parent.parent.parent / "resources/scenes"
REPEATS = 5


def bench_import(build, work):
    """A mesh of 40,000 triangles, from the command's start to the saved scene."""
    ball = shapes.sphere(rings=101, sectors=200)
    (work / "forty.stl").write_bytes(shapes.stl(*ball))
    times = []
    for _ in range(REPEATS):
        start = time.monotonic()
        subprocess.run([build / "app/spore", "import", work / "forty.stl", "--unit", "m", "-o", work / "forty/forty.spore", "--quiet"],
                       check=True)
        times.append(time.monotonic() - start)
    yield row("import", f"{len(ball[1])} triangles, STL", min(times), "s", 1)


def bench_spheres(build, work):
    """Sphere sets of a knobbly solid."""
    vertices, triangles = shapes.sphere(rings=60, sectors=72)
    bumpy = [(x * (1 + 8 * y), y * 1.5, z * (1 + 200 * x * x)) for x, y, z in vertices]
    (work / "bumpy.off").write_bytes(shapes.off(bumpy, triangles))
    for count in (32, 110, 500):
        done = subprocess.run([build / "app/spore", "spheres", work / "bumpy.off", "--count", str(count), "--json"],
                              capture_output=True, text=True, check=True)
        report = json.loads(done.stdout)
        yield row("spheres", f"{count} spheres, {len(triangles)} triangles", report["seconds"], "s", 5, error_ours=report["depth_error"])


def bench_interrupt(build, work):
    """From Ctrl-C to the end of long work."""
    (work / "fine.off").write_bytes(shapes.off(*shapes.sphere(rings=60, sectors=120)))
    scene = SCENES / "laparoscopy.spore"
    for case, arguments in (("run", ["run", scene, "--steps", "1000000000"]),
                            ("spheres", ["spheres", work / "fine.off", "--count", "3000"]),
                            ("tetrahedra", ["tetrahedra", work / "fine.off", "--cells", "1000000"])):
        worst = 0
        for wait in (0.2, 0.6, 1.0):
            process = subprocess.Popen([build / "app/spore", *arguments], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(wait)
            process.send_signal(signal.SIGINT)
            start = time.monotonic()
            process.wait()
            worst = max(worst, time.monotonic() - start)
        yield row("interrupt", f"{case}, worst of 3", worst, "s", 0.5)


BENCHES = {"import": bench_import, "spheres": bench_spheres, "interrupt": bench_interrupt}
