#!/usr/bin/python3
"""Scenes exported for other programs. test_export.py SPORE PLAYER SCENES"""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from tap import Skip, check, is_sanitized, main, wait_for_work

SPORE, PLAYER, SCENES = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2]), pathlib.Path(sys.argv[3])
FOLDER = pathlib.Path(tempfile.mkdtemp(prefix="spore-export-"))
STEPS = 40


def run(*command, status=0):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=250)
    assert done.returncode == status, (command, done.returncode, done.stdout[-500:], done.stderr[-500:])
    return done.stderr if status == 2 else done.stdout


def export(scene, *options, status=0):
    file = FOLDER / (pathlib.Path(scene).stem + ".run")
    said = run(SPORE, "export", scene, "--format", "runtime", "-o", file, *options, status=status)
    return file, said


def state(*command):
    done = subprocess.run([str(word) for word in command] + ["--json"], capture_output=True, text=True, timeout=250)
    assert done.returncode in (0, 1), (command, done.stderr)
    return json.loads(done.stdout)


@check
def every_shipped_scene_plays(*_):
    """Every shipped scene, written as a runtime file, plays to the same bits"""
    scenes = sorted(SCENES.glob("*.spore"))
    for scene in scenes[::4] if is_sanitized(SPORE) else scenes:
        file, said = export(scene, "--json")
        report = json.loads(said)
        assert not any("exercise" in words for words in report["lost"]), scene
        assert report["written"] == [{"file": str(file), "bytes": file.stat().st_size}] and report["left_out"]
        played, alone = state(PLAYER, file, "--steps", STEPS), state(SPORE, "run", scene, "-n", STEPS)
        assert played["state_hash"] == alone["state_hash"] and played.get("exercise") == alone.get("exercise"), scene
        assert ("exercise" in played) == ("<exercise " in scene.read_text()), scene
        assert played["steps"] == STEPS and played["bodies"]
        file.unlink()


@check
def an_exercise_comes_to_the_same_end(*_):
    """An exercise that goes on from step to step comes to the same events, metrics and score"""
    scene, steps = SCENES / "exercise-peg-transfer.spore", 4100
    file, _ = export(scene)
    played, alone = state(PLAYER, file, "--steps", steps), state(SPORE, "run", scene, "-n", steps)
    assert played["exercise"] == alone["exercise"] and sum(s["phase"] == "done" for s in played["exercise"]["steps"]) == 4, played
    said = run(PLAYER, file, "--steps", 1500)
    assert "2 of 48 steps done" in said and "step take_1: done at" in said and "step pass_1: not done" in said, said


@check
def settings_and_input_come_along(*_):
    """Settings, another step and another input come along"""
    scene = SCENES / "plate1-ovary.spore"
    options = ["--set", "environment/gravity=0 -5 0", "--dt", "0.002", "--integrator", "bdf2", "--input", SCENES / "plate4-deformed-ovary" / "plate4-deformed-ovary.track"]
    file, _ = export(scene, *options)
    assert state(PLAYER, file, "--steps", STEPS)["state_hash"] == state(SPORE, "run", scene, "-n", STEPS, *options)["state_hash"]
    clips = ["--set", "tools/left_clamp/fidelity/mode=effect"]
    clamped = SCENES / "exercise-clip-and-cut.spore"
    clipped, _ = export(clamped, *clips)
    held = state(SPORE, "run", clamped, "-n", 500, *clips)
    assert held["tools"][0]["held"] > 0 and held["tools"][0]["squeeze_Nm"] == 0, held["tools"]
    assert state(PLAYER, clipped, "--steps", 500)["state_hash"] == held["state_hash"] != state(SPORE, "run", clamped, "-n", 500)["state_hash"]
    shutil.copytree(SCENES / "minimal", FOLDER / "minimal")
    rinsed = shutil.copy(SCENES / "minimal.spore", FOLDER / "minimal.spore")
    run(SPORE, "edit", rinsed, "--instrument", "irrigator:jet")
    run(SPORE, "edit", rinsed, "--set", "effects/jet_irrigation/trigger=always", "--set", "solver/time_step=0.004")
    washed, _ = export(rinsed)
    wet = state(SPORE, "run", rinsed, "-n", STEPS)
    assert state(PLAYER, washed, "--steps", STEPS)["state_hash"] == wet["state_hash"] and wet["fluids"][0]["poured_ml"] > 2
    washed.unlink()
    names = state(PLAYER, file, "--steps", 0)
    assert "ovary_right" in names["bodies"] and any(visual["body"] == "ovary_right" and visual["vertices"] > 100 for visual in names["visuals"])


