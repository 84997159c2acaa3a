"""Triangle meshes for the worlds."""
import numpy as np


class Mesh:
    """Triangles with texture coordinates, written as Wavefront OBJ; coordinates with so many digits after the point."""

    def __init__(self, digits=3):
        self.digits = digits
        self.points, self.texture, self.faces = [], [], []

    def grid(self, points, texture, flip=False):
        """Quads between the m x n `points`; seen from the side on which (row, column) runs anticlockwise, unless flipped."""
        rows, columns = points.shape[:2]
        first = len(self.points)
        self.points += points.reshape(-1, 3).tolist()
        self.texture += texture.reshape(-1, 2).tolist()
        for r in range(rows - 1):
            for c in range(columns - 1):
                a, b = first + r * columns + c, first + r * columns + c + 1
                e, f = a + columns, b + columns
                self.faces += [(a, b, e), (b, f, e)] if flip else [(a, e, b), (b, e, f)]

    def slab(self, front, back, texture):
        """A closed body between two grids of the same size, seen from outside."""
        first = len(self.faces)
        self.grid(front, texture)
        self.grid(back, texture, flip=True)
        for pick, flip in ((np.s_[0, :], False), (np.s_[-1, :], True), (np.s_[:, 0], True), (np.s_[:, -1], False)):
            self.grid(np.stack([back[pick], front[pick]]), np.stack([texture[pick], texture[pick]]), flip)
        if self.volume(first) < 0.0:
            self.faces[first:] = [(a, c, b) for a, b, c in self.faces[first:]]

    def volume(self, first=0):
        """Of what the faces from `first` on enclose; negative when they look inwards."""
        corners = np.array(self.points)[np.array(self.faces[first:])]
        return float(np.einsum('ij,ij->', corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))) / 6.0

    def write(self, path, maker):
        with open(path, 'w') as out:
            out.write(f'# made by {maker}\n')
            out.writelines(f'v {x:.{self.digits}f} {y:.{self.digits}f} {z:.{self.digits}f}\n' for x, y, z in self.points)
            out.writelines(f'vt {u:.4f} {v:.4f}\n' for u, v in self.texture)
            out.writelines(f'f {a + 1}/{a + 1} {b + 1}/{b + 1} {c + 1}/{c + 1}\n' for a, b, c in self.faces)
