"""The plan of worlds/street, and its ground: carriageway, pavements with their kerbs, gardens and painted lines."""
import numpy as np

from mjcf import EYE, SOLID

# The plan of the street. The carriageway runs north along WEST..EAST, then east along SOUTH..NORTH.
WEST, EAST, SOUTH, NORTH = 9.0, 15.0, 80.0, 86.0
START_Y, END_X = 4.0, 56.0
BAY = 2.2            # parking bays outside the carriageway, on the inner side of the bend
PAVEMENT = 2.0
KERB = 0.12          # a full kerb
DROPPED = 0.05       # a dropped one
FULL_KERB_KEEP_OUT = 0.06  # kerbs higher than this are lines not to cross


def pavement_run(w, name, along, a, b, inner, outer, kerb_at, drops, keep_out):
    """A pavement along one axis from a to b, between the lines inner and outer across it; `kerb_at` is which of the two is the
    kerb. `drops` are (from, to, height) of lowered crossings. Adds the kerb lines that must not be crossed."""
    cuts = [(a, b, KERB)]
    for start, end, height in drops:
        pieces = []
        for low, high, z in cuts:
            if low <= start and end <= high:
                pieces += [(low, start, z), (start, end, height), (end, high, z)]
            else:
                pieces.append((low, high, z))
        cuts = pieces
    lo, hi = min(inner, outer), max(inner, outer)
    stone = 0.15
    for i, (low, high, z) in enumerate(cuts):
        if high - low < 1e-6:
            continue
        kind = 'dropped_kerb' if z < KERB else 'kerb'
        for part, (p, q), material in (
                (f'pavement_{name}_{i}', (lo + stone, hi) if kerb_at == lo else (lo, hi - stone), 'paving'),
                (f'{kind}_{name}_{i}', (lo, lo + stone) if kerb_at == lo else (hi - stone, hi), 'kerbstone')):
            box = (low, high, p, q) if along == 'x' else (p, q, low, high)
            w.box(part, *box, -0.2, z, material)
        def point(s, t):
            return [round(s, 3), round(t, 3)] if along == 'x' else [round(t, 3), round(s, 3)]
        if z > FULL_KERB_KEEP_OUT:
            keep_out.append({'name': f'{kind}_{name}_{i}', 'line': [point(low, kerb_at), point(high, kerb_at)]})
        else:  # the way up ends where the pavement is full height again
            far = hi if kerb_at == lo else lo
            keep_out.append({'name': f'{kind}_{name}_{i}',
                             'line': [point(low, kerb_at), point(low, far), point(high, far), point(high, kerb_at)]})


def ground(w, keep_out):
    w.comment('ground')
    w.geom('ground_base', 'plane', (30, 50, -0.02), (60, 80, 1), 'grass', SOLID)
    w.box('carriageway_north', WEST, EAST + BAY, START_Y, NORTH, -0.2, 0.0, 'asphalt')
    w.box('carriageway_east', EAST + BAY, END_X, SOUTH - BAY, NORTH, -0.2, 0.0, 'asphalt')
    p = PAVEMENT
    pavement_run(w, 'west', 'y', START_Y, NORTH + p, WEST, WEST - p, WEST,
                 [(20.0, 23.0, 0.025), (64.5, 67.5, DROPPED)], keep_out)
    pavement_run(w, 'north', 'x', WEST, END_X, NORTH, NORTH + p, NORTH, [(30.0, 33.0, DROPPED)], keep_out)
    pavement_run(w, 'east', 'y', START_Y, SOUTH - BAY - p, EAST + BAY, EAST + BAY + p, EAST + BAY,
                 [(44.0, 47.0, DROPPED)], keep_out)
    pavement_run(w, 'south', 'x', EAST + BAY, END_X, SOUTH - BAY, SOUTH - BAY - p, SOUTH - BAY, [], keep_out)
    # Gardens, level with the pavement.
    w.box('ground_garden_west', 0.0, WEST - p, 0.0, 100.0, -0.2, KERB, 'grass')
    w.box('ground_garden_north', WEST - p, 60.0, NORTH + p, 100.0, -0.2, KERB, 'grass')
    w.box('ground_garden_east', EAST + BAY + p, 60.0, 0.0, SOUTH - BAY - p, -0.2, KERB, 'grass')
    w.box('ground_garden_south', WEST - p, EAST + BAY + p, 0.0, START_Y, -0.2, KERB, 'grass')
    w.box('ground_garden_end', END_X, 60.0, SOUTH - BAY - p, NORTH + p, -0.2, KERB, 'grass')
    # Painted lines, 3 mm above the road.
    middle_x, middle_y = (WEST + EAST) / 2, (SOUTH + NORTH) / 2
    for i, y in enumerate(np.arange(6.0, 78.0, 5.0)):
        w.box(f'line_north_{i}', middle_x - 0.06, middle_x + 0.06, y, y + 2.2, 0.001, 0.004, 'paint_white', EYE)
    for i, x in enumerate(np.arange(19.0, 54.0, 5.0)):
        w.box(f'line_east_{i}', x, x + 2.2, middle_y - 0.06, middle_y + 0.06, 0.001, 0.004, 'paint_white', EYE)
    for i, y in enumerate(np.arange(6.0, 77.0, 5.6)):
        w.box(f'line_bay_{i}', EAST, EAST + BAY, y, y + 0.1, 0.001, 0.004, 'paint_white', EYE)
    w.box('line_bay_edge', EAST - 0.05, EAST + 0.05, START_Y, SOUTH - BAY, 0.001, 0.004, 'paint_white', EYE)
    for i, (x, y) in enumerate(((12.8, 20.0), (11.2, 45.0), (13.0, 70.0), (25.0, 82.4), (47.0, 84.0))):
        w.geom(f'manhole_{i}', 'cylinder', (x, y, 0.002), (0.32, 0.003), 'iron', EYE)
    for i, y in enumerate((15.0, 40.0, 60.0)):  # gullies by the kerb
        w.box(f'gully_{i}', WEST + 0.05, WEST + 0.4, y, y + 0.45, 0.001, 0.004, 'iron', EYE)
