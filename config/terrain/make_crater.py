#!/usr/bin/python3
"""Writes crater.tif, ground of the Moon that config/rover takes: a simple crater with its rim, ejecta around it, later and smaller craters.

    /usr/bin/python3 make_crater.py

24 by 18 m in pixels of 0.1 m. The shape is that of simple craters: a bowl, shallow as old ones are, a rim whose height falls with the third
power of the distance, fractal roughness (amplitudes halve with each octave), and small craters whose number falls with the square of
their size. Band `rock` is what lies below, with boulders that stick out, band `regolith` the surface of what covers it.
"""

import numpy as np
import terrain_file
from make_terrain import RANDOM, boulder, rough

SIZE = np.array([24.0, 18.0])  # m
PIXEL = 0.1  # m
CENTRE, RADIUS, DEPTH, RIM = np.array([15.0, 9.0]), 6.0, 1.15, 0.48  # m; depth below the plain
REGOLITH = 0.18  # m
SMALL_CRATERS = 45
BOULDERS = [(10.2, 4.6, 0.55), (9.2, 13.2, 0.45), (17.4, 3.0, 0.60), (20.8, 13.6, 0.50), (14.0, 15.7, 0.40), (16.9, 11.0, 0.38), (4.4, 5.2, 0.42),
            (22.2, 6.2, 0.45), (12.4, 2.2, 0.35), (6.5, 12.6, 0.36), (18.4, 8.0, 0.30), (2.2, 14.9, 0.55)]  # x, y, radius [m]


def crater(x, y, centre, radius, depth, rim):
    """A bowl and its rim, rounded where they meet."""
    distance = np.hypot(x - centre[0], y - centre[1]) / radius
    bowl = -depth + (depth + rim) * distance**2
    apron = rim * np.maximum(distance, 0.3) ** -3
    sharpness = 6.0 / (depth + rim)
    return -np.log(np.exp(-sharpness * np.minimum(bowl, 5.0)) + np.exp(-sharpness * np.minimum(apron, 5.0))) / sharpness


def surface(x, y):
    wobble = 1.0 + 0.05 * rough(x, y, 6.0, 2)
    ground = crater(CENTRE[0] + (x - CENTRE[0]) * wobble, CENTRE[1] + (y - CENTRE[1]) * wobble, CENTRE, RADIUS, DEPTH, RIM)
    for _ in range(SMALL_CRATERS):
        radius = 0.30 / np.sqrt(RANDOM.uniform(0.06, 1.0))
        ground = ground + crater(x, y, RANDOM.uniform([0.0, 0.0], SIZE), radius, 0.18 * radius, 0.05 * radius)
    return ground + 0.055 * rough(x, y, 4.0, 5)


def rock(x, y, regolith):
    ground = regolith - REGOLITH * (1.0 + 0.4 * rough(x, y, 2.5, 3))
    for a, b, radius in BOULDERS:
        foot = regolith[int(b / PIXEL), int(a / PIXEL)]
        ground = np.maximum(ground, foot + boulder(x, y, (a, b), radius, 1.3 * radius, RANDOM.uniform(0.0, np.pi)))
    return ground


def main():
    columns, rows = np.rint(SIZE / PIXEL).astype(int)
    x, y = np.meshgrid(PIXEL * (np.arange(columns) + 0.5), PIXEL * (np.arange(rows) + 0.5))
    regolith = surface(x, y)
    terrain_file.write("crater.tif", PIXEL, 0.001, {"rock": rock(x, y, regolith), "regolith": regolith})


if __name__ == "__main__":
    main()
