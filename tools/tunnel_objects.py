"""What stands and moves in worlds/tunnel: machines, material and cabinets, the bridge, the charging post, workers and the dumper."""
import math

import numpy as np

import tunnel_shape as shape
from meshes import Mesh
from mjcf import EYE, SEEN, SOLID, TOUCH, fmt, person, upright
from tunnel_shape import heading, place, swept

# The robot's body when docked: nose-in at the post, 0.08 m before its face at x = +0.63 m of the body.
DOCK_S, DOCK_D = 3.4, -2.4
POST_PROFILE = [(0.63, -0.42), (0.63, -0.34), (0.77, -0.20), (0.77, -0.16), (0.63, -0.06),
                (0.63, 0.06), (0.77, 0.16), (0.77, 0.20), (0.63, 0.34), (0.63, 0.42)]
POST_BACK = 1.0


# --- machines and material ------------------------------------------------------------------------------------------

def truck(w, name, cab):
    """A dump truck 7.6 x 2.5 x 3.1 m, nose to +x."""
    w.box(f'{name}_frame', -3.6, 3.5, -0.45, 0.45, 0.62, 0.92, 'iron', SEEN)
    w.box(f'{name}_guard_left', -1.3, 1.6, 1.12, 1.20, 0.38, 0.78, 'steel', SEEN)
    w.box(f'{name}_guard_right', -1.3, 1.6, -1.20, -1.12, 0.38, 0.78, 'steel', SEEN)
    w.box(f'{name}_bumper', 3.55, 3.75, -1.22, 1.22, 0.38, 0.82, cab, SEEN)
    w.box(f'{name}_underrun', -3.75, -3.65, -1.15, 1.15, 0.42, 0.66, 'stripes_red', SEEN)
    w.box(f'{name}_cab', 2.05, 3.70, -1.20, 1.20, 0.82, 2.30, cab, SEEN)
    w.box(f'{name}_cab_top', 2.05, 3.45, -1.12, 1.12, 2.30, 2.86, cab, EYE)
    w.geom(f'{name}_screen', 'box', (3.60, 0, 2.12), (0.02, 1.05, 0.42), 'glass', EYE, euler=(0, -14, 0))
    w.box(f'{name}_grille', 3.70, 3.72, -0.75, 0.75, 1.10, 1.62, 'iron', EYE)
    w.box(f'{name}_plate', 3.755, 3.765, -0.26, 0.26, 0.50, 0.62, 'white', EYE)
    for sign in (-1, 1):
        tag = 'left' if sign > 0 else 'right'
        w.box(f'{name}_window_{tag}', 2.45, 3.30, sign * 1.205 - 0.008, sign * 1.205 + 0.008, 1.75, 2.40, 'glass', EYE)
        w.box(f'{name}_mirror_{tag}', 3.55, 3.62, sign * 1.38 - 0.10, sign * 1.38 + 0.10, 1.85, 2.30, 'iron', EYE)
        w.geom(f'{name}_head_{tag}', 'ellipsoid', (3.77, sign * 0.90, 0.98), (0.03, 0.15, 0.10), 'lamp', EYE)
        w.box(f'{name}_tail_{tag}', -3.78, -3.75, sign * 0.95 - 0.14, sign * 0.95 + 0.14, 0.70, 0.82, 'led_red', EYE)
        for k, x in enumerate((2.75, -1.75, -2.95)):
            w.geom(f'{name}_wheel_{tag}_{k}', 'cylinder', (x, sign * 1.02, 0.50), (0.50, 0.19), 'rubber', SEEN, euler=(90, 0, 0))
            w.geom(f'{name}_rim_{tag}_{k}', 'cylinder', (x, sign * 1.20, 0.50), (0.27, 0.02), 'steel', EYE, euler=(90, 0, 0))
    w.box(f'{name}_tub_floor', -3.75, 1.75, -1.22, 1.22, 1.00, 1.14, 'tub_grey', SEEN)
    w.box(f'{name}_tub_front', 1.65, 1.80, -1.24, 1.24, 1.0, 2.75, 'tub_grey', SEEN)
    w.box(f'{name}_tub_visor', 1.70, 2.75, -1.20, 1.20, 2.92, 3.00, 'tub_grey', EYE)
    w.box(f'{name}_tub_rear', -3.80, -3.68, -1.20, 1.20, 1.0, 2.05, 'tub_grey', SEEN)
    for sign in (-1, 1):
        tag = 'left' if sign > 0 else 'right'
        w.box(f'{name}_tub_{tag}', -3.75, 1.75, sign * 1.20 - 0.05, sign * 1.20 + 0.05, 1.0, 2.20, 'tub_grey', SEEN)
        for k, x in enumerate(np.arange(-3.3, 1.5, 0.9)):
            w.box(f'{name}_rib_{tag}_{k}', x - 0.06, x + 0.06, sign * 1.29 - 0.05, sign * 1.29 + 0.05, 1.0, 2.20, 'tub_grey', EYE)
    w.geom(f'{name}_load', 'ellipsoid', (-1.0, 0, 1.85), (2.5, 1.1, 0.75), 'gravel', EYE)
    w.box(f'{name}_hull', -3.8, 3.77, -1.25, 1.25, 0.10, 2.9, 'iron', TOUCH)


