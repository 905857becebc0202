#!/usr/bin/env python3
"""Makes sky.hdr: `python3 make_sky.py` writes a late-afternoon sky over hills beside this file, in half a minute.

A latitude-longitude map: the centre looks along -Z, columns go from there to +X, rows from +Y down. The sky follows
Preetham, Shirley and Smits, "A Practical Analytic Model for Daylight" (1999), section 3 and appendix, also for the
colour of the sun; clouds, hills and ground are noise: Perlin, "Improving Noise" (2002). Radiances are such that a
white sheet lying flat under the clear sky and the sun has luminance 1.
"""

import math
import random
from pathlib import Path

import radiance_picture

WIDTH, HEIGHT = 1024, 512
TEXEL = 2 * math.pi / WIDTH  # [rad]

SUN_AZIMUTH = math.radians(55)  # From -Z towards +X.
SUN_ELEVATION = math.radians(18)
SUN_RADIUS = math.radians(0.2665)
# Irradiance on a surface that faces the sun, over that of the clear sky on the ground: crisp shadows, not black ones.
SUN_TO_SKY = 5.0
TURBIDITY = 2.5  # Clear air.


def direction(azimuth, elevation):
    return (math.cos(elevation) * math.sin(azimuth), math.sin(elevation), -math.cos(elevation) * math.cos(azimuth))


