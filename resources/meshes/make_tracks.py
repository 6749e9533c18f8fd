#!/usr/bin/python3
"""Makes the recorded input of the shipped scenes: instruments that turn about the place where they enter the body,
their tips led through points in time.

    make_tracks.py FOLDER
"""
import math
import pathlib
import sys

RATE_HZ = 50

# Where the instruments go through the wall of the belly, m.
RIGHT, LEFT, NAVEL = (0.105, 0.045, 0.190), (-0.105, 0.045, 0.190), (0.020, 0.130, 0.180)
UPPER_RIGHT, UPPER_LEFT = (0.085, 0.150, 0.150), (-0.085, 0.150, 0.150)
ABOVE, BESIDE = (0.090, 0.120, 0.100), (-0.100, 0.130, 0.090)  # of the bowl of blood, whose middle is the origin
UMBILICUS = (0.040, 0.180, 0.250)  # of an endoscope whose lens looks upward from its shaft

# Scene: instrument: place of entry, then rows of time (s) and place of the tip (m) and, where they are used, the buttons
# that are down from then on and how far the shaft is turned about itself (rad).
TRACKS = {
    # The right probe presses the ovary, the fold behind it and the tube, then stirs the blood and turns to the bowel; the
    # left one does the same on its side and pulls at the thread; the endoscope looks on, comes nearer and rests on the bowel.
    "laparoscopy": {
        "probe": (RIGHT, [
            (0.0, 0.088, 0.058, 0.075), (0.6, 0.066, 0.028, 0.034), (1.2, 0.057, 0.013, 0.011), (1.8, 0.054, 0.014, 0.010),
            (2.2, 0.068, 0.034, 0.026), (2.7, 0.062, 0.030, -0.020), (3.2, 0.066, 0.042, 0.012), (3.6, 0.078, 0.038, 0.002),
            (4.0, 0.074, 0.030, 0.034), (4.6, 0.040, -0.027, 0.034), (5.2, 0.034, -0.031, 0.028), (5.6, 0.048, 0.010, 0.050),
            (6.2, 0.040, -0.012, 0.088), (6.8, 0.038, -0.027, 0.088), (8.0, 0.088, 0.058, 0.075)]),
        "probe_left": (LEFT, [
            (0.0, -0.080, 0.050, 0.080), (0.8, -0.060, 0.024, 0.036), (1.4, -0.056, 0.014, 0.014), (2.0, -0.052, 0.016, 0.013),
            (2.4, -0.062, 0.036, 0.026), (2.9, -0.060, 0.029, -0.020), (3.4, -0.062, 0.040, 0.020), (4.0, -0.020, 0.022, 0.034),
            (4.6, -0.006, 0.006, 0.016), (5.2, -0.014, 0.004, 0.030), (5.8, -0.040, 0.010, 0.080), (6.4, -0.040, -0.025, 0.088),
            (8.0, -0.080, 0.050, 0.080)]),
        "endoscope": (UMBILICUS, [
            (0.0, 0.032, 0.080, 0.160), (2.0, 0.032, 0.074, 0.152), (4.4, 0.032, 0.074, 0.152), (5.6, 0.024, 0.040, 0.120),
            (6.4, 0.020, -0.0300, 0.088), (7.0, 0.024, 0.040, 0.120), (8.0, 0.032, 0.080, 0.160)]),
    },
    # The right probe presses and strokes, the left one meets it from the other side, the endoscope comes near and touches.
    "table1": {
        "probe": (RIGHT, [
            (0.0, 0.075, 0.040, 0.070), (0.6, 0.058, 0.014, 0.024), (1.0, 0.057, 0.013, 0.014),
            (1.6, 0.060, 0.012, 0.014), (2.2, 0.052, 0.010, 0.014), (2.8, 0.057, 0.014, 0.024),
            (4.0, 0.075, 0.040, 0.070)]),
        "probe_left": (LEFT, [
            (0.0, 0.020, 0.030, 0.070), (0.8, 0.034, 0.012, 0.030), (1.4, 0.043, 0.010, 0.016),
            (2.4, 0.044, 0.014, 0.015), (3.2, 0.034, 0.012, 0.030), (4.0, 0.020, 0.030, 0.070)]),
        "endoscope": (NAVEL, [
            (0.0, 0.045, 0.075, 0.080), (1.0, 0.055, 0.034, 0.032), (1.8, 0.055, 0.026, 0.016),
            (2.6, 0.055, 0.034, 0.030), (4.0, 0.045, 0.075, 0.080)]),
    },
    # Two probes stir the pool from both sides, the endoscope dips into it.
    "table1-fluid": {
        "probe": (RIGHT, [
            (0.0, 0.075, 0.020, 0.080), (0.8, 0.042, -0.018, 0.022), (1.6, 0.030, -0.022, 0.012),
            (2.4, 0.040, -0.022, 0.014), (3.2, 0.044, -0.010, 0.026), (4.0, 0.075, 0.020, 0.080)]),
        "probe_left": (LEFT, [
            (0.0, 0.000, 0.020, 0.080), (1.0, 0.020, -0.014, 0.030), (1.8, 0.030, -0.020, 0.018),
            (2.6, 0.024, -0.020, 0.020), (4.0, 0.000, 0.020, 0.080)]),
        "endoscope": (NAVEL, [
            (0.0, 0.035, 0.065, 0.090), (1.2, 0.034, 0.000, 0.030), (2.0, 0.034, -0.014, 0.018),
            (2.8, 0.034, 0.000, 0.030), (4.0, 0.035, 0.065, 0.090)]),
    },
    "plate1-ovary": {"probe": (RIGHT, [
        (0.0, 0.080, 0.045, 0.070), (1.0, 0.062, 0.020, 0.026), (1.6, 0.058, 0.012, 0.012), (2.4, 0.050, 0.014, 0.011),
        (3.2, 0.062, 0.024, 0.030), (4.0, 0.080, 0.045, 0.070)])},
    "plate2-tissue": {"probe": (RIGHT, [
        (0.0, 0.085, 0.040, 0.085), (1.0, 0.062, 0.008, 0.042), (1.8, 0.058, 0.004, 0.024), (2.6, 0.052, 0.006, 0.026),
        (3.2, 0.062, 0.010, 0.046), (4.0, 0.085, 0.040, 0.085)])},
    # Down into the pool, round in it twice, and out.
    "plate3-blood": {"probe": (RIGHT, [
        (0.0, 0.075, 0.030, 0.080), (0.9, 0.046, -0.014, 0.036), (1.2, 0.042, -0.030, 0.030), (1.5, 0.034, -0.031, 0.026),
        (1.8, 0.032, -0.031, 0.034), (2.1, 0.042, -0.032, 0.036), (2.4, 0.044, -0.030, 0.026), (2.7, 0.034, -0.031, 0.026),
        (3.0, 0.032, -0.031, 0.034), (3.3, 0.044, -0.012, 0.038), (4.0, 0.075, 0.030, 0.080)])},
    "plate4-deformed-ovary": {"probe": (RIGHT, [
        (0.0, 0.080, 0.045, 0.070), (1.0, 0.060, 0.018, 0.026), (1.8, 0.056, 0.012, 0.009), (2.6, 0.056, 0.012, 0.009),
        (3.2, 0.062, 0.024, 0.030), (4.0, 0.080, 0.045, 0.070)])},
    # Touches the ovary and coagulates it there, in two bursts: it gives way as it shrinks.
    "plate7-steam": {"probe": (RIGHT, [
        (0.0, 0.080, 0.045, 0.070, 0), (0.8, 0.060, 0.022, 0.028, 0), (1.1, 0.058, 0.0140, 0.0140, 1),
        (2.6, 0.056, 0.0137, 0.0135, 0), (2.9, 0.059, 0.020, 0.025, 0), (3.2, 0.054, 0.0137, 0.0130, 1),
        (4.2, 0.053, 0.0136, 0.0126, 0), (5.0, 0.080, 0.045, 0.070, 0)])},
    # The clamp comes open over the tube, closes on it, lifts it a little and stays.
    "plate8-clamp": {"shaft": (RIGHT, [
        (0.0, 0.0690, 0.0428, 0.0560, 0), (1.0, 0.0530, 0.0418, -0.0010, 0), (1.4, 0.0527, 0.0417, -0.0024, 1),
        (1.7, 0.0527, 0.0417, -0.0024, 0), (2.6, 0.0540, 0.0470, 0.0030, 0), (3.4, 0.0527, 0.0430, -0.0010, 0),
        (4.0, 0.0527, 0.0430, -0.0010, 0)])},
    # Takes the ovary, lowers it into the bag, lets go and leaves; the draw-string is pulled through the holder's tube, and the
    # closed bag carried up.
    "bag": {
        "shaft": (UPPER_RIGHT, [
            (0.0, 0.036, 0.060, 0.060, 0), (0.8, 0.0580, 0.030, 0.027, 0), (1.2, 0.0568, 0.0220, 0.0190, 1),
            (2.0, 0.0568, 0.0220, 0.0190, 1), (2.8, 0.040, 0.075, 0.055, 1),
            (3.6, 0.002, 0.074, 0.072, 1), (4.2, 0.002, 0.030, 0.070, 1), (4.4, 0.002, 0.030, 0.070, 0),
            (4.8, 0.002, 0.030, 0.070, 0), (5.6, 0.036, 0.090, 0.080, 0), (11.0, 0.036, 0.090, 0.080, 0)]),
        "holder": (LEFT, [(0.0, -0.0300, 0.0329, 0.0851), (8.6, -0.0300, 0.0329, 0.0851), (10.0, -0.0280, 0.0700, 0.0860), (11.0, -0.0280, 0.0700, 0.0860)]),
        "puller": (LEFT, [(0.0, -0.0300, 0.0329, 0.0851), (5.6, -0.0300, 0.0329, 0.0851), (8.2, -0.0671, 0.0389, 0.1369), (8.6, -0.0671, 0.0389, 0.1369),
            (10.0, -0.0654, 0.0579, 0.1365), (11.0, -0.0654, 0.0579, 0.1365)]),
    },
    # Open to the ovary and closed on it three times, each deeper, and back.
    "cut-ovary": {"shaft": (RIGHT, [
        (0.0, 0.0750, 0.0350, 0.0750, 0), (0.6, 0.0611, 0.0142, 0.0271, 0), (0.7, 0.0611, 0.0142, 0.0271, 1), (1.3, 0.0611, 0.0142, 0.0271, 0),
        (1.8, 0.0588, 0.0126, 0.0185, 0), (1.9, 0.0588, 0.0126, 0.0185, 1), (2.4, 0.0588, 0.0126, 0.0185, 0),
        (2.9, 0.0568, 0.0112, 0.0109, 0), (3.0, 0.0568, 0.0112, 0.0109, 1), (3.5, 0.0568, 0.0112, 0.0109, 1), (4.5, 0.0750, 0.0350, 0.0750, 1)])},
    "plate5-string": {"probe": (RIGHT, [
        (0.0, 0.085, 0.040, 0.080), (0.8, 0.060, -0.026, 0.040), (1.2, 0.056, -0.026, 0.018), (2.2, 0.056, 0.006, 0.018),
        (3.0, 0.056, -0.026, 0.020), (3.4, 0.070, -0.020, 0.050), (4.0, 0.085, 0.040, 0.080)])},
    # The ends of the suture are drawn apart, and let come back.
    "knot": {
        "right": (RIGHT, [
            (0.0, 0.0746, 0.0199, 0.0500), (0.2, 0.0746, 0.0199, 0.0500), (1.8, 0.0931, 0.0199, 0.0500),
            (2.4, 0.0931, 0.0199, 0.0500), (3.0, 0.0820, 0.0180, 0.0500), (4.0, 0.0820, 0.0180, 0.0500)]),
        "left": (LEFT, [
            (0.0, 0.0154, 0.0199, 0.0500), (0.2, 0.0154, 0.0199, 0.0500), (1.8, -0.0031, 0.0199, 0.0500),
            (2.4, -0.0031, 0.0199, 0.0500), (3.0, 0.0080, 0.0180, 0.0500), (4.0, 0.0080, 0.0180, 0.0500)]),
    },
    # The tube goes down into the bowl, sucks in the middle and on all sides, rinses the wound with its second button, sucks
    # away what ran down, and comes out; the other instrument waits.
    "exercise-suction": {
        "tube": (ABOVE, [
            (0.0, 0.030, 0.035, 0.033, 0), (0.7, 0.004, -0.018, 0.004, 0), (0.9, 0.000, -0.0290, 0.000, 1), (2.6, 0.000, -0.0290, 0.000, 1),
            (3.1, 0.008, -0.0285, -0.006, 1), (3.6, -0.008, -0.0285, -0.006, 1), (4.1, -0.008, -0.0285, 0.006, 1), (4.6, 0.000, -0.0295, 0.000, 1),
            (4.8, 0.000, -0.0295, 0.000, 0), (5.2, 0.030, -0.004, 0.004, 2), (5.6, 0.030, -0.004, 0.004, 0), (6.0, 0.000, -0.0290, 0.000, 1),
            (8.2, 0.000, -0.0290, 0.000, 0), (8.8, 0.030, 0.035, 0.033, 0)]),
        "endoscope": (BESIDE, [(0.0, -0.052, 0.068, 0.047), (8.8, -0.052, 0.068, 0.047)]),
    },
    # Into the fold between two loops, the upper one to the left, and out.
    "plate6-intestine": {"probe": (RIGHT, [
        (0.0, 0.070, 0.045, 0.110), (0.8, 0.050, 0.020, 0.080), (1.4, 0.044, -0.004, 0.066), (2.2, 0.026, -0.002, 0.074),
        (2.8, 0.044, 0.004, 0.074), (3.4, 0.050, 0.024, 0.084), (4.0, 0.070, 0.045, 0.110)])},
}