def trolley(w):
    """The formwork carriage that casts the lining: two rows of columns on rails, portals across, the steel skin above. One drives
    through below."""
    for side, sign in (('left', 1), ('right', -1)):
        y = sign * 4.05
        for k, x in enumerate((-4.2, -1.4, 1.4, 4.2)):
            w.box(f'trolley_column_{side}_{k}', x - 0.14, x + 0.14, y - 0.14, y + 0.14, 0.34, 4.7, 'form_orange', SEEN)
            w.geom(f'trolley_wheel_{side}_{k}', 'cylinder', (x, y, 0.26), (0.16, 0.06), 'iron', EYE, euler=(90, 0, 0))
            w.rod(f'trolley_jack_{side}_{k}', (x, y + sign * 0.15, 1.6), (x, sign * 4.95, 2.1), 0.06, 'steel', EYE)
            w.rod(f'trolley_jack_high_{side}_{k}', (x, y + sign * 0.15, 3.6), (x, sign * 4.75, 4.1), 0.06, 'steel', EYE)
        for k, x in enumerate((-4.2, -1.4, 1.4)):
            w.rod(f'trolley_brace_{side}_{k}', (x, y, 1.0), (x + 2.8, y, 3.6), 0.05, 'form_orange', EYE)
        w.box(f'trolley_sill_{side}', -4.8, 4.8, y - 0.16, y + 0.16, 0.42, 0.72, 'form_orange', SEEN)
        w.box(f'trolley_beam_{side}', -4.8, 4.8, y - 0.16, y + 0.16, 4.35, 4.75, 'form_orange', SEEN)
        w.box(f'trolley_nose_{side}', -5.0, -4.8, y - 0.2, y + 0.2, 0.4, 2.0, 'stripes', SEEN)
        w.box(f'trolley_hull_{side}', -5.0, 4.85, y - 0.22, y + 0.22, 0.0, 2.0, 'form_orange', TOUCH)
        w.box(f'trolley_walk_{side}', -4.8, 4.8, sign * 3.3 - 0.45, sign * 3.3 + 0.45, 4.80, 4.85, 'tread', EYE)
        w.rod(f'trolley_rail_{side}', (-4.8, sign * 2.85, 5.85), (4.8, sign * 2.85, 5.85), 0.025, 'truck_yellow', EYE)
        for k, x in enumerate(np.arange(-4.6, 4.7, 1.53)):
            w.rod(f'trolley_post_{side}_{k}', (x, sign * 2.85, 4.8), (x, sign * 2.85, 5.85), 0.02, 'truck_yellow', EYE)
    for k, x in enumerate((-4.2, -1.4, 1.4, 4.2)):
        w.box(f'trolley_portal_{k}', x - 0.16, x + 0.16, -4.2, 4.2, 4.35, 4.80, 'form_orange', SEEN)
        for j, y in enumerate((-2.4, 0.0, 2.4)):
            w.rod(f'trolley_prop_{k}_{j}', (x, y, 4.8), (x, y * 1.15, 7.55 if j == 1 else 6.9), 0.07, 'form_orange', EYE)
    w.box('trolley_board', -4.97, -4.90, -2.2, 2.2, 4.42, 4.72, 'stripes', EYE)
    w.geom('trolley_sign', 'box', (-4.99, 0.0, 5.25), (0.8, 0.4, 0.01), 'sign_danger', EYE, quat=upright(-90))
    for k, y in enumerate((-3.2, 3.2)):
        w.geom(f'trolley_lamp_{k}', 'box', (-4.9, y, 4.2), (0.06, 0.22, 0.12), 'lamp_warm', EYE)


