#!/usr/bin/python3
"""Films and rows of pictures by `spore render`. test_film.py SPORE FEATURES: what the build holds (render, video)."""
import json
import os
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import picture_files
import shapes
from tap import Skip, check, main, wait_for_work

SPORE, FEATURES = os.path.abspath(sys.argv[1]), sys.argv[2].split(",")
WORK = pathlib.Path(tempfile.mkdtemp(prefix="spore-film-"))
SIZE = 64, 48


def track(name, *rows):
    """A track that leads the ball to (x, y) at each time."""
    (WORK / name).write_text("spore-track 1\ndevice ball\n" + "".join(f"{t} {x} {y} 0 1 0 0 0 0 0\n" for t, x, y in rows))
    return name


def prepare():
    (WORK / "ball.off").write_bytes(shapes.off(*shapes.sphere(radius=0.02)))
    track("across.track", (0, -0.05, 0), (1.5, 0.05, 0))
    track("down.track", (0, 0, 0.03), (1.5, 0, -0.03))
    scene = """<spore version="1.0"><solver time_step="0.01"/><assets><mesh name="ball" file="ball.off"/></assets>
  <bodies><body name="ball" role="active"><visual mesh="ball" colour="0.8 0.3 0.2"/></body></bodies>
  <tools><camera name="front" position="0 0 0.3" target="0 0 0" field_of_view="0.4"/>DEVICES</spore>"""
    (WORK / "ball.spore").write_text(scene.replace("DEVICES", '<probe name="hand" body="ball" device="across"/></tools>'
                                                   '<devices><track name="across" file="across.track"/></devices>'))
    (WORK / "still.spore").write_text(scene.replace("DEVICES", "</tools>"))


def render(output, *options, status=0, scene="ball.spore", **how):
    size = () if "--size" in options else ("--size", "%dx%d" % SIZE)
    done = subprocess.run([SPORE, "render", scene, "-o", output, *size, *map(str, options), "--json"], cwd=WORK, capture_output=True,
                          text=True, timeout=120, **how)
    assert done.returncode == status, (options, done.returncode, done.stdout, done.stderr)
    return done.stderr if status else json.loads(done.stdout)


def at(time, *options):
    render("at.png", "--time", time, *options)
    return picture_files.png(WORK / "at.png")


def needs_films():
    if "video" not in FEATURES:
        raise Skip("built without libvpx")


@check
def a_film_shows_what_pictures_show():
    """A film has as many pictures as its length and rate say, and each is that of its moment"""
    needs_films()
    told = render("run.webm", "--fps", 8)
    assert (told["frames"], told["length_s"], told["width"], told["height"]) == (12, 1.5, *SIZE), told
    film = picture_files.Film(WORK / "run.webm")
    assert film.size == SIZE and abs(film.duration - 1.5) < 1e-9
    assert [round(time * 1000) for time in film.times] == [125 * k for k in range(12)]
    pictures = picture_files.film_pictures(WORK / "run.webm", SIZE)
    assert len(pictures) == 12
    for k in (0, 5, 11):
        own, other = (picture_files.likeness(pictures[k], at(time)) for time in (k / 8, (k + 2) / 8))
        assert own > 30 and other < own - 6, (k, own, other)


@check
def a_long_film_has_a_table_of_its_clusters():
    """A film of half a minute has pictures that need no other at least every 5 s, and a table that names each"""
    needs_films()
    assert render("long.webm", "--fps", 4, "--speed", 0.05)["frames"] == 120
    film = picture_files.Film(WORK / "long.webm")  # asserts the table
    assert len(film.times) == 120 and abs(film.duration - 30) < 1e-9


@check
def a_row_of_pictures_is_the_run():
    """A row is numbered from 0; slow motion doubles it; --from and --time bound it; each is the picture of its moment, to the byte"""
    for folder, options, count in [("all", (), 6), ("slow", ("--speed", 0.5), 12), ("part", ("--from", 0.5, "--time", 1), 2)]:
        (WORK / folder).mkdir()
        told = render(f"{folder}/p-%03d.png", "--fps", 4, *options)
        assert told["frames"] == count and told["length_s"] == count / 4, told
        assert sorted(os.listdir(WORK / folder)) == [f"p-{k:03d}.png" for k in range(count)]
    for name, time in [("all/p-003.png", 0.75), ("slow/p-003.png", 0.375), ("part/p-000.png", 0.5), ("part/p-001.png", 0.75)]:
        render("at.png", "--time", time)
        assert (WORK / name).read_bytes() == (WORK / "at.png").read_bytes(), name
    assert (WORK / "all/p-003.png").read_bytes() != (WORK / "all/p-002.png").read_bytes()


