#!/usr/bin/env python3
"""plyfile and pypcd4 read our point clouds, and we read theirs, to the last bit.

usage: point_clouds_test.py CLOUD_FILES
"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np
from plyfile import PlyData, PlyElement
from pypcd4 import Encoding, PointCloud

CLOUD_FILES = sys.argv[1]
T = np.arange(1000, dtype=np.float32)
SAMPLE = np.stack([0.125 * T, -1.5 * T, 1 / (1 + T), T % 256], axis=1).astype(np.float32)  # that of cloud_files.cc
NAMES = ("x", "y", "z", "intensity")


class PointClouds(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        subprocess.run([CLOUD_FILES, "write", self.folder], check=True, timeout=60)

    def read(self, file):
        done = subprocess.run([CLOUD_FILES, "read", file], capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        return np.array([line.split() for line in done.stdout.splitlines()], np.float32)

    def vertices(self, types):
        table = np.empty(len(SAMPLE), [*zip(NAMES, types)])
        for name, column in zip(NAMES, SAMPLE.T):
            table[name] = column
        return PlyElement.describe(table, "vertex")

    def test_plyfile_reads_our_ply(self):
        vertex = PlyData.read(self.folder / "cloud.ply")["vertex"]
        self.assertEqual([p.name for p in vertex.properties], [*NAMES])
        np.testing.assert_array_equal(np.stack([vertex[name] for name in NAMES], axis=1), SAMPLE)

    def test_pypcd4_reads_our_pcd(self):
        cloud = PointCloud.from_path(self.folder / "cloud.pcd")
        self.assertEqual(tuple(cloud.fields), NAMES)
        np.testing.assert_array_equal(cloud.numpy(NAMES), SAMPLE)

    def test_we_read_what_plyfile_writes_binary_and_in_figures(self):
        faces = PlyElement.describe(np.array([([0, 1, 2],)], [("vertex_indices", "i4", (3,))]), "face")
        for text in (False, True):
            file = self.folder / "theirs.ply"
            PlyData([self.vertices(("f4", "f8", "f4", "u1")), faces], text=text, byte_order="<").write(file)
            np.testing.assert_array_equal(self.read(file), SAMPLE)

    def test_we_read_what_pypcd4_writes_binary_and_in_figures(self):
        cloud = PointCloud.from_points(SAMPLE, NAMES, (np.float32, np.float64, np.float32, np.uint16))
        for encoding in (Encoding.BINARY, Encoding.ASCII):
            file = self.folder / "theirs.pcd"
            cloud.save(file, encoding=encoding)
            np.testing.assert_allclose(self.read(file), SAMPLE, rtol=0 if encoding == Encoding.BINARY else 1e-5)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