def rails(w, start, end):
    """What the trolley rolls on."""
    for side, d in (('left', 4.05), ('right', -4.05)):
        for k, s in enumerate(np.arange(start, end, 4.0)):
            with w.at(s + 2.0, d):
                w.box(f'rail_{side}_{k}', -2.0, 2.0, -0.05, 0.05, -0.06, 0.10, 'rust')


def stones(w):
    """Rubble for the eye: along the walls, and more of it before the face."""
    rng = np.random.default_rng(31)
    for i in range(150):
        if i < 90:
            s, d, size = rng.uniform(4.0, 150.0), rng.choice((-1, 1)) * rng.uniform(4.25, 4.9), rng.uniform(0.03, 0.10)
        else:
            s, d, size = rng.uniform(149.0, 158.5), rng.uniform(-4.6, 4.6), rng.uniform(0.06, 0.28)
        x, y = place(s, d)
        shape_of = size * rng.uniform(0.6, 1.2, 3)
        w.geom(f'stone_{i}', 'box' if i % 3 else 'ellipsoid', (float(x), float(y), float(shape.invert_height(s, d)) + 0.4 * size), shape_of,
               ('stone_dark', 'stone_pale')[i % 2], EYE if size < 0.12 else SOLID, euler=tuple(rng.uniform(-40, 40, 3)))


def trolley_skin(w, s):
    """The steel skin, just inside the ring it casts."""
    points, normals, along = shape.section(side_steps=4, crown_steps=18)
    is_skin = points[:, 1] > 1.3
    inner, texture = swept(np.linspace(s - 4.6, s + 4.6, 7), (points - 0.42 * normals)[is_skin], 2.0)
    outer, _ = swept(np.linspace(s - 4.6, s + 4.6, 7), (points - 0.12 * normals)[is_skin], 2.0)
    mesh = Mesh()
    mesh.slab(inner, outer, texture)
    w.mesh('trolley_skin', mesh, 'form_steel', SEEN)
    mesh = Mesh()
    for ds in np.linspace(-4.6, 4.6, 7):
        ribs, uv = swept([s + ds - 0.05, s + ds + 0.05], (points - 0.62 * normals)[is_skin], 2.0)
        roots, _ = swept([s + ds - 0.05, s + ds + 0.05], (points - 0.40 * normals)[is_skin], 2.0)
        mesh.slab(ribs, roots, uv)
    w.mesh('trolley_ribs', mesh, 'form_orange', EYE)


