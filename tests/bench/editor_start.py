#!/usr/bin/python3
"""editor_start.py EDITOR: seconds from the start of the editor to its first drawn frame, under a private Xvfb with llvmpipe.
The frame counts as drawn when the middle of the window, where the viewport is, holds more than one colour."""
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

SCENE = pathlib.Path(__file__).resolve().parent.parent.parent / "resources/scenes/laparoscopy.spore"


def start_display():
    read, write = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x800x24", "-nolisten", "tcp"],
                              pass_fds=[write], stderr=subprocess.DEVNULL)
    os.close(write)
    with os.fdopen(read) as pipe:
        return server, ":" + pipe.readline().strip()


def drawn(environment):
    """True when the viewport shows a picture: many colours about the middle of the screen."""
    shot = subprocess.run(["xwd", "-root", "-silent"], env=environment, capture_output=True)
    data = shot.stdout
    if shot.returncode or len(data) < 1280 * 800 * 4:
        return False
    pixels = data[-1280 * 800 * 4:]
    colours = {pixels[4 * (1280 * y + x):4 * (1280 * y + x) + 3] for y in range(300, 500, 4) for x in range(450, 800, 4)}
    return len(colours) > 50


def main():
    home = tempfile.mkdtemp(prefix="spore-start-")
    server, display = start_display()
    environment = {**os.environ, "DISPLAY": display, "HOME": home, "XDG_STATE_HOME": home, "XDG_CONFIG_HOME": home,
                   "XDG_CACHE_HOME": home, "GDK_BACKEND": "x11", "LIBGL_ALWAYS_SOFTWARE": "1", "NO_AT_BRIDGE": "1",
                   "GSETTINGS_BACKEND": "memory", "GTK_USE_PORTAL": "0", "GIO_USE_VFS": "local"}
    for name in ("WAYLAND_DISPLAY", "GTK_MODULES"):
        environment.pop(name, None)
    best = None
    try:
        for _ in range(4):  # the first start fills the caches of the file system
            begin = time.monotonic()
            editor = subprocess.Popen(["dbus-run-session", "--", sys.argv[1], str(SCENE)], env=environment,
                                      stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
            while not drawn(environment) and time.monotonic() - begin < 20:
                time.sleep(0.01)
            seconds = time.monotonic() - begin
            best = seconds if best is None else min(best, seconds)
            os.killpg(editor.pid, signal.SIGKILL)
            editor.wait()
            while drawn(environment):  # the window goes with the connection
                time.sleep(0.01)
    finally:
        server.terminate()
        shutil.rmtree(home, ignore_errors=True)
    print("%.3f" % best)


main()
