"""The structure of worlds/tunnel: lining, rock, face, the walls that the robot touches, invert and portal."""
import math

import numpy as np
from PIL import Image

import tunnel_shape as shape
import tunnel_textures as paint
from meshes import Mesh
from mjcf import EYE, SEEN, SOLID, TOUCH, fmt
from tunnel_shape import place, swept

LIDAR_ONLY = 'class="ground"'
CELL_ALONG, CELL_ACROSS = 0.2, 0.1  # of the height field
LEVEL_STEP = 0.002                  # of its 255 levels

FIRST_RING = 0.0  # chainage at which ring 1 begins
JOINT = 0.01      # between the corners of neighbouring rings

SECTION_LENGTH = float(shape.section()[2][-1])  # from foot to foot
INVERT_WIDTH = 12.8  # that its texture covers


def lining(w):
    """The lined part: a shell 0.45 m thick in rings, the same everywhere, so that a lidar cannot tell one place from another. Its
    inner face is within a millimetre of the design's section, and has corners on both sides of every joint, so that a ring can be
    moved against its neighbours; the outer face is not visible and is coarse."""
    points, normals, along = shape.section(side_steps=13, crown_steps=84)
    joints = np.arange(FIRST_RING, shape.LINED + 0.01, paint.RING)
    stations = np.concatenate([[-1.5], joints - JOINT / 2, joints[:-1] + JOINT / 2, [shape.LINED],
                               joints[:-1][joints[:-1] >= shape.STRAIGHT] + paint.RING / 2])  # an arc's rings in two halves
    stations.sort()
    inner, texture = swept(stations, points + 0.0005 * normals, paint.LAMP_SPACING)  # the middles of its facets lie as far within
    texture[..., 1] = 1.0 - along / along[-1]
    mesh = Mesh(digits=4)
    mesh.grid(inner, texture)
    for row, flip in ((0, False), (-1, True)):
        rim, _ = swept([stations[row]], points + 0.45 * normals, paint.LAMP_SPACING)
        mesh.grid(np.stack([rim[0], inner[row]]), np.stack([texture[row], texture[row]]), flip)
    points, normals, _ = shape.section()
    outer, texture = swept(np.linspace(-1.5, shape.LINED, 15), points + 0.45 * normals, paint.LAMP_SPACING)
    mesh.grid(outer, texture, flip=True)
    w.mesh('lining', mesh, 'lining', SEEN)


def rock(w):
    """Shotcrete and bare rock outside the lined section, with the steel arches that hold the first of it."""
    points, normals, along = shape.section(side_steps=8, crown_steps=34)
    for name, start, end, material in (('shotcrete', shape.LINED - 1.0, 146.0, 'shotcrete'), ('bare_rock', 145.5, shape.FACE + 2.0, 'bare_rock')):
        stations = np.arange(start, end + 0.01, 0.5)
        outline = lambda s: points + normals * shape.rock_offset(s, along)[:, None]
        inner, texture = swept(stations, outline, 6.0)
        texture[..., 1] = along / 6.0
        outer, _ = swept(stations, points + 1.8 * normals, 6.0)
        mesh = Mesh()
        mesh.slab(inner, outer, texture)
        w.mesh(name, mesh, material, SEEN)
    arch_points, arch_normals, _ = shape.section(side_steps=3, crown_steps=16)
    mesh = Mesh()
    for s in np.arange(104.0, 145.0, 2.0):
        rings = []
        for ds, out in ((-0.08, 0.16), (0.08, 0.16), (0.08, 0.34), (-0.08, 0.34), (-0.08, 0.16)):
            ring, _ = swept([s + ds], arch_points + out * arch_normals, 1.0)
            rings.append(ring[0])
        grid = np.array(rings)
        mesh.grid(grid, np.zeros(grid.shape[:2] + (2,)), flip=False)
    w.mesh('arches', mesh, 'rust', SEEN)


