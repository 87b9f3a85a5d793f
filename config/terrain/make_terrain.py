#!/usr/bin/python3
"""Writes terrain.tif, ground that config/scenes/terrain.yaml takes: rocks at the foot of a cliff, and the sand between them.

    /usr/bin/python3 make_terrain.py

8 by 6 m in pixels of 0.04 m. Band `rock` is the rock's elevation, band `sand` that of the sand's surface, both in whole millimetres, with a
scale that makes them metres.
"""

import numpy as np
import terrain_file

SIZE = np.array([8.0, 6.0])  # m
PIXEL = 0.04  # m
RANDOM = np.random.RandomState(7)


def smooth_step(low, high, value):
    t = np.clip((value - low) / (high - low), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def noise(x, y, wavelength):
    """Smooth noise between -1 and 1: random numbers on a lattice of this wavelength, blended between."""
    lattice = RANDOM.uniform(-1.0, 1.0, (64, 64))
    u, v = x / wavelength + 16.0, y / wavelength + 16.0
    i, j = np.floor(u).astype(int), np.floor(v).astype(int)
    s, t = smooth_step(0.0, 1.0, u - i), smooth_step(0.0, 1.0, v - j)
    corner = lambda di, dj: lattice[(i + di) % 64, (j + dj) % 64]
    return (1 - s) * (1 - t) * corner(0, 0) + s * (1 - t) * corner(1, 0) + (1 - s) * t * corner(0, 1) + s * t * corner(1, 1)


def rough(x, y, wavelength, octaves):
    return sum(noise(x, y, wavelength / 2**k) / 2**k for k in range(octaves))


def cliff(x, y):
    """A plateau 1.5 m up in the north, with ledges where its strata end."""
    edge = 4.4 + 0.45 * rough(x, 0.0 * y, 2.4, 3) + 0.06 * rough(x, y, 0.4, 2)
    strata = [(0.00, 0.45), (0.16, 0.30), (0.22, 0.40), (0.42, 0.35)]  # m behind the edge; m high
    height = sum(rise * smooth_step(0.0, 0.09, y - edge - behind - 0.05 * noise(x, y, 0.7)) for behind, rise in strata)
    return height + 0.03 * smooth_step(0.3, 0.6, height) * rough(x, y, 0.5, 3)


def boulder(x, y, centre, radius, height, turn):
    """A block with facets and rounded corners; below the ground outside of it."""
    u = (np.cos(turn) * (x - centre[0]) + np.sin(turn) * (y - centre[1])) / radius
    v = (-np.sin(turn) * (x - centre[0]) + np.cos(turn) * (y - centre[1])) / (0.75 * radius)
    facets = [u * np.cos(a) + v * np.sin(a) for a in RANDOM.uniform(0.0, 0.5) + np.arange(7) * 2.0 * np.pi / 7.0]
    distance = 0.6 * np.max(facets, axis=0) + 0.4 * np.hypot(u, v)
    top = 1.0 + 0.25 * u * RANDOM.uniform(-1.0, 1.0) + 0.25 * v * RANDOM.uniform(-1.0, 1.0)
    return height * (np.minimum(top, 2.6 * (1.0 - distance)) + 0.05 * rough(x, y, 0.3, 2)) - 0.3


def rock(x, y):
    ground = -0.35 + 0.10 * rough(x, y, 2.0, 4) + cliff(x, y)
    for k in range(17):
        # Large ones first, and most of them at the foot of the cliff.
        radius = 0.75 * 0.92**k
        centre = RANDOM.uniform([0.3, 0.3], [7.7, 4.2])
        centre[1] += (4.2 - centre[1]) * RANDOM.uniform(0.0, 0.6)
        ground = np.maximum(ground, boulder(x, y, centre, radius, max(0.5, 1.2 * radius), RANDOM.uniform(0.0, np.pi)))
    return ground


def sand(x, y):
    """Lies highest at the cliff, in low dunes that run across the wind."""
    return 0.02 + 0.05 * y / SIZE[1] + 0.06 * rough(x, y, 3.0, 2) + 0.02 * np.sin(2.0 * np.pi * (0.9 * x + 0.5 * y + 0.4 * noise(x, y, 1.5)))


def main():
    columns, rows = np.rint(SIZE / PIXEL).astype(int)
    x, y = np.meshgrid(PIXEL * (np.arange(columns) + 0.5), PIXEL * (np.arange(rows) + 0.5))
    terrain_file.write("terrain.tif", PIXEL, 0.001, {"rock": rock(x, y), "sand": sand(x, y)})


if __name__ == "__main__":
    main()