def bridge(w):
    """A trestle bridge over the excavated invert: ramps of 13 degrees, deck 0.5 m up, kerb rails that keep the tracks on it."""
    half, height, width, thick = 4.0, 0.50, 1.65, 0.10
    slope = math.radians(13.0)
    w.box('ground_bridge_deck', -half, half, -width, width, height - thick, height, 'planks')
    reach = height / math.tan(slope) + 0.20  # the lower edge dips into the ground
    length = reach / math.cos(slope)
    for k, sign in enumerate((-1, 1)):
        middle = sign * (half + reach / 2)
        top = height - reach / 2 * math.tan(slope)
        pos = (middle - sign * math.sin(slope) * thick / 2, 0.0, top - math.cos(slope) * thick / 2)
        w.geom(f'ground_bridge_ramp_{k}', 'box', pos, (length / 2 + 0.01, width, thick / 2), 'planks', SOLID, euler=(0, sign * math.degrees(slope), 0))
        for side, y in (('left', width - 0.08), ('right', -width + 0.08)):
            w.geom(f'bridge_ramp_kerb_{side}_{k}', 'box', (middle + sign * math.sin(slope) * 0.1, y, top + math.cos(slope) * 0.1),
                   (length / 2 - 0.15, 0.08, 0.1), 'stripes', SOLID, euler=(0, sign * math.degrees(slope), 0))
    for side, sign in (('left', 1), ('right', -1)):
        y = sign * (width - 0.08)
        w.box(f'bridge_kerb_{side}', -half, half, y - 0.08, y + 0.08, height, height + 0.22, 'stripes')
        w.box(f'bridge_beam_{side}', -half, half, sign * 1.1 - 0.1, sign * 1.1 + 0.1, height - 0.40, height - thick, 'rust', SEEN)
        w.rod(f'bridge_handrail_{side}', (-half, sign * 1.62, 1.55), (half, sign * 1.62, 1.55), 0.025, 'truck_yellow')
        w.rod(f'bridge_middle_rail_{side}', (-half, sign * 1.62, 1.08), (half, sign * 1.62, 1.08), 0.02, 'truck_yellow', EYE)
        for k, x in enumerate(np.linspace(-half + 0.1, half - 0.1, 6)):
            w.rod(f'bridge_post_{side}_{k}', (x, sign * 1.62, height), (x, sign * 1.62, 1.55), 0.025, 'truck_yellow')
        for k, x in enumerate((-2.6, -0.9, 0.9, 2.6)):
            w.rod(f'bridge_leg_{side}_{k}', (x, sign * 1.1, -0.45), (x, sign * 1.1, 0.2), 0.08, 'rust', EYE, 'cylinder')


def trench(w):
    """Barriers between the bridge and the excavation, and rebar in the excavation."""
    for k, (s, side) in enumerate(((130.4, 1), (139.6, 1))):
        for j in range(3):
            with w.at(s, 0.95 + 1.45 * j):
                w.box(f'barrier_{k}_{j}', -0.05, 0.05, -0.68, 0.68, 0.35, 1.0, 'stripes_red', SEEN)
                w.box(f'barrier_{k}_{j}_foot_a', -0.30, 0.30, -0.62, -0.54, -0.05, 0.08, 'iron', EYE)
                w.box(f'barrier_{k}_{j}_foot_b', -0.30, 0.30, 0.54, 0.62, -0.05, 0.08, 'iron', EYE)
                w.box(f'barrier_{k}_{j}_hull', -0.10, 0.10, -0.70, 0.70, -0.1, 1.0, 'iron', TOUCH)
        with w.at(s, -4.55):
            w.box(f'barrier_{k}_wall', -0.05, 0.05, -0.70, 0.80, 0.35, 1.0, 'stripes_red', SEEN)
            w.box(f'barrier_{k}_wall_hull', -0.10, 0.10, -0.75, 0.85, -0.1, 1.0, 'iron', TOUCH)
    with w.at(135.0, 2.4):
        for k, x in enumerate(np.arange(-2.8, 2.9, 0.4)):
            w.rod(f'mat_across_{k}', (x, -1.9, -0.28), (x, 2.2, -0.28), 0.012, 'rust', EYE)
        for k, y in enumerate(np.arange(-1.8, 2.2, 0.4)):
            w.rod(f'mat_along_{k}', (-3.0, y, -0.26), (3.0, y, -0.26), 0.012, 'rust', EYE)


