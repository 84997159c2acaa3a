"""The services of worlds/tunnel: ventilation duct, cables, water pipe, lamps and UWB anchors."""
import math

import numpy as np

import tunnel_shape as shape
import tunnel_textures as paint
from meshes import Mesh
from mjcf import EYE, SEEN, fmt
from tunnel_shape import place, swept

FLOODS = [14.0 + 28.0 * k for k in range(6)]  # lamps that OpenGL has a light for

# number, s, wall (+1 left), height
ANCHORS = [(1, 6.0, 1, 2.2), (2, 25.0, -1, 2.8), (3, 44.0, 1, 1.7), (4, 63.0, -1, 2.4), (5, 82.0, 1, 3.0),
           (6, 100.5, -1, 1.9), (7, 119.0, 1, 2.6), (8, 137.5, -1, 2.2), (9, 155.0, 1, 2.9)]


def circle(d, z, radius, count=10):
    t = np.linspace(0.0, 2.0 * math.pi, count, endpoint=False)
    return np.stack([d + radius * np.cos(t), z + radius * np.sin(t)], axis=1)


def services(w):
    """Duct, cables, water pipe, lamps and anchors."""
    w.comment('ventilation, water, power and light')
    mesh = Mesh()
    points, texture = swept(np.arange(-3.0, 150.1, 1.5), lambda s: circle(-1.9, 6.35 + 0.05 * math.sin(2 * math.pi * s / 6.0), 0.68, 14), 3.0, closed=True)
    mesh.grid(points, texture, flip=True)
    w.mesh('duct', mesh, 'duct', EYE)
    mesh = Mesh()
    for k, (height, radius) in enumerate(((2.62, 0.035), (2.45, 0.028), (2.30, 0.045), (2.12, 0.02))):
        side = shape.wall_offset(min(height, 2.5)) - 0.10
        points, texture = swept(np.arange(0.0, 158.1, 1.0), lambda s: circle(side, height - 0.07 * abs(math.sin(math.pi * s / 4.0)), radius, 5), 1.0, closed=True)
        mesh.grid(points, texture, flip=True)
    w.mesh('cables', mesh, 'cable', EYE)
    mesh = Mesh()
    side = -(shape.wall_offset(1.3) - 0.16)
    points, texture = swept(np.arange(0.0, 126.1, 2.0), lambda s: circle(side, 1.3, 0.08, 8), 1.0, closed=True)
    mesh.grid(points, texture, flip=True)
    w.mesh('water_pipe', mesh, 'hose_blue', SEEN)
    for i, s in enumerate(np.arange(2.0, 158.0, 4.0)):
        with w.at(s, shape.wall_offset(2.4) - 0.06):
            w.box(f'bracket_{i}', -0.03, 0.03, -0.08, 0.06, 2.05, 2.72, 'steel', EYE)
    for i, s in enumerate(np.arange(paint.LAMP_SPACING / 2, 158.0, paint.LAMP_SPACING)):
        reach = math.sqrt(shape.CROWN ** 2 - (paint.LAMP_HEIGHT - shape.SPRING) ** 2)
        with w.at(s, reach - 0.10):
            w.box(f'lamp_{i}', -0.65, 0.65, -0.05, 0.03, paint.LAMP_HEIGHT - 0.05, paint.LAMP_HEIGHT + 0.05, 'lamp', EYE)
            w.box(f'lamp_back_{i}', -0.72, 0.72, 0.03, 0.12, paint.LAMP_HEIGHT - 0.09, paint.LAMP_HEIGHT + 0.09, 'cabinet', EYE)
    for i, s in enumerate(FLOODS):
        with w.at(s, 1.6):
            w.box(f'flood_{i}', -0.20, 0.20, -0.14, 0.14, 7.18, 7.26, 'lamp_warm', EYE)
            w.box(f'flood_back_{i}', -0.24, 0.24, -0.18, 0.18, 7.26, 7.40, 'iron', EYE)
            w.lines.append(f'<light name="flood_{i}" pos="0 0 7.1" dir="0 -0.22 -1" cutoff="88" exponent="1.2" castshadow="false" '
                           'diffuse="1.5 1.38 1.14" specular="0.20 0.19 0.16" ambient="0 0 0" attenuation="0.6 0.02 0.010"/>')
    for number, (x, y, z) in anchor_places():
        w.geom(f'anchor_{number}', 'box', (x, y, z), (0.06, 0.06, 0.09), 'white', EYE)
        w.geom(f'anchor_{number}_led', 'sphere', (x, y, z + 0.1), (0.015,), 'led_green', EYE)
        w.lines.append(f'<site name="uwb_anchor_{number}" pos="{fmt((x, y, z))}" size="0.03" rgba="0.2 0.6 1 0.6" group="4"/>')


def anchor_places():
    for number, s, wall, z in ANCHORS:
        reach = shape.wall_offset(z) if z < shape.SPRING else math.sqrt(shape.CROWN ** 2 - (z - shape.SPRING) ** 2)
        x, y = place(s, wall * (reach - 0.14))
        yield number, (round(float(x), 3), round(float(y), 3), z)