@check
def a_folder_with_a_player_runs_on_a_bare_system(*_):
    """A folder with the player holds all that its run needs: it comes to the same bits, wherever it lies, with the C library alone"""
    if is_sanitized(SPORE):
        raise Skip("a sanitizer's program needs more libraries")
    scene, bare = SCENES / "exercise-peg-transfer.spore", FOLDER / "bare"
    report = json.loads(run(SPORE, "export", scene, "--format", "player", "-o", FOLDER / "given", "--json"))
    written = {pathlib.Path(one["file"]) for one in report["written"]}
    assert written == {FOLDER / "given" / name for name in ("play", "spore-player", "scene.run", "README.txt")}
    assert all(pathlib.Path(one["file"]).stat().st_size == one["bytes"] for one in report["written"]) and report["lost"]
    expected = state(SPORE, "run", scene, "-n", STEPS)
    (bare / "elsewhere").mkdir(parents=True)
    moved = (FOLDER / "given").rename(bare / "elsewhere" / "a b")
    assert state(moved / "play", "--steps", STEPS)["state_hash"] == expected["state_hash"]
    libraries = [line.split("=>")[-1].split()[0] for line in run("ldd", moved / "spore-player").splitlines() if "/" in line]
    assert {pathlib.Path(name).name.split(".")[0].split("-")[0] for name in libraries} == {"libc", "libm", "ld"}, libraries
    if os.geteuid() == 0:  # a system with nothing else
        for library in libraries:
            (bare / library[1:]).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(library, bare / library[1:])
        said = subprocess.run(["/elsewhere/a b/spore-player", "/elsewhere/a b/scene.run", "--steps", str(STEPS), "--json"], capture_output=True,
                              check=True, env={}, cwd="/", preexec_fn=lambda: os.chroot(bare))
        assert json.loads(said.stdout)["state_hash"] == expected["state_hash"]


@check
def a_folder_of_ones_own_is_left_alone(*_):
    """A folder that holds something, a file, and a spore without its player are refused, and nothing is written"""
    scene, own = SCENES / "minimal.spore", FOLDER / "own"
    own.mkdir()
    run(SPORE, "export", scene, "--format", "player", "-o", own)
    (own / "mine").write_text("x")
    for taken in (own, own / "mine"):
        assert "already" in run(SPORE, "export", scene, "--format", "player", "-o", taken, status=2)
    assert len(list(own.iterdir())) == 5 and (own / "mine").read_text() == "x"
    alone = FOLDER / "spore"
    shutil.copy(SPORE, alone)
    if os.access("/usr/local/libexec/spore/spore-player", os.X_OK):
        raise Skip("a player is installed")
    said = run(alone, "export", scene, "--format", "player", "-o", FOLDER / "none", status=2)
    assert "spore-player is not there" in said and said.count("\n") == 1 and not (FOLDER / "none").exists()


@check
def bad_input(*_):
    """Bad input: one line, status 2, and nothing is written"""
    scene = SCENES / "minimal.spore"
    for options, word in [([], "--format"), (["--format", "nope", "-o", FOLDER / "f"], "nope"), (["--format", "runtime"], "-o"),
                          (["--format", "runtime", "-o", FOLDER / "none" / "f"], "none"), (["--format", "runtime", "-o", scene], "this is the input")]:
        said = run(SPORE, "export", scene, *options, status=2)
        assert word in said and said.count("\n") == 1, said
    assert not (FOLDER / "f").exists()
    assert "gone" in run(SPORE, "export", FOLDER / "gone.spore", "--format", "runtime", "-o", FOLDER / "f", status=2)
    file, _ = export(scene)
    for arguments, word in [([], "no file"), ([FOLDER / "gone"], "cannot be read"), ([file, "--steps", "x"], "--steps"), ([file, "--nope"], "--nope"),
                            ([scene], "no runtime file"), ([file, file], "more than one")]:
        said = run(PLAYER, *arguments, status=2)
        assert word in said and said.count("\n") == 1, said
    content = bytearray(file.read_bytes())
    content[len(content) // 2] ^= 1
    file.write_bytes(content)
    assert "checksum" in run(PLAYER, file, status=2)
    file.write_bytes(content[:1000])
    assert "copy it again" in run(PLAYER, file, status=2)


@check
def the_player_ends_on_signals(*_):
    """Ctrl-C and SIGTERM end the player"""
    file, _ = export(SCENES / "plate4-deformed-ovary.spore")
    for number in (signal.SIGINT, signal.SIGTERM):
        process = subprocess.Popen([PLAYER, file, "--steps", "1000000000"], stdout=subprocess.DEVNULL)
        wait_for_work(process)
        process.send_signal(number)
        assert process.wait(timeout=60) == 130


try:
    main()
finally:
    shutil.rmtree(FOLDER, ignore_errors=True)
