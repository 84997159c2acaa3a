#include "importer/mesh_file_system.h"

#include <string>

#include <gtest/gtest.h>

#include "importer/mesh.h"
#include "tests/support/temporary_file.h"

namespace patrol::importer::mesh_file_system_test {
namespace {

TEST(MeshFileSystem, NumbersOfVerticesGetADigitBeforeThePoint) {
  EXPECT_EQ(with_leading_digits("v .6 -.5 0.4\r\nvn\t.1 1. .\n vt .5\n"), "v 0.6 -.5 0.4\r\nvn\t0.1 1. .\n vt 0.5\n");
  EXPECT_EQ(with_leading_digits("# v .6\nusemtl .5\nv 1 2 3\n"), "# v .6\nusemtl .5\nv 1 2 3\n");
}

TEST(MeshFileSystem, AnObjWithLeadingPointsIsReadWithItsMaterial) {
  const test::TemporaryFolder folder;
  test::write_bytes(folder / "m.mtl", "newmtl red\nKd 1 0 0\n");
  test::write_bytes(
      folder / "m.obj",
      "mtllib m.mtl\nusemtl red\nv 0 0 0\nv .6 0 0\nv 0 .4 0\nv 0 0 .2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const std::vector<MeshPart> parts = load_mesh(folder / "m.obj");
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_TRUE(parts[0].has_color);
  EXPECT_NEAR(integrate(parts[0].mesh).volume_m3, 0.6 * 0.4 * 0.2 / 6.0, 1e-8);
}

}  // namespace
}  // namespace patrol::importer::mesh_file_system_test
