"""Every sentence that `spore check`, `spore plan` and the register of unsolved steps can print, each with a scene that
makes the program print it and one, as near to the first as may be, that must not.

A row is (command, message, remedies, printed by, not printed by). Messages and remedies are the texts of the source;
a conversion like %s stands for anything, numbers for any number. A scene is its text, or a pair of the text (or the
name of a shipped scene) and options of the command. None: no scene is without the sentence."""

import math

CORNERS = [(x, y, z) for z in (-.05, .05) for x, y in ((-.05, -.05), (.05, -.05), (.05, .05), (-.05, .05))]
FACES = "032 021 456 467 015 054 237 276 126 165 047 073".split()


def off(corners, faces):
    return (f"OFF\n{len(corners)} {len(faces)} 0\n" + "".join("%g %g %g\n" % c for c in corners) +
            "".join("3 %s %s %s\n" % tuple(f) for f in faces))


def cells(cubes):
    """Medit text of cubes of five tetrahedra, each moved by a vector."""
    tetrahedra = (0, 1, 2, 5), (0, 2, 3, 7), (0, 5, 7, 4), (2, 7, 5, 6), (0, 2, 7, 5)
    points = [tuple(c[k] + by[k] for k in range(3)) for by in cubes for c in CORNERS]
    return (f"MeshVersionFormatted 2\nDimension 3\nVertices {len(points)}\n" + "".join("%g %g %g 0\n" % p for p in points) +
            f"Tetrahedra {5 * len(cubes)}\n" + "".join("%d %d %d %d 0\n" % tuple(8 * b + i + 1 for i in t)
                                                     for b in range(len(cubes)) for t in tetrahedra) + "End\n")


def grid(count, size, at=lambda x, z: (x, 0, z)):
    points = [at(size * x / count, size * z / count) for x in range(count + 1) for z in range(count + 1)]
    n = count + 1
    return (f"OFF\n{len(points)} {2 * count * count} 0\n" + "".join("%g %g %g\n" % p for p in points) + "".join(
        f"3 {a} {a + 1} {a + n + 1}\n3 {a} {a + n + 1} {a + n}\n" for x in range(count) for z in range(count) for a in [n * x + z]))


def fold(gap):
    """A thread of 2 mm radius that runs 10 cm along x and, in an arc, back above itself."""
    arc = [(.1 + gap / 2 * math.sin(math.pi * i / 8), gap / 2 - gap / 2 * math.cos(math.pi * i / 8)) for i in range(9)]
    points = [(.01 * i, 0) for i in range(10)] + arc + [(.1 - .01 * i, gap) for i in range(1, 11)]
    return "".join(f"{x:.5f} {y:.5f} 0 0.002\n" for x, y in points)


FILES = {
    "cube.off": off(CORNERS, FACES),
    "box.off": off([(3 * x, 2 * y, z) for x, y, z in CORNERS], FACES),
    "slant.off": off([(2 * x, 1.6 * y - 0.12 * z, 1.2 * y + 0.16 * z) for x, y, z in CORNERS], FACES),
    "web.off": grid(20, 1, lambda x, z: (0.034 * x, 0.012 * z - 0.002, 0)),
    "hair.off": off([(0.02 + 0.5 * x, 0.004 + 0.2 * y, 0.12 * z) for x, y, z in CORNERS], FACES),
    "tube.off": off([(0.05 + 0.98 * x, 0.02 * y, 0.02 * z) for x, y, z in CORNERS], FACES),
    "open.off": off(CORNERS, FACES[:10]),
    "inside.off": off(CORNERS, [f[::-1] for f in FACES]),
    "vast.off": off([(1e10 * x, 1e10 * y, 1e10 * z) for x, y, z in CORNERS], FACES),
    "large.off": off([(2000 * x, 2000 * y, 2000 * z) for x, y, z in CORNERS], FACES),
    "wide.off": off([(-.1, -.1, -.1), (.1, .1, -.1), (.1, -.1, .1), (-.1, .1, .1)], "012 031 023 132".split()),
    "sheet.off": grid(6, 0.1),
    "loose.off": grid(3, 0.1),
    "cube.mesh": cells([(0, 0, 0)]),
    "two.mesh": cells([(0, 0, 0), (0.3, 0, 0)]),
    "flat.mesh": "MeshVersionFormatted 2\nDimension 3\nVertices 4\n0 0 0 0\n.1 0 0 0\n0 0 .1 0\n.03 .001 .03 0\n"
                 "Tetrahedra 1\n1 3 2 4 0\nEnd\n",
    "ball.spheres": "0 0 0 0.05\n",
    "led.pose": "spore-pose 1\nof cbf29ce484222325\nat 1 0 0 1 0 0 0\nnumbers 7\n1.1\n0\n0\n1\n0\n0\n0\n",
    "four.spheres": "".join(f"{x} 0 {z} 0.05\n" for x in (-.04, .04) for z in (-.04, .04)),
    "knots.spheres": "".join(f"{x / 60} 0 {z / 60} 0.009\n" for x in range(7) for z in range(7)),
    "drop.off": off([(.3 * x, .3 * y, .3 * z) for x, y, z in CORNERS], FACES),
    "floor.spheres": "0 -1000 0 1000\n",
    "felt.spheres": "# level 0.025\n0 0 0 0.1 0.5\n",
    "away.spheres": "0 0 0 0.05\n0.3 0 0 0.05\n",
    "far.spheres": "0 0 0 0.05\n0.8 0 0.8 0.05\n",
    "line.curve": "".join(f"{i / 200} 0 0 0.001\n" for i in range(21)),
    "fold.curve": fold(.03),
    "flat.curve": fold(.0015),
    "bent.curve": "".join(f"{x} {y} 0 0.004\n" for x, y in ((0, 0), (.03, 0), (.034, .002), (.034, .006), (.03, .008), (0, .008))),
}

ASSETS = '<mesh name="cube" file="cube.off"/><spheres name="ball" file="ball.spheres"/>'
CELLS = '<tetrahedra name="cells" file="cube.mesh"/>'
SHEET = '<mesh name="sheet" file="sheet.off"/>'
LINE = '<curve name="line" file="line.curve"/>'
BALL = '<collision spheres="ball"/>'
STONE = '<mechanical geometry="cube"><rigid_body/></mechanical>'
NET = '<mechanical geometry="sheet"><mass_spring_net/></mechanical>'
SOFT = '<mechanical geometry="cells"><neo_hookean_tetrahedra/></mechanical>'
FLUID = '<mechanical geometry="cube"><lennard_jones particles="60"/></mechanical>'
SMOKE = '<mechanical geometry="cube"><smoke particles="20"/></mechanical>'
EFFECT = '<fidelity mode="effect"/>'
CORD = '<spring name="cord" body_a="stone" stiffness="100"/>'
PROBE = '<probe name="t" body="tool" device="m"/>'
MOUSE = '<mouse name="m"/>'


def scene(*bodies, links="", tools="", devices="", effects="", exercise="", assets=ASSETS, solver="", environment=""):
    parts = "".join(f"<{name}>{content}</{name}>" for name, content in
                    (("assets", assets), ("bodies", "".join(bodies)), ("links", links), ("tools", tools),
                     ("devices", devices), ("effects", effects), ("exercise", exercise)) if content)
    return f'<spore version="1.0"><environment {environment}/><solver {solver}/>{parts}</spore>\n'


def body(name, *units, **attributes):
    return f'<body name="{name}"' + "".join(f' {k}="{v}"' for k, v in attributes.items()) + f'>{"".join(units)}</body>'


def floor(*units, **attributes):
    return body("floor", *(units or [BALL]), **{"role": "unmovable", "position": "0 -0.1 0", **attributes})


def stone(*units, **attributes):
    return body("stone", *(units or [STONE, BALL]), **attributes)


