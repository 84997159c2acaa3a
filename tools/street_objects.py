"""What stands and moves in worlds/street: trees, lamp posts, cars, bins, bicycles, the gas network and pedestrians."""
import math

from mjcf import EYE, SEEN, SOLID, TOUCH, fmt, person, product, upright
from street_ground import BAY, DROPPED, EAST, KERB, SOUTH


# --- things in the street ---------------------------------------------------------------------------------------------

def tree(w, rng, name, x, y, z0):
    height = 2.4 + 0.6 * rng.random()
    radius = 0.11 + 0.05 * rng.random()
    w.geom(f'{name}_trunk', 'cylinder', (x, y, z0 + height / 2), (radius, height / 2), 'bark', SOLID)
    for k in range(9):
        a, r = 2 * math.pi * k / 9 + rng.random(), 0.75 + 0.35 * rng.random()
        spread = 0.85 if k % 3 else 0.15
        w.geom(f'{name}_crown_{k}', 'ellipsoid',
               (x + spread * math.cos(a), y + spread * math.sin(a), z0 + height + 0.45 + 0.5 * (k % 3) + 0.2 * rng.random()),
               (r, r, 0.75 * r), 'leaves', EYE)
    w.box(f'{name}_bed', x - 0.5, x + 0.5, y - 0.5, y + 0.5, z0 - 0.05, z0 + 0.004, 'gravel', EYE)


def lamp_post(w, name, x, y, z0, reach_x, reach_y):
    w.geom(f'{name}_base', 'cylinder', (x, y, z0 + 0.5), (0.10, 0.5), 'iron', SOLID)
    w.geom(f'{name}_post', 'cylinder', (x, y, z0 + 2.75), (0.055, 2.25), 'iron', SEEN)
    w.box(f'{name}_arm', min(x, x + reach_x) - 0.03, max(x, x + reach_x) + 0.03, min(y, y + reach_y) - 0.03, max(y, y + reach_y) + 0.03, z0 + 4.9, z0 + 4.96, 'iron', EYE)
    w.geom(f'{name}_head', 'ellipsoid', (x + reach_x, y + reach_y, z0 + 4.86), (0.30, 0.18, 0.09), 'lamp', EYE)


def car_shape(put, colour, hull=True):
    """A car about its middle on the road, 4.2 x 1.7 x 1.45 m, nose to +x; `put(name, kind, pos, size, material, cls, euler)`."""
    put('lower', 'box', (0, 0, 0.52), (2.08, 0.84, 0.26), colour, SEEN, None)
    put('skirt', 'box', (0, 0, 0.27), (1.55, 0.82, 0.10), 'rubber', SEEN, None)
    put('nose', 'ellipsoid', (1.72, 0, 0.56), (0.46, 0.83, 0.24), colour, EYE, None)
    put('tail', 'ellipsoid', (-1.78, 0, 0.60), (0.40, 0.83, 0.28), colour, EYE, None)
    put('bonnet', 'box', (1.32, 0, 0.79), (0.66, 0.78, 0.04), colour, EYE, (0, 5, 0))
    put('cabin', 'box', (-0.32, 0, 1.06), (0.98, 0.70, 0.32), 'car_glass', SEEN, None)
    put('screen', 'box', (0.80, 0, 1.02), (0.42, 0.69, 0.03), 'car_glass', EYE, (0, 42, 0))
    put('hatch', 'box', (-1.42, 0, 1.04), (0.40, 0.69, 0.03), 'car_glass', EYE, (0, -52, 0))
    put('roof', 'box', (-0.34, 0, 1.40), (0.92, 0.67, 0.035), colour, EYE, None)
    for sx in (-0.55, 0.22):
        for sy in (-1, 1):
            put(f'pillar_{"r" if sy < 0 else "l"}_{"b" if sx < 0 else "f"}', 'box', (sx, sy * 0.705, 1.07), (0.035, 0.012, 0.31), colour, EYE, None)
    for sy in (-1, 1):
        put(f'head_{"r" if sy < 0 else "l"}', 'ellipsoid', (2.05, sy * 0.58, 0.62), (0.08, 0.18, 0.08), 'lamp', EYE, None)
        put(f'rear_{"r" if sy < 0 else "l"}', 'box', (-2.09, sy * 0.66, 0.70), (0.03, 0.12, 0.08), 'tail_lamp', EYE, None)
        put(f'mirror_{"r" if sy < 0 else "l"}', 'ellipsoid', (0.62, sy * 0.92, 0.95), (0.07, 0.09, 0.06), colour, EYE, None)
        for sx in (-1.28, 1.30):
            tag = f'{"f" if sx > 0 else "b"}{"r" if sy < 0 else "l"}'
            put(f'wheel_{tag}', 'cylinder', (sx, sy * 0.74, 0.31), (0.31, 0.10), 'rubber', SEEN, (90, 0, 0))
            put(f'rim_{tag}', 'cylinder', (sx, sy * 0.845, 0.31), (0.19, 0.008), 'steel', EYE, (90, 0, 0))
    put('plate', 'box', (2.17, 0, 0.42), (0.01, 0.26, 0.055), 'paint_white', EYE, None)
    if hull:
        put('hull', 'box', (0, 0, 0.72), (2.12, 0.86, 0.62), colour, TOUCH, None)


