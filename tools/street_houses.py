"""The houses of worlds/street, their front gardens and what parts these from the pavement."""
import math

import numpy as np

from mjcf import EYE, SEEN, SOLID, TOUCH, upright
from street_ground import BAY, EAST, KERB, NORTH, PAVEMENT, SOUTH, WEST


class Front:
    """A house front's own axes: u along the front, v away from the street, so that one description serves all sides."""

    def __init__(self, side, u0, line):
        self.side, self.u0, self.line = side, u0, line

    def box(self, w, name, u0, u1, v0, v1, z0, z1, material, cls=SOLID):
        u0, u1 = self.u0 + u0, self.u0 + u1
        if self.side == 'west':
            w.box(name, self.line - v1, self.line - v0, u0, u1, z0, z1, material, cls)
        elif self.side == 'east':
            w.box(name, self.line + v0, self.line + v1, u0, u1, z0, z1, material, cls)
        elif self.side == 'north':
            w.box(name, u0, u1, self.line + v0, self.line + v1, z0, z1, material, cls)
        else:
            w.box(name, u0, u1, self.line - v1, self.line - v0, z0, z1, material, cls)

    def point(self, u, v):
        u = self.u0 + u
        return {'west': (self.line - v, u), 'east': (self.line + v, u), 'north': (u, self.line + v), 'south': (u, self.line - v)}[self.side]

    def along_x(self):
        return self.side in ('north', 'south')


def picture(w, name, front, u, v, z, width, height, material):
    """A flat textured face turned to the street: a thin box whose shown side is its local +z, upright."""
    x, y = front.point(u, v)
    yaw = {'west': 90, 'east': -90, 'north': 0, 'south': 180}[front.side]
    w.geom(name, 'box', (x, y, z), (width / 2, height / 2, 0.015), material, EYE, quat=upright(yaw))


