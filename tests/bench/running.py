"""Programs run for a benchmark, and what is left when it is interrupted."""
import os
import pathlib
import subprocess
import sys


def run(command):
    """Runs a program to its end and keeps what it prints. When we are interrupted the program is ended first."""
    words = [str(word) for word in command]
    with subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            out, err = process.communicate()
        except BaseException:
            process.terminate()
            process.wait()
            raise
    return subprocess.CompletedProcess(words, process.returncode, out, err)


def write_whole(path, text):
    """A file is there whole or not at all."""
    path = pathlib.Path(path)
    part = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        part.write_text(text)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)


def say(text):
    """Progress, and what is to be read beside the rows."""
    print(text, file=sys.stderr, flush=True)


def load():
    """What else the machine does, for figures that suffer from it."""
    return os.getloadavg()[0]