SUN = direction(SUN_AZIMUTH, SUN_ELEVATION)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def scale(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def multiply(a, b):
    return (a[0] * b[0], a[1] * b[1], a[2] * b[2])


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def mix(a, b, t):
    return (a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t)


def smoothstep(low, high, x):
    t = min(max((x - low) / (high - low), 0.0), 1.0)
    return t * t * (3 - 2 * t)


def luminance(rgb):
    return dot((0.2126, 0.7152, 0.0722), rgb)


# --- Clear sky and sun -----------------------------------------------------------------------------------------------

# Perez' coefficients A to E of luminance and of the chromaticities x and y, as slope and offset over turbidity.
PEREZ = [
    [s * TURBIDITY + o for s, o in table]
    for table in (
        ((0.1787, -1.4630), (-0.3554, 0.4275), (-0.0227, 5.3251), (0.1206, -2.5771), (-0.0670, 0.3703)),
        ((-0.0193, -0.2592), (-0.0665, 0.0008), (-0.0004, 0.2125), (-0.0641, -0.8989), (-0.0033, 0.0452)),
        ((-0.0167, -0.2608), (-0.0950, 0.0092), (-0.0079, 0.2102), (-0.0441, -1.6537), (-0.0109, 0.0529)),
    )
]

# The zenith's chromaticities: coefficients of turbidity^2, turbidity and 1, each a cubic in the sun's zenith angle.
ZENITH_X = (
    (0.00166, -0.00375, 0.00209, 0.0),
    (-0.02903, 0.06377, -0.03202, 0.00394),
    (0.11693, -0.21196, 0.06052, 0.25886),
)
ZENITH_Y = (
    (0.00275, -0.00610, 0.00317, 0.0),
    (-0.04214, 0.08970, -0.04153, 0.00516),
    (0.15346, -0.26756, 0.06670, 0.26688),
)


def zenith_values():
    """Luminance [kcd/m^2], x and y straight above."""
    theta = math.pi / 2 - SUN_ELEVATION
    chi = (4 / 9 - TURBIDITY / 120) * (math.pi - 2 * theta)
    values = [(4.0453 * TURBIDITY - 4.9710) * math.tan(chi) - 0.2155 * TURBIDITY + 2.4192]
    for table in (ZENITH_X, ZENITH_Y):
        cubics = [((a * theta + b) * theta + c) * theta + d for a, b, c, d in table]
        values.append((cubics[0] * TURBIDITY + cubics[1]) * TURBIDITY + cubics[2])
    return values


def perez(coefficients, cos_theta, gamma):
    a, b, c, d, e = coefficients
    return (1 + a * math.exp(b / cos_theta)) * (1 + c * math.exp(d * gamma) + e * math.cos(gamma) ** 2)


# What a coefficient's distribution is multiplied by: the zenith's value over the distribution there.
PEREZ_SCALES = [
    value / perez(coefficients, 1.0, math.pi / 2 - SUN_ELEVATION)
    for value, coefficients in zip(zenith_values(), PEREZ)
]


def model_sky(d):
    """Radiance of the clear sky in the unit direction d, in the model's unit; below the horizon as just above it."""
    cos_theta = max(d[1], 0.015)
    gamma = math.acos(min(max(dot(d, SUN), -1.0), 1.0))
    big_y, x, y = (s * perez(c, cos_theta, gamma) for s, c in zip(PEREZ_SCALES, PEREZ))
    big_x, big_z = x / y * big_y, (1 - x - y) / y * big_y
    return (
        max(3.2404542 * big_x - 1.5371385 * big_y - 0.4985314 * big_z, 0.0),
        max(-0.9692660 * big_x + 1.8760108 * big_y + 0.0415560 * big_z, 0.0),
        max(0.0556434 * big_x - 0.2040259 * big_y + 1.0572252 * big_z, 0.0),
    )


def sun_colour():
    """The sun's light behind the air, of luminance 1: white light minus absorption by molecules, aerosols and ozone."""
    angle = math.degrees(math.pi / 2 - SUN_ELEVATION)
    mass = 1 / (math.cos(math.radians(angle)) + 0.15 * (93.885 - angle) ** -1.253)
    beta = 0.04608 * TURBIDITY - 0.04586
    rgb = []
    for wavelength, ozone in ((0.61, 0.12), (0.55, 0.085), (0.465, 0.015)):  # [um], [1/cm]
        depth = 0.008735 * wavelength**-4.08 + beta * wavelength**-1.3 + 0.35 * ozone
        rgb.append(math.exp(-depth * mass))
    return scale(rgb, 1 / luminance(rgb))


def irradiance_of_model_sky(steps=48):
    """On the ground, by the midpoint rule."""
    total = (0.0, 0.0, 0.0)
    for i in range(steps):
        elevation = (i + 0.5) / steps * math.pi / 2
        weight = math.sin(elevation) * math.cos(elevation) * (math.pi / 2 / steps) * (2 * math.pi / (2 * steps))
        for j in range(2 * steps):
            sky = model_sky(direction(2 * math.pi * (j + 0.5) / (2 * steps), elevation))
            total = add(total, scale(sky, weight))
    return total


MODEL_IRRADIANCE = irradiance_of_model_sky()
# From the model's unit to that of the file.
UNIT = math.pi / (luminance(MODEL_IRRADIANCE) * (1 + SUN_TO_SKY * math.sin(SUN_ELEVATION)))
SKY_IRRADIANCE = scale(MODEL_IRRADIANCE, UNIT)  # On the ground.
SUN_IRRADIANCE = scale(sun_colour(), SUN_TO_SKY * luminance(SKY_IRRADIANCE))  # On a surface that faces the sun.

GROUND_ALBEDO = (0.16, 0.13, 0.075)
# Radiance of the ground under both.
GROUND = scale(
    multiply(GROUND_ALBEDO, add(SKY_IRRADIANCE, scale(SUN_IRRADIANCE, math.sin(SUN_ELEVATION)))), 1 / math.pi
)


def clear_sky(d):
    return scale(model_sky(d), UNIT)


# --- Noise -----------------------------------------------------------------------------------------------------------


def shuffled_bytes():
    numbers = random.Random(7)
    keys = [numbers.random() for _ in range(256)]
    return sorted(range(256), key=keys.__getitem__) * 2


PERMUTATION = shuffled_bytes()
GRADIENTS = [(math.cos(2 * math.pi * i / 64), math.sin(2 * math.pi * i / 64)) for i in range(64)] * 4


def noise(x, y):
    """Gradient noise of the plane, of wavelength 1, within about [-0.7, 0.7]."""
    i, j = math.floor(x), math.floor(y)
    x, y = x - i, y - j
    i, j = i & 255, j & 255
    p0, p1 = PERMUTATION[i], PERMUTATION[i + 1]
    g00, g10 = GRADIENTS[PERMUTATION[p0 + j]], GRADIENTS[PERMUTATION[p1 + j]]
    g01, g11 = GRADIENTS[PERMUTATION[p0 + j + 1]], GRADIENTS[PERMUTATION[p1 + j + 1]]
    u = x * x * x * (x * (x * 6 - 15) + 10)
    v = y * y * y * (y * (y * 6 - 15) + 10)
    bottom = g00[0] * x + g00[1] * y
    bottom += u * (g10[0] * (x - 1) + g10[1] * y - bottom)
    top = g01[0] * x + g01[1] * (y - 1)
    top += u * (g11[0] * (x - 1) + g11[1] * (y - 1) - top)
    return bottom + v * (top - bottom)


def fractal(x, y, octaves, footprint, gain=0.5):
    """A sum of octaves, less those that are finer than the footprint of a texel shows."""
    total, amplitude = 0.0, 1.0
    for _ in range(octaves):
        visible = 1 - smoothstep(0.25, 0.7, footprint)
        if visible == 0:
            break
        total += visible * amplitude * noise(x, y)
        # Octaves turned against each other by an angle of cosine 0.8 hide the lattice.
        x, y = 2.03 * (0.8 * x - 0.6 * y) + 17.3, 2.03 * (0.6 * x + 0.8 * y) + 5.1
        footprint *= 2.03
        amplitude *= gain
    return total


# --- Clouds: a thin layer over a round Earth, lengths in heights of the layer ----------------------------------------

EARTH_RADIUS = 1500.0
CLOUD_FREQUENCY = 0.9


def cloud_depth(x, z, footprint, octaves):
    """Optical depth of the layer, straight through."""
    x, z = x * CLOUD_FREQUENCY, z * CLOUD_FREQUENCY
    footprint *= CLOUD_FREQUENCY
    # A slow wave of cover, so that clouds come in fields; and a bend of the plane, so that they are not blobs.
    cover = 0.5 * noise(0.31 * x + 3.7, 0.31 * z - 8.2)
    bend = 0.55 * noise(0.9 * x + 41.0, 0.9 * z + 9.0) * (1 - smoothstep(0.3, 0.8, footprint))
    value = fractal(x + bend, 0.75 * z - bend, octaves, footprint, 0.56) + cover
    return 5.0 * smoothstep(0.0, 0.85, value) ** 1.5


def add_clouds(sky, d):
    """The sky in direction d behind and between the clouds."""
    rise = EARTH_RADIUS * d[1]
    distance = math.sqrt(rise * rise + 2 * EARTH_RADIUS + 1) - rise
    x, z = d[0] * distance, d[2] * distance
    slope = (rise + distance) / EARTH_RADIUS  # Cosine between the ray and the layer's normal, nearly.
    footprint = distance * TEXEL / max(math.sqrt(max(slope, 0.0)), 0.08)
    depth = cloud_depth(x, z, footprint, 7)
    if depth < 1e-3:
        return sky
    # The layer's matter between here and the sun.
    shadow = 0.0
    for step in (0.08, 0.2, 0.42):
        shadow += cloud_depth(x + step * SUN[0], z + step * SUN[2], footprint, 5)
    cos_gamma = dot(d, SUN)
    g = 0.75  # Droplets scatter forwards; Henyey and Greenstein's phase function, over that of isotropic scattering.
    forward = (1 - g * g) / (1 + g * g - 2 * g * cos_gamma) ** 1.5
    lit = math.exp(-0.2 * shadow) * (0.75 + 0.25 * math.exp(-0.6 * depth) * min(forward, 12.0))
    sunlight = scale(SUN_IRRADIANCE, 0.17 * lit)
    # From above comes the sky's light, from below that of the ground; less through a thick cloud.
    skylight = scale(SKY_IRRADIANCE, (0.45 + 0.25 * math.exp(-0.7 * depth)) / math.pi)
    skylight = add(skylight, scale(GROUND, 0.25))
    opacity = (1 - math.exp(-1.1 * depth)) * math.exp(-distance / 38.0)
    return mix(sky, add(sunlight, skylight), opacity)


# --- Hills and ground ------------------------------------------------------------------------------------------------

# Ranges of hills from the farthest: mean elevation and its variation [rad], frequency, share of haze.
HILLS = ((0.046, 0.045, 2.6, 0.62), (0.028, 0.034, 4.1, 0.42), (0.012, 0.022, 6.3, 0.24))


def haze(d):
    """The colour of far things: that of the sky a little above the horizon, in the same azimuth."""
    length = math.hypot(d[0], d[2])
    up = 0.16
    s = math.sqrt(1 - up * up) / max(length, 1e-6)
    return multiply(clear_sky((d[0] * s, up, d[2] * s)), (0.6, 0.68, 0.8))


def add_hills(sky, d, elevation, veil):
    azimuth = math.atan2(d[0], -d[2])
    for number, (mean, variation, frequency, far) in enumerate(HILLS):
        x, y = frequency * math.cos(azimuth) + 31 * number, frequency * math.sin(azimuth) + 57
        top = mean + variation * fractal(x, y, 6, frequency * TEXEL, 0.45)
        fraction = smoothstep(-0.6 * TEXEL, 0.6 * TEXEL, top - elevation)
        if fraction > 0:
            colour = mix(scale(GROUND, 0.55), veil, far * (1 - 0.25 * smoothstep(0.0, 0.05, elevation)))
            sky = mix(sky, colour, fraction)
    return sky


def ground(d, veil):
    """The plain from 1 above it: patches of earth, fading into haze."""
    distance = 1 / max(-d[1], 1e-4)
    x, z = d[0] * distance, d[2] * distance
    footprint = distance * distance * TEXEL
    patches = fractal(1.3 * x, 1.3 * z, 6, 1.3 * footprint, 0.65)
    colour = multiply(GROUND, (1 + 0.5 * patches, 1 + 0.38 * patches, 1 + 0.4 * patches))
    return mix(colour, veil, 0.3 * (1 - math.exp(-distance / 30.0)))


# --- The picture -----------------------------------------------------------------------------------------------------


def texel_direction(column, row):
    """Through a point of the map, in texels from its upper left corner."""
    return direction(2 * math.pi * (column / WIDTH - 0.5), math.pi * (0.5 - row / HEIGHT))


def sun_fraction(column, row, samples=24):
    """The share of a texel that the sun's disk covers."""
    if dot(texel_direction(column + 0.5, row + 0.5), SUN) < math.cos(SUN_RADIUS + 2 * TEXEL):
        return 0.0
    inside = 0
    for i in range(samples):
        for j in range(samples):
            d = texel_direction(column + (i + 0.5) / samples, row + (j + 0.5) / samples)
            inside += dot(d, SUN) > math.cos(SUN_RADIUS)
    return inside / samples**2


def radiance(column, row):
    d = texel_direction(column + 0.5, row + 0.5)
    elevation = math.pi * (0.5 - (row + 0.5) / HEIGHT)
    veil = haze(d)
    if elevation < 0:
        colour = ground(d, veil)
    else:
        colour = add_clouds(clear_sky(d), d)
        fraction = sun_fraction(column, row)
        if fraction > 0:
            solid_angle = 2 * math.pi * (1 - math.cos(SUN_RADIUS))
            colour = add(colour, scale(SUN_IRRADIANCE, fraction / solid_angle))
    return add_hills(colour, d, elevation, veil) if 0 < elevation < 0.15 else colour


# --- The file --------------------------------------------------------------------------------------------------------


def encoded_row(row):
    return radiance_picture.encoded_row([radiance(column, row) for column in range(WIDTH)])


def header():
    return radiance_picture.header("make_sky.py", WIDTH, HEIGHT)


if __name__ == "__main__":
    rows = [encoded_row(row) for row in range(HEIGHT)]
    Path(__file__).with_name("sky.hdr").write_bytes(header() + b"".join(rows))
