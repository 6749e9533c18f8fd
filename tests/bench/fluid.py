"""The Lennard-Jones liquid against LAMMPS: density 0.8442, temperature 1.44 at first, cut-off 2.5, skin 0.3, step 0.005, periodic,
one core, CPU time. Both are let go for a while first; errors are how far the energy of a particle strays from its mean."""
import math
import re
import shutil
import statistics
import subprocess

from peers import REPEATS, field
from table import row

CELLS = (4, 5, 8, 14)  # of the lattice, four particles each: 256, 500, 2048, 10976
SETTLE = 400
INPUT = """units lj
atom_style atomic
lattice fcc 0.8442
region box block 0 {cells} 0 {cells} 0 {cells}
create_box 1 box
create_atoms 1 box
mass 1 1
velocity all create 1.44 87287 loop geom
pair_style {style}
pair_coeff 1 1 1 1
neighbor 0.3 bin
neigh_modify delay 0 every 20 check no
fix 1 all nve
timestep 0.005
thermo_style custom step etotal
thermo_modify norm yes
thermo {every}
run {settle}
run {steps}
"""


def lammps(work, style, cells, steps):
    """CPU seconds a step, and how far the energy of a particle strays, root mean square."""
    every = max(1, steps // 20)
    text = INPUT.format(style=style, cells=cells, steps=steps, settle=SETTLE, every=every)
    (work / "fluid.in").write_text(text)
    done = subprocess.run(["lmp", "-log", "none", "-in", work / "fluid.in"], capture_output=True, text=True, check=True, cwd=work,
                          env={"OMP_NUM_THREADS": "1", "PATH": "/usr/bin:/bin", "OMPI_ALLOW_RUN_AS_ROOT": "1",
                               "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"})
    loops = re.findall(r"^Loop time of (\S+) .*\n(?:.*\n)*?(\S+)% CPU use", done.stdout, re.M)
    seconds, share = loops[-1]
    energies = [float(e) for step, e in re.findall(r"^ +(\d+) +(-?\d+\.\d+) *$", done.stdout, re.M) if int(step) >= SETTLE]
    return float(seconds) * float(share) / 100 / steps, statistics.pstdev(energies)


def bench_fluid(build, work):
    """The Lennard-Jones liquid against LAMMPS."""
    f = field(build, work)
    if not shutil.which("lmp"):
        return
    for cells in CELLS:
        steps = 200 * max(1, 2000 // cells ** 3)
        for name, style in (("LAMMPS", "lj/cut 2.5"), ("LAMMPS, force-shifted", "lj/smooth/linear 2.5")):
            times = {"ours": [], "peer": []}
            for _ in range(REPEATS):
                seconds, astray = lammps(work, style, cells, steps)
                mine = f.ours.run("fluid", cells=cells, steps=steps, time=0.005 * steps, settle=SETTLE,
                                  frames=20)
                times["peer"].append(seconds)
                times["ours"].append(mine["cpu_s"] / steps)
            pairs = 4 * cells ** 3 * 0.8442 * 4 / 3 * math.pi * 2.8 ** 3 / 2  # within cut-off and skin, of 30 operations each
            yield row("fluid", f"{4 * cells ** 3} particles", 1e6 * statistics.median(times["ours"]), "us", floor=1e6 * f.seconds(pairs * 30),
                      peer_name=name, peer=1e6 * statistics.median(times["peer"]), error_ours=mine["astray"] / (4 * cells ** 3), error_peer=astray, least=2)


BENCHES = {"fluid": bench_fluid}
