#!/usr/bin/python3
"""Writes rover.urdf and drive.yaml: a rover with six wheels on rockers and bogies that drives over a crater's rim and down into it.

    /usr/bin/python3 make_rover.py

Each wheel goes SINKAGE into the regolith of config/terrain/crater.tif; the rover's height, pitch and roll, and the turns of rockers and bogies
follow from that. The rockers are coupled by a differential: one turns as far up as the other turns down.
"""

import pathlib
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.append(str(HERE.parent))
from vehicles import Description, Ground, along, box, cylinder, ease, wheel, write_motion  # noqa: E402
from make_motions import Robot  # noqa: E402

RADIUS, WIDTH, SINKAGE = 0.26, 0.30, 0.06  # m
HALF_TRACK = 0.95  # m
AHEAD = {"front": 1.05, "middle": 0.0, "rear": -1.05}  # m, of wheels
ROCKER, BOGIE = np.array([0.15, 0.80]), np.array([-0.525, 0.50])  # m, x and z of their pivots when all is level
DURATION, INTERVAL = 20.0, 0.2  # s
SIDES = {"left": 1, "right": -1}
# m; straight over the plain, up the rim, and along the slope inside
WAYPOINTS = np.array([(5.4, 6.5), (7.2, 8.0), (9.4, 9.2), (11.6, 9.6), (13.6, 8.9), (15.0, 7.6), (15.4, 5.9)])
COLORS = {
    "rubber": (0.16, 0.16, 0.17), "tread": (0.45, 0.45, 0.46), "metal": (0.80, 0.80, 0.78), "white": (0.93, 0.93, 0.91),
    "gold": (0.83, 0.62, 0.20), "panel": (0.06, 0.09, 0.20), "black": (0.07, 0.07, 0.08),
}


def strut(start, end, thickness=0.07):
    """A beam between two places given as (x, y, z)."""
    start, end = np.array(start, float), np.array(end, float)
    way = end - start
    length = np.linalg.norm(way)
    pitch, yaw = -np.arcsin(way[2] / length), np.arctan2(way[1], way[0])
    return box((length, thickness, thickness), (start + end) / 2, (0, pitch, yaw), "metal")


def describe(file):
    rover = Description("rover", "A rover with six wheels; made by make_rover.py.", COLORS)
    rover.hang("body")
    # The body's frame lies between the pivots of the rockers.
    rover.link(
        "body",
        box((1.55, 1.15, 0.42), (0.05, 0, 0.12), color="gold"),
        box((1.62, 1.22, 0.05), (0.05, 0, 0.355), color="white"),
        box((1.00, 1.70, 0.03), (-0.42, 0, 0.43), (0, -0.10, 0), "panel"),
        *(box((0.98, 0.015, 0.034), (-0.42, y, 0.433), (0, -0.10, 0), "metal") for y in np.linspace(-0.85, 0.85, 7)),
        cylinder(0.05, 2 * HALF_TRACK - 0.34, color="metal"),
        cylinder(0.045, 0.85, (0.62, 0.35, 0.78), (0, 0, 0), "white"),
        box((0.16, 0.46, 0.16), (0.66, 0.35, 1.26), color="white"),
        *(cylinder(0.05, 0.03, (0.75, 0.35 + y, 1.26), (0, np.pi / 2, 0), "black") for y in (-0.14, 0.0, 0.14)),
        cylinder(0.02, 0.55, (-0.65, -0.45, 0.66), (0, 0, 0), "metal"),
        cylinder(0.33, 0.04, (-0.65, -0.45, 1.02), (0.5, -0.5, 0), "white"),
        box((0.30, 0.30, 0.30), (-0.90, 0, 0.12), color="black"),
    )
    for side, left in SIDES.items():
        rocker, bogie = f"rocker_{side}", f"bogie_{side}"
        inner = -0.25 * left  # wheels stand outside of their beams
        to_bogie = BOGIE - ROCKER
        rover.joint(rocker, "continuous", "body", rocker, (0, 1, 0), (0, left * HALF_TRACK, 0))
        rover.link(rocker, cylinder(0.09, 0.12, (0, inner, 0)), strut((0, inner, 0), (AHEAD["front"] - ROCKER[0], inner, -0.05)),
                   strut((0, inner, 0), (to_bogie[0], inner, to_bogie[1])))
        rover.joint(bogie, "continuous", rocker, bogie, (0, 1, 0), (to_bogie[0], 0, to_bogie[1]))
        rover.link(bogie, cylinder(0.07, 0.12, (0, inner, 0)), strut((0, inner, 0), (AHEAD["rear"] - BOGIE[0], inner, 0.08)),
                   strut((0, inner, 0), (AHEAD["middle"] - BOGIE[0], inner, RADIUS - BOGIE[1])))
        for row, ahead in AHEAD.items():
            parent, pivot = (rocker, ROCKER) if row == "front" else (bogie, BOGIE)
            knuckle, rim = f"knuckle_{row}_{side}", f"wheel_{row}_{side}"
            rover.joint(knuckle, "continuous", parent, knuckle, (0, 0, 1), (ahead - pivot[0], 0, RADIUS - pivot[1]))
            shapes = [cylinder(0.04, 0.25, (0, inner / 2, 0))]
            if row != "middle":
                top = ROCKER[1] - 0.05 - RADIUS if row == "front" else BOGIE[1] + 0.08 - RADIUS
                shapes.append(strut((0, inner, 0), (0, inner, top), 0.08))
            rover.link(knuckle, *shapes)
            rover.joint(rim, "continuous", knuckle, rim, (0, 1, 0))
            rover.link(rim, *wheel(RADIUS, WIDTH, "metal", 20))
    rover.write(file)


