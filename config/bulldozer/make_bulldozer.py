#!/usr/bin/python3
"""Writes bulldozer.urdf and drive.yaml: a bulldozer that levels a site in passes that overlap, its blade's edge at the plan's level, z = 0.

    /usr/bin/python3 make_bulldozer.py

Each pass goes east with the blade down; at its end the blade is lifted, and the bulldozer backs to the apron, on to where the next pass begins.
It drives on what it has levelled, so its height stays the same.
"""

import pathlib
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.append(str(HERE.parent))
from vehicles import Description, box, cylinder, ease, write_motion  # noqa: E402

# Where passes go, y [m], and how fast [m/s]: the blade is 3.0 m wide. The last ones take up what the first ones have left between them.
PASSES = ((2.1, 0.8), (4.7, 0.8), (7.3, 0.8), (9.9, 0.8), (8.6, 1.2), (6.0, 1.2), (3.4, 1.2))
WEST, EAST = 2.4, 13.2  # m, between which the bulldozer's middle goes
BLADE_AHEAD, LIFT = 1.95, 0.55  # m
BACK_SPEED, LIFT_TIME = 3.0, 1.0  # m/s, s
INTERVAL = 0.2  # s
COLORS = {
    "yellow": (0.96, 0.72, 0.08), "rubber": (0.10, 0.10, 0.11), "tread": (0.22, 0.22, 0.23), "metal": (0.45, 0.46, 0.48),
    "steel": (0.72, 0.73, 0.75), "glass": (0.15, 0.20, 0.25), "lamp": (1, 0.97, 0.85),
}


def track(y):
    """A belt around two wheels; plates across it."""
    length, radius, width = 2.3, 0.34, 0.46
    shapes = [box((length, width, 2 * radius), (0, y, radius), color="rubber")]
    shapes += [cylinder(radius, width, (x, y, radius), color="rubber") for x in (-length / 2, length / 2)]
    shapes += [cylinder(0.72 * radius, 1.04 * width, (x, y, radius), color="yellow") for x in (-length / 2, length / 2)]
    shapes += [cylinder(0.13, 1.04 * width, (x, y, 0.20), color="metal") for x in (-0.7, -0.35, 0.0, 0.35, 0.7)]
    shapes.append(box((1.9, 1.03 * width, 0.12), (0, y, 0.42), color="yellow"))
    plates = [box((0.06, 1.02 * width, 0.05), (x, y, z), color="tread") for x in np.arange(-1.1, 1.11, 0.2) for z in (0.015, 2 * radius)]
    return shapes + plates


def describe(file):
    dozer = Description("bulldozer", "A bulldozer; made by make_bulldozer.py.", COLORS)
    dozer.hang("bulldozer", motions=("x", "y", "yaw"))
    dozer.link(
        "bulldozer", *track(0.85), *track(-0.85),
        box((2.6, 1.2, 0.45), (0.0, 0, 0.62), color="metal"),
        box((1.45, 1.0, 0.62), (0.65, 0, 1.12), color="yellow"),
        box((0.04, 0.84, 0.50), (1.39, 0, 1.10), color="tread"),
        *(box((0.02, 0.84, 0.03), (1.42, 0, z), color="metal") for z in np.arange(0.92, 1.31, 0.09)),
        box((1.15, 1.5, 0.30), (-0.75, 0, 0.95), color="yellow"),
        box((0.95, 1.15, 0.95), (-0.55, 0, 1.55), color="glass"),
        box((1.15, 1.32, 0.09), (-0.55, 0, 2.06), color="yellow"),
        *(box((0.08, 0.08, 0.98), (x, y, 1.55), color="yellow") for x in (-1.0, -0.1) for y in (-0.56, 0.56)),
        cylinder(0.05, 0.65, (0.45, 0.3, 1.70), (0, 0, 0), color="tread"),
        *(box((0.05, 0.14, 0.09), (-0.02, y, 2.14), color="lamp") for y in (-0.45, 0.45)),
        box((0.5, 1.1, 0.5), (-1.45, 0, 0.72), color="yellow"),
    )
    dozer.joint("lift", "prismatic", "bulldozer", "blade", (0, 0, 1), (BLADE_AHEAD, 0, 0))
    # Its edge is at the link's z = 0. Upright, for sand is carried by what it lies on.
    dozer.link(
        "blade",
        box((0.14, 3.0, 1.30), (0.0, 0, 0.65), color="yellow", solid=True),
        *(box((0.10, 2.9, 0.07), (-0.10, 0, z), color="yellow") for z in (0.15, 0.60, 1.10)),
        box((0.04, 3.0, 0.12), (0.09, 0, 0.06), color="steel"),
        *(box((0.70, 0.08, 1.20), (0.28, y, 0.60), color="yellow", solid=True) for y in (-1.47, 1.47)),
        *(box((1.9, 0.14, 0.20), (-0.95, y, 0.32), color="yellow") for y in (-1.22, 1.22)),
        *(cylinder(0.055, 0.95, (-0.42, y, 0.80), (0, -1.05, 0), color="steel") for y in (-0.40, 0.40)),
    )
    dozer.write(file)


def smooth(share):
    return share * share * (3 - 2 * share)


def cycle():
    """Rows time, x, y, yaw, lift; phases."""
    rows, phases, time = [(0.0, WEST, PASSES[0][0], 0.0, 0.0)], [], 0.0

    def move(duration, place):
        nonlocal time
        count = max(2, round(duration / INTERVAL))
        rows.extend((time + duration * k / count, *place(k / count)) for k in range(1, count + 1))
        time += duration

    length = EAST - WEST
    for number, (lane, speed) in enumerate(PASSES, 1):
        start = time
        move(length / speed / 0.9, lambda share: (WEST + length * ease(share), lane, 0.0, 0.0))
        phases.append((f"pass_{number}", start, time))
        # The blade comes out backwards, or it would tear down what it has heaped.
        move(LIFT_TIME, lambda share: (EAST - 0.6 * smooth(share), lane, 0.0, LIFT * smooth(share)))
        if number == len(PASSES):
            break
        after, back, reach = PASSES[number][0], length - 0.6, 6.0

        def backward(share):
            x = EAST - 0.6 - back * ease(share)
            aside = np.clip((WEST + 0.3 + reach - x) / reach, 0.0, 1.0)
            slope = -(after - lane) * 6 * aside * (1 - aside) / reach
            return x, lane + (after - lane) * smooth(aside), np.arctan(slope), LIFT

        move(back / BACK_SPEED / 0.9, backward)
        move(LIFT_TIME, lambda share: (WEST, after, 0.0, LIFT * (1 - smooth(share))))
    return np.array(rows), phases


def main():
    describe(HERE / "bulldozer.urdf")
    rows, phases = cycle()
    write_motion(HERE / "drive.yaml", "A bulldozer levels a site in passes that overlap: made by make_bulldozer.py.", rows[:, 0],
                 dict(zip(("x", "y", "yaw", "lift"), rows[:, 1:].T)), phases)


if __name__ == "__main__":
    main()