def face(w):
    """The rock face, and what the last round brought down."""
    d, z = np.meshgrid(np.linspace(7.2, -7.2, 37), np.linspace(-1.0, 9.2, 28))
    s = shape.FACE + shape.face_offset(d, z)
    x, y = place(s, d)
    front = np.stack([x, y, z], axis=-1)
    x, y = place(np.full_like(d, shape.FACE + 1.6), d)
    back = np.stack([x, y, z], axis=-1)
    mesh = Mesh()
    mesh.slab(front, back, np.stack([d / 6.0, z / 6.0], axis=-1))
    w.mesh('face', mesh, 'bare_rock', SEEN)
    s, d = np.meshgrid(np.linspace(155.0, shape.FACE + 0.6, 20), np.linspace(-5.6, 5.6, 29), indexing='ij')
    rise = np.clip((s - 155.6) / 6.0, 0.0, 1.0) ** 1.2 * (1.9 - 0.05 * (d + 1.0) ** 2)
    z = rise * (1.0 + 0.35 * shape._ledges(s, d)) + 0.25 * shape._chips(s, d) * (rise > 0.05) - 0.06
    x, y = place(s, d)
    top = np.stack([x, y, z], axis=-1)
    mesh = Mesh()
    mesh.slab(top, top * (1, 1, 0) + (0, 0, -0.5), np.stack([s / 3.0, d / 3.0], axis=-1))
    w.mesh('muck', mesh, 'muck', SEEN)
    with w.at(shape.FACE - 2.2, 0.0):
        w.box('face_hull', -1.4, 3.0, -5.6, 5.6, -0.5, 2.0, 'bare_rock', TOUCH)


def walls(w):
    """What the robot touches of the tube: a box every few metres at the wall's place at its height."""
    for name, start, end, step in (('lining', -1.5, shape.LINED, 6.0), ('rock', shape.LINED, shape.FACE, 3.0)):
        for i, s in enumerate(np.arange(start, end - 0.1, step)):
            middle = s + step / 2
            for side, sign in (('left', 1), ('right', -1)):
                inner = shape.wall_offset(0.3)
                if name == 'rock':
                    along = 0.9 if sign > 0 else SECTION_LENGTH - 0.9
                    inner += float(shape.rock_offset(np.linspace(s, s + step, 7), along).min())
                with w.at(middle, sign * (inner + 0.15)):
                    w.box(f'wall_{name}_{side}_{i}', -step / 2 - 0.02, step / 2 + 0.02, -0.15, 0.15, -0.3, 1.5, 'concrete', TOUCH)


def height_field(w, folder):
    """The invert, in a rectangle along the tunnel's chord. Returns its asset line."""
    chord = np.array(place(shape.FACE + 1.0, 0.0)) - np.array(place(-6.0, 0.0))
    yaw = math.atan2(chord[1], chord[0])
    axis, across = np.array((math.cos(yaw), math.sin(yaw))), np.array((-math.sin(yaw), math.cos(yaw)))
    edge = np.array([place(s, d) for s in np.arange(-6.0, shape.FACE + 1.1, 1.0) for d in (-6.4, 6.4)])
    low = np.array((np.min(edge @ axis), np.min(edge @ across)))
    size = np.array((np.max(edge @ axis), np.max(edge @ across))) - low
    columns, rows = int(math.ceil(size[0] / CELL_ALONG)) + 1, int(math.ceil(size[1] / CELL_ACROSS)) + 1
    u, v = np.meshgrid(low[0] + np.arange(columns) * CELL_ALONG, low[1] + np.arange(rows) * CELL_ACROSS)
    s, d = shape.chainage(u * axis[0] + v * across[0], u * axis[1] + v * across[1])
    levels = np.round(shape.invert_height(s, d) / LEVEL_STEP).astype(int)
    bottom, top = int(levels.min()), int(levels.max())
    if top - bottom > 255:
        raise SystemExit(f'the invert takes {top - bottom} levels of {LEVEL_STEP} m: more than a PNG has')
    grey = np.round((levels - bottom) * 255.0 / (top - bottom)).astype(np.uint8)
    Image.fromarray(grey[::-1]).save(folder / 'invert_height.png', optimize=True)  # the picture's first row is the highest y
    half = ((columns - 1) * CELL_ALONG / 2, (rows - 1) * CELL_ACROSS / 2)
    middle = (low[0] + half[0]) * axis + (low[1] + half[1]) * across
    w.lines.append(f'<geom name="ground_invert" {LIDAR_ONLY} type="hfield" hfield="invert" pos="{fmt((*middle, bottom * LEVEL_STEP))}" '
                   f'euler="0 0 {math.degrees(yaw):.6g}" material="invert_plain"/>')
    return f'<hfield name="invert" file="invert_height.png" size="{fmt((*half, (top - bottom) * LEVEL_STEP, 0.5))}"/>'


