#!/usr/bin/python3
"""Writes mountain.tif, ground that config/scenes/avalanche.yaml takes: a bowl under a ridge, a gully, and the valley floor.

    /usr/bin/python3 make_mountain.py

2560 by 2560 m in pixels of 10 m. Band `rock` is the rock's elevation, band `snow` the depth of the slab that breaks loose: what lies
above 450 m where the bowl is steeper than 28 degrees.
"""

import numpy as np
import terrain_file
from make_terrain import rough, smooth_step

SIZE = 2560.0  # m
PIXEL = 10.0
BREAKS_ABOVE = 450.0  # m
BREAKS_STEEPER = np.tan(np.radians(28.0))
SLAB = 3.0  # m


def middle(y):
    """Of the bowl and of the gully that it drains into."""
    return 1280.0 + 160.0 * np.sin(y / 330.0)


def rock(x, y):
    """Falls to the north: 36 degrees under the ridge, less and less down to the valley floor."""
    way = np.clip(2150.0 - y, 0.0, 1800.0)  # from the floor
    up = way / 1800.0
    slope = 0.73 * way**2 / (2.0 * 1800.0) - 0.5 * np.clip(350.0 - y, 0.0, None)
    width = 110.0 + 420.0 * smooth_step(0.5, 0.9, up)
    away = np.abs(x - middle(y)) / width
    sides = 70.0 * smooth_step(0.0, 0.35, up) * away**2 / (1.0 + 0.5 * away**2)
    crags = (3.0 + 40.0 * smooth_step(0.7, 1.5, away)) * smooth_step(0.05, 0.35, up) * rough(x, y, 420.0, 5)
    return slope + sides + crags + 1.5 * rough(x, y, 500.0, 3)


def snow(x, y, elevation):
    steepness = np.hypot(*np.gradient(elevation, PIXEL))
    in_bowl = np.abs(x - middle(y)) < 400.0 + 60.0 * rough(x, y, 300.0, 3)
    return np.where((elevation > BREAKS_ABOVE) & (steepness > BREAKS_STEEPER) & in_bowl & (y > 390.0), SLAB, 0.0)


def main():
    middles = PIXEL * (np.arange(round(SIZE / PIXEL)) + 0.5)
    x, y = np.meshgrid(middles, middles)
    elevation = rock(x, y)
    terrain_file.write("mountain.tif", PIXEL, 0.1, {"rock": elevation, "snow": snow(x, y, elevation)})


if __name__ == "__main__":
    main()
