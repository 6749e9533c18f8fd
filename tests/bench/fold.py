"""Whether spheres that follow where a net bends pay: how deep a ball sinks between spheres that are spread evenly over a folded
net, or of which a part is moved into the fold, in the fold and where the net is flat, by bench_fold."""
import re
import subprocess

from table import row


def bench_fold(build, work):
    """A line a fold and part moved; the peer is the even spread."""
    done = subprocess.run([build / "tests/bench/bench_fold"], capture_output=True, text=True, check=True)
    even = {}
    for fold, moved, rest in re.findall(r"^ *(\d+) mm +\S+ mm +(\d+) %(.+)$", done.stdout, re.M):
        numbers = [float(number) for number in rest.split()]
        found = {"gap in the fold": numbers[2], "gap where it is flat": numbers[5]}
        if moved == "0":
            even[fold] = found
            continue
        for name, gap in found.items():
            yield row("fold", f"fold of {fold} mm, {moved} % moved: {name}, 95 % are less", gap, "mm", peer_name="even", peer=even[fold][name])


BENCHES = {"fold": bench_fold}
