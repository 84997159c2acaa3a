"""What else stands in worlds/substation: transformers and their fire wall, capacitors and reactors, control building, masts, lamps, fence."""
import numpy as np

from mjcf import EYE, SEEN, SOLID, TOUCH, upright
from substation_bays import GRAVEL, INSULATOR, insulator, wire


# --- transformers -----------------------------------------------------------------------------------------------------

def oil_pit(w, name, half_x, half_y):
    """A kerb round pebbles, lower than the lidar's plane."""
    wide, top = 0.3, 0.32
    for part, x0, x1, y0, y1 in (('south', -half_x, half_x, -half_y, -half_y + wide), ('north', -half_x, half_x, half_y - wide, half_y),
                                 ('west', -half_x, -half_x + wide, -half_y + wide, half_y - wide),
                                 ('east', half_x - wide, half_x, -half_y + wide, half_y - wide)):
        w.box(f'{name}_pit_{part}', x0, x1, y0, y1, -0.3, top, 'concrete')
    w.box(f'{name}_pebbles', -half_x + wide, half_x - wide, -half_y + wide, half_y - wide, -0.3, 0.08, 'pebbles', EYE)


def radiators(w, name, side):
    """A bank of seven on one long side of the tank, hung from two headers; they reach down below the lidar's plane."""
    y0 = side * 1.45
    for k, z in enumerate((0.75, 3.05)):
        w.rod(f'{name}_header_{k}', (-3.3, y0 + side * 0.25, z), (3.3, y0 + side * 0.25, z), 0.11, 'tank', EYE)
    for k, x in enumerate(np.linspace(-3.0, 3.0, 7)):
        low, high = sorted((y0 + side * 0.4, y0 + side * 1.7))
        w.box(f'{name}_radiator_{k}', x - 0.24, x + 0.24, low, high, 0.42, 3.25, 'radiator', SEEN)


def fans(w, name, side):
    for k, x in enumerate((-2.5, -1.5, -0.5, 0.5, 1.5, 2.5)):
        y = side * 3.2
        w.geom(f'{name}_fan_{k}', 'cylinder', (x, y, 1.9), (0.36, 0.06), 'iron', EYE, euler=(90, 0, 0))
        w.geom(f'{name}_hub_{k}', 'cylinder', (x, y + side * 0.03, 1.9), (0.11, 0.06), 'tank', EYE, euler=(90, 0, 0))