def house(w, rng, index, side, u0, width, line, depth=7.0):
    front = Front(side, u0, line)
    name = f'house_{index}'
    wall = rng.choice(['brick_red', 'brick_tan', 'brick_grey', 'plaster_white', 'plaster_ochre', 'plaster_blue'])
    roof = rng.choice(['roof_red', 'roof_grey'])
    door_colour = rng.choice(['door_green', 'door_red', 'door_blue'])
    eaves = 5.4 + 0.8 * rng.random()
    mirror = rng.random() < 0.5

    def at(u):
        return width - u if mirror else u

    def span(a, b):
        return (at(b), at(a)) if mirror else (a, b)

    # The body in two parts: one stands back, so that the front is not one flat wall.
    recess = 0.6 + 0.8 * rng.random()
    split = width * (0.52 + 0.1 * rng.random())
    front.box(w, f'{name}_wall_front', *span(0, split), 0, depth, 0, eaves, wall)
    front.box(w, f'{name}_wall_back', *span(split, width), recess, depth, 0, eaves, wall)
    front.box(w, f'{name}_plinth', *span(0, split), -0.06, 0.0, 0, 0.55, 'kerbstone', SOLID)
    # Bay window on the ground floor of the forward part.
    bay0, bay1 = split * 0.25, split * 0.75
    front.box(w, f'{name}_bay', *span(bay0, bay1), -0.75, 0, 0, 2.7, wall)
    front.box(w, f'{name}_bay_roof', *span(bay0 - 0.1, bay1 + 0.1), -0.85, 0.0, 2.7, 2.85, roof, EYE)
    picture(w, f'{name}_bay_window', front, at((bay0 + bay1) / 2), -0.765, 1.65, (bay1 - bay0) * 0.82, 1.35, 'window')
    front.box(w, f'{name}_bay_sill', *span(bay0 + 0.1, bay1 - 0.1), -0.85, -0.75, 0.86, 0.94, 'sill', EYE)
    # Door with step and canopy in the part that stands back.
    door_u = (split + width) / 2
    picture(w, f'{name}_door', front, at(door_u), recess - 0.02, KERB + 0.15 + 1.05, 1.0, 2.1, door_colour)
    front.box(w, f'{name}_step', *span(door_u - 0.7, door_u + 0.7), recess - 0.7, recess, 0, KERB + 0.15, 'kerbstone')
    front.box(w, f'{name}_canopy', *span(door_u - 0.8, door_u + 0.8), recess - 0.9, recess, 2.55, 2.65, roof, EYE)
    # Upper windows with sills.
    for k, u in enumerate((split * 0.3, split * 0.74)):
        picture(w, f'{name}_window_{k}', front, at(u), -0.015, 4.1, 1.15, 1.35, 'window')
        front.box(w, f'{name}_sill_{k}', *span(u - 0.66, u + 0.66), -0.12, 0.0, 3.33, 3.41, 'sill', EYE)
    picture(w, f'{name}_window_2', front, at(door_u), recess - 0.015, 4.1, 1.0, 1.25, 'window')
    front.box(w, f'{name}_sill_2', *span(door_u - 0.6, door_u + 0.6), recess - 0.12, recess, 3.38, 3.46, 'sill', EYE)
    # Pitched roof: two slopes, ridge along the front; gables close it.
    rise, overhang = 2.2, 0.35
    half = depth / 2 + overhang
    slope = math.atan2(rise, depth / 2)
    for part, sign in (('street', -1), ('garden', 1)):
        v = depth / 2 + sign * half / 2
        x, y = front.point(width / 2, v)
        length = half / math.cos(slope) / 2
        z = eaves + rise - half / 2 * math.tan(slope) + 0.1
        if front.along_x():
            tilt = slope * (-sign if side == 'north' else sign)
            w.geom(f'{name}_roof_{part}', 'box', (x, y, z), (width / 2 + 0.2, length, 0.07), roof, EYE, euler=(math.degrees(tilt), 0, 0))
        else:
            tilt = slope * (sign if side == 'east' else -sign)
            w.geom(f'{name}_roof_{part}', 'box', (x, y, z), (length, width / 2 + 0.2, 0.07), roof, EYE, euler=(0, math.degrees(tilt), 0))
    for k, share in enumerate((0.2, 0.45, 0.7, 0.9)):  # the gable, in steps under the slopes
        inset = depth / 2 * share
        front.box(w, f'{name}_gable_{k}', 0.05, width - 0.05, inset, depth - inset, eaves + rise * (share - 0.25), eaves + rise * share - 0.02, wall, EYE)
    front.box(w, f'{name}_chimney', *span(width * 0.15, width * 0.15 + 0.7), depth / 2 - 0.35, depth / 2 + 0.35, eaves + 1.0, eaves + rise + 1.1, 'brick_red', EYE)
    # Drainpipe.
    x, y = front.point(at(split - 0.12), -0.06)
    w.geom(f'{name}_drainpipe', 'cylinder', (x, y, eaves / 2), (0.05, eaves / 2), 'metal_grey', SOLID)
    # Path from the gate to the door.
    front.box(w, f'{name}_path', *span(door_u - 0.6, door_u + 0.6), -2.9, recess - 0.7, KERB, KERB + 0.005, 'gravel', EYE)
    return front, at(door_u)