def parked_car(w, name, x, y, yaw_deg, colour):
    c, s = math.cos(math.radians(yaw_deg)), math.sin(math.radians(yaw_deg))

    def put(part, kind, pos, size, material, cls, euler):
        world = (x + c * pos[0] - s * pos[1], y + s * pos[0] + c * pos[1], pos[2])
        yaw = math.radians(yaw_deg)
        quat = (math.cos(yaw / 2), 0, 0, math.sin(yaw / 2))
        if euler:
            axis = 0 if euler[0] else 1
            half = math.radians(euler[axis]) / 2
            turn = (math.cos(half), math.sin(half), 0, 0) if axis == 0 else (math.cos(half), 0, math.sin(half), 0)
            quat = product(quat, turn)
        w.geom(f'{name}_{part}', kind, world, size, material, cls, quat=quat)
    car_shape(put, colour)


def wheelie_bin(w, name, x, y, z0, material):
    w.box(f'{name}_tub', x - 0.24, x + 0.24, y - 0.28, y + 0.28, z0 + 0.06, z0 + 0.95, material)
    w.box(f'{name}_lid', x - 0.27, x + 0.27, y - 0.32, y + 0.30, z0 + 0.95, z0 + 1.02, 'iron', EYE)
    for s in (-1, 1):
        w.geom(f'{name}_wheel_{"a" if s < 0 else "b"}', 'cylinder', (x + s * 0.26, y - 0.24, z0 + 0.1), (0.1, 0.03), 'rubber', EYE, euler=(0, 90, 0))


def bicycle(w, name, x, y, z0):
    """Leaning on its stand, along y."""
    for k, dy in enumerate((-0.52, 0.52)):
        for j in range(12):  # a wheel as a ring of short rods
            a, b = 2 * math.pi * j / 12, 2 * math.pi * (j + 1) / 12
            p = (x, y + dy + 0.33 * math.cos(a), z0 + 0.34 + 0.33 * math.sin(a))
            q = (x, y + dy + 0.33 * math.cos(b), z0 + 0.34 + 0.33 * math.sin(b))
            w.lines.append(f'<geom name="{name}_tyre_{k}_{j}" class="seen" type="capsule" fromto="{fmt(p)} {fmt(q)}" size="0.018" material="rubber"/>')
        for j in range(4):
            a = math.pi * j / 4
            p = (x, y + dy + 0.32 * math.cos(a), z0 + 0.34 + 0.32 * math.sin(a))
            q = (x, y + dy - 0.32 * math.cos(a), z0 + 0.34 - 0.32 * math.sin(a))
            w.lines.append(f'<geom name="{name}_spoke_{k}_{j}" {EYE} type="capsule" fromto="{fmt(p)} {fmt(q)}" size="0.004" material="steel"/>')
    joints = {'rear': (-0.52, 0.34), 'crank': (-0.08, 0.32), 'seat': (-0.22, 0.86), 'head': (0.36, 0.84), 'fork': (0.52, 0.34), 'bar': (0.32, 1.0), 'saddle': (-0.25, 0.95)}
    for k, (a, b) in enumerate((('rear', 'crank'), ('rear', 'seat'), ('crank', 'seat'), ('crank', 'head'), ('seat', 'head'), ('head', 'fork'), ('head', 'bar'), ('seat', 'saddle'))):
        p, q = joints[a], joints[b]
        w.lines.append(f'<geom name="{name}_tube_{k}" class="seen" type="capsule" fromto="{fmt((x, y + p[0], z0 + p[1], x, y + q[0], z0 + q[1]))}" size="0.018" material="bicycle"/>')
    w.lines.append(f'<geom name="{name}_bar_cross" {EYE} type="capsule" fromto="{fmt((x - 0.26, y + 0.32, z0 + 1.0, x + 0.26, y + 0.32, z0 + 1.0))}" size="0.014" material="iron"/>')
    w.geom(f'{name}_saddle_top', 'ellipsoid', (x, y - 0.26, z0 + 0.97), (0.07, 0.13, 0.03), 'rubber', EYE)
    w.box(f'{name}_hull', x - 0.25, x + 0.25, y - 0.85, y + 0.85, z0, z0 + 1.0, 'iron', TOUCH)


