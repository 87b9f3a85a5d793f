#!/usr/bin/python3
"""Writes cars.urdf and drive.yaml: two cars on a sand table, of which one drives a circle, the other an S across the table and over the circle.

    /usr/bin/python3 make_cars.py

All four wheels of a car steer, so that those behind roll in the ruts of those in front. Each wheel goes SINKAGE into config/terrain/dunes.tif:
height, pitch and roll of the car and the twist of its springs follow from that.
"""

import pathlib
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.append(str(HERE.parent))
from vehicles import Description, Ground, along, box, cylinder, ease, wheel, write_motion  # noqa: E402
from make_motions import Robot  # noqa: E402

HALF_BASE, HALF_TRACK = 0.17, 0.145  # m from the car's middle to its wheels
RADIUS, WIDTH = 0.075, 0.05  # m, of wheels
SINKAGE = 0.015  # m
DURATION = 24.0  # s
INTERVAL = 0.2  # s
WHEELS = {"front_left": (1, 1), "front_right": (1, -1), "rear_left": (-1, 1), "rear_right": (-1, -1)}
CARS = {"red": (0.80, 0.13, 0.09), "blue": (0.10, 0.30, 0.65)}
COLORS = {
    "rubber": (0.10, 0.10, 0.11), "tread": (0.20, 0.20, 0.21), "metal": (0.70, 0.71, 0.73), "glass": (0.10, 0.14, 0.18),
    "lamp": (1, 0.97, 0.85), **CARS,
}


def describe(file):
    cars = Description("cars", "Two cars for a sand table; made by make_cars.py.", COLORS)
    for car in CARS:
        cars.hang(car, car + "_")
        cars.link(
            car,
            box((0.46, 0.17, 0.05), (0, 0, 0.105), color="metal"),
            box((0.50, 0.20, 0.06), (0, 0, 0.150), color=car, solid=True),
            box((0.13, 0.19, 0.03), (0.17, 0, 0.190), (0, 0.10, 0), color=car),
            box((0.22, 0.18, 0.075), (-0.05, 0, 0.215), color="glass"),
            box((0.24, 0.19, 0.014), (-0.05, 0, 0.258), color=car),
            *(box((0.012, 0.012, 0.085), (x, y, 0.215), color=car) for x in (-0.16, 0.06) for y in (-0.088, 0.088)),
            cylinder(0.066, 0.045, (-0.262, 0, 0.165), (0, np.pi / 2, 0), color="rubber"),
            *(cylinder(0.02, 0.012, (0.252, y, 0.158), (0, np.pi / 2, 0), color="lamp") for y in (-0.07, 0.07)),
            box((0.02, 0.24, 0.03), (0.262, 0, 0.115), color="metal"),
        )
        for name, (ahead, left) in WHEELS.items():
            spring, knuckle, rim = (f"{car}_{part}_{name}" for part in ("spring", "knuckle", "wheel"))
            cars.joint(spring, "prismatic", car, spring, (0, 0, 1), (ahead * HALF_BASE, left * HALF_TRACK, RADIUS))
            cars.link(spring, cylinder(0.012, 0.10, (0, -left * 0.05, 0.01), (left * 0.5, 0, 0)))
            cars.joint(knuckle, "continuous", spring, knuckle)
            cars.link(knuckle, cylinder(0.012, 0.06, (0, -left * 0.03, 0)))
            cars.joint(rim, "continuous", knuckle, rim, (0, 1, 0))
            cars.link(rim, *wheel(RADIUS, WIDTH, car, 14))
    cars.write(file)


def circle(share):
    """Anticlockwise."""
    angle = np.radians(285.0) + 2 * np.pi * share
    return 1.36 + 0.86 * np.cos(angle), 1.28 + 0.86 * np.sin(angle)


def curve(share):
    """An S from the east to the west."""
    x = 4.72 - 4.3 * share
    return x, 1.28 - 0.72 * np.sin(2 * np.pi * share)


def drive(robot, ground, car, path, times):
    """Joints of a car at the times."""
    rows = []
    free = dict.fromkeys((f"{car}_z", f"{car}_pitch", f"{car}_roll", "twist"), 0.0)
    for x, y, yaw, curvature, way in along(path, ease(times / times[-1])):
        steered = {f"{car}_x": x, f"{car}_y": y, f"{car}_yaw": yaw}
        for name, (ahead, left) in WHEELS.items():
            forward, sideward = 1 - left * HALF_TRACK * curvature, ahead * HALF_BASE * curvature
            steered[f"{car}_knuckle_{name}"] = np.arctan2(sideward, forward)
            # Close enough where the curvature changes slowly.
            rolled = rows[-1][f"{car}_wheel_{name}"] + (way - before) * np.hypot(forward, sideward) / RADIUS if rows else 0.0
            steered[f"{car}_wheel_{name}"] = rolled

        def joints(trial):
            springs = {f"{car}_spring_{name}": ahead * left * trial["twist"] for name, (ahead, left) in WHEELS.items()}
            return {**steered, **springs, **{name: value for name, value in trial.items() if name != "twist"}}

        free = ground.settled(robot, [f"{car}_wheel_{name}" for name in WHEELS], joints, free, RADIUS, SINKAGE)
        rows.append(joints(free))
        before = way
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def main():
    describe(HERE / "cars.urdf")
    robot, ground = Robot(HERE / "cars.urdf"), Ground("dunes.tif", 1, 0.02)
    times = np.arange(0.0, DURATION + 0.5 * INTERVAL, INTERVAL)
    joints = {**drive(robot, ground, "red", circle, times), **drive(robot, ground, "blue", curve, times)}
    apart = np.hypot(joints["red_x"] - joints["blue_x"], joints["red_y"] - joints["blue_y"]).min()
    if apart < 0.6:
        raise SystemExit(f"the cars come as near as {apart:.2f} m")
    write_motion(HERE / "drive.yaml", "A car drives a circle, another one an S over it: made by make_cars.py.", times, joints)


if __name__ == "__main__":
    main()