def tool(*units, **attributes):
    return body("tool", *(units or [BALL]), **{"role": "active", "position": "1 0 0", **attributes})


def net(*units, **attributes):
    return body("net", *(units or [NET]), **attributes)


def line(points, *units, model="", links="", **rest):
    return scene(body("b", f'<mechanical geometry="line"><spline_1d control_points="{points}" {model}/></mechanical>', *units),
                 assets=LINE, links=links, **rest)


def pinned(points, radius, x="0"):
    return line(points, links=f'<pin name="p" body="b" point="{x} 0 0" radius="{radius}"/>')


def organ(units, *, solver='integrator="implicit_euler"', role="passive", assets="", collision=BALL, **rest):
    return scene(floor(), body("organ", f'<mechanical geometry="cells">{units}</mechanical>', collision, role=role),
                 assets=ASSETS + CELLS + assets, solver=solver, **rest)


def folded(curve, unit):
    """The lower leg is held, and the upper one falls on it."""
    return scene(floor(position="0 -1 0"), body(
        "b", '<mechanical geometry="fold"><spline_1d control_points="40" young_modulus="3e3" damping="0.05"/></mechanical>',
        f"<collision {unit}/>"), assets=ASSETS + f'<curve name="fold" file="{curve}"/>',
        links="".join(f'<pin name="p{i}" body="b" point="{.025 * i:g} 0 0" radius="0.014"/>' for i in range(5)))


def through(step, port):
    """A probe that stands upright in a port, 0.1 m below it, and a step of an exercise."""
    x, y, z = map(float, port.split())
    shown = stone(STONE, BALL, '<visual mesh="cube"/>')
    return scene(shown, tool(position=f"{x} {y - 0.1} {z}"), tools=PROBE, devices=MOUSE, exercise=step,
                 links=f'<port name="p" body_a="tool" point="{port}" direction="0 1 0"/>')


GOOD = scene(floor(), stone())
WORN = scene(stone(STONE, BALL, '<visual mesh="cube" texture="a" texture_places="a"/>'))
HINGES = dict(hinge="0.06 0 0", axis="0 0 1")
JAWS = [body(name, BALL, role="active", position="1 0 0") for name in ("left", "right")]


def instrument(kind, *bodies, more="", spheres=BALL, assets=ASSETS + SHEET + CELLS, **rest):
    return scene(*bodies, tool(spheres), *JAWS, assets=assets, devices=MOUSE,
                 tools=f'<{kind} name="t" body="tool" device="m" {more}/>', **rest)


def kept_jaws(x):
    """A grasper whose jaws, kept at 1.1, are about the stone or not."""
    kept = [body(name, BALL, role="active", position="1 0 0", kept_pose="led.pose") for name in ("left", "right")]
    return scene(stone(position=f"{x} 0 0"), tool(), *kept, devices=MOUSE,
                 tools='<grasper name="t" body="tool" device="m" jaw_a="left" jaw_b="right" hinge="1 0 0" axis="0 0 1"/>')


def jaws(kind, *bodies, left='jaw_a="left"', **rest):
    return instrument(kind, *bodies, more=f'{left} jaw_b="right" hinge="1 0 0" axis="0 0 1"' +
                      (' tip="1.05 0 0"' if kind == "scissors" else ""), **rest)


def clip(fidelity):
    """A clamp, a clip where that is its fidelity."""
    return jaws("clamp", stone()).replace('axis="0 0 1"/>', f'axis="0 0 1">{fidelity}</clamp>')


def seeping(source, stain, fidelity=EFFECT):
    fluid = f'<mechanical geometry="cube"><lennard_jones particles="60" stain="{stain}"/></mechanical>'
    return scene(floor(), stone(fluid, position="0 1 0"),
                 effects=f'<emitter name="e" body="stone" reserve="5" {source}>{fidelity}</emitter>')


THREAD = body("b", '<mechanical geometry="line"><spline_1d/></mechanical>', position="1.02 0 0")


def needle(*bodies, thread="", **rest):
    return instrument("needle", *bodies, assets=ASSETS + SHEET + CELLS + LINE, more=f'tip="1 0 0" middle="1.01 0 0" swage="1.02 0 0" {thread}', **rest)


def hung(stiffness, **solver):
    return scene(stone(), links=f'<spring name="s" body_a="stone" point_a="0 0 0" point_b="0 0.1 0" stiffness="{stiffness}" damping="1"/>',
                 solver=" ".join(f'{k}="{v}"' for k, v in solver.items()))


def spheres_for(file, *bodies, assets="", **rest):
    return scene(*bodies, assets='<mesh name="cube" file="cube.off"/>' + f'<spheres name="ball" file="{file}"/>' + CELLS + assets, **rest)


def felt(*bodies):
    return scene(*bodies, assets=ASSETS + SHEET + '<spheres name="felt" file="felt.spheres"/>')


def fast(speed, collision='<collision spheres="ball" stiffness="2000" damping="0"/>', gravity="0 0 0"):
    return scene(floor(position="0 -0.5 0"), stone(STONE, collision, velocity=f"0 {-speed} 0"), environment=f'gravity="{gravity}"')


def dropped(file, speed):
    """A stone that comes at the speed onto a flat floor, with the spheres of the file: one or four."""
    felt = '<collision spheres="%s" stiffness="4000" damping="0"/>'
    return scene(body("floor", felt % "flat", role="unmovable"), stone(STONE, felt % "ball", position="0 0.06 0", velocity=f"0 {-speed} 0"),
                 assets=f'<mesh name="cube" file="cube.off"/><spheres name="ball" file="{file}"/><spheres name="flat" file="floor.spheres"/>',
                 environment='gravity="0 0 0"', solver='time_step="0.001"')


def generated(more):
    return scene(floor(), stone(), assets='<mesh name="cube" file="cube.off"/>'
                 f'<spheres name="ball" file="ball.spheres" source="cube" {more}/>')


def drawn(curve, mesh, model="control_points=\"12\""):
    return scene(body("b", f'<mechanical geometry="line"><spline_1d {model}/></mechanical>', '<visual mesh="drawn"/>'),
                 assets=f'<curve name="line" file="{curve}"/><mesh name="drawn" file="{mesh}"/>')


def grid_of(cells):
    return scene(body("b", f'<mechanical geometry="m"><finite_differences cells="{cells}"/></mechanical>'), assets='<mesh name="m" file="slant.off"/>')


def bent(model):
    return scene(body("b", f'<mechanical geometry="line"><spline_1d control_points="12" {model}/></mechanical>'),
                 assets='<curve name="line" file="bent.curve"/>')


def sheet_of(points):
    return scene(body("sheet", f'<mechanical geometry="sheet"><spline_2d control_points_u="{points}" control_points_v="{points}"/></mechanical>'),
                 assets=SHEET, solver='time_step="0.002" integrator="implicit_euler"')


def pinned_sheet(points, radius, x="0"):
    return scene(body("sheet", f'<mechanical geometry="sheet"><spline_2d control_points_u="{points}" control_points_v="{points}"/></mechanical>'),
                 assets=SHEET, links=f'<pin name="p" body="sheet" point="{x} 0 0.05" radius="{radius}"/>')


def pendulum(method):
    return scene(stone(STONE), links='<ball name="j" body_a="stone" point="0.03 0.2 0"/>', solver=f'time_step="0.004" integrator="{method}"')


def levelled(rule, levels='<coarse settings="cells=3"/>', **rest):
    return scene(body("b", '<mechanical geometry="cube"><finite_differences cells="6"/></mechanical>', f"<fidelity {rule}>{levels}</fidelity>"), **rest)


def torn(strain):
    return scene(net(f'<mechanical geometry="sheet"><mass_spring_net tear_strain="{strain}"/></mechanical>',
                     '<fidelity automatic="error"><coarse geometry="loose"/></fidelity>'), assets=SHEET + '<mesh name="loose" file="loose.off"/>')


