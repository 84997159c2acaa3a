#!/usr/bin/env python3
"""plyfile and pypcd4 read our point clouds, and we read theirs and scans of libE57Format, to the last bit.

usage: point_clouds_test.py CLOUD_FILES
"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import pye57
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

    def test_we_read_scans_that_libe57format_writes(self):
        file = self.folder / "theirs.e57"
        scans = pye57.E57(str(file), mode="w")
        scans.write_scan_raw({"cartesianX": SAMPLE[:, 0], "cartesianY": SAMPLE[:, 1], "cartesianZ": SAMPLE[:, 2],
                              "intensity": SAMPLE[:, 3]}, translation=np.array([0.0, 0.0, 0.0]))
        scans.close()
        np.testing.assert_array_equal(self.read(file), SAMPLE)

    def test_we_read_scaled_angles_that_libe57format_packs_into_bits(self):
        file, count = self.folder / "packed.e57", 30000  # several packets
        limits = {"sphericalRange": (0, 29999, 1e-3), "sphericalAzimuth": (-3000, 3000, 1e-3),
                  "sphericalElevation": (-1000, 1500, 1e-3)}
        image = pye57.libe57.ImageFile(str(file), "w")
        prototype, buffers, raw = pye57.libe57.StructureNode(image), pye57.libe57.VectorSourceDestBuffer(), []
        for i, (name, (low, high, scale)) in enumerate(limits.items()):
            raw.append((low + np.arange(count) * (7919 + i) % (high - low + 1)).astype(np.int16))
            prototype.set(name, pye57.libe57.ScaledIntegerNode(image, low, low, high, scale, 0.0))
            buffers.append(pye57.libe57.SourceDestBuffer(image, name, raw[-1], count, True, False))
        points = pye57.libe57.CompressedVectorNode(image, prototype, pye57.libe57.VectorNode(image, True))
        scan = pye57.libe57.StructureNode(image)
        scan.set("points", points)
        scans = pye57.libe57.VectorNode(image, True)
        image.root().set("data3D", scans)
        scans.append(scan)
        writer = points.writer(buffers)
        writer.write(count)
        writer.close()
        image.close()
        r, azimuth, elevation = (scale * values for values, (_, _, scale) in zip(raw, limits.values()))
        level = r * np.cos(elevation)
        wanted = np.stack([level * np.cos(azimuth), level * np.sin(azimuth), r * np.sin(elevation)], axis=1)
        np.testing.assert_allclose(self.read(file)[:, :3], wanted, atol=1e-5)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