def regulator_box(w, number, x, y, z0):
    """A gas regulator cabinet with its back to the garden, its front to +x; a fitting on the front can leak."""
    name = f'regulator_box_{number}'
    w.box(f'{name}_foot', x - 0.30, x + 0.30, y - 0.45, y + 0.45, 0.0, z0 + 0.10, 'kerbstone')
    w.box(f'{name}_cabinet', x - 0.25, x + 0.25, y - 0.40, y + 0.40, z0 + 0.10, z0 + 1.15, 'gas_grey')
    w.box(f'{name}_roof', x - 0.30, x + 0.32, y - 0.45, y + 0.45, z0 + 1.15, z0 + 1.20, 'gas_yellow', EYE)
    w.box(f'{name}_seam', x + 0.25, x + 0.256, y - 0.006, y + 0.006, z0 + 0.15, z0 + 1.1, 'iron', EYE)
    w.geom(f'{name}_label', 'box', (x + 0.262, y - 0.19, z0 + 0.92), (0.14, 0.07, 0.004), f'label_box_{number}', EYE, quat=upright(90))
    for k, dy in enumerate((-0.28, 0.28)):
        w.geom(f'{name}_pipe_{k}', 'capsule', (x + 0.33, y + dy, z0 + 0.2), (0.03, 0.22), 'gas_yellow', EYE)
    w.lines.append(f'<site name="{name}" pos="{fmt((x + 0.33, y, z0 + 0.42))}" size="0.03" rgba="1 0.4 0 0.6" group="4"/>')


