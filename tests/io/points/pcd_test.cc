#include "io/points/pcd.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/io/cloud_samples.h"

namespace patrol::io::pcd_test {
namespace {

using test::read_bytes, test::TemporaryFolder, test::write_bytes;

std::vector<ScannerPoint> load(const std::string& content) {
  const TemporaryFolder folder;
  write_bytes(folder / "c.pcd", content);
  return load_pcd(folder / "c.pcd");
}

std::string complaint_about(const std::string& content) { return complaint("c.pcd", content, load_pcd); }

std::string header(const std::string& size, const std::string& data = "ascii",
                   const std::string& fields = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n") {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n" + fields + size +
         "VIEWPOINT 0 0 0 1 0 0 0\nDATA " + data + "\n";
}

const std::string kOnePoint = "WIDTH 1\nHEIGHT 1\nPOINTS 1\n";

TEST(Pcd, ThereAndBackKeepsEveryBit) {
  const TemporaryFolder folder;
  save_pcd(folder / "c.pcd", kThreePoints);
  expect_same(load_pcd(folder / "c.pcd"), kThreePoints);
  save_pcd(folder / "none.pcd", {});
  EXPECT_TRUE(load_pcd(folder / "none.pcd").empty());
}

TEST(Pcd, AFileOfOursIsItsHeaderAnd16BytesAPoint) {
  const TemporaryFolder folder;
  save_pcd(folder / "c.pcd", kThreePoints);
  const std::string expected =
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F "
      "F\nCOUNT 1 1 1 1\n"
      "WIDTH 3\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 3\nDATA binary\n";
  const std::string content = read_bytes(folder / "c.pcd");
  EXPECT_EQ(content.substr(0, expected.size()), expected);
  EXPECT_EQ(content.size(), expected.size() + 3 * 16);
}

TEST(Pcd, OthersFieldsAreReadWithDescriptorsAndPaddingBetween) {
  const std::string fields =
      "FIELDS x y z _ normal intensity _\nSIZE 4 4 4 1 4 2 1\nTYPE F F F U F U U\nCOUNT 1 1 1 4 3 1 2\n";
  const std::string row = bytes(1.5F) + bytes(-2.0F) + bytes(3.0F) + "pad:" + bytes(0.0F) + bytes(0.0F) + bytes(1.0F) +
                          bytes(std::uint16_t{300}) + "..";
  expect_same(load(header("WIDTH 1\nHEIGHT 2\n", "binary", fields) + row + row),
              {{1.5F, -2.0F, 3.0F, 300.0F}, {1.5F, -2.0F, 3.0F, 300.0F}});
}

TEST(Pcd, FiguresAreRead) {
  expect_same(load(header("WIDTH 2\nHEIGHT 1\nPOINTS 2\n") + "1 2 3\n-0.5 0 2e-3\n"),
              {{1, 2, 3, 0}, {-0.5F, 0, 2e-3F, 0}});
}

/// Compressed data of two points: x, y, z as floats, then an intensity of two bytes, column after column.
std::string two_compressed_points() {
  const std::string values = bytes(1.0F) + bytes(4.0F) + bytes(2.0F) + bytes(5.0F) + bytes(3.0F) + bytes(6.0F) +
                             bytes(std::uint16_t{7}) + bytes(std::uint16_t{8});
  const auto size = static_cast<std::uint32_t>(values.size());
  // LZF: literal runs begin with their length minus one.
  const std::string packed = '\x0F' + values.substr(0, 16) + '\x0B' + values.substr(16);
  return bytes(size + 2) + bytes(size) + packed;
}

const std::string kTwoCompressed =
    header("WIDTH 2\nHEIGHT 1\n", "binary_compressed", "FIELDS x y z intensity\nSIZE 4 4 4 2\nTYPE F F F U\n");

TEST(Pcd, CompressedDataHaveTheirColumnsOneAfterTheOther) {
  expect_same(load(kTwoCompressed + two_compressed_points()), {{1, 2, 3, 7}, {4, 5, 6, 8}});
  EXPECT_TRUE(load(header("WIDTH 0\nHEIGHT 1\n", "binary_compressed") + std::string(8, '\0')).empty());
}

TEST(Pcd, InvalidCompressedDataAreRefused) {
  const std::string data = two_compressed_points();
  EXPECT_EQ(complaint_about(kTwoCompressed + data.substr(0, 7)), "c.pcd: ends too early for compressed data");
  EXPECT_EQ(complaint_about(kTwoCompressed + data.substr(0, 20)), "c.pcd: ends too early for compressed data");
  EXPECT_EQ(complaint_about(kTwoCompressed + bytes(std::uint32_t{30}) + bytes(std::uint32_t{27}) + data.substr(8)),
            "c.pcd: has 27 bytes of compressed data, 2 points of 14 bytes need 28");
  std::string backward = data;
  backward[8] = '\x20';  // a copy of bytes before the first
  EXPECT_EQ(complaint_about(kTwoCompressed + backward), "c.pcd: the compressed data are invalid");
  const std::string huge = header("WIDTH 300000000\nHEIGHT 1\n", "binary_compressed");
  EXPECT_EQ(complaint_about(huge + bytes(std::uint32_t{4}) + bytes(std::uint32_t{3'600'000'000}) + "abcd"),
            "c.pcd: ends too early for compressed data");
}

TEST(Pcd, WhatIsNoPcdIsRefusedWithItsLine) {
  EXPECT_EQ(complaint_about("ply\n"), "c.pcd:1: is not a line of a PCD header");
  EXPECT_EQ(complaint_about("VERSION 0.7\n"), "c.pcd:1: the header has no line DATA");
  EXPECT_EQ(complaint_about(header(kOnePoint, "binary_zip")),
            "c.pcd:11: DATA must be ascii, binary or binary_compressed");
  EXPECT_EQ(complaint_about(header(kOnePoint, "ascii", "FIELDS x y\nSIZE 4 4\nTYPE F F\n")),
            "c.pcd:10: the points have no z");
  EXPECT_EQ(complaint_about(header(kOnePoint, "ascii", "FIELDS x y z\nSIZE 4 4\nTYPE F F F\n")),
            "c.pcd:10: FIELDS has 3 words, SIZE 2 and TYPE 3");
  EXPECT_EQ(complaint_about(header(kOnePoint, "ascii", "FIELDS x y z\nSIZE 4 4 3\nTYPE F F F\n")),
            "c.pcd:10: TYPE and SIZE of field 3 are inconsistent");
  EXPECT_EQ(complaint_about(header(kOnePoint, "ascii", "FIELDS x\nCOUNT 1 1\n")),
            "c.pcd:4: COUNT has more words than FIELDS");
}

TEST(Pcd, WrongCountsAreRefusedWithoutFillingTheMemory) {
  const std::string point = bytes(1.0F) + bytes(2.0F) + bytes(3.0F);
  EXPECT_EQ(complaint_about(header("WIDTH 2\nHEIGHT 3\nPOINTS 5\n")), "c.pcd:11: POINTS is 5, WIDTH x HEIGHT 6");
  EXPECT_EQ(complaint_about(header("WIDTH 1000000000\nHEIGHT 1000000000\n", "binary")),
            "c.pcd:10: WIDTH x HEIGHT is too large");
  EXPECT_EQ(complaint_about(header("WIDTH 1000000000\nHEIGHT 1\n", "binary") + point),
            "c.pcd: ends too early for 1000000000 points of 12 bytes");
  EXPECT_EQ(complaint_about(header(kOnePoint, "binary") + point.substr(2)),
            "c.pcd: ends too early for 1 points of 12 bytes");
  EXPECT_EQ(complaint_about(header(kOnePoint, "binary") + point + point), "c.pcd: has data after its 1 points");
  EXPECT_EQ(complaint_about(header("WIDTH 9\nHEIGHT 1\n") + "1 2 3\n"), "c.pcd: ends too early for 9 points");
  EXPECT_NE(complaint_about(header("WIDTH -1\nHEIGHT 1\n")), "accepted");
}

TEST(Pcd, NumbersThatAreNoneAreRefusedWithTheirPlace) {
  EXPECT_EQ(complaint_about(header(kOnePoint, "binary") + bytes(1.0F) + bytes(std::nanf("")) + bytes(1.0F)),
            "c.pcd: point 1 is not finite");
  EXPECT_EQ(complaint_about(header(kOnePoint) + "1 inf 3\n"), "c.pcd:12: is not finite");
  EXPECT_EQ(complaint_about(header(kOnePoint) + "1 2    \n"), "c.pcd:12: must be 3 numbers");
}

}  // namespace
}  // namespace patrol::io::pcd_test
