"""Textures of worlds/tunnel. Lamps hang every LAMP_SPACING along the left wall: their light on lining and invert is painted here,
since OpenGL has eight lights and the tunnel has twenty."""
import math

import numpy as np
from PIL import Image

from textures import noise, stretched_noise

LAMP_SPACING = 8.0
LAMP_HEIGHT = 3.7
RING = 2.0  # length of a lining ring


def paint(field, low, high):
    low, high = np.array(low, float), np.array(high, float)
    return low + field[..., None] * (high - low)


def lining(rng, size, length_along):
    """LAMP_SPACING of lined tunnel: x along the tunnel, y from the left foot over the crown to the right foot."""
    metres = np.arange(size) / size * LAMP_SPACING
    along = np.arange(size) / size * length_along
    field = 0.6 * noise(rng, size, (2, 4, 16, 64), (0.5, 0.8, 1, 2)) + 0.4 * stretched_noise(rng, size, (4, 16, 32), (1, 1, 1), 6)
    image = paint(field, (92, 92, 90), (186, 184, 178))
    # Joints between rings, and the keys of their segments, shifted from ring to ring.
    to_joint = np.abs((metres + RING / 2) % RING - RING / 2)
    image *= (1.0 - 0.62 * np.exp(-(to_joint / 0.018) ** 2) - 0.10 * np.exp(-(to_joint / 0.10) ** 2))[None, :, None]
    for ring in range(int(LAMP_SPACING / RING)):
        columns = (metres >= ring * RING) & (metres < (ring + 1) * RING)
        tone = 1.0 + 0.07 * rng.uniform(-1, 1)
        image[:, columns] *= tone
        for key in np.linspace(0.06, 0.94, 7) + (0.035 if ring % 2 else -0.035):
            gap = np.abs(along - key * length_along)
            image[:, columns] *= (1.0 - 0.45 * np.exp(-(gap / 0.02) ** 2))[:, None, None]
        for key in np.linspace(0.13, 0.87, 12):  # bolt pockets
            for side in (0.22, RING - 0.22):
                y, x = int(key * size), int((ring * RING + side) / LAMP_SPACING * size)
                image[y - 4:y + 4, x - 6:x + 6] *= 0.55
    # Splashed with mud at the foot, white bloom of lime at some joints.
    height = np.minimum(along, length_along - along)
    mud = np.clip(1.0 - height / 1.5, 0.0, 1.0) ** 1.5 * (0.5 + 0.5 * noise(rng, size, (16, 32), (1, 1)).mean(axis=1))
    image += mud[:, None, None] * (np.array((84, 74, 60)) - image) * 0.8
    for _ in range(9):
        x, y0, reach = rng.integers(size), rng.integers(size), rng.integers(60, 190)
        wide = rng.integers(2, 9)
        rows = (y0 + np.arange(reach)) % size
        image[np.ix_(rows, (x + np.arange(wide)) % size)] += np.linspace(26, 0, reach)[:, None, None]
    # The lamp's light: strongest beside it, fading over the section.
    lamp_at = (LAMP_HEIGHT + 0.6) / length_along
    down = along / length_along - lamp_at
    glow = np.exp(-((metres - LAMP_SPACING / 2) / 1.9) ** 2)[None, :] * np.exp(-(down / 0.11) ** 2)[:, None]
    veil = 0.62 + 0.16 * np.cos(2 * math.pi * (metres / LAMP_SPACING - 0.5))[None, :] * np.exp(-(down / 0.45) ** 2)[:, None]
    image = image * veil[..., None] + glow[..., None] * np.array((96, 88, 66)) * (0.55 + 0.9 * field[..., None])
    return Image.fromarray(image.clip(0, 255).astype(np.uint8))


def rock(rng, size, low, high, crack):
    field = noise(rng, size, (2, 4, 8, 32, 64), (0.7, 1, 1.2, 1.2, 1))
    sharp = np.abs(noise(rng, size, (8, 16, 32), (1, 1, 1)) - 0.5) * 2.0
    image = paint(field ** 1.2, low, high) * (1.0 - crack * np.exp(-(sharp / 0.05) ** 2))[..., None]
    wet = (stretched_noise(rng, size, (16, 32, 64), (1, 1, 1), 4) > 0.60)
    image[wet] *= 0.74
    return Image.fromarray(image.clip(0, 255).astype(np.uint8))


