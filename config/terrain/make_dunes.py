#!/usr/bin/python3
"""Writes dunes.tif, the surface of config/sand_table/sand.yaml: low dunes and a few hills that cars can drive over.

    /usr/bin/python3 make_dunes.py

5.12 by 2.56 m in pixels of 0.02 m; the mean is 0. No slope is steeper than 20 degrees, so that the sand stays as it is until somebody drives.
"""

import numpy as np
import terrain_file
from make_terrain import noise, rough

SIZE = np.array([5.12, 2.56])  # m
PIXEL = 0.02  # m
HILLS = [(0.55, 0.45, 0.07, 0.30), (2.55, 2.05, 0.08, 0.34), (4.45, 0.60, 0.09, 0.36), (1.50, 1.28, 0.06, 0.26)]  # x, y, height, radius [m]
STEEPEST = 20.0  # degrees


def surface(x, y):
    dunes = 0.017 * np.sin(2.0 * np.pi * (0.8 * x + 0.35 * y) / 0.9 + 1.6 * noise(x, y, 1.4)) * (1.0 + 0.6 * noise(x, y, 1.0))
    hills = sum(height * np.exp(-((x - a) ** 2 + (y - b) ** 2) / radius**2) for a, b, height, radius in HILLS)
    return dunes + hills + 0.018 * rough(x, y, 1.6, 3)


def main():
    columns, rows = np.rint(SIZE / PIXEL).astype(int)
    x, y = np.meshgrid(PIXEL * (np.arange(columns) + 0.5), PIXEL * (np.arange(rows) + 0.5))
    sand = surface(x, y)
    steepest = np.degrees(np.arctan(np.hypot(*np.gradient(sand, PIXEL)).max()))
    if steepest > STEEPEST:
        raise SystemExit(f"{steepest:.1f} degrees are too steep")
    terrain_file.write("dunes.tif", PIXEL, 0.0002, {"sand": sand - sand.mean()})


if __name__ == "__main__":
    main()