def ease(x):
    return x * x * (3 - 2 * x)


def tip(points, t):
    """Place, buttons and turn."""
    k = max(i for i, p in enumerate(points[:-1]) if i == 0 or t >= p[0])
    (start, *a), (end, *b) = points[k], points[k + 1]
    s = ease(min(1, (t - start) / (end - start)))
    turn = a[4] + s * (b[4] - a[4]) if len(a) > 4 else 0
    return [x + s * (y - x) for x, y in zip(a[:3], b)], a[3] if len(a) > 3 else 0, turn


def aim(place, entry):
    """The shaft lies along the body's +z, from the tip to the place of entry: the least turn that brings z there, as
    w, x and y of a quaternion; its z is 0."""
    d = [e - p for e, p in zip(entry, place)]
    length = math.hypot(*d)
    w, x, y = 1 + d[2] / length, -d[1] / length, d[0] / length
    norm = math.hypot(w, x, y)
    return w / norm, x / norm, y / norm


def row(t, place, buttons, turn, entry):
    w, x, y = aim(place, entry)
    z = "0"
    if turn:
        c, s = math.cos(turn / 2), math.sin(turn / 2)
        w, x, y, z = w * c, x * c + y * s, y * c - x * s, "%.7f" % (w * s)
    return "%.2f %.6f %.6f %.6f %.7f %.7f %.7f %s 0 %d" % (t, *place, w, x, y, z, buttons)


def track(instruments):
    lines = ["spore-track 1"]
    for name, (entry, points) in instruments.items():
        lines.append("device " + name)
        lines += [row(n / RATE_HZ, *tip(points, n / RATE_HZ), entry) for n in range(round(RATE_HZ * points[-1][0]) + 1)]
    return "\n".join(lines) + "\n"


def main():
    for scene, instruments in TRACKS.items():
        path = pathlib.Path(sys.argv[1]) / scene / (scene + ".track")
        path.parent.mkdir(exist_ok=True)
        path.write_text(track(instruments))


if __name__ == "__main__":
    main()
