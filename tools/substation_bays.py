"""The switchyard of worlds/substation: what stands in a 220 kV bay, and what is strung over it.

A bay is a frame with x across it (the phases at PHASES) and y towards the outgoing line. Single busbar of tubes; from the bus to the
line: pantograph disconnector, circuit breaker, (the inspection path,) current transformer, disconnector, voltage transformer, surge
arrester, gantry. Live parts hang above 4.5 m, insulators are 2.3 m, what carries them is thin: that is all a level lidar 0.55 m up sees.
"""
import numpy as np

from meshes import Mesh
from mjcf import EYE, SEEN, SOLID, TOUCH

LIDAR_ONLY = 'class="lidar"'
GRAVEL = -0.05                   # height of the gravel; roads are at 0

BAY_WIDTH = 15.0
PHASES = (-4.0, 0.0, 4.0)
BUS_Y = (41.5, 45.0, 48.5)       # of the three phases' tubes
BUS_Z = 8.8
BREAKER_Y, CURRENT_Y, DISCONNECTOR_Y, VOLTAGE_Y, ARRESTER_Y, LINE_GANTRY_Y = 51.8, 59.5, 63.5, 67.5, 70.0, 74.5
HALF_DISCONNECTOR = 1.25         # its two columns stand so far from its middle
FEED_GANTRY_Y = 38.6             # where the transformers' conductors come in
BEAM_Z = 14.0

SUPPORT = 2.5                    # height of a support
INSULATOR = 2.3                  # length of the mesh
CORE, SHED = 0.085, 0.165        # its radii
LIDAR_CORE = 0.12                # as a lidar sees it: a cylinder of about as much


# --- parts --------------------------------------------------------------------------------------------------------------

def insulator_mesh(sides=12, sheds=14):
    """A stack of sheds about z from 0 to INSULATOR, flanges at both ends."""
    pitch = (INSULATOR - 0.2) / sheds
    outline = [(0.0, 0.0), (0.13, 0.0), (0.13, 0.08), (CORE, 0.10)]
    for k in range(sheds):
        z = 0.10 + k * pitch
        outline += [(CORE, z + 0.25 * pitch), (SHED - (0.03 if k % 2 else 0.0), z + 0.45 * pitch), (CORE, z + 0.85 * pitch)]
    outline += [(CORE, INSULATOR - 0.10), (0.13, INSULATOR - 0.08), (0.13, INSULATOR), (0.0, INSULATOR)]
    radius, z = np.array(outline).T
    turn = np.linspace(0.0, 2.0 * np.pi, sides + 1)
    points = np.stack([np.outer(radius, np.cos(turn)), np.outer(radius, np.sin(turn)), np.outer(z, np.ones_like(turn))], axis=-1)
    mesh = Mesh()
    mesh.grid(points, np.stack(np.meshgrid(turn, z), axis=-1), flip=True)
    return mesh


def insulator(w, name, x, y, z, material='porcelain', cls=LIDAR_ONLY):
    """Standing; the eye sees its sheds, the lidar a cylinder."""
    w.count += 1
    w.lines.append(f'<geom name="{name}" {EYE} type="mesh" mesh="insulator" pos="{x:g} {y:g} {z:g}" material="{material}"/>')
    w.geom(f'{name}_core', 'cylinder', (x, y, z + INSULATOR / 2), (LIDAR_CORE, INSULATOR / 2), material, cls)


def string(w, name, a, b):
    """A strain string between two points: a rod for the core, discs of glass on it for the eye."""
    a, b = np.array(a), np.array(b)
    w.rod(name, a, b, 0.03, 'galvanised', EYE)
    steps = np.linspace(0.08, 0.92, 9)
    for k, (s, t) in enumerate(zip(steps - 0.02, steps + 0.02)):
        w.rod(f'{name}_disc_{k}', a + s * (b - a), a + t * (b - a), 0.13, 'porcelain', EYE, 'cylinder')