@check
def two_runs_stand_side_by_side():
    """--beside shows the scene with another track at the right, at the same moment"""
    told = render("both.png", "--time", 1, "--beside", "down.track")
    assert (told["width"], told["height"]) == (2 * SIZE[0], SIZE[1]), told
    both, middle = picture_files.png(WORK / "both.png"), 3 * SIZE[0]
    left, right = [row[:middle] for row in both], [row[middle:] for row in both]
    assert left == at(1) and right == at(1, "--input", "down.track") and left != right
    if "video" in FEATURES:
        assert render("both.webm", "--beside", "down.track", "--fps", 2)["width"] == 2 * SIZE[0]
        assert picture_files.Film(WORK / "both.webm").size == (2 * SIZE[0], SIZE[1])


@check
def bad_input_is_said():
    """What cannot be filmed is one line with a remedy, status 2, and no file"""
    before = sorted(os.listdir(WORK))
    track("other.track", (0, 0, 0))
    (WORK / "other.track").write_text((WORK / "other.track").read_text().replace("ball", "liver"))
    cases = [("f.webm", ("--fps", 0), "--fps"), ("f.webm", ("--speed", "-1"), "--speed"), ("f.webm", ("--speed", "x"), "--speed"),
             ("f.png", ("--fps", 10), "F-%05d.png"), ("f.avi", (), "F.webm"), ("f-%d-%d.png", (), "two places"), ("f-%d.webm", (), "%d"),
             ("f.webm", ("--from", 2), "after the beginning"), ("f-%d.png", ("--time", 1, "--from", 1), "after the beginning"),
             ("f-%d.png", ("--beside", "other.track"), "liver"), ("f-%d.png", ("--beside", "none.track"), "none.track"),
             ("f.png", ("--beside", "down.track", "--size", "8000x20"), "4096"), ("no/f.webm", (), "no/f.webm")]
    for output, options, says in cases:
        said = render(output, *options, status=2)
        assert says in said and len(said.splitlines()) == 1, (output, options, said)
    assert "--time S" in render("f-%d.png", status=2, scene="still.spore")
    if "video" in FEATURES:
        assert "66x48" in render("f.webm", "--size", "65x47", status=2)
    else:
        assert "libvpx-dev" in render("f.webm", status=2)
    assert sorted(os.listdir(WORK)) == sorted([*before, "other.track"])


@check
def what_cannot_be_written_leaves_the_old():
    """A full disk and Ctrl-C leave the film or the row that was there, and nothing beside it"""
    for name, output in [("row-1.png", "row-%d.png")] + [("old.webm", "old.webm")] * ("video" in FEATURES):
        folder = WORK / f"kept-{name}"
        folder.mkdir()
        (folder / name).write_bytes(b"old")
        full = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (256, 256))
        assert "File too large" in render(folder / output, "--fps", 4, status=2, preexec_fn=full)
        process = subprocess.Popen([SPORE, "render", "ball.spore", "-o", folder / output, "--time", "9999", "--size", "64x48"], cwd=WORK,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        wait_for_work(process)
        process.send_signal(signal.SIGINT)
        said = process.communicate(timeout=60)[1]
        assert process.returncode == 130 and b"Sanitizer" not in said, (process.returncode, said)
        assert os.listdir(folder) == [name] and (folder / name).read_bytes() == b"old", os.listdir(folder)


@check
def a_row_of_large_pictures_ends_at_once():
    """Ctrl-C while a large picture is drawn takes back those of the row that wait to be renamed"""
    folder = WORK / "large"
    folder.mkdir()
    process = subprocess.Popen([SPORE, "render", "ball.spore", "-o", folder / "p-%d.png", "--size", "1600x1200"], cwd=WORK,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while process.poll() is None and not any(folder.iterdir()):
        time.sleep(0.01)
    process.send_signal(signal.SIGINT)
    assert process.wait(60) == 130 and not any(folder.iterdir()), (process.returncode, os.listdir(folder))


if __name__ == "__main__":
    prepare()
    main()