STALE = generated('source_hash="{cube}" options_hash="0000000000000000"')


CHECK = [
    ("%s=\"%s\" names nothing; expected the name of a %s", ["correct the name, or add what it names"],
     scene(stone(STONE, '<collision spheres="bal"/>'), floor()), GOOD),
    ("\"%s\" is passive, but has no mechanical model that moves it", ["choose a mechanical model, or make the role unmovable"],
     scene(floor(), stone(BALL)), scene(floor(), stone(BALL, role="unmovable", position="0 1 0"))),
    ("the mechanical model of \"%s\" is not used: its role is %s", ["make the role passive, or remove the model"],
     scene(floor(STONE, BALL)), GOOD),
    ("\"%s\" has no collision spheres: bodies pass through it",
     ["generate spheres and name them in its collision unit, if it should be felt"],
     scene(floor(), stone(STONE)), scene(floor(), stone(FLUID, '<collision/>'))),
    ("\"%s\" is active, but no tool moves it", ["add a tool that names it, with a device"],
     scene(tool()), scene(tool(), tools=PROBE, devices=MOUSE)),
    ("the name \"%s\" is a guess: it stands at its label's number in a common set",
     ["see whether it is that; rename it if not; then set name_guessed to false"],
     scene(floor(), stone(STONE, BALL, name_guessed="true")), scene(floor(), stone(STONE, BALL, name_guessed="false"))),
    ("\"%s\" is to be an effect, and physics does not move it anyway", ["make the mode physical, or the role passive"],
     scene(floor(BALL, EFFECT)), scene(floor(), stone(STONE, BALL, EFFECT))),
    ("\"%s\" is an effect, so that it does not give way to the link \"%s\"", ["make the mode physical, or take the link away"],
     scene(stone(STONE, EFFECT), links=CORD), scene(stone(STONE), links=CORD)),
    ("\"%s\" is to be what was advised, and nothing was: it is physical", ["ask spore advise, with --apply"],
     scene(stone(STONE, '<fidelity mode="auto"/>')), scene(stone(STONE, '<fidelity mode="auto" advice_hash="0"/>'))),
    ("\"%s\" was advised on before the scene changed: it is physical", ["ask spore advise again, with --apply"],
     scene(stone(STONE, '<fidelity mode="auto" advice="effect" advice_hash="0"/>')), scene(stone(STONE, '<fidelity mode="auto"/>'))),
    ("\"%s\" is to change its level by itself, and has but one", ["add <coarse> or <medium> to its fidelity"],
     levelled('automatic="error"', levels=""), levelled('automatic="error"')),
    ("the level of \"%s\" goes by distance, and nothing counts that could be near: it stays at its coarsest level",
     ["add an instrument or a camera, or make the distance larger than 0"],
     levelled('automatic="distance"'), levelled('automatic="distance" view_distance="0.1"', tools='<camera name="c"/>')),
    ("the level of \"%s\" does not get coarser by itself: it may be cut or torn, at level fine alone",
     ["let its level go by distance, or nothing, if it should stay fine"], torn(0.5), torn(0)),
    ("the tool \"%s\" moves \"%s\", which is not active", ["make its role active, or choose another body"],
     scene(floor(), stone(), tools='<probe name="t" body="stone" device="m"/>', devices=MOUSE),
     scene(tool(), tools=PROBE, devices=MOUSE)),
    ("the tool \"%s\" has no %s", ["add an active body for the jaw and name it"],
     jaws("grasper", net(), left=""), jaws("grasper", net())),
    ("the tool \"%s\" has no body", ["name an active body"],
     scene(tool(), tools='<probe name="t" device="m"/>', devices=MOUSE), scene(tool(), tools=PROBE, devices=MOUSE)),
    ("the tool \"%s\" has no device: nothing moves it", ["name a mouse or a track"],
     scene(tool(), tools='<probe name="t" body="tool"/>'), scene(tool(), tools=PROBE, devices=MOUSE)),
    ("nothing is seen of \"%s\" as an effect: it has no organ as its source, or its fluid stains nothing",
     ["make the mode physical, and the fluid an effect if that is enough"], seeping("", 10), seeping('source="floor"', 10)),
    ("nothing is seen of \"%s\" as an effect: it has no organ as its source, or its fluid stains nothing", [], seeping('source="floor"', 0),
     seeping('source="floor"', 10, fidelity="")),
    ("nothing comes out of the emitter \"%s\": it has no body", ["name a fluid of particles, or remove the emitter"],
     scene(stone(FLUID), effects='<emitter name="e"/>'),
     scene(stone(FLUID), effects='<emitter name="e" body="stone" reserve="5"/>')),
    ("\"%s\" passes through \"%s\", whose stiffness is that of the whole",
     ["make it neo_hookean_tetrahedra, if it should be cut; nothing is to be done if not"],
     jaws("scissors", net('<mechanical geometry="cells"><linear_tetrahedra/></mechanical>')), jaws("scissors", net(SOFT))),
    ("\"%s\" reaches nothing of \"%s\" through its port \"%s\"",
     ["move the port: drag it in the view with the Edit tool, or by spore edit --port"],
     through('<touched name="g" body="stone"/>', "0 0.5 0"), through('<touched name="g" body="stone"/>', "0 0.25 0")),
    ("\"%s\" does not get to the place of the step \"%s\" through its port \"%s\"",
     ["move the port: drag it in the view with the Edit tool, or by spore edit --port"],
     through('<reached name="g" point="0.2 0.1 0"/>', "0 0.25 0"), through('<reached name="g" point="0.13 0.1 0"/>', "0 0.25 0")),
    ("no tool of the scene can do the step \"%s\"", ["add a tool that can, or remove the step"],
     scene(stone(), tool(), tools=PROBE, devices=MOUSE, exercise='<grasped name="g" body="stone"/>'),
     scene(stone(), tool(), tools=PROBE, devices=MOUSE, exercise='<touched name="g" body="stone"/>')),
    ("\"%s\" has nothing to work on: no body has a model that can be cut",
     ["make what is to be cut a mass_spring_net or neo_hookean_tetrahedra, or the tool a grasper"],
     jaws("scissors", net(role="unmovable")), jaws("scissors", net())),
    ("\"%s\" has nothing to work on: no body has a model that can be coagulated",
     ["make what is to be coagulated a mass_spring_net or neo_hookean_tetrahedra, or the tool a grasper"],
     instrument("bipolar", stone()), instrument("bipolar", net())),
    ("\"%s\" has nothing to work on: no body has a model that can be pierced",
     ["make what is to be sewn a mass_spring_net, a deformable_surface or neo_hookean_tetrahedra"],
     needle(net('<mechanical geometry="cells"><linear_tetrahedra/></mechanical>')), needle(net(SOFT))),
    ("\"%s\" draws no thread: what it has pierced comes off behind it", ["name a body along a curve that begins at its swage"],
     needle(net()), needle(net(), THREAD, thread='thread="b"')),
    ("the spheres of \"%s\" keep \"%s\" from what it is to pierce: its tip needs none to feel it",
     ["take the spheres away, or put both bodies in one group"],
     needle(net(NET, BALL)), needle(net(NET, '<collision spheres="ball" group="1"/>'), spheres='<collision spheres="ball" group="1"/>')),
    ("\"%s\" has nothing to take away: the scene has no fluid of particles", ["add a fluid, or make it a probe"],
     instrument("suction", stone()), instrument("suction", stone(FLUID))),
    ("the scene has no bodies", ["import a mesh, or add a body"], scene(assets=""), scene(floor())),

    ("\"%s\" is %s across", ["if it is an organ or a tool, its unit is wrong: %s"],
     scene(floor('<visual mesh="m"/>'), assets='<mesh name="m" file="large.off"/>'), GOOD),
    ("\"%s\" is %s across", ["no unit of length would make it an organ: look at the file"],
     scene(floor('<visual mesh="m"/>'), assets='<mesh name="m" file="vast.off"/>'), GOOD),
    ("\"%s\" is %s across", ["in %s it would be %s across"],
     scene(floor('<visual mesh="m"/>'), assets='<mesh name="m" file="cube.off" unit="um"/>'), GOOD),
    ("\"%s\" faces inward in its file, wholly or in part: its triangles are turned outward", ["nothing, or export it again, facing outward"],
     scene(floor('<visual mesh="m"/>'), assets='<mesh name="m" file="inside.off"/>'), GOOD),
    ("\"%s\" is not a closed surface: %zu open, %zu non-manifold and %zu misoriented edges",
     ["tetrahedra can still be generated: the surface is repaired or wrapped then"],
     scene(floor(), assets=SHEET + '<spheres name="ball" file="ball.spheres" source="sheet"/>'), scene(net(), assets=SHEET)),
    ("\"%s\" is in %zu pieces that share no node: those that nothing holds move by themselves",
     ["pin each of them, or tie them together"],
     scene(body("organ", SOFT), assets='<tetrahedra name="cells" file="two.mesh"/>'), organ("<neo_hookean_tetrahedra/>")),
    ("\"%s\" is in %zu pieces that share no node: those that nothing holds move by themselves", ["generate them again with more cells"],
     scene(body("organ", SOFT), assets='<mesh name="cube" file="cube.off"/><tetrahedra name="cells" file="two.mesh" source="cube"/>'),
     scene(body("organ", SOFT), assets='<mesh name="cube" file="cube.off"/><tetrahedra name="cells" file="cube.mesh" source="cube"/>')),
    ("\"%s\" has slivers: the flattest tetrahedron has an angle of %.2g degrees; expected over %g",
     ["generate them again with another number of cells"],
     scene(body("organ", SOFT), assets='<tetrahedra name="cells" file="flat.mesh"/>'), organ("<neo_hookean_tetrahedra/>")),
    ("\"%s\" is stale: \"%s\", which it was made from, has changed", ["generate it again"],
     generated('source_hash="0000000000000000"'), generated("")),
    ("\"%s\" is stale: \"%s\", which it was made from, has changed", ["nothing, or take \"frozen\" away and generate it again"],
     generated('source_hash="0000000000000000" frozen="true"'), generated('frozen="true"')),
    ("\"%s\" is stale: its options have changed since it was made", ["generate it again"],
     STALE, generated('source_hash="{cube}"')),
    ("the kept pose of \"%s\" is of another shape or model: it begins as its geometry says",
     ["play and keep the pose again, or take kept_pose out"],
     scene(stone(kept_pose="led.pose")), scene(tool(kept_pose="led.pose"), tools=PROBE, devices=MOUSE)),
    ("\"%s\" has its jaws about \"%s\" as they were kept, and holds it only when its device closes them",
     ["close them at the start, or let a link hold it"], kept_jaws("1.1"), kept_jaws("1.3")),
    ("\"%s\" has a kept pose, and does not move", ["take kept_pose out, or make it movable"],
     scene(floor(kept_pose="led.pose")), scene(floor(), stone(kept_pose="led.pose"))),
    ("\"%s\" has places in a texture, and no texture", ["name a texture, or remove texture_places"],
     scene(stone(STONE, BALL, '<visual mesh="cube" texture_places="a"/>')),
     WORN),
    ("nothing uses the %s \"%s\"", ["remove it, or name it in a body"],
     scene(floor(), stone(), assets=ASSETS + CELLS), GOOD),

    ("the link \"%s\" has no %s", ["name a body, or remove the link"],
     scene(floor(), stone(), links='<pin name="p"/>'), scene(floor(), stone(), links='<pin name="p" body="stone" radius="1"/>')),
    ("\"%s\" and the links before it hold %u of the 6 ways in which \"%s\" can move: how much each of them bears is not determined",
     ["remove one of the links, or choose kinds that hold less"],
     scene(floor(), stone(), links='<weld name="w" body_a="stone"/><ball name="h" body_a="stone"/>'),
     scene(floor(), stone(), links='<ball name="w" body_a="stone"/><ball name="h" body_a="stone" point="0.04 0 0"/>')),
    ("\"%s\" ties \"%s\" at a point that is %s outside it, while it is %s across: what is between them counts as stiff",
     ["move its point to the body, or choose another body"],
     scene(floor(), stone(), links='<ball name="b" body_a="stone" point="0 7 0"/>'),
     scene(floor(), stone(), links='<ball name="b" body_a="stone" point="0 0.06 0"/>')),

    ("%zu of the %zu spheres of \"%s\" lie away from its geometry, and follow it as on a lever: up to %.3g times as far as what carries them",
     ["generate spheres from the same mesh as the geometry"],
     spheres_for("away.spheres", floor(), stone()), GOOD),
    ("%.3g%% of the vertices drawn for \"%s\" lie off its geometry, by up to %s at (%.3g %.3g %.3g) m, and swing up to %.3g times as far as what carries them",
     ["draw the mesh that the geometry was made from, or make the geometry again from the one that is drawn, and finer"],
     scene(body("organ", SOFT, '<visual mesh="m"/>'), assets=CELLS + '<mesh name="m" file="wide.off"/>'),
     scene(body("organ", SOFT, '<visual mesh="m"/>'), assets=CELLS + '<mesh name="m" file="cube.off"/>')),
    ("%.3g%% of the edges drawn for \"%s\" lead from one loop of its line to another, and are torn apart as these move",
     ["draw a surface whose loops do not touch, or the body's own skin"], drawn("bent.curve", "web.off"), drawn("line.curve", "tube.off")),
    ("the line of \"%s\" bends more sharply, over five radii, than the distance of %.3g%% of the vertices drawn around it, up to %.3g times, near "
     "(%.3g %.3g %.3g) m: where it bends on, the surface folds on the inside",
     ["draw a smoother surface or a smoother line; fewer control points make it smoother"],
     drawn("bent.curve", "hair.off"), drawn("line.curve", "tube.off")),
    ("\"%s\" is not drawn: of its mesh, ", [],
     scene(net(NET, '<visual mesh="m"/>'), assets=SHEET + '<mesh name="m" file="wide.off"/>'),
     scene(net(NET, '<visual mesh="sheet"/>'), assets=SHEET)),

    ("%s=\"%g\" lies outside of what was measured of %s: %g to %g %s (%s)", ["leave it out, to have %g, or choose the material that it is of"],
     organ('<neo_hookean_tetrahedra young_modulus="5000"/>').replace('geometry="cells"', 'geometry="cells" material="spleen"'),
     organ('<neo_hookean_tetrahedra young_modulus="4000"/>').replace('geometry="cells"', 'geometry="cells" material="spleen"')),
    ("material=\"%s\" says nothing to %s, which has none of its figures", ["set its values yourself, or choose another model or material"],
     scene(floor(), stone('<mechanical geometry="cube" material="small_intestine"><rigid_body/></mechanical>', BALL)),
     scene(floor(), stone('<mechanical geometry="cube" material="kidney"><rigid_body/></mechanical>', BALL))),

    ("\"%s\" and \"%s\" overlap by %.3g mm at the start: the contact pushes them apart",
     ["move them apart, or generate spheres that fit more closely"],
     scene(floor(), stone(position="0 -0.02 0")), GOOD),
    ("\"%s\" is held by nothing, and nothing that could carry it lies under it: it falls",
     ["pin it, tie it with a spring, or put an unmovable body under it"],
     scene(stone(), floor(STONE)), scene(stone(), tool(position="0 -0.1 0"), tools=PROBE, devices=MOUSE)),
    ("\"%s\" is held by nothing, and nothing that could carry it lies under it: it falls", [],
     scene(stone(position="0 0.1 0"), body("low", STONE, BALL)),
     scene(stone(position="0 0.1 0"), body("low", STONE, BALL), links='<ball name="l" body_a="low"/>')),
    ("\"%s\" is held by nothing, and nothing that could carry it lies under it: it falls", [],
     needle(THREAD), needle(THREAD, thread='thread="b"')),
    ("\"%s\" is held by nothing, and nothing that could carry it lies under it: it falls", [],
     scene(stone(STONE, '<collision spheres="ball" group="1"/>'), floor('<collision spheres="ball" group="1"/>')),
     scene(stone(), environment='gravity="0 0 0"')),
    ("\"%s\" comes at up to %.3g m/s, and a single contact, as with \"%s\", stops it up to %.3g m/s: r sqrt(k/m) of its "
     "sphere, more with damping or where several touch at once",
     ["make contacts stiffer for more"], fast(1.0), fast(0.1)),
    ("\"%s\" comes at up to %.3g m/s, and a single contact, as with \"%s\", stops it up to %.3g m/s: r sqrt(k/m) of its "
     "sphere, more with damping or where several touch at once",
     ["make contacts %.3g times as stiff, or let it come more slowly"], fast(10), fast(0.1)),
    ("\"%s\" comes at up to %.3g m/s, and a single contact, as with \"%s\", stops it up to %.3g m/s: r sqrt(k/m) of its "
     "sphere, more with damping or where several touch at once",
     ["give contacts a stiffness, or let it come more slowly"],
     fast(10, '<collision spheres="ball" stiffness="0" damping="0"/>'), fast(0)),
    ("\"%s\" comes at up to %.3g m/s, and a single contact, as with \"%s\", stops it up to %.3g m/s: r sqrt(k/m) of its "
     "sphere, more with damping or where several touch at once",
     [], dropped("four.spheres", 3), dropped("four.spheres", 0.1)),
    ("the margin of \"%s\" is %.3g m, more than the radius of its smallest sphere, %.3g m: of a sphere no more than its "
     "radius counts, pairs that far apart cost as much as contacts, and neighbours that near never meet",
     ["take about a quarter of that radius"],
     scene(floor(), stone(STONE, '<collision spheres="ball" margin="0.2"/>')),
     scene(floor(), stone(STONE, '<collision spheres="ball" margin="0.05"/>'))),

    ("\"%s\" holds %zu control points of \"%s\", which bends as if it were clamped %s within the pin's radius",
     ["give the body more control points, or choose another radius"], pinned(10, 0.02), pinned(80, 0.02)),

    ("\"%s\" holds %zu control points of \"%s\", which stands still only deeper than %s within the pin's radius",
     ["give the body more control points, or choose another radius"], pinned_sheet(13, 0.05), pinned_sheet(60, 0.03)),
    ("error_tolerance is not used: no body is integrated by tr_bdf2", ["choose tr_bdf2 as integrator, or remove error_tolerance"],
     scene(floor(), stone(), solver='error_tolerance="1e-6"'), scene(floor(), stone(), solver='error_tolerance="1e-6" integrator="tr_bdf2"')),
    ("every body is integrated explicitly: how equations are solved matters only in steps that contacts, links or recovery make implicit",
     ["choose an implicit integrator, or leave nonlinear and linear open"],
     scene(floor(), stone(), solver='integrator="verlet" linear="cholesky"'), scene(floor(), stone(), solver='linear="cholesky"')),
    ("substeps of \"%s\" gain nothing: static finds the balance of forces, in which time does not count",
     ["remove substeps, or choose another integrator"],
     scene(floor(), stone('<mechanical geometry="cube" integrator="static" substeps="4"><rigid_body/></mechanical>', BALL)),
     scene(floor(), stone('<mechanical geometry="cube" integrator="static"><rigid_body/></mechanical>', BALL))),
    ("\"%s\" is integrated by static, but neither pin nor spring holds it: it finds no balance but where it touches something; "
     "in the open it sinks at %.2g m/s, and where it touches it settles as slowly",
     ["pin it, tie it with a spring, or choose an integrator that moves it"],
     scene(stone(), solver='integrator="static"'), hung(1000, integrator="static")),
    ("particles of \"%s\" have no Jacobian that %s could use: its steps may be no longer than verlet's, each costs many of "
     "them, and its equations may be left unsolved",
     ["leave the integrator open, or take verlet"],
     scene(stone(FLUID.replace('"cube"', '"cube" integrator="tr_bdf2"')), solver='time_step="0.0001"'),
     scene(stone(FLUID), solver='time_step="0.0001" integrator="tr_bdf2"')),
    ("the scene's integrator %s is not used for \"%s\": particles are moved by verlet", ["choose verlet for it, so that the scene says so"],
     scene(stone(FLUID), solver='integrator="tr_bdf2"'), scene(stone(FLUID.replace('"cube"', '"cube" integrator="verlet"')), solver='integrator="tr_bdf2"')),
    ("the weights of the spheres of \"%s\" are not used: others feel each sphere by itself",
     ["set surface to depth_field, or generate spheres without weights"],
     felt(floor(), stone(STONE, '<collision spheres="felt"/>')), felt(floor(), stone(STONE, '<collision spheres="felt" surface="depth_field"/>'))),
    ("the weights of the spheres of \"%s\" are not used: others feel each sphere by itself",
     ["generate spheres without weights: the body deforms"],
     felt(floor(), net(NET, '<collision spheres="felt"/>')), felt(floor(), net(NET, BALL))),
    ("the depth field of \"%s\" is not used: the body deforms, and others feel its spheres", ["leave surface at spheres, or make the body rigid"],
     felt(floor(), net(NET, '<collision spheres="ball" surface="depth_field"/>')),
     felt(floor(), stone(STONE, '<collision spheres="ball" surface="depth_field"/>'))),
    ("\"%s\" is alone in group %lld", ["put the other bodies in it, or remove group"],
     scene(floor(), stone(STONE, '<collision spheres="ball" group="3"/>')),
     scene(floor('<collision spheres="ball" group="3"/>'), stone(STONE, '<collision spheres="ball" group="3"/>'))),
    ("the spheres of \"%s\" do not move against each other: self has no effect", ["remove self, or make the role passive"],
     scene(floor('<collision spheres="ball" self="true"/>')), scene(floor(), net(NET, '<collision spheres="ball" self="true"/>'), assets=ASSETS + SHEET)),

    ("linear elements with a Poisson's ratio above 0.45 are much too stiff: a bar 2 cells thick bends by a third of what it "
     "should at 0.45, and by a twentieth at 0.499; choose element=\"quadratic\", or a Poisson's ratio of 0.45 or less", [],
     organ('<neo_hookean_tetrahedra poisson_ratio="0.48"/>'), organ('<neo_hookean_tetrahedra poisson_ratio="0.48" element="quadratic"/>')),
    ("linear elements with a Poisson's ratio above 0.45 are much too stiff: a bar 2 cells thick bends by a third of what it "
     "should at 0.45, and by a twentieth at 0.499; choose neo-Hookean tetrahedra with element=\"quadratic\", or a Poisson's "
     "ratio of 0.45 or less", [],
     organ('<linear_tetrahedra poisson_ratio="0.48"/>'), organ('<linear_tetrahedra poisson_ratio="0.44"/>')),
    ("most of the grid's cells are cut by the surface, so that its thin parts bend less than they should; ask for more cells, or "
     "choose a model of tetrahedra", [],
     grid_of(12), grid_of(60)),
    ("its curve still turns by more than most_bend between knots; raise maximum_control_points or most_bend", [],
     bent('most_bend="0.1" maximum_control_points="13"'), bent('most_bend="3" maximum_control_points="13"')),

    ("\"%s\" takes about %.2g s to make", ["take fewer control points or nodes"], sheet_of(200), sheet_of(60)),
    ("\"%s\" takes about %.2g s each time that its matrix is factorised", ["take fewer control points or nodes"],
     sheet_of(200), sheet_of(60)),
    ("\"%s\" takes at least about %.2g s a step, longer than its time step of %g s",
     ["take fewer control points or nodes, or a longer time_step"], sheet_of(60), sheet_of(10)),
]

