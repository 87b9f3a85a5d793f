#!/usr/bin/env python3
"""Writes the motions of this folder: what sticks draw in the scenes butterfly and writing, as lists of poses for `motion: {file: ...}`."""

import math
from pathlib import Path

FOLDER = Path(__file__).parent


class Pen:
    """A stick that is put down, drawn along and lifted, at one speed."""

    def __init__(self, speed, drawing, lifted):
        self.speed = speed  # m/s
        self.drawing = drawing  # z of the stick's origin while it draws [m]
        self.lifted = lifted
        self.poses = []  # time, x, y, z

    def go(self, x, y, z):
        if not self.poses:
            self.poses.append((0.0, x, y, z))
            return
        time, *place = self.poses[-1]
        way = math.dist(place, (x, y, z))
        if way > 0.0:
            self.poses.append((time + way / self.speed, x, y, z))

    def draw(self, points):
        """One stroke. @param points x, y [m]"""
        self.go(*points[0], self.lifted)
        for point in points:
            self.go(*point, self.drawing)
        self.go(*points[-1], self.lifted)

    def write(self, name, comment):
        with open(FOLDER / name, "w") as out:
            out.write(f"# {comment} Written by {Path(__file__).name}.\n")
            for time, x, y, z in self.poses:
                out.write(f"- {{time: {time:.3f}, position: [{x:.4f}, {y:.4f}, {z:.4f}]}}\n")
        print(f"{name}: {len(self.poses)} poses, {self.poses[-1][0]:.1f} s")


def butterfly():
    """Wings along the first turn of Fay's butterfly curve, body and feelers."""
    scale, x0, y0 = 0.32, 1.28, 1.1
    pen = Pen(speed=0.5, drawing=0.33, lifted=0.42)
    steps = 240
    wings = []
    for k in range(steps + 1):
        t = 2.0 * math.pi * k / steps
        r = math.exp(math.cos(t)) - 2.0 * math.cos(4.0 * t) - math.sin(t / 12.0) ** 5
        wings.append((x0 + scale * r * math.sin(t), y0 + scale * r * math.cos(t)))
    pen.draw(wings)
    for side in (-1.0, 1.0):
        pen.draw([(x0 + side * 0.35 * (k / 20) ** 2, y0 + 0.55 + 0.75 * k / 20) for k in range(21)])
    pen.write("butterfly.yaml", "The stick of butterfly.yaml.")


# Strokes in the order in which they are written, in a square of length 1.
FLY = [
    [(0.08, 0.78), (0.62, 0.81), (0.62, 0.62), (0.65, 0.40), (0.73, 0.18), (0.84, 0.07), (0.95, 0.08), (0.95, 0.24)],
    [(0.95, 0.78), (0.74, 0.60)],
    [(0.77, 0.56), (0.95, 0.44)],
]
WING = [[(0.0, 0.82), (0.20, 0.82), (0.20, 0.12), (0.11, 0.18)], [(0.03, 0.66), (0.11, 0.55)], [(0.0, 0.32), (0.13, 0.44)]]
HOVER = [
    [(0.08, 0.95), (0.16, 0.82)],
    [(0.36, 0.96), (0.27, 0.82)],
    [(0.03, 0.74), (0.41, 0.74)],
    [(0.07, 0.56), (0.37, 0.56)],
    [(0.0, 0.38), (0.43, 0.38)],
    [(0.22, 0.74), (0.22, 0.30), (0.17, 0.16), (0.06, 0.04)],
    *[[(x + shift, y) for x, y in stroke] for shift in (0.51, 0.79) for stroke in WING],
]


def writing():
    """Two characters that mean flying."""
    pen = Pen(speed=0.8, drawing=0.28, lifted=0.40)
    for character, x0 in ((FLY, 0.2), (HOVER, 2.75)):
        for stroke in character:
            pen.draw([(x0 + 2.15 * x, 0.22 + 2.15 * y) for x, y in stroke])
    pen.write("writing.yaml", "The stick of writing.yaml.")


if __name__ == "__main__":
    butterfly()
    writing()
