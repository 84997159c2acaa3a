"""What the tools that make worlds share: lines of an MJCF file, people. All sizes in metres."""
import contextlib
import math

SOLID = 'class="solid"'  # eye and lidar see it, and it can be touched
SEEN = 'class="seen"'    # eye and lidar see it, and it is not touched
EYE = 'class="eye"'      # only looked at
TOUCH = 'class="touch"'  # only touched: a simple hull

# WGS 84 position of the origin of the sites under open sky; the default of sensors.gnss.
DATUM = {'latitude_deg': 29.21, 'longitude_deg': 119.46}

# What a thing is for, by geom group (README, "Worlds").
CLASSES = '''  <default>
    <!-- What a thing is for (README, "Worlds"): solid is seen by eye and lidar and touched; seen is seen by both and not touched; eye
         is only looked at; touch is only touched, a simple hull; actor is what moves. -->
    <default class="solid"><geom group="0" contype="1" conaffinity="2"/></default>
    <default class="seen"><geom group="0" contype="0" conaffinity="0"/></default>
    <default class="eye"><geom group="1" contype="0" conaffinity="0"/></default>
    <default class="touch"><geom group="3" contype="1" conaffinity="2"/></default>
    <default class="actor"><geom group="0" contype="1" conaffinity="2"/></default>
  </default>
'''


def fmt(values):
    return ' '.join(f'{round(v, 4):g}' for v in values)


class World:
    """Collects the body of the MJCF file."""

    def __init__(self):
        self.lines = []
        self.count = 0

    def geom(self, name, kind, pos, size, material, cls=SOLID, euler=None, quat=None, extra=''):
        self.count += 1
        turn = f' euler="{fmt(euler)}"' if euler else f' quat="{fmt(quat)}"' if quat else ''
        self.lines.append(f'<geom name="{name}" {cls} type="{kind}" pos="{fmt(pos)}" size="{fmt(size)}"{turn} '
                          f'material="{material}"{" " + extra if extra else ""}/>')

    def box(self, name, x0, x1, y0, y1, z0, z1, material, cls=SOLID):
        self.geom(name, 'box', ((x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2),
                  ((x1 - x0) / 2, (y1 - y0) / 2, (z1 - z0) / 2), material, cls)

    def rod(self, name, a, b, radius, material, cls=SEEN, kind='capsule'):
        self.count += 1
        self.lines.append(f'<geom name="{name}" {cls} type="{kind}" fromto="{fmt(a)} {fmt(b)}" size="{radius:g}" material="{material}"/>')

    @contextlib.contextmanager
    def frame(self, x, y, yaw_deg=0.0, z=0.0):
        """What is put down within stands at a place and is turned about the vertical."""
        self.lines.append(f'<frame pos="{fmt((x, y, z))}" euler="0 0 {fmt([yaw_deg])}">')
        yield
        self.lines.append('</frame>')

    def comment(self, text):
        self.lines.append(f'<!-- {text} -->')


# --- people -----------------------------------------------------------------------------------------------------------

def person(name, x, y, z0, shirt, trousers, head):
    """Torso and four limb parts, each a mocap body: sim/actors.cc walks them. Hip at 0.92 m, thigh and shank 0.43 m. `head` are
    (part, kind, 'pos="..." size="..."', material) of what sits on the neck."""
    hip = 0.92 + z0
    out = [f'<body name="{name}" mocap="true" pos="{fmt((x, y, hip))}">',
           f'<geom name="{name}_torso" class="actor" type="capsule" fromto="0 0 0.08 0 0 0.46" size="0.15" material="{shirt}"/>',
           f'<geom name="{name}_hips" class="actor" type="ellipsoid" pos="0 0 0.02" size="0.13 0.17 0.13" material="{trousers}"/>',
           f'<geom name="{name}_neck" class="actor" type="capsule" fromto="0 0 0.55 0 0 0.64" size="0.055" material="skin"/>']
    out += [f'<geom name="{name}_{part}" class="actor" type="{kind}" {shape} material="{material}"/>' for part, kind, shape, material in head]
    for side, sy in (('left', 1), ('right', -1)):
        out.append(f'<geom name="{name}_arm_{side}" class="actor" type="capsule" fromto="0 {sy * 0.2} 0.46 0.02 {sy * 0.24} 0.0" size="0.045" material="{shirt}"/>')
        out.append(f'<geom name="{name}_hand_{side}" class="actor" type="sphere" pos="0.03 {sy * 0.245} -0.06" size="0.05" material="skin"/>')
    out.append('</body>')
    for side, sy in (('left', 1), ('right', -1)):
        out += [f'<body name="{name}_thigh_{side}" mocap="true" pos="{fmt((x, y + sy * 0.09, hip))}">',
                f'<geom name="{name}_thigh_{side}" class="actor" type="capsule" fromto="0 0 0 0 0 -0.43" size="0.07" material="{trousers}"/></body>',
                f'<body name="{name}_shank_{side}" mocap="true" pos="{fmt((x, y + sy * 0.09, hip - 0.43))}">',
                f'<geom name="{name}_shank_{side}" class="actor" type="capsule" fromto="0 0 0 0 0 -0.40" size="0.052" material="{trousers}"/>',
                f'<geom name="{name}_shoe_{side}" class="actor" type="ellipsoid" pos="0.06 0 -0.43" size="0.13 0.05 0.05" material="hair"/></body>']
    return out


# --- turns and places -----------------------------------------------------------------------------------------------------------

def product(a, b):
    """Of two quaternions w, x, y, z."""
    w1, x1, y1, z1 = a
    w2, x2, y2, z2 = b
    return (w1 * w2 - x1 * x2 - y1 * y2 - z1 * z2, w1 * x2 + x1 * w2 + y1 * z2 - z1 * y2,
            w1 * y2 - x1 * z2 + y1 * w2 + z1 * x2, w1 * z2 + x1 * y2 - y1 * x2 + z1 * w2)


def upright(yaw_deg):
    """Turns local z to face -y (yaw 0), local y up."""
    a, b = math.radians(90), math.radians(yaw_deg)
    qx = (math.cos(a / 2), math.sin(a / 2), 0, 0)
    qz = (math.cos(b / 2), 0, 0, math.sin(b / 2))
    return product(qz, qx)


def quaternion(yaw_rad):
    """x, y, z, w: the order of the survey's files."""
    return [0.0, 0.0, round(math.sin(yaw_rad / 2), 9), round(math.cos(yaw_rad / 2), 9)]