def transformer(w, name):
    """About its middle, the 220 kV bushings to +y. 7.2 m x 2.6 m of tank, radiators on both sides, conservator above the end at -x."""
    oil_pit(w, name, 5.8, 4.4)
    for k, x in enumerate((-2.6, 2.6)):
        w.box(f'{name}_footing_{k}', x - 0.5, x + 0.5, -1.2, 1.2, -0.3, 0.38, 'concrete', SEEN)
    w.box(f'{name}_tank', -3.6, 3.6, -1.3, 1.3, 0.38, 3.5, 'tank', SEEN)
    for k, x in enumerate(np.arange(-3.3, 3.4, 0.94)):
        for side in (-1, 1):
            w.box(f'{name}_rib_{k}_{side + 1}', x - 0.05, x + 0.05, side * 1.35 - 0.05, side * 1.35 + 0.05, 0.5, 3.4, 'tank', EYE)
    w.box(f'{name}_cover', -3.7, 3.7, -1.4, 1.4, 3.5, 3.62, 'tank', EYE)
    w.box(f'{name}_hull', -3.8, 3.8, -3.2, 3.2, 0.0, 3.5, 'tank', TOUCH)
    for side, tag in ((-1, 'south'), (1, 'north')):
        radiators(w, f'{name}_{tag}', side)
    fans(w, name, -1)
    for k, x in enumerate((-2.2, 0.0, 2.2)):
        w.geom(f'{name}_turret_{k}', 'cylinder', (x, 0.7, 4.1), (0.38, 0.5), 'tank', SEEN)
        insulator(w, f'{name}_bushing_{k}', x, 0.7, 4.6)
        w.geom(f'{name}_terminal_{k}', 'cylinder', (x, 0.7, 4.6 + INSULATOR + 0.1), (0.05, 0.15), 'aluminium', EYE)
    for k, x in enumerate((-0.6, 0.3, 1.2, 2.1)):
        w.geom(f'{name}_low_turret_{k}', 'cylinder', (x, -0.75, 3.85), (0.16, 0.25), 'tank', EYE)
        w.geom(f'{name}_low_bushing_{k}', 'cylinder', (x, -0.75, 4.5), (0.10, 0.42), 'porcelain', EYE)
    w.geom(f'{name}_conservator', 'cylinder', (-3.0, -0.1, 5.1), (0.48, 1.9), 'tank', SEEN, euler=(90, 0, 0))
    for k, y in enumerate((-1.2, 1.0)):
        w.rod(f'{name}_strut_{k}', (-3.0, y, 3.6), (-3.0, y, 4.7), 0.08, 'tank', EYE)
    w.rod(f'{name}_pipe', (-2.6, 0.0, 4.8), (-1.2, 0.0, 3.7), 0.05, 'tank', EYE)
    w.box(f'{name}_cabinet', 3.75, 4.35, -0.5, 0.5, 0.55, 2.1, 'cabinet', SEEN)
    w.rod(f'{name}_ladder_0', (3.68, 0.75, 0.4), (3.68, 0.75, 3.7), 0.025, 'galvanised', EYE)
    w.rod(f'{name}_ladder_1', (3.68, 1.15, 0.4), (3.68, 1.15, 3.7), 0.025, 'galvanised', EYE)
    for k, z in enumerate(np.arange(0.6, 3.6, 0.3)):
        w.rod(f'{name}_rung_{k}', (3.68, 0.75, z), (3.68, 1.15, z), 0.015, 'galvanised', EYE)
    for k, (x, y) in enumerate(((-5.0, -3.7), (5.0, -3.7), (5.0, 3.7), (-5.0, 3.7))):  # the fire spray's pipes
        w.rod(f'{name}_spray_post_{k}', (x, y, 0.0), (x, y, 4.2), 0.045, 'fire_red')
    for k, y in enumerate((-3.7, 3.7)):
        w.rod(f'{name}_spray_{k}', (-5.0, y, 4.2), (5.0, y, 4.2), 0.035, 'fire_red', EYE)


def fire_wall(w, x, y):
    w.box('fire_wall', x - 0.15, x + 0.15, y - 6.0, y + 6.0, -0.3, 6.2, 'concrete')
    for k, dy in enumerate((-5.8, -1.95, 1.95, 5.8)):
        w.box(f'fire_wall_pier_{k}', x - 0.3, x + 0.3, y + dy - 0.2, y + dy + 0.2, -0.3, 6.4, 'concrete')


def sand_box(w, name, x, y):
    """For fires: sand, and shovels on a red board behind it."""
    w.box(f'{name}', x - 0.75, x + 0.75, y - 0.5, y + 0.5, GRAVEL, 0.95, 'fire_red')
    w.box(f'{name}_lid', x - 0.8, x + 0.8, y - 0.55, y + 0.55, 0.95, 1.0, 'white', EYE)


# --- reactive power ---------------------------------------------------------------------------------------------------

def reactor(w, name, x, y):
    """An air-core coil on six short posts."""
    for k in range(6):
        a = np.pi * k / 3.0
        px, py = x + 0.85 * np.cos(a), y + 0.85 * np.sin(a)
        w.geom(f'{name}_leg_{k}', 'cylinder', (px, py, 0.45), (0.09, 0.5), 'concrete')
        w.geom(f'{name}_post_{k}', 'cylinder', (px, py, 1.3), (0.10, 0.35), 'porcelain', SEEN)
    w.geom(f'{name}_coil', 'cylinder', (x, y, 2.9), (1.15, 1.25), 'reactor', SEEN)
    w.geom(f'{name}_hole', 'cylinder', (x, y, 4.16), (0.8, 0.01), 'iron', EYE)