def support(w, name, x, y, height=SUPPORT, radius=0.15):
    """A steel tube on its footing, which ends under the lidar's plane; a plate on top."""
    w.box(f'{name}_footing', x - 0.35, x + 0.35, y - 0.35, y + 0.35, -0.3, 0.15, 'concrete')
    w.geom(f'{name}_tube', 'cylinder', (x, y, (0.15 + height) / 2), (radius, (height - 0.15) / 2), 'galvanised')
    w.box(f'{name}_plate', x - 0.25, x + 0.25, y - 0.25, y + 0.25, height - 0.04, height, 'galvanised', EYE)
    w.box(f'{name}_earth', x + radius - 0.005, x + radius + 0.01, y - 0.03, y + 0.03, 0.15, 1.1, 'earth', EYE)


def wire(w, name, *points):
    for k, (a, b) in enumerate(zip(points, points[1:])):
        w.rod(f'{name}_{k}', a, b, 0.025, 'aluminium', EYE)


def sagging(a, b, sag, pieces=6):
    """Points of a conductor that hangs from a to b."""
    share = np.linspace(0.0, 1.0, pieces + 1)[:, None]
    points = (1.0 - share) * np.array(a) + share * np.array(b)
    points[:, 2] -= 4.0 * sag * (share * (1.0 - share))[:, 0]
    return [tuple(p) for p in points]


# --- one phase of a bay -----------------------------------------------------------------------------------------------

def bus_disconnector(w, name, x, y):
    """A pantograph under its tube of the bus."""
    support(w, name, x, y, 2.6, 0.16)
    insulator(w, f'{name}_post', x, y, 2.6)
    w.rod(f'{name}_drive', (x + 0.45, y, 2.6), (x + 0.20, y, 4.85), 0.05, 'porcelain', EYE)
    w.box(f'{name}_head', x - 0.35, x + 0.35, y - 0.12, y + 0.12, 4.90, 5.10, 'aluminium', EYE)
    for side in (-1, 1):
        wire(w, f'{name}_arm_{side + 1}', (x, y, 5.1), (x + side * 0.55, y, 6.95), (x, y, BUS_Z - 0.08))


def breaker(w, name, x, y):
    """A live-tank breaker: frame of four angles, the drive's cabinet in it, support insulator, interrupter."""
    w.box(f'{name}_footing', x - 0.55, x + 0.55, y - 0.45, y + 0.45, -0.3, 0.15, 'concrete')
    for i, dx in enumerate((-0.4, 0.4)):
        for j, dy in enumerate((-0.3, 0.3)):
            w.box(f'{name}_leg_{i}{j}', x + dx - 0.05, x + dx + 0.05, y + dy - 0.05, y + dy + 0.05, 0.15, 2.4, 'galvanised', SEEN)
    w.box(f'{name}_cabinet', x - 0.30, x + 0.30, y - 0.24, y + 0.24, 0.42, 1.50, 'cabinet', SEEN)
    w.box(f'{name}_door', x - 0.24, x + 0.24, y + 0.24, y + 0.25, 0.48, 1.44, 'cabinet_door', EYE)
    w.box(f'{name}_deck', x - 0.48, x + 0.48, y - 0.38, y + 0.38, 2.32, 2.42, 'galvanised', EYE)
    w.box(f'{name}_hull', x - 0.45, x + 0.45, y - 0.35, y + 0.35, 0.0, 2.4, 'galvanised', TOUCH)
    insulator(w, f'{name}_post', x, y, 2.42)
    insulator(w, f'{name}_interrupter', x, y, 2.42 + INSULATOR + 0.12)
    for k, z in enumerate((2.42 + INSULATOR, 2.42 + 2 * INSULATOR + 0.12)):
        w.geom(f'{name}_terminal_{k}', 'cylinder', (x, y, z + 0.06), (0.19, 0.07), 'aluminium', EYE)


def current_transformer(w, name, x, y):
    support(w, name, x, y)
    w.box(f'{name}_tank', x - 0.30, x + 0.30, y - 0.30, y + 0.30, SUPPORT, 3.0, 'cabinet', SEEN)
    insulator(w, f'{name}_post', x, y, 3.0)
    w.geom(f'{name}_head', 'cylinder', (x, y, 5.72), (0.34, 0.42), 'cabinet', SEEN)
    w.geom(f'{name}_cap', 'ellipsoid', (x, y, 6.14), (0.34, 0.34, 0.15), 'aluminium', EYE)