def spline(share):
    """A smooth way through the waypoints (Catmull and Rom's)."""
    points = np.vstack([2 * WAYPOINTS[0] - WAYPOINTS[1], WAYPOINTS, 2 * WAYPOINTS[-1] - WAYPOINTS[-2]])
    at = share * (len(WAYPOINTS) - 1)
    k = np.minimum(at.astype(int), len(WAYPOINTS) - 2)
    t = (at - k)[:, None]
    a, b, c, d = (points[k + n] for n in range(4))
    x, y = (0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t**2 + (3 * b - a - 3 * c + d) * t**3)).T
    return x, y


def drive(robot, ground, times):
    """Joints at the times."""
    rows = []
    free = dict.fromkeys(("z", "pitch", "roll", "differential", "bogie_left", "bogie_right"), 0.0)
    for x, y, yaw, curvature, way in along(spline, ease(times / times[-1])):
        steered = {"x": x, "y": y, "yaw": yaw}
        for side, left in SIDES.items():
            for row, ahead in AHEAD.items():
                forward, sideward = 1 - left * HALF_TRACK * curvature, (ahead - ROCKER[0]) * curvature
                steered[f"knuckle_{row}_{side}"] = np.arctan2(sideward, forward) if row != "middle" else 0.0
                rim = f"wheel_{row}_{side}"
                steered[rim] = rows[-1][rim] + (way - before) * np.hypot(forward, sideward) / RADIUS if rows else 0.0

        def joints(trial):
            rockers = {f"rocker_{side}": left * trial["differential"] for side, left in SIDES.items()}
            return {**steered, **rockers, **{name: value for name, value in trial.items() if name != "differential"}}

        free = ground.settled(robot, [f"wheel_{row}_{side}" for side in SIDES for row in AHEAD], joints, free, RADIUS, SINKAGE)
        rows.append(joints(free))
        before = way
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def main():
    describe(HERE / "rover.urdf")
    robot, ground = Robot(HERE / "rover.urdf"), Ground("crater.tif", 2, 0.1)
    times = np.arange(0.0, DURATION + 0.5 * INTERVAL, INTERVAL)
    joints = drive(robot, ground, times)
    write_motion(HERE / "drive.yaml", "A rover drives over a crater's rim and down into it: made by make_rover.py.", times, joints)
    for name in ("z", "pitch", "roll", "rocker_left", "bogie_left", "bogie_right"):
        print(f"{name:12s} {joints[name].min():6.3f} to {joints[name].max():6.3f}")


if __name__ == "__main__":
    main()