VERLET = 'integrator="verlet"'
ALONE = scene(stone(FLUID))
STILL = scene(floor())
MADE = '<mesh name="cube" file="cube.off"/><tetrahedra name="cells" file="cube.mesh" source="cube"/>'
FREE = scene(stone(STONE))
PORT = scene(tool(), links='<port name="l" body_a="tool" point="1 0.1 0"/>', tools=PROBE, devices=MOUSE)
BREAKS = scene(stone(), links='<ball name="b" body_a="stone" strength="5"/>')
GRIPS = jaws("grasper", net())

PLAN = [
    ("parameters and pulls may change while it runs", [], STILL, None),
    ("the next state becomes the state", [], STILL, None),
    ("readers see the new state", [], STILL, None),
    ("active bodies follow their devices", [], scene(tool(), tools=PROBE, devices=MOUSE), GOOD),
    ("no body is driven by a device or a track", [], GOOD, scene(tool(), tools=PROBE, devices=MOUSE)),
    ("devices feel what active bodies touch", [], scene(tool(), tools=PROBE, devices=MOUSE), GOOD),
    ("bodies change their level of detail by themselves", [], "levels", levelled("")),
    ("no body changes its level of detail by itself", [], levelled(""), "levels"),
    ("instruments close, hold or suck", [], GRIPS, scene(tool(), tools=PROBE, devices=MOUSE)),
    ("no instrument does more than touch", [], scene(tool(), tools=PROBE, devices=MOUSE), GRIPS),
    ("nets may tear where they are strained too much", [],
     scene(net('<mechanical geometry="sheet"><mass_spring_net tear_strain="0.5"/></mechanical>'), assets=SHEET), scene(net(), assets=SHEET)),
    ("no body tears", [], scene(net(), assets=SHEET),
     scene(net('<mechanical geometry="sheet"><mass_spring_net tear_strain="0.5"/></mechanical>'), assets=SHEET)),
    ("bodies that move have spheres to touch", [], GOOD, scene(floor(), stone(STONE))),
    ("no two bodies can touch", [], scene(floor(), stone(STONE)), GOOD),
    ("what drops lie on takes on their colour", [], scene(floor(), stone(FLUID, '<collision/>')), GOOD),
    ("no fluid stains or washes what it touches", [], GOOD, scene(floor(), stone(FLUID, '<collision/>'))),
    ("drops wet the lens of an endoscope, or smoke hazes its view", [],
     scene(floor(), stone(FLUID, '<collision/>'), tools='<camera name="c" lens="0.004"/>'),
     scene(floor(), stone(FLUID, '<collision/>'), tools='<camera name="c"/>')),
    ("nothing wets a lens, and no smoke hazes a view", [], scene(floor(), stone(), tools='<camera name="c" lens="0.004"/>'),
     scene(floor(), stone(FLUID, '<collision/>'), tools='<camera name="c" lens="0.004"/>')),
    ("no two bodies can touch", [],
     scene(floor('<collision spheres="ball" group="1"/>'), stone(STONE, '<collision spheres="ball" group="1"/>')), GOOD),
    ("bodies at rest sleep until something that moves touches them", [], GOOD, STILL),
    ("bodies never sleep: sleep_speed is 0, or none moves by physics", [], scene(floor(), stone(), solver='sleep_speed="0"'), GOOD),
    ("bodies never sleep: sleep_speed is 0, or none moves by physics", [], STILL, GOOD),
    ("links, jaws or a viewer's pull tie bodies", [], hung(100), scene(stone(), links='<pin name="p" body="stone" radius="1"/>')),
    ("no link ties bodies, and nobody pulls at one", [], scene(stone(), links='<pin name="p" body="stone" radius="1"/>'), hung(100)),
    ("bodies that touch or are tied are solved together", [], GOOD, STILL),
    ("no body moves by physics", [], STILL, FREE),
    ("passive bodies move by physics", [], FREE, STILL),
    ("what steps solve is evaluated again, apart from the solver", [], FREE, ALONE),
    ("no step solves equations", [], ALONE, FREE),
    ("contacts or links push back", [], hung(100), FREE),
    ("nothing touches and nothing is tied", [], FREE, hung(100)),
    ("bodies that move have a next state", [], FREE, STILL),
    ("no body moves", [], STILL, scene(tool(), tools=PROBE, devices=MOUSE)),
    ("particles come and go: by suction, by emitters, or as they dissolve", [],
     scene(stone(FLUID), effects='<emitter name="e" body="stone" reserve="5"/>'), ALONE),
    ("particles come and go: by suction, by emitters, or as they dissolve", [], scene(stone(SMOKE)), FREE),
    ("particles come and go: by suction, by emitters, or as they dissolve", [], instrument("suction", stone(FLUID)), ALONE),
    ("nothing sucks particles away or lets them out", [], ALONE, instrument("suction", stone(FLUID))),
    ("nothing sucks particles away or lets them out", [], FREE, scene(stone(SMOKE))),
    ("scissors may cut tetrahedra apart", [], jaws("scissors", net(SOFT)), jaws("grasper", net(SOFT))),
    ("nothing cuts tetrahedra apart", [], jaws("grasper", net(SOFT)), jaws("scissors", net(SOFT))),
    ("contacts that stick hold on in the next step", [], GOOD, FREE),
    ("links may bear too much", [], BREAKS, hung(100)),
    ("no link can break", [], hung(100), BREAKS),
    ("what jaws hold may tear away", [], GRIPS, instrument("suction", stone(FLUID))),
    ("no jaws hold anything", [], instrument("suction", stone(FLUID)), GRIPS),
    ("some methods may make energy out of nothing", [], scene(stone(), solver=VERLET), scene(stone(), solver='integrator="implicit_euler"')),
    ("no method makes energy out of nothing, or static moves a body and keeps none", [],
     scene(stone(), solver='integrator="implicit_euler"'), scene(stone(), solver=VERLET)),
    ("no method makes energy out of nothing, or static moves a body and keeps none", [],
     hung(100, integrator="verlet").replace('geometry="cube"', 'geometry="cube" integrator="static"'), hung(100, integrator="verlet")),
    ("what went wrong is counted and said", [], FREE, STILL),
    ("threads get control points where they bend", [], line(10, model='most_bend="0.3" maximum_control_points="40"'), line(10)),
    ("no thread gets control points where it bends", [], line(10), line(10, model='most_bend="0.3" maximum_control_points="40"')),
    ("left out: %s (%s)\n", [], FREE, instrument("suction", stone(FLUID), body("other", STONE, BALL), links='<ball name="l" body_a="other"/>')),
    ("left out: collision (no two bodies can touch)", ["collision"], FREE, GOOD),
    ("left out: mapping of unmovable spheres (they lie in the grid from the start)", ["mapping of unmovable spheres", "they lie in the grid from the start"], GOOD, FREE),
    ("left out: integration (no body moves by physics)", ["integration"], STILL, FREE),
    ("left out: the nonlinear solver (every body is integrated explicitly, and nothing touches or ties them)",
     ["the nonlinear solver", "every body is integrated explicitly, and nothing touches or ties them"], ALONE, scene(stone(STONE), solver=VERLET)),
    ("effects move bodies in place of physics", [], scene(stone(SMOKE, EFFECT)), scene(stone(SMOKE))),
    ("physics moves all bodies that no device moves", [], scene(stone(SMOKE)), scene(stone(SMOKE, EFFECT))),
    ("%s: an effect; --measure says what that saves\n", ["t: an effect"], clip(EFFECT), clip("")),
    ("%s: an effect; --measure says what that saves\n", ["e: an effect"], seeping('source="floor"', 10), seeping('source="floor"', 10, fidelity="")),
    ("%s: an effect, which takes about %.3g us of a step; its physics would take %.3g us\n", ["stone: an effect"],
     scene(stone(SMOKE, EFFECT)), scene(stone(SMOKE))),
    ("left out: physics of effects (an effect moves these bodies)", ["physics of effects", "an effect moves these bodies"], scene(stone(SMOKE, EFFECT)),
     scene(stone(SMOKE))),
    ("left out: exchange of particles (nothing sucks particles away or lets them out)", ["exchange of particles"], FREE,
     instrument("suction", stone(FLUID))),
    ("left out: tools (no instrument does more than touch)", ["tools"], FREE, GRIPS),
    ("left out: devices and feedback (no body is driven by a device or a track)", ["devices and feedback"], FREE, PORT),
    ("left out: links (the scene has none)", ["links", "the scene has none"], FREE, PORT),
    ("left out: links (the scene has none)", [], FREE, scene(stone(), links='<pin name="p" body="stone" radius="1"/>')),
    ("left out: links other than pins (the scene has none)", ["links other than pins"],
     scene(stone(), links='<pin name="p" body="stone" radius="1"/>'), hung(100)),

    ("of %g us that are simulated in it\n", [], STILL, None),
    ("models (bodies): %s\n", [], FREE, STILL),
    ("shaders: none, a run draws nothing; of a picture (bodies): %s\n", [], STILL, None),
    ("files: %u simulated (%.1f kB), %u only drawn (%.1f kB)\n", [], FREE, scene(body("a", role="unmovable"), assets="")),
    ("left out: %s (%s): saves %.1f kB\n", ["sources: a run reads what was generated from them"],
     scene(body("organ", SOFT), assets=MADE), generated("")),
    ("left out: %s (%s): saves %.1f kB\n", ["nothing names them"], scene(stone(), assets=ASSETS + CELLS), GOOD),
    ("left out: %s (%s): saves %.1f kB\n", ["textures: a run draws nothing"], WORN, GOOD),
    ("texture: %s (%.1f kB), of %s\n", [], WORN, GOOD),
    ("%s: contacts that its step does not resolve are met in a few substeps, or are implicit\n", [], scene(floor(), stone(FLUID, '<collision/>')), ALONE),
    ("%s: %s moves it in steps that do not resolve its contacts\n", [], scene(floor(), stone(), solver=VERLET), GOOD),
    ("%s: %s moves it also in steps in which spheres are within their margins, %.3g m apart at most\n", [],
     scene(floor(), stone(STONE, '<collision spheres="ball" margin="0.01"/>'), solver=VERLET), scene(floor(), stone(), solver=VERLET)),
    ("%s: its spheres keep their places on it while it bends, which leaves gaps about 5 %% wider in a sharp fold than where it is flat; "
     "spheres that follow the fold would double the cost of contacts, and 40 %% more of them narrow all gaps by a quarter\n", [],
     scene(floor(), net(NET, '<collision spheres="knots"/>'), assets=ASSETS + SHEET + '<spheres name="knots" file="knots.spheres"/>'),
     scene(floor(), net(NET, BALL), assets=ASSETS + SHEET)),
    ("%s: its spheres keep their places on it while it bends, which leaves gaps about 5 %% wider in a sharp fold than where it is flat; "
     "spheres that follow the fold would double the cost of contacts, and 40 %% more of them narrow all gaps by a quarter\n", [],
     scene(floor(), net(NET, '<collision spheres="knots"/>'), assets=ASSETS + SHEET + '<spheres name="knots" file="knots.spheres"/>'),
     scene(floor(), net(NET.replace('sheet', 'cube'), '<collision spheres="knots"/>'), assets=ASSETS + '<spheres name="knots" file="knots.spheres"/>')),
    ("%s: %s follows its impacts with one other rigid body, in parts of the step\n", [], GOOD, scene(stone())),
    ("%s: how fast it leaves an impact depends on the step, since a link ties it\n", [],
     scene(floor(), stone(), links='<spring name="s" body_a="stone" point_a="0 0 0" point_b="0 0.1 0" stiffness="10"/>'), GOOD),
    ("%s: its step does not resolve its links, which are met in a few substeps, or are implicit\n", [],
     scene(stone(FLUID), links='<spring name="s" body_a="stone" point_a="0 0 0" point_b="0 0.1 0" stiffness="1e7"/>'), ALONE),
    ("%s: %s moves it, since its step does not resolve its links; %zu substeps would\n", [],
     hung(1e6, integrator="verlet"), hung(10, integrator="verlet")),
    ("%s: %s moves it, since its step does not resolve its links\n", [],
     hung(1e12, integrator="verlet"), hung(1e6, integrator="verlet")),
    ("%s: its method takes %.3g %% of the energy of its slowest swing in a second\n", [],
     pendulum("implicit_euler"), pendulum("implicit_midpoint")),
    ("static: %s: of the balances that it may have, the one reached by following the load from the state before; others may lie "
     "beyond where its stiffness is negative\n", [],
     hung(1000, integrator="static"), hung(1000)),
    ("static: %s: of the balances that it may have, the one reached by following the load from the state before; others may lie "
     "beyond where its stiffness is negative\n", [],
     hung(1000, integrator="static"), scene(stone(), solver='integrator="static"')),
    ("pin %s: holds %zu control points of %s, which can turn there\n", [], pinned(10, 0), pinned(10, 0.02)),
    ("pin %s: holds %zu control points of %s, which bends as if it were clamped %.2g m within the pin's radius\n", [],
     pinned(10, 0.02), pinned(10, 0)),
    ("pin %s: holds %zu control points of %s, which stands still deeper than %.2g m within the pin's radius\n", [],
     pinned_sheet(25, 0.05), pinned_sheet(13, 0.01, "0.05")),
    ("pin %s: holds %zu control points of %s, of which no place within the pin's radius stands still\n", [],
     pinned_sheet(13, 0.01, "0.05"), pinned_sheet(25, 0.05)),
    ("(* active; the step is of the whole scene)", [], "levels", FREE),
    ("%s changes its level by itself, so that its estimated error stays within its tolerance\n", [],
     levelled('automatic="error"'), levelled('automatic="distance"')),
    ("%s changes its level by itself: it is fine within %g m of a tool, and %g m of a camera\n", [],
     levelled('automatic="distance"'), levelled('automatic="error"')),
    ("%s changes its level by itself, by the time that steps take: two runs of this scene may differ\n", [],
     levelled('automatic="time"'), levelled('automatic="error"')),
    ("%s: %zu control points, up to %zu as it bends: %zu degrees of freedom then; %.0f kB are kept", [],
     line(10, model='most_bend="0.3" maximum_control_points="40"'), line(10)),
    ("\"%s\" takes at least about %.2g s a step, longer than its time step of %g s; ",
     ["take fewer control points or nodes, or a longer time_step"], sheet_of(60), sheet_of(10)),
]
MEASURED = [
    ("%s: an effect; over %.3g s a step takes %.3g us, with its physics %.3g us\n", ["t: an effect"], clip(EFFECT), clip("")),
    ("with nothing left out a step takes %.2f us instead of %.2f us (%.2f times as long, %.2f to %.2f in half of the steps)", [], FREE, None),
    ("; each of %zu steps gives the same state to the bit\n", [], FREE, None),
    ("; %.2f us a step to look at its bends, %.1f us when some come or go", [],
     line(10, model='most_bend="0.3" maximum_control_points="40"'), line(10)),
]