def line_disconnector(w, name, x, y):
    """Two turning columns whose arms meet in the middle; the middle phase carries the drive."""
    for k, dy in enumerate((-HALF_DISCONNECTOR, HALF_DISCONNECTOR)):
        support(w, f'{name}_{k}', x, y + dy, 2.4)
        insulator(w, f'{name}_post_{k}', x, y + dy, 2.58)
        w.rod(f'{name}_arm_{k}', (x, y + dy, 4.95), (x, y, 4.95), 0.05, 'aluminium', EYE)
    w.box(f'{name}_base', x - 0.13, x + 0.13, y - 1.55, y + 1.55, 2.4, 2.58, 'galvanised', EYE)
    if x == 0.0:
        w.box(f'{name}_drive', x + 0.16, x + 0.62, y - 1.5, y - 1.0, 0.85, 1.6, 'cabinet', SEEN)
        w.rod(f'{name}_shaft', (x + 0.35, y - 1.25, 1.6), (x + 0.35, y - 1.25, 2.45), 0.03, 'galvanised', EYE)


def voltage_transformer(w, name, x, y):
    support(w, name, x, y)
    w.box(f'{name}_tank', x - 0.32, x + 0.32, y - 0.28, y + 0.28, SUPPORT, 3.1, 'cabinet', SEEN)
    insulator(w, f'{name}_post', x, y, 3.1, 'composite')
    w.geom(f'{name}_cap', 'cylinder', (x, y, 5.5), (0.24, 0.10), 'aluminium', EYE)


def arrester(w, name, x, y):
    support(w, name, x, y, 2.6, 0.14)
    insulator(w, f'{name}_post', x, y, 2.6, 'composite')
    w.geom(f'{name}_ring', 'cylinder', (x, y, 4.65), (0.42, 0.03), 'aluminium', EYE)
    w.box(f'{name}_counter', x - 0.09, x + 0.09, y - 0.26, y - 0.15, 1.45, 1.65, 'cabinet', EYE)


def phase(w, name, index):
    x, bus_y = PHASES[index], BUS_Y[index]
    bus_disconnector(w, f'{name}_pantograph', x, bus_y)
    breaker(w, f'{name}_breaker', x, BREAKER_Y)
    current_transformer(w, f'{name}_ct', x, CURRENT_Y)
    line_disconnector(w, f'{name}_disconnector', x, DISCONNECTOR_Y)
    voltage_transformer(w, f'{name}_vt', x, VOLTAGE_Y)
    arrester(w, f'{name}_arrester', x, ARRESTER_Y)
    wire(w, f'{name}_to_breaker', *sagging((x + 0.3, bus_y, 5.0), (x, BREAKER_Y, 7.25), 0.25))
    wire(w, f'{name}_to_ct', *sagging((x, BREAKER_Y, 4.8), (x, CURRENT_Y, 5.75), 0.35))
    wire(w, f'{name}_to_line', (x, CURRENT_Y, 5.75), (x, DISCONNECTOR_Y - HALF_DISCONNECTOR, 4.95))
    wire(w, f'{name}_to_vt', (x, DISCONNECTOR_Y + HALF_DISCONNECTOR, 4.95), (x, VOLTAGE_Y, 5.6), (x, ARRESTER_Y, 4.95))
    string(w, f'{name}_string', (x, LINE_GANTRY_Y + 0.4, BEAM_Z), (x, LINE_GANTRY_Y + 2.8, BEAM_Z - 0.7))
    wire(w, f'{name}_jumper', *sagging((x, ARRESTER_Y, 4.95), (x, LINE_GANTRY_Y + 2.8, BEAM_Z - 0.7), 0.6))
    wire(w, f'{name}_line', *sagging((x, LINE_GANTRY_Y + 2.8, BEAM_Z - 0.7), (x, LINE_GANTRY_Y + 45.0, 19.0), 1.5, 4))


