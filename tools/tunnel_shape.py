"""The shape of worlds/tunnel: its line, its section, its invert and its rock, as functions of chainage. Metres and radians."""
import math

import numpy as np

STRAIGHT = 80.0      # chainage at which the left curve begins
RADIUS = 400.0
LINED = 100.0        # lining up to here
FACE = 162.0
CROWN, SPRING = 5.5, 2.5   # radius of the crown, height of its centre
SIDE = 8.0           # radius of the side walls below it
FOOT = -0.6          # the section goes down to here, below the invert
OVERBREAK = 0.35     # rock lies outside the lined section by this on average


# --- the line ---------------------------------------------------------------------------------------------------------

def heading(s):
    return np.maximum(np.asarray(s, float) - STRAIGHT, 0.0) / RADIUS


def place(s, d):
    """x, y of chainage s and offset d to the left of the line."""
    s, d = np.asarray(s, float), np.asarray(d, float)
    a = heading(s)
    x = np.minimum(s, STRAIGHT) + (RADIUS - d) * np.sin(a)
    y = d + (RADIUS - d) * (1.0 - np.cos(a))
    return x, y


def chainage(x, y):
    """s, d of a place: `place` backwards."""
    x, y = np.asarray(x, float), np.asarray(y, float)
    a = np.arctan2(x - STRAIGHT, RADIUS - y)
    is_curved = x > STRAIGHT
    s = np.where(is_curved, STRAIGHT + RADIUS * a, x)
    d = np.where(is_curved, RADIUS - np.hypot(x - STRAIGHT, y - RADIUS), y)
    return s, d


# --- the section ------------------------------------------------------------------------------------------------------

def section(side_steps=5, crown_steps=18):
    """The horseshoe from its left foot over the crown to its right foot: points (d, z), outward normals, length along."""
    top = math.asin((SPRING - FOOT) / SIDE)
    points, normals = [], []
    for t in np.linspace(top, 0.0, side_steps, endpoint=False):
        points.append((CROWN - SIDE + SIDE * math.cos(t), SPRING - SIDE * math.sin(t)))
        normals.append((math.cos(t), -math.sin(t)))
    for t in np.linspace(0.0, math.pi, crown_steps + 1):
        points.append((CROWN * math.cos(t), SPRING + CROWN * math.sin(t)))
        normals.append((math.cos(t), math.sin(t)))
    for (d, z), (nd, nz) in zip(points[:side_steps][::-1], normals[:side_steps][::-1]):
        points.append((-d, z))
        normals.append((-nd, nz))
    points, normals = np.array(points), np.array(normals)
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    return points, normals, along


def wall_offset(z):
    """Half the width of the lined section at a height below the springing."""
    return CROWN - SIDE + math.sqrt(SIDE ** 2 - (SPRING - z) ** 2)


# --- noise ------------------------------------------------------------------------------------------------------------

class Lattice:
    """Smooth random numbers on the plane, -1 ... 1: bicubic blends of a periodic lattice of one wavelength."""

    def __init__(self, seed, wavelength, count=64):
        self.values = np.random.default_rng(seed).uniform(-1.0, 1.0, (count, count))
        self.wavelength, self.count = wavelength, count

    def __call__(self, u, v):
        u, v = np.asarray(u, float) / self.wavelength, np.asarray(v, float) / self.wavelength
        i, j = np.floor(u).astype(int), np.floor(v).astype(int)
        fu, fv = u - i, v - j
        fu, fv = fu * fu * (3.0 - 2.0 * fu), fv * fv * (3.0 - 2.0 * fv)
        at = lambda a, b: self.values[(i + a) % self.count, (j + b) % self.count]
        return (at(0, 0) * (1 - fu) + at(1, 0) * fu) * (1 - fv) + (at(0, 1) * (1 - fu) + at(1, 1) * fu) * fv


# --- the invert -------------------------------------------------------------------------------------------------------

LANES = (-2.2, 2.2)                   # vehicles keep to these offsets
TRENCH = (131.3, 138.7, 0.40)         # from, to, depth: excavated for the invert's concrete
_swell, _bumps, _rubble, _wear = Lattice(11, 5.0), Lattice(12, 1.7), Lattice(13, 0.7), Lattice(14, 7.0)


def smooth_step(low, high, value):
    t = np.clip((value - low) / (high - low), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def invert_height(s, d):
    """Height of the ground: ruts and gentle swell on the lanes, rubble towards the walls, the trench under the bridge."""
    s, d = np.asarray(s, float), np.asarray(d, float)
    beside = smooth_step(3.6, 4.6, np.abs(d))
    rough = 1.0 + 0.5 * smooth_step(LINED - 4.0, LINED + 6.0, s)
    z = rough * (0.010 * _swell(s, d) + (0.006 + 0.012 * beside) * _bumps(s, d) + (0.003 + 0.027 * beside) * _rubble(s, d))
    z += 0.02 * beside
    for lane in LANES:
        for wheel in (-1.0, 1.0):
            across = (d - lane - wheel) / 0.26
            wear = 0.6 + 0.4 * _wear(s, d + 20.0 * lane)
            z += wear * (-0.020 * np.exp(-across ** 2) + 0.007 * (np.exp(-(across - 1.9) ** 2) + np.exp(-(across + 1.9) ** 2)))
    z *= 0.25 + 0.75 * smooth_step(5.0, 9.0, s)                              # a concrete slab at the portal
    start, end, depth = TRENCH
    edge = 0.45
    inside = smooth_step(start, start + edge, s) * (1.0 - smooth_step(end - edge, end, s))
    flat = smooth_step(start - 4.0, start - 3.0, s) * (1.0 - smooth_step(end + 3.0, end + 4.0, s))
    return z * (1.0 - 0.9 * flat) - depth * inside


# --- the rock ---------------------------------------------------------------------------------------------------------

_blocks, _ledges, _chips = Lattice(21, 3.4), Lattice(22, 1.5), Lattice(23, 0.8)


def rock_offset(s, along):
    """How far the rock stands outside the lined section: shotcrete first, bare rock towards the face."""
    bare = smooth_step(FACE - 22.0, FACE - 10.0, s)
    return (OVERBREAK + (0.10 + 0.08 * bare) * _blocks(s, along) + (0.05 + 0.06 * bare) * _ledges(s, along)
            + (0.015 + 0.04 * bare) * _chips(s, along))


def face_offset(d, z):
    return 0.30 * _blocks(d + 40.0, z) + 0.14 * _ledges(d + 40.0, z) + 0.06 * _chips(d + 40.0, z)


# --- swept surfaces -------------------------------------------------------------------------------------------

def swept(stations, profile, texture_length, closed=False):
    """Points of a profile [(d, z)] carried along the chainages, and their texture coordinates. A function of chainage may stand
    for the profile."""
    rows, texture = [], []
    for s in stations:
        outline = np.asarray(profile(s) if callable(profile) else profile, float)
        if closed:
            outline = np.concatenate([outline, outline[:1]])
        x, y = place(s, outline[:, 0])
        rows.append(np.stack([x, y, outline[:, 1]], axis=1))
        along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(outline, axis=0), axis=1))])
        texture.append(np.stack([np.full(len(outline), s / texture_length), along / along[-1]], axis=1))
    return np.array(rows), np.array(texture)
