#!/usr/bin/python3
"""Writes site.tif, the uneven ground that the bulldozer of config/bulldozer levels: heaps and hollows, and a level apron in the west.

    /usr/bin/python3 make_site.py

20 by 12 m in pixels of 0.125 m; elevations are against the plan's level, which is 0.
"""

import numpy as np
import terrain_file
from make_terrain import RANDOM, rough, smooth_step

SIZE = np.array([20.0, 12.0])  # m
PIXEL = 0.125  # m
HEAPS = 26


def surface(x, y):
    ground = 0.015 + 0.05 * rough(x, y, 3.0, 3)
    for k in range(HEAPS):
        # Every second is a hollow, not as deep as heaps are high, and has sand to its west.
        hollow = k % 2 == 1
        a, b = RANDOM.uniform([9.0 if hollow else 6.0, 1.0], [13.0 if hollow else 11.0, 11.0])
        height, radius = RANDOM.uniform(0.08, 0.22), RANDOM.uniform(0.8, 1.2)
        ground = ground + (-0.7 if hollow else 1.0) * height * np.exp(-((x - a) ** 2 + (y - b) ** 2) / radius**2)
    return ground * smooth_step(4.5, 6.5, x) * smooth_step(19.5, 16.0, x)


def main():
    columns, rows = np.rint(SIZE / PIXEL).astype(int)
    x, y = np.meshgrid(PIXEL * (np.arange(columns) + 0.5), PIXEL * (np.arange(rows) + 0.5))
    terrain_file.write("site.tif", PIXEL, 0.001, {"sand": surface(x, y)})


if __name__ == "__main__":
    main()