def boundary(w, rng, name, front, length, v, gate_u, style):
    """What parts a front garden from the pavement, with a gap at the gate."""
    runs = [(0.1, gate_u - 0.65), (gate_u + 0.65, length - 0.1)]
    for k, (a, b) in enumerate(runs):
        if b - a < 0.3:
            continue
        tag = f'{name}_{style}_{k}'
        if style == 'wall':
            front.box(w, tag, a, b, v - 0.11, v + 0.11, 0, 0.85, 'brick_red')
            front.box(w, tag + '_cope', a, b, v - 0.15, v + 0.15, 0.85, 0.91, 'kerbstone', EYE)
        elif style == 'hedge':
            front.box(w, tag, a, b, v - 0.28, v + 0.28, 0, 1.15, 'hedge')
            for j, u in enumerate(np.arange(a + 0.3, b - 0.2, 0.7)):  # an uneven top
                x, y = front.point(u, v)
                w.geom(f'{tag}_top_{j}', 'ellipsoid', (x, y, 1.1), (0.42, 0.42, 0.16 + 0.1 * rng.random()), 'hedge', EYE)
        else:  # fence: pales on rails
            for j, u in enumerate(np.arange(a, b + 0.01, 0.24)):
                front.box(w, f'{tag}_pale_{j}', u - 0.045, u + 0.045, v - 0.015, v + 0.015, 0.15, 1.0, 'timber', SEEN)
            front.box(w, tag + '_rails', a, b, v + 0.015, v + 0.05, 0.42, 0.5, 'timber', SEEN)
            front.box(w, tag + '_rail_top', a, b, v + 0.015, v + 0.05, 0.82, 0.9, 'timber', EYE)
            front.box(w, tag + '_hull', a, b, v - 0.03, v + 0.05, 0.1, 1.0, 'timber', TOUCH)
    for k, u in enumerate((gate_u - 0.65, gate_u + 0.65)):
        front.box(w, f'{name}_gatepost_{k}', u - 0.14, u + 0.14, v - 0.14, v + 0.14, 0, 1.2, 'brick_tan')


def garden(w, rng, name, front, length, gate_u):
    """Bushes and flowers before the house."""
    for k in range(3):
        u = length * (0.12 + 0.76 * rng.random())
        if abs(u - gate_u) < 1.1:
            continue
        x, y = front.point(u, -1.9 + 0.5 * rng.random())
        r = 0.3 + 0.25 * rng.random()
        w.geom(f'{name}_bush_{k}', 'ellipsoid', (x, y, KERB + r * 0.8), (r, r, r * 0.9), 'leaves', SOLID)
        for j in range(3):
            w.geom(f'{name}_flower_{k}_{j}', 'sphere', (x + rng.normal(0, r * 0.6), y + rng.normal(0, r * 0.6), KERB + r * 1.5 + 0.04 * j), (0.06,), 'flower', EYE)


def houses(w, rng):
    w.comment('houses, front gardens and what parts them from the pavement')
    index = 0
    sides = [('west', 4.0, 100.0, WEST - PAVEMENT - 3.0, 4.5), ('north', 10.5, 58.0, NORTH + PAVEMENT + 3.0, 10.5),
             ('east', 4.5, 69.0, EAST + BAY + PAVEMENT + 3.0, 4.5), ('south', 30.5, 58.0, SOUTH - BAY - PAVEMENT - 3.0, 30.5)]
    for side, _, end, line, u in sides:
        while True:
            width = 7.6 + 1.8 * rng.random()
            if u + width > end:
                break
            front, gate_u = house(w, rng, index, side, u, width, line, depth=4.0 if side == 'west' else 7.0)
            gap = 1.2 + 1.6 * rng.random()
            style = ('wall', 'hedge', 'fence')[index % 3]
            boundary(w, rng, f'front_{index}', front, width + gap, -2.85, gate_u, style)
            garden(w, rng, f'front_{index}', front, width, gate_u)
            index += 1
            u += width + gap
    # The ends and corners of the block are closed.
    w.box('end_wall_south', WEST - PAVEMENT, EAST + BAY + PAVEMENT, 2.6, 2.9, 0, 2.2, 'brick_grey')
    w.box('end_hedge_south', WEST, EAST, 3.2, 3.7, 0, 1.3, 'hedge')
    w.box('end_wall_east', 58.2, 58.6, SOUTH - BAY - PAVEMENT - 3, NORTH + PAVEMENT + 3, 0, 2.4, 'brick_tan')
    for k, y in enumerate(np.arange(76.5, 90.0, 2.6)):
        w.box(f'end_pier_{k}', 57.95, 58.2, y, y + 0.4, 0, 2.5, 'brick_grey')
    w.box('corner_house', EAST + BAY + PAVEMENT + 3.0, 29.0, 70.2, 72.6, 0, 5.6, 'plaster_ochre')
