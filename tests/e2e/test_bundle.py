#!/usr/bin/python3
"""Scenes as bundles: written, run, and strangers' bundles refused. test_bundle.py SPORE SCENES FEATURES"""
import json
import os
import pathlib
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import zipfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from tap import check, is_sanitized, main, wait_for_work

SPORE, SCENES, FEATURES = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3].split(",")
FOLDER = pathlib.Path(tempfile.mkdtemp(prefix="spore-bundle-"))
TEMPORARY = FOLDER / "temporary"
STEPS = 10
BALL = "0 0 0 0.05\n"
SCENE = ('<spore version="1.0"><assets><spheres name="ball" file="ball.spheres"/></assets><bodies><body name="stone" role="unmovable">'
         '<collision spheres="ball"/></body></bodies></spore>\n')


def call(*command, **options):
    done = subprocess.run([SPORE] + [str(word) for word in command], capture_output=True, text=True, timeout=250,
                          env={**os.environ, "TMPDIR": str(TEMPORARY)}, **options)
    assert not list(TEMPORARY.iterdir()), command
    return done


def run(*command, status=0, **options):
    done = call(*command, **options)
    assert done.returncode == status, (command, done.returncode, done.stdout[-500:], done.stderr[-500:])
    return done.stderr if status == 2 else done.stdout


def refused(*command, word, **options):
    said = run(*command, status=2, **options)
    assert word in said and said.count("\n") == 1, (word, said)


def bundle(scene, *options):
    file = FOLDER / "a.sporez"
    return file, json.loads(run("export", scene, "--format", "bundle", "-o", file, "--json", *options))


def state(scene, *options):
    done = call("run", scene, "-n", STEPS, "--json", *options)
    assert done.returncode in (0, 1), (scene, done.stderr)
    return json.loads(done.stdout)["state_hash"]


def zipped(files, name="x.sporez", **options):
    """A bundle that no exporter made. files: pairs of a name or ZipInfo and a content."""
    path = FOLDER / name
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, **options) as made:
        for entry, content in files:
            made.writestr(entry, content, zipfile.ZIP_DEFLATED)
    return path


def entry(name, mode):
    info = zipfile.ZipInfo(name)
    info.create_system, info.external_attr = 3, mode << 16
    return info


def many_files(count, said):
    """A zip of empty files, whose end says that there are `said`."""
    names = [b"f%d" % i for i in range(count)]
    heads = [struct.pack("<4s5H3I2H", b"PK\3\4", 20, 0, 0, 0, 33, 0, 0, 0, len(name), 0) + name for name in names]
    rows, at = [], 0
    for head, name in zip(heads, names):
        rows.append(struct.pack("<4s6H3I5H2I", b"PK\1\2", 20, 20, 0, 0, 0, 33, 0, 0, 0, len(name), 0, 0, 0, 0, 0, at) + name)
        at += len(head)
    table = b"".join(rows)
    path = FOLDER / "many.sporez"
    path.write_bytes(b"".join(heads) + table + struct.pack("<4s4H2IH", b"PK\5\6", 0, 0, said, said, len(table), at, 0))
    return path


def scene_folder(name, text, **files):
    """A scene with files beside it, given as NAME_EXTENSION=content."""
    folder = FOLDER / name
    folder.mkdir()
    for file, content in files.items():
        (folder / file.replace("_", ".")).write_text(content)
    (folder / "s.spore").write_text(text)
    return folder / "s.spore"


@check
def shipped_scenes_run_from_their_bundles():
    """Shipped scenes run from their bundles to the same bits, and the same scene gives the same bundle"""
    scenes = sorted(SCENES.glob("*.spore"))
    for scene in scenes[::8] if is_sanitized(SPORE) else scenes[::4]:
        file, report = bundle(scene)
        content = file.read_bytes()
        assert report["written"] == [{"file": str(file), "bytes": len(content)}] and not report["lost"], report
        assert state(file) == state(scene), scene
        bundle(scene)
        assert file.read_bytes() == content, scene
        with zipfile.ZipFile(file) as opened:
            assert opened.testzip() is None
            assert all((SCENES / name).read_bytes() == opened.read(name) for name in opened.namelist() if name != "scene.spore")