def pipes(w, name, length, radius, rows, material):
    """Pipes stacked along x in a heap of `rows`, with stakes."""
    count = 0
    for row in range(rows):
        for k in range(rows - row):
            y = (k - (rows - row - 1) / 2) * 2.05 * radius
            z = radius + row * 1.75 * radius
            w.rod(f'{name}_{count}', (-length / 2, y, z), (length / 2, y, z), radius, material, SEEN, 'cylinder')
            w.rod(f'{name}_bore_{count}', (-length / 2 - 0.004, y, z), (length / 2 + 0.004, y, z), radius * 0.82, 'iron', EYE, 'cylinder')
            count += 1
    wide = rows * radius * 1.03
    w.box(f'{name}_hull', -length / 2, length / 2, -wide, wide, 0.0, 2 * radius + (rows - 1) * 1.75 * radius, 'iron', TOUCH)


def pallet(w, name, layers):
    """A pallet of cement in sacks."""
    for k in range(3):
        w.box(f'{name}_bearer_{k}', -0.6, 0.6, -0.4 + 0.36 * k - 0.04, -0.4 + 0.36 * k + 0.12, 0.0, 0.10, 'pallet', EYE)
    w.box(f'{name}_board', -0.62, 0.62, -0.45, 0.45, 0.10, 0.15, 'pallet', EYE)
    for k in range(layers):
        z = 0.15 + 0.15 * k
        inset = 0.015 * (k % 2)
        w.box(f'{name}_sacks_{k}', -0.58 + inset, 0.58 - inset, -0.42 + inset, 0.42 - inset, z, z + 0.14, 'sack', SEEN)
    w.box(f'{name}_hull', -0.62, 0.62, -0.45, 0.45, 0.0, 0.15 + 0.15 * layers, 'pallet', TOUCH)


def rebar(w, name, length, count=7, radius=0.012, hull=0.10):
    rng = np.random.default_rng(len(name) + int(length * 10))
    for k in range(count):
        y, z = 0.045 * (k - count / 2) + rng.normal(0, 0.01), 0.03 + 0.028 * (k % 3)
        a, b = rng.normal(0, 0.06, 2)
        w.rod(f'{name}_bar_{k}', (-length / 2 + a, y, z), (length / 2 + b, y + rng.normal(0, 0.03), z), radius, 'rust', SEEN)
    w.box(f'{name}_hull', -length / 2, length / 2, -0.045 * count / 2 - 0.03, 0.045 * count / 2 + 0.03, -0.02, hull, 'rust', TOUCH)


def cabinet(w, name, sign):
    """A power cabinet with its back to the wall; `sign` +1 on the left."""
    w.box(f'{name}_foot', -0.42, 0.42, -0.24, 0.24, -0.05, 0.12, 'kerbstone', SEEN)
    w.box(f'{name}_body', -0.40, 0.40, -0.22, 0.22, 0.12, 1.55, 'cabinet')
    w.box(f'{name}_seam', -0.005, 0.005, -sign * 0.225 - 0.003, -sign * 0.225 + 0.003, 0.2, 1.5, 'iron', EYE)
    w.box(f'{name}_warning', -0.30, -0.12, -sign * 0.225 - 0.004, -sign * 0.225 + 0.004, 1.1, 1.28, 'truck_yellow', EYE)
    w.geom(f'{name}_led', 'sphere', (0.2, -sign * 0.23, 1.4), (0.02,), 'led_green', EYE)