def furniture(w, rng):
    w.comment('trees, lamp posts, cars, bins, bicycles, signs and the gas network')
    for i, (x, y) in enumerate(((7.55, 14.0), (7.55, 28.5), (7.55, 43.5), (7.55, 58.0), (7.55, 74.0), (18.6, 12.0), (18.6, 33.0), (18.6, 54.0), (24.0, 87.4), (37.5, 87.4), (50.0, 87.4))):
        tree(w, rng, f'tree_{i}', x, y, KERB)
    for i, (x, y, rx, ry) in enumerate(((8.6, 10.5, 0.8, 0), (8.6, 36.5, 0.8, 0), (8.6, 61.5, 0.8, 0), (17.6, 24.0, -0.8, 0), (17.6, 49.0, -0.8, 0), (17.6, 70.0, -0.8, 0), (20.0, 86.4, 0, -0.8), (44.0, 86.4, 0, -0.8), (31.0, 77.4, 0, 0.8), (52.0, 77.4, 0, 0.8))):
        lamp_post(w, f'lamp_post_{i}', x, y, KERB, rx, ry)
    colours = ['car_red', 'car_blue', 'car_white', 'car_silver', 'car_green', 'car_black']
    for i, y in enumerate((8.9, 14.4, 25.7, 31.4, 39.0, 53.9, 59.4, 70.6)):
        parked_car(w, f'parked_car_{i}', EAST + BAY / 2 + 0.05, y, 90 if i % 3 else -90, colours[i % 6])
    for i, x in enumerate((23.0, 29.2, 36.0, 47.5, 53.2)):
        parked_car(w, f'parked_car_{8 + i}', x, SOUTH - BAY / 2 - 0.05, 0 if i % 2 else 180, colours[(i + 3) % 6])
    for i, (x, y, m) in enumerate(((7.4, 18.4, 'bin_green'), (7.4, 19.1, 'bin_grey'), (18.8, 28.0, 'bin_green'), (18.8, 62.3, 'bin_grey'), (7.4, 51.2, 'bin_green'), (28.0, 87.6, 'bin_green'), (28.7, 87.6, 'bin_grey'), (42.0, 76.2, 'bin_grey'))):
        wheelie_bin(w, f'bin_{i}', x, y, KERB, m)
    for i, (x, y) in enumerate(((7.4, 25.2), (18.8, 40.5), (18.8, 65.8))):
        bicycle(w, f'bicycle_{i}', x, y, KERB)
    # A bench and two signs.
    w.box('bench_seat', 7.15, 7.55, 45.8, 47.4, KERB + 0.40, KERB + 0.46, 'timber')
    w.box('bench_back', 7.1, 7.15, 45.8, 47.4, KERB + 0.5, KERB + 0.9, 'timber', SEEN)
    for k, y in enumerate((46.0, 47.2)):
        w.box(f'bench_leg_{k}', 7.15, 7.5, y - 0.04, y + 0.04, KERB, KERB + 0.4, 'iron')
    for k, (x, y) in enumerate(((8.7, 77.5), (17.5, 6.5))):
        w.geom(f'sign_{k}_post', 'cylinder', (x, y, KERB + 1.2), (0.03, 1.2), 'steel', SOLID)
        w.geom(f'sign_{k}_plate', 'cylinder', (x, y, KERB + 2.2), (0.3, 0.01), 'sign_blue', EYE, euler=(90, 0, 0))
    regulator_box(w, 1, 7.35, 34.0, KERB)
    regulator_box(w, 2, 7.0, 66.0, DROPPED)
    w.geom('valve_well_3_cover', 'cylinder', (40.0, 83.0, 0.004), (0.38, 0.004), 'gas_yellow', EYE)
    w.geom('valve_well_3_lid', 'cylinder', (40.0, 83.0, 0.007), (0.30, 0.004), 'iron', EYE)
    w.box('valve_well_3_marker', 39.6, 39.85, 86.2, 86.3, KERB, KERB + 0.6, 'gas_yellow')
    w.lines.append('<site name="valve_well_3" pos="40 83 0.02" size="0.03" rgba="1 0.4 0 0.6" group="4"/>')
    w.geom('valve_well_0_cover', 'cylinder', (12.6, 18.6, 0.004), (0.38, 0.004), 'gas_yellow', EYE)
    w.geom('valve_well_0_lid', 'cylinder', (12.6, 18.6, 0.007), (0.30, 0.004), 'iron', EYE)
    w.lines.append('<site name="valve_well_0" pos="12.6 18.6 0.02" size="0.03" rgba="1 0.4 0 0.6" group="4"/>')


# --- actors -----------------------------------------------------------------------------------------------------------

def pedestrian(name, x, y, shirt, trousers):
    head = [('head', 'ellipsoid', 'pos="0.01 0 0.74" size="0.10 0.085 0.125"', 'skin'),
            ('hair', 'ellipsoid', 'pos="-0.02 0 0.78" size="0.10 0.09 0.10"', 'hair')]
    return person(name, x, y, KERB, shirt, trousers, head)


def moving_car(name, x, y, colour):
    out = [f'<body name="{name}" mocap="true" pos="{fmt((x, y, 0))}" quat="0.7071 0 0 -0.7071">']

    def put(part, kind, pos, size, material, cls, euler):
        cls = 'class="actor"' if cls == SEEN else cls
        turn = f' euler="{fmt(euler)}"' if euler else ''
        out.append(f'<geom name="{name}_{part}" {cls} type="{kind}" pos="{fmt(pos)}" size="{fmt(size)}"{turn} material="{material}"/>')
    car_shape(put, colour, hull=False)
    return out + ['</body>']