@check
def every_command_opens_a_bundle():
    """check, plan, edit, render and export open a bundle as they open its scene"""
    scene = SCENES / "minimal.spore"
    file, _ = bundle(scene)
    diagnostics = json.loads(run("check", scene, "--json")), json.loads(run("check", file, "--json"))
    assert diagnostics[0] == diagnostics[1]
    assert json.loads(run("plan", file, "--json"))["assets"] == json.loads(run("plan", scene, "--json"))["assets"]
    before = file.read_bytes()
    refused("edit", file, "--set", "solver/time_step=0.002", word="a bundle is not edited")
    assert file.read_bytes() == before
    run("edit", file, "--set", "solver/time_step=0.002", "-o", FOLDER / "unpacked" / "s.spore")
    assert state(FOLDER / "unpacked" / "s.spore") == state(scene, "--dt", "0.002")
    assert (FOLDER / "unpacked" / "minimal" / "ball.off").read_bytes() == (SCENES / "minimal" / "ball.off").read_bytes()
    again = FOLDER / "again.sporez"
    run("export", file, "--format", "bundle", "-o", again)
    assert again.read_bytes() == before
    if "render" in FEATURES:
        pictures = [FOLDER / "one.png", FOLDER / "two.png"]
        for given, picture in zip((scene, file), pictures):
            run("render", given, "--time", "0.02", "--size", "64x48", "-o", picture)
        assert pictures[0].read_bytes() == pictures[1].read_bytes()


@check
def what_a_run_does_not_need_is_left_out():
    """What no run needs is left out, named with its size, and the rest runs to the same bits"""
    ball = (SCENES / "minimal" / "ball.off").read_text()
    text = """<spore version="1.0"><meta title="t"><measured method="verlet" time_step="0.001"/></meta><!-- aside -->
<assets><mesh name="ball" file="ball.off"/><mesh name="origin" file="origin.off"/><mesh name="spare" file="spare.off"/>
<mesh name="rough" file="rough.off"/><spheres name="dots" file="dots.spheres" source="origin" count="7"/>
<curve name="line" file="line.curve"/></assets>
<bodies><body name="stone"><mechanical geometry="ball"><rigid_body/></mechanical><collision spheres="dots"/></body>
<body name="thread" position="0 1 0"><mechanical geometry="line"><spline_1d control_points="20"/></mechanical>
<fidelity automatic="%s"><coarse settings="control_points=10"/></fidelity></body>
<body name="tool" role="active"><collision spheres="dots"/></body></bodies>
<tools><probe name="p" body="tool" device="used"/></tools>
<devices><track name="used" file="used.track"/><track name="still" file="still.track"/></devices></spore>"""
    track = "spore-track 1\ndevice tool\n0 1 1 1 1 0 0 0 0 0\n1 1 1 1.1 1 0 0 0 0 0\n"
    files = dict(ball_off=ball, origin_off=ball + "\n", spare_off=ball + "\n\n", rough_off=ball, dots_spheres=BALL, used_track=track,
                 still_track=track + "\n", line_curve="".join(f"{i / 200} 0 0 0.001\n" for i in range(21)))
    scene = scene_folder("whole", text % "none", **files)
    file, report = bundle(scene)
    left = report["left_out"]
    for name, content, word in (("origin.off", ball + "\n", "generated from it"), ("spare.off", ball + "\n\n", "names it"),
                                ("rough.off", ball, "names it"), ("still.track", track + "\n", "moves nothing")):
        assert [line for line in left if name in line and f" {len(content)} bytes" in line and word in line], (name, left)
    assert [line for line in left if "thread" in line and "coarse" in line], left
    with zipfile.ZipFile(file) as opened:
        assert sorted(opened.namelist()) == ["ball.off", "dots.spheres", "line.curve", "scene.spore", "used.track"]
        inside = opened.read("scene.spore").decode()
    assert 'title="t"' in inside and not [word for word in ("measured", "aside", "source", "count=", "coarse") if word in inside], inside
    size = [int(line.split(": ")[1].split()[0]) for line in left if "comments" in line]
    assert size and 0 < size[0] < len(text), left
    assert state(file) == state(scene)
    automatic = scene_folder("automatic", text % "distance", **files)
    file, report = bundle(automatic)
    assert not [line for line in report["left_out"] if "coarse" in line] and state(file) == state(automatic)


@check
def settings_come_along():
    """Settings of the command line are in the bundle; another input is refused"""
    scene = SCENES / "plate1-ovary.spore"
    options = ["--dt", "0.002", "--integrator", "bdf2", "--set", "environment/gravity=0 -5 0"]
    file, _ = bundle(scene, *options)
    assert state(file) == state(scene, *options) != state(scene)
    refused("export", scene, "--format", "bundle", "-o", file, "--input", SCENES / "plate1-ovary" / "plate1-ovary.track", word="--input")


