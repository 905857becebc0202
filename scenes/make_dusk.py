#!/usr/bin/env python3
"""Makes dusk.hdr: `python3 make_dusk.py` writes a clear sky just after sunset beside this file.

A latitude-longitude map, like sky.hdr. The glow around the place where the sun went down is so wide that light which
meets it by chance, as all light behind glass must, makes little noise.
"""

import math
from pathlib import Path

import radiance_picture

WIDTH, HEIGHT = 512, 256

GLOW_AZIMUTH = math.radians(80)  # From -Z towards +X.
GLOW_ELEVATION = math.radians(22)
GLOW_WIDTH = math.radians(16)  # One standard deviation.
GLOW = (18.0, 7.8, 2.5)  # Radiance [W/(m^2 sr)] at its middle, like the other colours.
HALO_WIDTH = math.radians(30)
HALO = (1.0, 0.36, 0.14)

ZENITH = (0.09, 0.17, 0.44)
ROSE = (0.45, 0.24, 0.42)  # The band above the horizon ...
ROSE_HEIGHT = math.radians(22)
EMBER = (2.2, 0.75, 0.16)  # ... and the one upon it, behind the still life on its right.
EMBER_HEIGHT = math.radians(8)
EMBER_AZIMUTH = math.radians(24)
EMBER_WIDTH = math.radians(24)
HILLS = (0.06, 0.05, 0.09)
SOFT = math.radians(0.4)  # Across the edge of the hills.
WATER = 0.5  # The share of the light that the lake mirrors.


def mix(a, b, t):
    return [x + (y - x) * t for x, y in zip(a, b)]


def hill_height(azimuth):
    """The elevation [rad] up to which hills hide the sky."""
    waves = ((0.9, 3, 1), (0.6, 7, 0), (0.3, 16, 2))
    return math.radians(2.2 + sum(a * math.sin(f * azimuth + phase) for a, f, phase in waves))


def radiance(azimuth, elevation):
    """Of the direction that lies `azimuth` from -Z towards +X and `elevation` above the horizon [rad]."""
    if elevation < 0:  # The lake before the hills.
        return [WATER * c for c in radiance(azimuth, -elevation)]
    cosine = math.sin(elevation) * math.sin(GLOW_ELEVATION)
    cosine += math.cos(elevation) * math.cos(GLOW_ELEVATION) * math.cos(azimuth - GLOW_AZIMUTH)
    angle = math.acos(max(-1.0, min(1.0, cosine)))
    beside = math.remainder(azimuth - EMBER_AZIMUTH, 2 * math.pi)
    ember = math.exp(-0.5 * (beside / EMBER_WIDTH) ** 2 - elevation / EMBER_HEIGHT)
    sky = mix(ZENITH, ROSE, math.exp(-elevation / ROSE_HEIGHT))
    sky = mix(sky, EMBER, ember)
    glow, halo = math.exp(-0.5 * (angle / GLOW_WIDTH) ** 2), math.exp(-0.5 * (angle / HALO_WIDTH) ** 2)
    sky = [s + g * glow + h * halo for s, g, h in zip(sky, GLOW, HALO)]
    above = (elevation - hill_height(azimuth)) / SOFT
    return mix(HILLS, sky, min(max(above, 0.0), 1.0))


def encoded_row(row):
    elevation = math.pi * (0.5 - (row + 0.5) / HEIGHT)
    azimuths = [2 * math.pi * ((column + 0.5) / WIDTH - 0.5) for column in range(WIDTH)]
    return radiance_picture.encoded_row([radiance(azimuth, elevation) for azimuth in azimuths])


def header():
    return radiance_picture.header("make_dusk.py", WIDTH, HEIGHT)


if __name__ == "__main__":
    rows = [encoded_row(row) for row in range(HEIGHT)]
    Path(__file__).with_name("dusk.hdr").write_bytes(header() + b"".join(rows))