def things(w):
    w.comment('machines, material, cabinets')
    for name, s, d, yaw, colour in (('truck_1', 14.2, -2.75, 180, 'truck_white'), ('truck_2', 75.0, -2.7, 180, 'truck_red')):
        with w.at(s, d, yaw):
            truck(w, name, colour)
    with w.at(96.0, 0.0):
        trolley(w)
    trolley_skin(w, 96.0)
    rails(w, 84.0, 112.0)
    stones(w)
    with w.at(135.0, -1.9):
        bridge(w)
    trench(w)
    for name, s, d, yaw, length, radius, rows, material in (
            ('pipes_1', 13.5, 3.9, 0, 5.5, 0.22, 3, 'plastic_pipe'), ('pipes_2', 106.8, -3.8, 0, 4.0, 0.16, 4, 'rust'),
            ('pipes_3', 148.5, 4.0, 0, 5.0, 0.20, 3, 'steel')):
        with w.at(s, d, yaw):
            pipes(w, name, length, radius, rows, material)
    for i, (s, d, yaw, layers) in enumerate(((8.5, 3.9, 4, 6), (17.3, 4.1, -3, 5), (88.3, -1.7, 8, 6), (89.2, -0.8, -4, 5), (88.2, 4.2, 2, 5), (108.2, 4.1, 5, 6), (109.8, 4.2, 0, 4),
                                             (111.0, -1.0, 12, 5), (122.0, -4.0, 3, 5), (144.0, -3.9, 0, 6))):
        with w.at(s, d, yaw):
            pallet(w, f'pallet_{i}', layers)
    for i, (s, d, sign) in enumerate(((11.5, -4.75, -1), (80.0, 4.75, 1), (103.2, 4.85, 1), (125.5, 4.8, 1))):
        with w.at(s, d):
            cabinet(w, f'cabinet_{i}', sign)
    # Low: under the lidar's plane, beside the lanes and between them.
    for i, (s, d, yaw, length) in enumerate(((28.0, 3.9, 0, 4.0), (41.0, -3.8, 2, 5.0), (46.5, 0.1, 4, 4.0), (57.0, 3.8, -2, 4.5), (64.0, -3.9, 0, 3.5), (115.0, -3.7, 5, 4.0))):
        with w.at(s, d, yaw):
            rebar(w, f'rebar_{i}', length)
    for i, (s, d, yaw) in enumerate(((31.0, 0.0, 3), (32.2, 0.1, -2), (52.0, 4.2, 0), (53.2, 4.25, 4), (54.4, 4.2, 0), (60.5, -0.1, 30))):
        with w.at(s, d, yaw):
            w.box(f'kerbstone_{i}', -0.5, 0.5, -0.09, 0.09, -0.03, 0.22, 'kerbstone')
    for i, (s, d, length) in enumerate(((21.0, 4.35, 6.0), (36.0, 4.3, 7.0), (48.5, -4.3, 6.0))):
        hose(w, f'hose_{i}', s, d, length)


def hose(w, name, s, d, length):
    """A hose lying in bends along the wall, 10 cm thick."""
    steps = np.arange(0.0, length + 0.01, 0.75)
    points = [(*map(float, place(s + t, d + 0.22 * math.sin(2.2 * t))), 0.06) for t in steps]
    for k, (a, b) in enumerate(zip(points, points[1:])):
        w.rod(f'{name}_{k}', a, b, 0.05, 'hose_blue', SOLID)


def docking_post(w):
    """The charging post: a prism whose outline at the lidar's height is the profile in the survey."""
    w.comment('the charging post')
    with w.at(DOCK_S, DOCK_D, 180):
        back = [(POST_BACK, y) for _, y in POST_PROFILE]
        mesh = Mesh()
        rows = [np.array([(x, y, z) for x, y in POST_PROFILE]) for z in (-0.05, 1.05)]
        rear = [np.array([(x, y, z) for x, y in back]) for z in (-0.05, 1.05)]
        uv = np.array([[(y, z) for _, y in POST_PROFILE] for z in (-0.05, 1.05)])
        mesh.slab(np.array(rows), np.array(rear), uv)
        w.mesh('charging_post', mesh, 'white', SEEN)
        front = min(x for x, _ in POST_PROFILE)
        w.box('charging_post_hull', front, POST_BACK, -0.42, 0.42, -0.1, 1.05, 'white', TOUCH)
        w.box('charging_post_cap', front - 0.02, POST_BACK + 0.02, -0.46, 0.46, 1.05, 1.12, 'led_green', EYE)
        w.box('charging_post_panel', 0.80, POST_BACK, -0.40, 0.40, 1.12, 1.75, 'cabinet', EYE)
        w.geom('charging_post_sign', 'box', (0.79, 0.0, 1.46), (0.34, 0.17, 0.008), 'sign_charge', EYE, quat=upright(-90))
        for k, y in enumerate((-0.03, 0.03)):
            w.box(f'charging_contact_{k}', front - 0.008, front, y - 0.012, y + 0.012, 0.18, 0.34, 'steel', EYE)
        for k, y in enumerate((-0.55, 0.55)):
            w.box(f'charging_line_{k}', -0.9, 0.6, y - 0.03, y + 0.03, 0.0, 0.012, 'truck_yellow', EYE)