def flung(method, step, velocity, **solver):
    more = "".join(f' {k}="{v}"' for k, v in solver.items())
    return scene(net('<mechanical geometry="sheet"><mass_spring_net damping="0"/></mechanical>', velocity=velocity), assets=SHEET,
                 solver=f'integrator="{method}" time_step="{step}" sleep_speed="0"{more}', links='<pin name="p" body="net" point="0 0 0" radius="0.01"/>')


def spun(file, spin):
    return scene(stone('<mechanical geometry="m"><rigid_body/></mechanical>', spin=spin), assets=f'<mesh name="m" file="{file}"/>',
                 solver='time_step="0.02"')


def wetted(friction):
    """Drops of particles, explicit, that rub on an implicit net: one island of two methods."""
    return scene(net(NET.replace('"sheet"', '"sheet" integrator="bdf2"'), f'<collision spheres="knots" friction="{friction}"/>'),
                 body("blood", '<mechanical geometry="drop"><lennard_jones particles="100"/></mechanical>',
                      f'<collision friction="{friction}"/>', position="0.05 0.02 0.05", velocity="1 -1 0.5"),
                 assets=SHEET + '<mesh name="drop" file="drop.off"/><spheres name="knots" file="knots.spheres"/>', solver='time_step="0.001"',
                 links='<pin name="p" body="net" point="0 0 0" radius="0.02"/><pin name="q" body="net" point="0.1 0 0.1" radius="0.02"/>')