def capacitors(w, name, x, y):
    """A rack of cans on a steel frame, 4 m along x."""
    for i, dx in enumerate((-2.0, 0.0, 2.0)):
        for j, dy in enumerate((-0.55, 0.55)):
            w.box(f'{name}_leg_{i}{j}', x + dx - 0.06, x + dx + 0.06, y + dy - 0.06, y + dy + 0.06, GRAVEL, 3.2, 'galvanised')
    for level, z in enumerate((0.9, 2.0)):
        w.box(f'{name}_shelf_{level}', x - 2.1, x + 2.1, y - 0.6, y + 0.6, z - 0.06, z, 'galvanised', EYE)
        for k, cx in enumerate(np.arange(-1.75, 1.8, 0.5)):
            w.box(f'{name}_can_{level}_{k}', x + cx - 0.17, x + cx + 0.17, y - 0.5, y + 0.5, z, z + 0.75, 'cabinet', SEEN)
            w.rod(f'{name}_stud_{level}_{k}', (x + cx, y, z + 0.75), (x + cx, y, z + 0.95), 0.05, 'porcelain', EYE)


def compensation_yard(w, x0, x1, y0, y1):
    """Reactors and capacitors behind a fence of their own."""
    for k, y in enumerate((y0 + 2.6, y0 + 6.1, y0 + 9.6)):
        reactor(w, f'reactor_{k}', x0 + 2.3, y)
        capacitors(w, f'capacitors_{k}', x1 - 3.0, y)
        wire(w, f'reactor_{k}_lead', (x0 + 2.3, y, 4.1), (x1 - 4.8, y, 3.1))
    fence_run(w, 'yard_south', (x0, y0), (x1, y0), 4, 1.7)
    fence_run(w, 'yard_east', (x1, y0), (x1, y1), 5, 1.7)
    fence_run(w, 'yard_north', (x1, y1), (x0, y1), 4, 1.7)
    fence_run(w, 'yard_west', (x0, y1), (x0, y0), 5, 1.7)


# --- fence --------------------------------------------------------------------------------------------------------------

def fence_run(w, name, start, end, panels, height=2.2):
    """Posts, a plinth that ends under the lidar's plane, and mesh.

    The mesh is there for eye and touch alone. Wires of 4 mm every 50 mm fill a twelfth of a beam's spot, so that mesh painted green (30 %)
    sends back what a closed surface of 2.4 % would; by the sensor's own law (10 m on 10 %) it is lost beyond 4.9 m, and the patrol keeps
    5 m from it. Nearer than that a real lidar would see some of it."""
    (x0, y0), (x1, y1) = start, end
    along_x = y0 == y1
    lo, hi = (min(x0, x1), max(x0, x1)) if along_x else (min(y0, y1), max(y0, y1))
    across = y0 if along_x else x0

    def wall(part, half, z0, z1, material, cls):
        if along_x:
            w.box(f'fence_{name}_{part}', lo, hi, across - half, across + half, z0, z1, material, cls)
        else:
            w.box(f'fence_{name}_{part}', across - half, across + half, lo, hi, z0, z1, material, cls)
    wall('plinth', 0.12, -0.3, 0.35, 'concrete', SEEN)
    wall('mesh', 0.004, 0.35, height, 'mesh', EYE)
    wall('hull', 0.12, -0.3, height, 'mesh', TOUCH)
    for k in range(panels):  # the run's last post is the next one's first
        s = k / panels
        x, y = x0 + s * (x1 - x0), y0 + s * (y1 - y0)
        w.geom(f'fence_{name}_post_{k}', 'cylinder', (x, y, height / 2), (0.04, height / 2 + 0.05), 'fence', SEEN)


def gate(w, x0, x1, y):
    """Of bars, closed."""
    w.box('gate_rail_low', x0, x1, y - 0.04, y + 0.04, 0.08, 0.20, 'white', SEEN)
    w.box('gate_rail_high', x0, x1, y - 0.04, y + 0.04, 1.7, 1.8, 'white', SEEN)
    for k, x in enumerate(np.arange(x0 + 0.1, x1, 0.15)):
        w.box(f'gate_bar_{k}', x - 0.02, x + 0.02, y - 0.02, y + 0.02, 0.2, 1.7, 'white', SEEN)
    w.box('gate_hull', x0, x1, y - 0.06, y + 0.06, 0.0, 1.8, 'white', TOUCH)
    for k, x in enumerate((x0 - 0.3, x1 + 0.3)):
        w.box(f'gate_pillar_{k}', x - 0.3, x + 0.3, y - 0.3, y + 0.3, -0.3, 2.5, 'facade')