def bay(w, name, x):
    """One bay about x; every one the same at the lidar's height."""
    with w.frame(x, 0.0):
        for index, letter in enumerate('abc'):
            phase(w, f'{name}_{letter}', index)
        for k, y in enumerate((58.0, 65.5)):  # marshalling cabinets, one by the path
            w.box(f'{name}_cabinet_{k}_footing', 5.85, 6.75, y - 0.35, y + 0.35, -0.3, 0.2, 'concrete')
            w.box(f'{name}_cabinet_{k}', 5.9, 6.7, y - 0.3, y + 0.3, 0.2, 1.75, 'cabinet')
            w.box(f'{name}_cabinet_{k}_door', 5.96, 6.64, y - 0.31, y - 0.30, 0.28, 1.68, 'cabinet_door', EYE)
        w.box(f'{name}_plate', -0.45, 0.45, CURRENT_Y - 0.36, CURRENT_Y - 0.34, 1.75, 2.1, f'plate_{name}', EYE)


# --- over the bays ----------------------------------------------------------------------------------------------------

def portal_leg(w, name, x, y, splay=1.5):
    """An A of two steel tubes that carries a gantry's beam."""
    for k, sign in enumerate((-1, 1)):
        foot = y + sign * splay
        w.box(f'{name}_footing_{k}', x - 0.45, x + 0.45, foot - 0.45, foot + 0.45, -0.3, 0.2, 'concrete')
        w.rod(f'{name}_leg_{k}', (x, foot, 0.0), (x, y + sign * 0.18, BEAM_Z), 0.17, 'galvanised', SOLID, 'cylinder')
    for k, z in enumerate((3.6, 8.0)):
        half = splay * (1.0 - z / BEAM_Z)
        w.rod(f'{name}_tie_{k}', (x, y - half, z), (x, y + half, z), 0.07, 'galvanised', EYE)
    w.rod(f'{name}_spike', (x, y, BEAM_Z), (x, y, BEAM_Z + 5.0), 0.05, 'galvanised', EYE)


def beam(w, name, x0, x1, y):
    """A lattice beam of three chords."""
    low, high = BEAM_Z, BEAM_Z + 0.9
    chords = ((y - 0.5, low), (y + 0.5, low), (y, high))
    for k, (cy, cz) in enumerate(chords):
        w.rod(f'{name}_chord_{k}', (x0, cy, cz), (x1, cy, cz), 0.06, 'galvanised', EYE)
    count = max(4, round((x1 - x0) / 1.9))
    at = np.linspace(x0, x1, count + 1)
    for k, (a, b) in enumerate(zip(at, at[1:])):
        middle = (a + b) / 2
        for j, cy in enumerate((y - 0.5, y + 0.5)):
            w.rod(f'{name}_brace_{k}_{j}', (a, cy, low), (middle, y, high), 0.03, 'galvanised', EYE)
            w.rod(f'{name}_brace_{k}_{j + 2}', (middle, y, high), (b, cy, low), 0.03, 'galvanised', EYE)


def gantry(w, name, legs_x, y):
    for k, x in enumerate(legs_x):
        portal_leg(w, f'{name}_{k}', x, y)
    for k, (a, b) in enumerate(zip(legs_x, legs_x[1:])):
        beam(w, f'{name}_beam_{k}', a, b, y)


def busbar(w, supports_x):
    """Three tubes along the row of bays on tall supports."""
    for index, y in enumerate(BUS_Y):
        for k, x in enumerate(supports_x):
            support(w, f'bus_{index}_{k}', x, y, BUS_Z - INSULATOR - 0.12, 0.17)
            insulator(w, f'bus_{index}_{k}_post', x, y, BUS_Z - INSULATOR - 0.12)
        w.rod(f'bus_{index}_tube', (supports_x[0] - 0.8, y, BUS_Z), (supports_x[-1] + 0.8, y, BUS_Z), 0.08, 'aluminium', EYE)
