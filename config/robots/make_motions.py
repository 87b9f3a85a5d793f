#!/usr/bin/python3
"""Writes how the public robots of the README move: keyframes for scripts/joint_player, beside this script.

    /usr/bin/python3 make_motions.py zx120 URDF | leo | anymal URDF

Joints are found numerically from where the feet, or the bucket's teeth, are to be; all lengths come from the URDF given.
"""

import pathlib
import sys
import xml.etree.ElementTree as ElementTree

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent


def rotation(axis, angle):
    """Rodrigues' formula; the axis may have any length."""
    x, y, z = np.array(axis, float) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def pose(rotation_matrix=np.eye(3), position=(0, 0, 0)):
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rotation_matrix, position
    return matrix


class Robot:
    def __init__(self, urdf):
        self.joints = {joint.find("child").get("link"): joint for joint in ElementTree.parse(urdf).getroot().findall("joint")}

    def frame(self, link, angles):
        """Where a link is in the root's frame."""
        if link not in self.joints:
            return np.eye(4)
        joint = self.joints[link]
        numbers = lambda tag, key, default: np.array((joint.find(tag).get(key, default) if joint.find(tag) is not None else default).split(), float)
        roll, pitch, yaw = numbers("origin", "rpy", "0 0 0")
        origin = pose(rotation([0, 0, 1], yaw) @ rotation([0, 1, 0], pitch) @ rotation([1, 0, 0], roll), numbers("origin", "xyz", "0 0 0"))
        axis, position = numbers("axis", "xyz", "1 0 0"), angles.get(joint.get("name"), 0.0)
        turn = pose(position=axis * position) if joint.get("type") == "prismatic" else pose(rotation(axis, position))
        return self.frame(joint.find("parent").get("link"), angles) @ origin @ turn


def solve(start, residual):
    """Angles near `start` at which the residual vanishes: Newton's method, damped."""
    names = list(start)
    values = np.array([start[name] for name in names], float)
    at = lambda q: np.asarray(residual(dict(zip(names, q))), float)
    for _ in range(200):
        error = at(values)
        if np.abs(error).max() < 1e-6:
            return dict(zip(names, values))
        slopes = np.column_stack([(at(values + 1e-6 * unit) - error) / 1e-6 for unit in np.eye(len(values))])
        step = np.linalg.solve(slopes.T @ slopes + 1e-5 * np.eye(len(values)), -slopes.T @ error)
        values = values + step * min(1.0, 0.3 / np.abs(step).max())
    raise SystemExit(f"out of reach: {residual.__doc__ or ''} {error}")


def smooth(waypoints, interval):
    """Rows (time, values...) between waypoints: at rest at each of them."""
    waypoints = np.array(waypoints, float)
    times = np.arange(0.0, waypoints[-1, 0] + 0.5 * interval, interval)
    before = np.clip(np.searchsorted(waypoints[:, 0], times, side="right") - 1, 0, len(waypoints) - 2)
    share = (times - waypoints[before, 0]) / (waypoints[before + 1, 0] - waypoints[before, 0])
    share = np.clip(share, 0, 1) ** 2 * (3 - 2 * np.clip(share, 0, 1))
    return times, waypoints[before, 1:] + share[:, None] * (waypoints[before + 1, 1:] - waypoints[before, 1:])


# The excavator: the bucket's teeth and pin in its frame, as its collision mesh has them.
TEETH = np.array([-0.87, 0.0, 0.89])
ARM = {"boom_joint": -0.6, "arm_joint": 1.6, "bucket_joint": 0.8}


def excavator(urdf):
    """Digs a cut 0.35 m deep ahead, carries what the bucket holds a quarter turn to the left, and tips it out."""
    robot = Robot(urdf)
    waypoints = [  # time, teeth's distance x and height z ahead of the machine, tilt of the line from pin to teeth, swing
        (0.0, 6.0, 1.6, -60.0, 0.0),
        (3.0, 6.9, 0.3, -75.0, 0.0),
        (5.0, 6.6, -0.35, -85.0, 0.0),
        (10.0, 4.9, -0.35, -100.0, 0.0),
        (13.0, 3.4, 0.30, -158.0, 0.0),
        (15.5, 3.2, 2.0, -160.0, 0.0),
        (20.0, 3.2, 2.2, -160.0, 70.0),
        (23.0, 5.8, 1.20, -80.0, 70.0),
        (25.0, 5.8, 1.40, -60.0, 70.0),
        (29.0, 6.0, 1.60, -60.0, 0.0),
    ]
    times, path = smooth(waypoints, 0.2)
    rows, angles = [], dict(ARM)
    for x, z, tilt, swing in path:
        def residual(trial):
            """the teeth's place and tilt"""
            frame = robot.frame("bucket_link", trial)
            teeth = (frame @ [*TEETH, 1.0])[:3]
            along = teeth - frame[:3, 3]
            error = np.arctan2(along[2], along[0]) - np.radians(tilt)
            return [teeth[0] - x, teeth[2] - z, (error + np.pi) % (2 * np.pi) - np.pi]
        angles = solve(angles, residual)
        rows.append([np.radians(swing), *angles.values()])
    return ["swing_joint", *ARM], times, rows, ("base_link", np.zeros((len(times), 4)))