# --- masts and lamps --------------------------------------------------------------------------------------------------

def lightning_mast(w, name, x, y, height=30.0, half=0.75):
    """A lattice tower of four legs."""
    corners = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    w.box(f'{name}_footing', x - half - 0.4, x + half + 0.4, y - half - 0.4, y + half + 0.4, -0.3, 0.2, 'concrete')
    levels = np.linspace(0.0, 1.0, 11)
    at = lambda k, t: (x + corners[k % 4][0] * half * (1.0 - 0.85 * t), y + corners[k % 4][1] * half * (1.0 - 0.85 * t), 0.2 + t * (height - 5.2))
    for k in range(4):
        w.rod(f'{name}_leg_{k}', at(k, 0.0), at(k, 1.0), 0.06, 'galvanised', SOLID, 'cylinder')
        for j, (t0, t1) in enumerate(zip(levels, levels[1:])):
            w.rod(f'{name}_lace_{k}_{j}', at(k + j % 2, t0), at(k + 1 - j % 2, t1), 0.03, 'galvanised', SEEN if j == 0 else EYE)
    w.rod(f'{name}_tip', (x, y, height - 5.2), (x, y, height), 0.04, 'galvanised', EYE)


def lamp_post(w, name, x, y, towards_x, towards_y):
    w.geom(f'{name}_footing', 'cylinder', (x, y, 0.0), (0.2, 0.1), 'concrete', SEEN)
    w.geom(f'{name}_pole', 'cylinder', (x, y, 2.0), (0.06, 2.0), 'galvanised')
    w.rod(f'{name}_arm', (x, y, 3.95), (x + 0.5 * towards_x, y + 0.5 * towards_y, 4.1), 0.03, 'galvanised', EYE)
    w.geom(f'{name}_head', 'ellipsoid', (x + 0.6 * towards_x, y + 0.6 * towards_y, 4.08), (0.24, 0.24, 0.07), 'lamp', EYE)


def hydrant(w, name, x, y):
    w.geom(f'{name}_stem', 'cylinder', (x, y, 0.35), (0.09, 0.42), 'fire_red')
    w.geom(f'{name}_cap', 'ellipsoid', (x, y, 0.79), (0.12, 0.12, 0.07), 'fire_red', EYE)
    w.rod(f'{name}_mouths', (x - 0.18, y, 0.6), (x + 0.18, y, 0.6), 0.05, 'fire_red', EYE)


# --- buildings --------------------------------------------------------------------------------------------------------

def picture(w, name, x, y, z, width, height, material, yaw_deg):
    """A flat face upright against a wall; yaw 0 looks to -y."""
    w.geom(name, 'box', (x, y, z), (width / 2, height / 2, 0.02), material, EYE, quat=upright(yaw_deg))