def invert_looks(w):
    """What the eye sees of the invert: the same ground, with the lanes painted on. In pieces, so that a camera can leave some out."""
    d = np.concatenate([[6.4, 5.8], np.arange(5.2, -5.21, -0.26), [-5.8, -6.4]])
    edges = np.concatenate([np.arange(t - 0.05, t + 0.56, 0.15) for t in (shape.TRENCH[0], shape.TRENCH[1] - 0.45)])
    for i, start in enumerate(np.arange(-6.0, shape.FACE + 0.9, 24.0)):
        end = min(start + 24.0, shape.FACE + 1.0)
        stations = np.concatenate([np.arange(start, end - 0.1, 0.6), edges[(edges > start) & (edges < end)], [end]])
        stations.sort()
        s, across = np.meshgrid(stations, d, indexing='ij')
        x, y = place(s, across)
        mesh = Mesh()
        mesh.grid(np.stack([x, y, shape.invert_height(s, across)], axis=-1),
                  np.stack([s / paint.LAMP_SPACING, 0.5 + across / INVERT_WIDTH], axis=-1), flip=True)
        w.mesh(f'invert_{i}', mesh, 'invert', EYE)


def portal(w):
    """The wall around the mouth, and the yard before it."""
    w.comment('the portal')
    w.box('ground_yard', -40.0, -5.9, -25.0, 25.0, -0.4, -0.01, 'gravel')
    points, normals, _ = shape.section()
    hole = points + 0.3 * normals
    rim = np.array([(np.sign(d) * 16.0, z) if z < 3.0 else (16.0 * math.cos(t), 11.0) for (d, z), t in zip(hole, np.arctan2(hole[:, 1] - 2.5, hole[:, 0]))])
    rim[:, 0] = np.where(rim[:, 1] == 11.0, np.clip(rim[:, 0] * 1.15, -16.0, 16.0), rim[:, 0])
    front, back = (np.stack([np.insert(outline, 0, x, axis=1) for outline in (hole, rim)]) for x in (-1.7, -0.9))
    mesh = Mesh()
    mesh.slab(front, back, front[..., 1:] / 3.0)
    w.mesh('portal', mesh, 'concrete_wall', SEEN)
    for side, sign in (('left', 1), ('right', -1)):
        y0, y1 = sorted((sign * 5.3, sign * 16.0))
        w.box(f'portal_hull_{side}', -1.7, -0.9, y0, y1, -0.5, 2.0, 'concrete', TOUCH)
    w.box('portal_cope', -1.9, -0.9, -16.0, 16.0, 11.0, 11.3, 'concrete', EYE)
    for i, (x, y, yaw, material) in enumerate(((-17.0, 7.5, 12, 'truck_white'), (-21.0, -6.0, -8, 'hose_blue'))):
        w.lines.append(f'<geom name="container_{i}" {SOLID} type="box" pos="{x} {y} 1.3" size="3 1.22 1.3" euler="0 0 {yaw}" material="{material}"/>')
    for k in range(8):
        w.box(f'yard_fence_{k}', -27.0, -26.9, -12.0 + 3.0 * k, -9.2 + 3.0 * k, 0.0, 2.0, 'steel', SEEN)