@check
def names_are_utf_8_in_every_locale():
    """Names of files beyond ASCII are the same in every locale"""
    scene = scene_folder("names", SCENE.replace("ball.spheres", "Öse/bälle 漢.spheres"))
    (scene.parent / "Öse").mkdir()
    (scene.parent / "Öse" / "bälle 漢.spheres").write_text(BALL)
    contents = []
    for locale in ("C", "C.UTF-8"):
        environment = {**os.environ, "LC_ALL": locale, "TMPDIR": str(TEMPORARY)}
        file = FOLDER / "named.sporez"
        subprocess.run([SPORE, "export", scene, "-f", "bundle", "-o", file], check=True, env=environment, stdout=subprocess.DEVNULL)
        subprocess.run([SPORE, "check", file], check=True, env=environment, stdout=subprocess.DEVNULL)
        contents.append(file.read_bytes())
    assert contents[0] == contents[1]
    with zipfile.ZipFile(FOLDER / "named.sporez") as opened:
        assert "Öse/bälle 漢.spheres" in opened.namelist()


@check
def written_whole_or_not_at_all():
    """A full disk, Ctrl-C, a missing file and a wrong name leave the old bundle, and nothing else"""
    target = FOLDER / "kept"
    target.mkdir()
    old = target / "old.sporez"
    old.write_bytes(b"old")
    lap = SCENES / "laparoscopy.spore"
    refused("export", lap, "-f", "bundle", "-o", old, word="nothing was changed",
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000)))
    gone = scene_folder("gone", SCENE)
    refused("export", gone, "-f", "bundle", "-o", old, word="ball.spheres")
    refused("export", lap, "-f", "bundle", "-o", target / "other.zip", word=".sporez")
    outside = scene_folder("outside", SCENE.replace("ball.spheres", "a/../ball.spheres"), ball_spheres=BALL)
    (outside.parent / "a").mkdir()
    refused("export", outside, "-f", "bundle", "-o", old, word="a/../ball.spheres")
    large = scene_folder("large", SCENE.replace('</bodies>', '<body name="tool" role="active"/></bodies><tools><probe name="p" body="tool" '
                                                'device="d"/></tools><devices><track name="d" file="d.track"/></devices>'), ball_spheres=BALL)
    (large.parent / "d.track").write_bytes(os.urandom(1 << 20) * 150)
    for number in (signal.SIGINT, signal.SIGTERM):
        process = subprocess.Popen([SPORE, "export", large, "-f", "bundle", "-o", old], stdout=subprocess.DEVNULL)
        wait_for_work(process)
        process.send_signal(number)
        assert process.wait(timeout=60) == 130
    assert [path.name for path in target.iterdir()] == ["old.sporez"] and old.read_bytes() == b"old"


@check
def names_that_lead_elsewhere():
    """Bundles with links, absolute and relative names, and names that are twice or folders are refused"""
    good = [("scene.spore", SCENE), ("ball.spheres", BALL)]
    assert json.loads(run("run", zipped(good), "-n", 1, "--json"))["steps"] == 1
    link, device = 0o120777, 0o020666
    for more, word in ([("/etc/passwd", "x")], "/etc/passwd"), ([("../up", "x")], "../up"), ([("a/../../up", "x")], "a/../../up"), \
            ([("./here", "x")], "./here"), ([("a//b", "x")], "a//b"), ([("a\x01b", "x")], "in UTF-8"), \
            ([("n" * 2000, "x")], "in UTF-8"), ([(entry("l", link), "ball.spheres")], "link"), \
            ([(entry("d", device), "")], "device"), ([("ball.spheres", BALL)], "twice"), ([("ball.spheres/in", "x")], "a folder that is a file"), \
            ([("ball.spheres/", "")], "a file and a folder"), ([("ä", "x"), ("b.spore", SCENE)], "two scenes"):
        for command in ("run", "check", "plan"):
            refused(command, zipped(good + more), word=word)
    assert json.loads(run("run", zipped(good + [("docs/", ""), ("docs/read me.txt", "x")]), "-n", 1, "--json"))["steps"] == 1


