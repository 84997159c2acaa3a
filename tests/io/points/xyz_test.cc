#include "io/points/xyz.h"

#include <gtest/gtest.h>

#include "io/points/point_collector.h"
#include "tests/io/cloud_samples.h"

namespace patrol::io::xyz_test {
namespace {

using test::TemporaryFolder, test::write_bytes;

struct Loaded {
  std::vector<ScannerPoint> points;
  std::string columns;
  PointShift shift;
};

Loaded load(const std::string& content) {
  const TemporaryFolder folder;
  write_bytes(folder / "c.xyz", content);
  Loaded loaded;
  loaded.points = load_shifted_xyz(folder / "c.xyz", loaded.shift, loaded.columns);
  return loaded;
}

std::string complaint_about(const std::string& content) {
  return complaint("c.xyz", content, [](const std::filesystem::path& file) {
    PointShift shift;
    std::string columns;
    load_shifted_xyz(file, shift, columns);
  });
}

TEST(Xyz, TheNumberOfColumnsSaysWhichIsTheIntensity) {
  EXPECT_EQ(load("1 2 3\n").columns, "the first three of 3 numbers in a line are x, y and z, none is the intensity");
  expect_same(load("1 2 3\n4 5 6\n").points, {{1, 2, 3, 0}, {4, 5, 6, 0}});
  expect_same(load("1 2 3 9\n").points, {{1, 2, 3, 9}});
  expect_same(load("1 2 3 255 128 0\n").points, {{1, 2, 3, 0}});
  expect_same(load("1 2 3 -700 255 128 0\n").points, {{1, 2, 3, -700}});
  EXPECT_EQ(load("1 2 3 -700 255 128 0\n").columns,
            "the first three of 7 numbers in a line are x, y and z, the fourth is the intensity");
}

TEST(Xyz, ALineOfNamesSaysWhichColumnIsWhich) {
  const std::vector<ScannerPoint> expected = {{1, 2, 3, 9}};
  for (const char* names : {"red,intensity,x,y,z", "// Red Intensity X Y Z", "#r scalar_Intensity x y z",
                            "\"red\";\"Reflectance\";\"X\";\"Y\";\"Z\""}) {
    SCOPED_TRACE(names);
    const Loaded loaded = load(std::string(names) + "\n200 9 1 2 3\n");
    expect_same(loaded.points, expected);
    EXPECT_EQ(loaded.columns, "");
  }
}

TEST(Xyz, CommentsBlankLinesAndByteOrderMarksAreIgnored) {
  const std::vector<ScannerPoint> expected = {{1, 2, 3, 0}, {4, 5, 6, 0}};
  expect_same(load("2\r\n1 2 3\r\n4 5 6\r\n").points, expected);
  expect_same(load("# x y z of the yard, in m; by hand\n\n1;2;3\n// rest\n4;5;6").points, expected);
  expect_same(load("  1,\t2, 3\n 4,5 ,6 \n\n").points, expected);
  expect_same(load("1, 2, 3\n4, 5, 6\n").points, expected);
  expect_same(load("\xEF\xBB\xBFx,y,z\n1,2,3\n4,5,6\n").points, expected);
  EXPECT_TRUE(load("").points.empty());
  EXPECT_TRUE(load("# nothing\n").points.empty());
}

TEST(Xyz, CoordinatesOfMillionsOfMetersKeepMillimetersAndPointsThatAreNotFiniteAreLeftOut) {
  const Loaded loaded = load("5411890.123 447312.456 212.5\nnan nan nan\n5411890.124 447312.456 212.5\n");
  EXPECT_EQ(loaded.shift.origin, Eigen::Vector3d(5'411'900.0, 447'300.0, 200.0));
  EXPECT_EQ(loaded.shift.num_dropped, 1U);
  ASSERT_EQ(loaded.points.size(), 2U);
  EXPECT_NEAR(loaded.points[1].x - loaded.points[0].x, 0.001F, 1e-5F);
}

TEST(Xyz, InvalidLinesAreRefused) {
  EXPECT_EQ(complaint_about("1 2 3\n1 2\n"), "c.xyz:2: must be 3 numbers");
  EXPECT_EQ(complaint_about("1 2 3\n1 2 3 4\n"), "c.xyz:2: must be 3 numbers");
  EXPECT_EQ(complaint_about("1 2 3\n1,,3\n"), "c.xyz:2: must be 3 numbers");
  EXPECT_EQ(complaint_about("1 2 3\na b c\n"), "c.xyz:2: must be 3 numbers");
  EXPECT_EQ(complaint_about("1 2 3\n1 2 1e300\n"), "c.xyz:2: is not finite");
  EXPECT_EQ(complaint_about("1 2\n"), "c.xyz:1: must be 3 to 100 numbers");
  EXPECT_EQ(complaint_about("x y z\n1 2 3 4\n"), "c.xyz:2: must be 3 numbers");
  EXPECT_EQ(complaint_about("easting,northing,height\n1,2,3\n"), "c.xyz:1: names no columns x, y and z");
  for (const char* line : {"1,5;2,5;3", "1,5 2,5 3", "1,5\t2\t3,25", "1,5 2,5 3,5 "})
    EXPECT_EQ(complaint_about(std::string(line) + "\n"),
              "c.xyz:1: has commas in its numbers: decimals must have a point");
  EXPECT_EQ(complaint_about("3\n1 2 3\n4 5 6\n"), "c.xyz: has 2 points, and 3 by its first line");
  EXPECT_EQ(complaint_about("1\n1 2 3\n4 5 6\n"), "c.xyz: has 2 points, and 1 by its first line");
  EXPECT_EQ(complaint_about("-5\n1 2 3\n"), "c.xyz:1: must be the number of points, or 3 numbers or more");
  EXPECT_EQ(complaint_about(std::string("\xFF\xFE"
                                        "1\0",
                                        4)),
            "c.xyz: is encoded as UTF-16: must be UTF-8");
}

}  // namespace
}  // namespace patrol::io::xyz_test