def rover():
    """Drives 2.4 m ahead in a gentle curve; its wheels roll, 2 cm deep in the sand."""
    radius, track, depth, speed, turn = 0.0625, 0.358, 0.02, 0.2, np.radians(25.0)
    length = 2.4
    times = np.arange(0.0, length / speed + 0.01, 0.2)
    way = speed * times
    heading = turn * way / length
    x, y = length / turn * np.sin(heading), length / turn * (1 - np.cos(heading))
    left, right = ((way - side * heading * track / 2) / radius for side in (1, -1))
    joints = ["wheel_FL_joint", "wheel_RL_joint", "wheel_FR_joint", "wheel_RR_joint"]
    # Every wheel's axis points to the robot's left.
    rows = [[l, l, r, r] for l, r in zip(left, right)]
    return joints, times, rows, ("base_footprint", np.column_stack([x, y, np.full_like(x, -depth), heading]))


LEGS = ("LF", "RF", "LH", "RH")


def walker(urdf):
    """Walks eight steps, one leg after the other; its feet go 4 cm into the sand."""
    robot = Robot(urdf)
    height, stride, lift, depth, swing_time = 0.48, 0.22, 0.14, 0.04, 0.8
    feet = {leg: np.array([(0.36 if leg[1] == "F" else -0.36), (0.22 if leg[0] == "L" else -0.22), -depth]) for leg in LEGS}
    start = {leg: {f"{leg}_HAA": 0.0, f"{leg}_HFE": bend, f"{leg}_KFE": -2 * bend}
             for leg, bend in (("LF", 0.7), ("RF", 0.7), ("LH", -0.7), ("RH", -0.7))}
    sole = np.array([0.0, 0.0, -0.0075, 1.0])  # below the foot's frame: its ball's lowest point
    order = ("LH", "LF", "RH", "RF")
    times = np.arange(0.0, 1.0 + 8 * swing_time + 1.0, 0.1)
    base_x = np.interp(times, [1.0, 1.0 + 8 * swing_time], [0.0, 2 * stride])
    rows, angles = [], start
    for time, x in zip(times, base_x):
        row = []
        for leg in LEGS:
            foot = feet[leg].copy()
            for step in range(8):
                share = np.clip((time - 1.0 - step * swing_time) / swing_time, 0.0, 1.0)
                if order[step % 4] != leg:
                    continue
                foot[0] += stride * share**2 * (3 - 2 * share)
                foot[2] += lift * np.sin(np.pi * share)
            # Whatever the legs do, the body stays level and moves on evenly.
            target = foot - [x, 0.0, height]
            angles[leg] = solve(angles[leg], lambda trial: (robot.frame(f"{leg}_FOOT", trial) @ sole)[:3] - target)
            row += angles[leg].values()
        rows.append(row)
    joints = [f"{leg}_{joint}" for leg in LEGS for joint in ("HAA", "HFE", "KFE")]
    base = np.column_stack([base_x, 0 * base_x, np.full_like(base_x, height), 0 * base_x])
    return joints, times, rows, ("base", base)


def main():
    makers = {"zx120": excavator, "leo": rover, "anymal": walker}
    name, arguments = sys.argv[1], sys.argv[2:]
    joints, times, rows, base = makers[name](*arguments)
    lines = [f"# {makers[name].__doc__}", "# Keyframes for scripts/joint_player, made by make_motions.py.", f"joints: [{', '.join(joints)}]"]
    lines += [f"base: {{parent: sand, child: {base[0]}}}", "keyframes:"]
    text = lambda values: "[" + ", ".join(f"{value:.4f}" for value in values) + "]"
    for k, (time, row) in enumerate(zip(times, rows)):
        lines.append(f"  - {{time: {time:.1f}, positions: {text(row)}, base: {text(base[1][k])}}}")
    (HERE / f"{name}.yaml").write_text("\n".join(lines) + "\n")
    print(f"{name}: {len(times)} keyframes over {times[-1]:.1f} s")


if __name__ == "__main__":
    main()