@check
def contents_that_are_not_a_scene():
    """A bundle without its scene, with one that lacks files or is wrong, and what is no bundle are refused"""
    refused("run", zipped([("ball.spheres", BALL)]), word="no scene")
    refused("run", zipped([("in/scene.spore", SCENE), ("in/ball.spheres", BALL)]), word="no scene")
    refused("run", zipped([]), word="empty")
    refused("run", zipped([("scene.spore", SCENE)]), word="ball.spheres")
    (FOLDER / "ball.spheres").write_text(BALL) # beside the bundle: no part of it
    refused("run", zipped([("scene.spore", SCENE)]), word="ball.spheres")
    refused("run", zipped([("scene.spore", SCENE), ("ball.spheres/", "")]), word="ball.spheres")
    refused("run", zipped([("scene.spore", "<spore>"), ("ball.spheres", BALL)]), word="x.sporez:1:")
    refused("run", zipped([("scene.spore", SCENE), ("ball.spheres", "x")]), word="ball.spheres")
    for content, word in (b"", "no bundle"), (SCENE.encode(), "no bundle"), (b"PK", "no bundle"), (b"PK\3\4", "damaged"), (os.urandom(4000), "no bundle"):
        (FOLDER / "x.sporez").write_bytes(content)
        refused("run", FOLDER / "x.sporez", word=word)
    refused("run", FOLDER, word="folder")
    (FOLDER / "folder.sporez").mkdir()
    refused("run", FOLDER / "folder.sporez", word="cannot be read")
    refused("run", FOLDER / "none.sporez", word="cannot be read")
    os.mkfifo(FOLDER / "pipe.sporez")
    refused("run", FOLDER / "pipe.sporez", word="cannot be read")


@check
def damaged_bundles():
    """Bundles that are cut off, changed, encrypted or packed in other ways are refused"""
    good = zipped([("scene.spore", SCENE), ("ball.spheres", BALL)])
    content = good.read_bytes()
    assert call("run", good, "-n", 1).returncode == 0
    for length in range(1, len(content)):
        good.write_bytes(content[:length])
        if length % 23 == 0 or length > len(content) - 23:
            refused("run", good, word="bundle")
    at = content.index(b"scene.spore") + len("scene.spore")
    good.write_bytes(content[:at + 20] + bytes([content[at + 20] ^ 0x55]) + content[at + 21:])
    refused("run", good, word="damaged")
    good.write_bytes(content[:6] + bytes([content[6] | 1]) + content[7:]) # the mark in the first file's head
    refused("run", good, word="encrypted")
    path = FOLDER / "packed.sporez"
    with zipfile.ZipFile(path, "w") as made:
        made.writestr("scene.spore", SCENE, zipfile.ZIP_LZMA)
    refused("run", path, word="unusual")
    good.write_bytes(content + b"behind")
    refused("run", good, word="damaged")


@check
def bundles_of_too_much():
    """Bombs of many files, of large ones and of small ones that unpack to much are refused before they are unpacked"""
    good = [("scene.spore", SCENE), ("ball.spheres", BALL)]
    for count, said, word in (4097, 4097, "over 4096 files"), (100000, 0xffff, "over 4096 files"), (100000, 2, "damaged"), (4096, 4096, "no scene"):
        refused("run", many_files(count, said), word=word)
    limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30))
    memory = {} if is_sanitized(SPORE) else {"preexec_fn": limit}
    refused("run", zipped(good + [("zeros", bytes(70 << 20))]), word="unpacks to", **memory)
    refused("run", zipped(good + [(f"zeros{i}", bytes(35 << 20)) for i in range(2)]), word="unpacks to", **memory)
    assert call("run", zipped(good + [("zeros", bytes(35 << 20))]), "-n", 1, **memory).returncode == 0
    refused("run", zipped([("scene.spore", b" " * (65 << 20) + SCENE.encode())]), word="unpacks to", **memory)
    packed = bytearray(zipped(good).read_bytes())
    for mark, place in (b"PK\1\2", 24), (b"PK\3\4", 22): # a file that says it has 1 GB, and one that says it has a byte
        at = packed.rindex(mark)
        for size in (1 << 30, 1):
            changed = bytearray(packed)
            changed[at + place:at + place + 4] = struct.pack("<I", size)
            (FOLDER / "x.sporez").write_bytes(changed)
            refused("run", FOLDER / "x.sporez", word="x.sporez", **memory)


TEMPORARY.mkdir()
try:
    main()
finally:
    shutil.rmtree(FOLDER, ignore_errors=True)
