#include "io/points/ply.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/io/cloud_samples.h"

namespace patrol::io::ply_test {
namespace {

using test::read_bytes, test::TemporaryFolder, test::write_bytes;

std::vector<ScannerPoint> load(const std::string& content) {
  const TemporaryFolder folder;
  write_bytes(folder / "c.ply", content);
  return load_ply(folder / "c.ply");
}

std::string complaint_about(const std::string& content) { return complaint("c.ply", content, load_ply); }

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";

std::string binary_header(const std::string& count, const std::string& properties = kXyz) {
  return "ply\nformat binary_little_endian 1.0\nelement vertex " + count + "\n" + properties + "end_header\n";
}

std::string ascii_header(const std::string& count) {
  return "ply\nformat ascii 1.0\nelement vertex " + count + "\n" + kXyz + "end_header\n";
}

TEST(Ply, ThereAndBackKeepsEveryBit) {
  const TemporaryFolder folder;
  save_ply(folder / "c.ply", kThreePoints, "station_3, 2 s");
  expect_same(load_ply(folder / "c.ply"), kThreePoints);
  save_ply(folder / "none.ply", {});
  EXPECT_TRUE(load_ply(folder / "none.ply").empty());
}

TEST(Ply, AFileOfOursIsItsHeaderAnd16BytesAPoint) {
  const TemporaryFolder folder;
  save_ply(folder / "c.ply", kThreePoints, "station_3");
  const std::string header = "ply\nformat binary_little_endian 1.0\ncomment station_3\nelement vertex 3\n" + kXyz +
                             "property float intensity\nend_header\n";
  const std::string content = read_bytes(folder / "c.ply");
  EXPECT_EQ(content.substr(0, header.size()), header);
  EXPECT_EQ(content.size(), header.size() + 3 * 16);
  EXPECT_EQ(content.substr(header.size(), 4), bytes(1.5F));
}

TEST(Ply, OthersTypesOrdersAndColoursAreRead) {
  const std::string properties =
      "property uchar red\nproperty double z\nproperty short y\nproperty float64 x\nproperty uint8 intensity\n";
  const auto points =
      load(binary_header("2", properties) + "\x07" + bytes(3.5) + bytes(std::int16_t{-4}) + bytes(0.25) + "\xc8" +
           "\x09" + bytes(-1.0) + bytes(std::int16_t{9}) + bytes(2.0) + std::string(1, '\0'));
  expect_same(points, {{0.25F, -4.0F, 3.5F, 200.0F}, {2.0F, 9.0F, -1.0F, 0.0F}});
}

TEST(Ply, FiguresAreReadWithWindowsLineEndsAndWithoutIntensityAndFacesAreLeftAlone) {
  expect_same(load("ply\r\nformat ascii 1.0\r\ncomment by hand\r\nelement vertex 2\r\nproperty float x\r\nproperty "
                   "float y\r\nproperty float z\r\n"
                   "element face 1\r\nproperty list uchar int vertex_indices\r\nend_header\r\n1 2 3\r\n-1.5 0 "
                   "2e-3\r\n3 0 1 0\r\n"),
              {{1.0F, 2.0F, 3.0F, 0.0F}, {-1.5F, 0.0F, 2e-3F, 0.0F}});
}

TEST(Ply, WhatIsNoPlyIsRefusedWithItsLine) {
  EXPECT_EQ(complaint_about("pcd\n"), "c.ply:1: is not a PLY file");
  EXPECT_EQ(complaint_about(""), "c.ply: is not a PLY file");
  EXPECT_EQ(complaint_about("ply\nformat ascii 1.0\n"), "c.ply:2: the header is incomplete");
  EXPECT_EQ(complaint_about("ply\nformat binary_middle_endian 1.0\nelement vertex 0\n" + kXyz + "end_header\n"),
            "c.ply:7: unsupported format (known: ascii, binary_little_endian, binary_big_endian)");
  EXPECT_EQ(complaint_about("ply\nformat ascii 1.0\nelement face 0\nend_header\n"),
            "c.ply:3: the first element must be vertex");
  EXPECT_EQ(complaint_about("ply\nformat ascii 1.0\nend_header\n"), "c.ply:3: the header contains no element");
  EXPECT_EQ(complaint_about("ply\nproperty float x\n"), "c.ply:2: property before the first element");
  EXPECT_EQ(complaint_about("ply\nsay hello\n"), "c.ply:2: is not a line of a PLY header");
  EXPECT_EQ(complaint_about(binary_header("1", "property float x\nproperty float y\n")),
            "c.ply:6: the points have no z");
  EXPECT_EQ(complaint_about(binary_header("1", kXyz + "property float x\n")), "c.ply:8: x: duplicate column");
  EXPECT_EQ(complaint_about(binary_header("1", "property list uchar int x\n")),
            "c.ply:4: list properties of vertex are not supported");
  EXPECT_EQ(complaint_about(binary_header("1", "property quad x\n")), "c.ply:4: property of unknown type");
}

TEST(Ply, WrongCountsAreRefusedWithoutFillingTheMemory) {
  const std::string point = bytes(1.0F) + bytes(2.0F) + bytes(3.0F);
  EXPECT_EQ(complaint_about(binary_header("2") + point), "c.ply: ends too early for 2 points of 12 bytes");
  EXPECT_EQ(complaint_about(binary_header("1") + point.substr(1)), "c.ply: ends too early for 1 points of 12 bytes");
  EXPECT_EQ(complaint_about(binary_header("1000000000") + point),
            "c.ply: ends too early for 1000000000 points of 12 bytes");
  EXPECT_NE(complaint_about(binary_header("99999999999999999999") + point), "accepted");
  EXPECT_NE(complaint_about(binary_header("-1") + point), "accepted");
  EXPECT_EQ(complaint_about(binary_header("1") + point + "x"), "c.ply: has data after its 1 points");
  EXPECT_EQ(complaint_about(ascii_header("2") + "1 2 3\n"), "c.ply: ends too early for 2 points");
  EXPECT_EQ(complaint_about(ascii_header("900000000") + "1 2 3\n"), "c.ply: ends too early for 900000000 points");
  EXPECT_EQ(complaint_about(ascii_header("1") + "1 2 3\n4 5 6\n"), "c.ply: has data after its 1 points");
}

TEST(Ply, NumbersThatAreNoneAreRefusedWithTheirPlace) {
  const std::string good = bytes(1.0F);
  for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity()}) {
    EXPECT_EQ(complaint_about(binary_header("2") + good + good + good + good + bytes(bad) + good),
              "c.ply: point 2 is not finite");
  }
  EXPECT_EQ(complaint_about(ascii_header("2") + "1 2 3\n1 nan 3\n"), "c.ply:9: is not finite");
  EXPECT_EQ(complaint_about(ascii_header("2") + "1 2 3\n1 two 3\n"), "c.ply:9: must be 3 numbers");
  EXPECT_EQ(complaint_about(ascii_header("2") + "1 2 3\n1 2 3 4\n"), "c.ply:9: more than 3 numbers");
}

TEST(Ply, AFileThatIsNotThereIsRefused) {
  EXPECT_THROW(load_ply("/nowhere/c.ply"), InputError);
  EXPECT_THROW(save_ply("/nowhere/c.ply", {}), InputError);
}

}  // namespace
}  // namespace patrol::io::ply_test
