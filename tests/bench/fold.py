"""Whether spheres that follow where a net bends pay: how deep a ball sinks between spheres that are spread evenly over a folded
net, or of which a part is moved into the fold, or more come there from a reserve, or more are spread evenly, in the fold and where
the net is flat, and what a step costs then, by bench_fold; and how sharply the nets of the scenes bend, by bench_bends."""
import pathlib
import re
import subprocess

from table import row


def bench_fold(build, work):
    """A line a fold and share of the spheres; the peer is the even spread, of a reserve the even spread of as many."""
    done = subprocess.run([build / "tests/bench/bench_fold"], capture_output=True, text=True, check=True)
    found = {}
    for fold, share, source, rest in re.findall(r"^ *(\d+) mm +\S+ mm +(\d+) % (\w+)(.+)$", done.stdout, re.M):
        numbers = [float(number) for number in rest.split()]
        found[fold, share, source] = {"gap in the fold, 95 % are less": (numbers[2], "mm"), "gap where it is flat, 95 % are less": (numbers[5], "mm"),
                                      "a step": (numbers[7], "us")}
    peers = {"moved": lambda fold, share: ("even", found[fold, "0", "moved"]), "reserve": lambda fold, share: ("as many, even", found[fold, share, "more"])}
    for (fold, share, source), figures in found.items():
        if share == "0" or source not in peers:
            continue
        peer_name, peer = peers[source](fold, share)
        for name, (value, unit) in figures.items():
            yield row("fold", f"fold of {fold} mm, {share} % {source}: {name}", value, unit, peer_name=peer_name, peer=peer[name][0])
    scenes = pathlib.Path(__file__).resolve().parents[2] / "resources/scenes"
    for scene, time in {"plate2-tissue": "8", "table1-mass-spring": "5", "bag": "8"}.items():
        done = subprocess.run([build / "tests/bench/bench_bends", scenes / f"{scene}.spore", time], capture_output=True, text=True, check=True)
        for line in done.stdout.splitlines():
            name, *_, sharpest, share = line.split()
            yield row("fold", f"{scene}, {name}: sharpest crease", float(sharpest), "degrees")
            yield row("fold", f"{scene}, {name}: creases above 60 degrees at once, most", float(share), "%")


BENCHES = {"fold": bench_fold}