# --- who moves --------------------------------------------------------------------------------------------------------

def worker(name, s, d, vest, hat):
    head = [('head', 'ellipsoid', 'pos="0.01 0 0.74" size="0.10 0.085 0.125"', 'skin'),
            ('hat', 'ellipsoid', 'pos="-0.005 0 0.80" size="0.125 0.11 0.095"', hat),
            ('brim', 'ellipsoid', 'pos="0.05 0 0.79" size="0.13 0.11 0.018"', hat),
            ('band', 'cylinder', 'pos="0 0 0.20" size="0.155 0.025"', 'reflex'),
            ('band_high', 'cylinder', 'pos="0 0 0.34" size="0.155 0.025"', 'reflex')]
    x, y = place(s, d)
    return person(name, float(x), float(y), float(shape.invert_height(s, d)), vest, 'overall', head)


def dumper(name, s, d):
    """A site dumper 4.2 x 1.9 m: skip before, engine behind, a roll bar over the seat; nose to +x."""
    x, y = place(s, d)
    half = float(heading(s)) / 2
    out = [f'<body name="{name}" mocap="true" pos="{fmt((float(x), float(y), float(shape.invert_height(s, d))))}" quat="{fmt((math.cos(half), 0, 0, math.sin(half)))}">']

    def put(part, kind, pos, size, material, euler=None):
        turn = f' euler="{fmt(euler)}"' if euler else ''
        out.append(f'<geom name="{name}_{part}" class="actor" type="{kind}" pos="{fmt(pos)}" size="{fmt(size)}"{turn} material="{material}"/>')
    put('frame', 'box', (0, 0, 0.62), (1.75, 0.55, 0.16), 'iron')
    put('engine', 'box', (-1.35, 0, 1.02), (0.70, 0.72, 0.36), 'truck_yellow')
    put('grille', 'box', (-2.06, 0, 1.0), (0.02, 0.55, 0.25), 'iron')
    put('skip', 'box', (1.05, 0, 1.05), (1.00, 0.86, 0.30), 'truck_yellow')
    put('skip_lip', 'box', (2.0, 0, 1.22), (0.22, 0.84, 0.06), 'truck_yellow', (0, -35, 0))
    put('load', 'ellipsoid', (1.0, 0, 1.32), (0.85, 0.72, 0.30), 'gravel')
    put('seat', 'box', (-0.45, 0, 1.05), (0.25, 0.30, 0.10), 'rubber')
    put('driver', 'capsule', (-0.45, 0, 1.45), (0.16, 0.22), 'vest')
    put('driver_head', 'sphere', (-0.43, 0, 1.88), (0.11,), 'hard_hat')
    put('wheel_bar', 'box', (-0.05, 0, 1.30), (0.03, 0.2, 0.2), 'iron')
    for sign in (-1, 1):
        tag = 'left' if sign > 0 else 'right'
        put(f'bar_{tag}', 'box', (-0.80, sign * 0.55, 1.75), (0.04, 0.04, 0.62), 'iron')
        put(f'beacon_{tag}', 'ellipsoid', (2.07, sign * 0.6, 0.80), (0.04, 0.12, 0.08), 'lamp')
        for k, wx in enumerate((1.25, -1.25)):
            put(f'wheel_{tag}_{k}', 'cylinder', (wx, sign * 0.78, 0.46), (0.46, 0.17), 'rubber', (90, 0, 0))
    put('bar_top', 'box', (-0.80, 0, 2.36), (0.05, 0.6, 0.04), 'iron')
    put('warning', 'ellipsoid', (-0.80, 0, 2.46), (0.07, 0.07, 0.07), 'lamp_warm')
    return out + ['</body>']