def invert(rng, size, width):
    """LAMP_SPACING of the ground: x along the tunnel, y from its left edge to its right edge."""
    d = width / 2 - np.arange(size) / size * width
    field = noise(rng, size, (1, 2, 4, 16, 64), (0.8, 1, 1, 1, 1.4))
    image = paint(field, (54, 48, 41), (138, 126, 110))
    grit = noise(rng, size, (2, 4), (1, 1))
    image[grit > 0.70] *= 1.28
    for lane in (-2.2, 2.2):  # where wheels run it is smooth, dark and wet
        for wheel in (-1.0, 1.0):
            wear = np.exp(-((d - lane - wheel) / 0.30) ** 2) * 0.62
            tread = 1.0 + 0.10 * np.sign(np.sin(2 * math.pi * np.arange(size) * 40 / size))
            track = (np.array((58, 53, 48)) * tread[None, :, None]) * (0.85 + 0.3 * field[..., None])
            image += wear[:, None, None] * (track - image)
    puddle = noise(rng, size, (64, 128), (1, 1))
    low_ground = np.exp(-(d / 1.0) ** 2) + 0.8 * np.exp(-((np.abs(d) - 1.2) / 0.3) ** 2) + 0.8 * np.exp(-((np.abs(d) - 3.2) / 0.3) ** 2)
    wet = np.clip((puddle - 0.50) * 9.0, 0.0, 1.0) * np.clip(low_ground, 0.0, 1.0)[:, None]
    mirror = np.array((86, 90, 90)) + 26.0 * noise(rng, size, (32,), (1,))[..., None]
    image += 0.85 * wet[..., None] * (mirror - image)
    edge = np.clip((np.abs(d) - 3.5) / 1.0, 0.0, 1.0)[:, None, None]
    image += edge * 0.5 * (paint(noise(rng, size, (4, 8, 16), (1, 1, 1)), (50, 46, 42), (150, 142, 130)) - image)
    metres = np.arange(size) / size * LAMP_SPACING
    veil = 0.80 + 0.20 * np.cos(2 * math.pi * (metres / LAMP_SPACING - 0.5))[None, :] * np.exp(-((d - 4.0) / 4.0) ** 2)[:, None]
    return Image.fromarray((image * veil[..., None]).clip(0, 255).astype(np.uint8))


def duct(rng, size):
    x = np.arange(size)
    hoop = 0.80 + 0.20 * np.abs(np.sin(math.pi * x * 8 / size)) ** 0.5
    seam = 1.0 - 0.35 * (x % (size // 2) < 3)
    field = noise(rng, size, (4, 16, 64), (1, 1, 1))
    return Image.fromarray((paint(field, (176, 138, 28), (226, 184, 60)) * (hoop * seam)[None, :, None]).clip(0, 255).astype(np.uint8))


def planks(rng, size, light, dark):
    image = np.zeros((size, size, 3))
    grain = stretched_noise(rng, size, (1, 4, 32), (1, 1, 1), 8).T
    count = 8
    for i in range(count):
        rows = slice(i * size // count, (i + 1) * size // count - 2)
        mix = rng.random()
        image[rows] = (np.array(dark) + mix * (np.array(light) - np.array(dark))) * (0.75 + 0.5 * grain[rows][..., None])
    return Image.fromarray(image.clip(0, 255).astype(np.uint8))


def daylight(size):
    """Six faces above one another (right, left, up, down, front, back): an overcast sky over the portal."""
    faces = []
    height = np.linspace(1, -1, size)[:, None, None]
    for face in range(6):
        image = np.array((196, 204, 212.0)) + np.zeros((size, size, 1)) + 24.0 * np.clip(height, 0, 1)
        if face == 3:
            image = np.tile(np.array((96, 94, 90.0)), (size, size, 1))
        elif face != 2:
            image = np.where(height < 0, np.array((104, 102, 98.0)), image)
        faces.append(image)
    return Image.fromarray(np.concatenate(faces).clip(0, 255).astype(np.uint8))