def control_building(w, x0, x1, y0, y1):
    """Two storeys; doors to the road in the north and to the gate in the south, windows all round."""
    w.box('control_building', x0, x1, y0, y1, -0.3, 7.6, 'facade')
    w.box('control_building_plinth', x0 - 0.05, x1 + 0.05, y0 - 0.05, y1 + 0.05, -0.3, 0.5, 'granite', SEEN)
    for part, a, b, c, d in (('south', x0, x1, y0 - 0.15, y0 + 0.2), ('north', x0, x1, y1 - 0.2, y1 + 0.15),
                             ('west', x0 - 0.15, x0 + 0.2, y0, y1), ('east', x1 - 0.2, x1 + 0.15, y0, y1)):
        w.box(f'control_building_parapet_{part}', a, b, c, d, 7.4, 8.2, 'band', EYE)
        w.box(f'control_building_band_{part}', a, b, min(c, d) + 0.1, max(c, d) - 0.1, 3.7, 4.0, 'band', EYE)
    doors = {'north': (x0 + 6.0, x0 + 20.0), 'south': (x0 + 13.0,)}
    for side, y, sign, yaw in (('south', y0, -1, 0), ('north', y1, 1, 180)):
        for k, x in enumerate(np.arange(x0 + 2.0, x1 - 1.0, 3.0)):
            for storey, z in enumerate((2.1, 5.6)):
                if storey == 0 and min(abs(x - door) for door in doors[side]) < 2.2:
                    continue
                picture(w, f'window_{side}_{k}_{storey}', x, y + sign * 0.02, z, 1.7, 1.6, 'window', yaw)
                w.box(f'sill_{side}_{k}_{storey}', x - 0.95, x + 0.95, *sorted((y, y + sign * 0.14)), z - 0.9, z - 0.8, 'granite', EYE)
        for k, x in enumerate(doors[side]):
            picture(w, f'door_{side}_{k}', x, y + sign * 0.06, 1.45, 1.8, 2.3, 'door_grey', yaw)
            w.box(f'step_{side}_{k}', x - 1.4, x + 1.4, *sorted((y, y + sign * 1.3)), -0.3, 0.16, 'concrete')
            w.box(f'landing_{side}_{k}', x - 1.2, x + 1.2, *sorted((y, y + sign * 0.8)), 0.16, 0.3, 'concrete')
            w.box(f'canopy_{side}_{k}', x - 1.5, x + 1.5, *sorted((y, y + sign * 1.3)), 2.9, 3.05, 'band', EYE)
    for side, x, sign, yaw in (('west', x0, -1, -90), ('east', x1, 1, 90)):
        for k, y in enumerate((y0 + 3.0, y1 - 3.0)):
            for storey, z in enumerate((2.1, 5.6)):
                picture(w, f'window_{side}_{k}_{storey}', x + sign * 0.02, y, z, 1.7, 1.6, 'window', yaw)
    for k, (x, y) in enumerate(((x0 + 4.0, y1 + 0.6), (x0 + 11.0, y1 + 0.6), (x0 + 23.5, y1 + 0.6), (x0 + 5.0, y0 - 0.6), (x0 + 20.0, y0 - 0.6))):
        w.box(f'air_conditioner_{k}', x - 0.45, x + 0.45, y - 0.18, y + 0.18, 0.15, 1.0, 'white')
        w.geom(f'air_conditioner_{k}_fan', 'cylinder', (x - 0.1, y + (0.19 if y > y1 else -0.19), 0.57), (0.27, 0.01), 'iron', EYE, euler=(90, 0, 0))
    for k, (x, y) in enumerate(((x0 + 0.2, y1 + 0.12), (x1 - 0.2, y1 + 0.12), (x0 + 0.2, y0 - 0.12), (x1 - 0.2, y0 - 0.12))):
        w.geom(f'downpipe_{k}', 'cylinder', (x, y, 3.6), (0.06, 3.7), 'white')
    picture(w, 'station_name', (x0 + x1) / 2, y0 - 0.2, 6.95, 6.0, 0.8, 'sign_name', 0)


def pump_house(w, x0, x1, y0, y1):
    w.box('pump_house', x0, x1, y0, y1, -0.3, 3.4, 'facade')
    w.box('pump_house_roof', x0 - 0.3, x1 + 0.3, y0 - 0.3, y1 + 0.3, 3.4, 3.6, 'band', EYE)
    picture(w, 'pump_house_door', x0 - 0.02, (y0 + y1) / 2, 1.15, 1.4, 2.1, 'door_red', -90)
    picture(w, 'pump_house_window', (x0 + x1) / 2, y1 + 0.02, 2.0, 1.2, 1.0, 'window', 180)


def station_supply(w, x, y):
    """The station's own small transformer, as a cabinet, and a post line beside it."""
    w.box('supply_footing', x - 1.5, x + 1.5, y - 1.1, y + 1.1, -0.3, 0.25, 'concrete')
    w.box('supply', x - 1.3, x + 1.3, y - 0.95, y + 0.95, 0.25, 2.3, 'supply_green')
    w.box('supply_roof', x - 1.45, x + 1.45, y - 1.1, y + 1.1, 2.3, 2.42, 'cabinet', EYE)
    for k, dx in enumerate((-0.65, 0.65)):
        w.box(f'supply_door_{k}', x + dx - 0.55, x + dx + 0.55, y + 0.95, y + 0.96, 0.4, 2.1, 'cabinet_door', EYE)