def orbit(step):
    return scene(stone(STONE, velocity="1 0 0"), solver=f'integrator="symplectic_euler" time_step="{step}" sleep_speed="0"', environment='gravity="0 0 0"',
                 links='<spring name="s" body_a="stone" point_a="0 0 0" point_b="0 0.1 0" stiffness="100" damping="0"/>')


def held(model):
    return scene(net(f'<mechanical geometry="cells"><{model} young_modulus="300"/></mechanical>'), assets=CELLS,
                 links='<pin name="p" body="net" point="-0.05 0 0" radius="0.075"/>')


def steps(case, count, *options):
    return case, ["-n", str(count), *options]


STIFF = ["--set", "links/right_cord_1/stiffness=1e12", "--set", "solver/tolerance=1e-5"]

THROUGH = ("loops of %s go through each other: in %llu steps two of its spheres that are more than two radii apart along it "
           "were nearer than half the sum of their radii, at worst %.2f of that sum at %.3f s; %s")
APART = steps(folded("fold.curve", 'self="true"'), 200)

RUN = [
    (THROUGH, ["set self=\"true\" in its collision unit, so that its loops meet"], steps(folded("fold.curve", ""), 200), APART),
    (THROUGH, ["its loops lie in each other at the start: correct its curve"],
     steps(folded("flat.curve", 'self="true"'), 20), APART),
    (THROUGH, ["take a larger contact stiffness, more control points, or a smaller time_step"],
     steps(folded("fold.curve", 'self="true" stiffness="0.001" damping="0"'), 200), APART),
    ("loops of %s: nearest %.2f of the sum of their radii", [], APART, steps(folded("fold.curve", ""), 200)),
    ("its equations are not solved to tolerance", ["take a smaller time_step or more newton_iterations"],
     steps(pendulum("implicit_euler").replace("<solver", '<solver newton_iterations="1" linear_iterations="1" tolerance="1e-12"'), 50),
     steps(pendulum("implicit_euler"), 50)),
    ("rounding is more than its equations may miss", ["take softer laws and links, move it nearer to the origin, or raise the tolerance"],
     steps("plate4-deformed-ovary", 3, *STIFF), steps("plate4-deformed-ovary", 3)),
    ("another integrator took steps that the scene's could not take",
     ["take a smaller time_step or less friction, or choose implicit_euler for all but particles"],
     steps(flung("implicit_midpoint", 0.01, "5 5 5"), 100), steps(flung("implicit_midpoint", 0.001, "1 1 1"), 100)),
    ("another integrator took steps that the scene's could not take",
     ["take a smaller time_step or less friction, or choose implicit_euler for all but particles"],
     steps(wetted(10), 300), steps(wetted(0.5), 300)),
    ("%s: %s takes steps that %s cannot take; %s", [], steps(flung("implicit_midpoint", 0.01, "5 5 5"), 100), steps(wetted(10), 300)),
    ("%s: %s takes steps that %s cannot take with what touches or ties it; %s", [],
     steps(wetted(10), 300), steps(flung("implicit_midpoint", 0.01, "5 5 5"), 100)),
    ("its model is not meant for what became of it, as its message says", ["do what the message advises"],
     steps(held("linear_tetrahedra"), 100), steps(held("neo_hookean_tetrahedra"), 100)),
    ("another integrator than the scene's moves it, since that one failed", ["take a smaller time_step, or choose implicit_euler for it"],
     steps(flung("symplectic_euler", 8e-4, "5 5 5"), 400), steps(flung("symplectic_euler", 8e-5, "5 5 5"), 400)),
    ("its steps made more than a hundredth of its energy out of nothing",
     ["take a smaller time_step, or choose implicit_euler for all but particles"],
     steps(orbit(0.01), 400), steps(orbit(0.005), 800)),
    ("an explicit step and two of half its size are more than a quarter of its speed apart", ["take a smaller time_step or more substeps"],
     steps(flung("position_based", 0.02, "5 5 5"), 130), steps(flung("symplectic_euler", 8e-5, "5 5 5"), 400)),
    ("it stands still, since its motion could not be computed", ["reset, or change its parameters"],
     steps(scene(stone(STONE, velocity="100 0 0"), solver='maximum_speed="1"'), 20), steps(scene(stone(STONE, velocity="100 0 0")), 20)),
    ("a contact does not hold it: it comes too fast, or a sphere goes deeper than its radius, or passes another",
     ["take a larger contact stiffness, or a smaller time_step"], steps(fast(100), 200), steps(fast(1), 800)),
    ("a contact does not hold it: it comes too fast, or a sphere goes deeper than its radius, or passes another", [],
     steps(dropped("ball.spheres", 3), 200), steps(dropped("four.spheres", 3), 200)),
    ("it spins so fast about changing axes that a step loses where it points", ["take a smaller time_step or more substeps"],
     steps(spun("box.off", "100 1000 20"), 5), steps(spun("cube.off", "100 1000 20"), 5)),
    ("it spins so fast about changing axes that a step loses where it points", [],
     steps(spun("box.off", "100 1000 20"), 5), steps(spun("box.off", "10 100 2"), 5)),
]
TITLES = set("yes;no;default;body;integrator (source);substeps;nonlinear;linear;stage;in?;items;estimate;measured;why;unit;points;off, %;"
             "farthest, m;leverage;rest, m;rigid, m;affine, m;bend, m;level;dof;spheres;a step".split(";"))
HELD_ELSEWHERE = {
    # remedies of messages that come from other rooms, and what needs a machine without memory
    "correct it": "tests/scene/test_check.c",
    "close other programs, or use fewer or coarser meshes": "tests/scene/test_memory.c",
    "close other programs, or use fewer or smaller spheres": "tests/sim/test_world.c",
    "contacts are left out, perhaps its own: there is no memory for them": "tests/sim/test_world.c",
    # by the time that stages take, of bodies that creep as they fall asleep, and a fault that no scene has shown
    "; in %zu steps no node is farther off than %.2g m: where nothing is left out, bodies that sleep (%zu at most) go on creeping\n":
        "tests/measure/test_pruning.c",
    "left out: %s (%s): saves %.2f us a step\n": "tests/e2e/test_cli.py",
    "; but a node is %.2g m off after %zu steps, although no body sleeps: this is a fault of ours\n": "tests/measure/test_pruning.c",
    "friction was left out, since with friction no motion was found": "tests/sim/test_verify.c",
    "take a smaller time_step or less friction": "tests/sim/test_verify.c",
    "a step went wrong, and was taken again in smaller ones": "tests/sim/test_verify.c",
    "take a smaller time_step": "tests/sim/test_verify.c",
}
