#include "io/points/las.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <tuple>

#include <gtest/gtest.h>

#include "io/points/point_collector.h"
#include "tests/io/cloud_samples.h"

namespace patrol::io::las_test {
namespace {

using test::TemporaryFolder, test::write_bytes;

/// Writer of a LAS file by the offsets of the specification.
struct LasFile {
  int minor = 2, format = 0;
  std::size_t point_bytes = 20;
  std::array<double, 3> scale = {0.001, 0.001, 0.01}, offset = {500'000.0, 5'400'000.0, 100.0};
  std::string points = {};

  void add(std::int32_t x, std::int32_t y, std::int32_t z, std::uint16_t intensity, std::uint8_t class_of_point = 2,
           bool is_withheld = false) {
    std::string point = bytes(x) + bytes(y) + bytes(z) + bytes(intensity) + '\x09';
    if (format < 6) {
      point += static_cast<char>(class_of_point | (is_withheld ? 0x80 : 0));
    } else {
      point += static_cast<char>(is_withheld ? 0x04 : 0);
      point += static_cast<char>(class_of_point);
    }
    point.resize(point_bytes, '\x7F');
    points += point;
  }

  std::string text() const {
    const std::size_t header_bytes = minor == 4 ? 375 : minor == 3 ? 235 : 227;
    std::string text(header_bytes + 5, '\0');  // with bytes between header and points
    const auto put = [&](std::size_t begin, const std::string& value) { text.replace(begin, value.size(), value); };
    const auto count = static_cast<std::uint32_t>(points.size() / point_bytes);
    put(0, "LASF");
    put(24, bytes(std::uint8_t{1}) + bytes(static_cast<std::uint8_t>(minor)));
    put(94, bytes(static_cast<std::uint16_t>(header_bytes)) + bytes(static_cast<std::uint32_t>(text.size())));
    put(104, bytes(static_cast<std::uint8_t>(format)) + bytes(static_cast<std::uint16_t>(point_bytes)));
    if (minor == 4) {
      put(247, bytes(std::uint64_t{count}));
    } else {
      put(107, bytes(count));
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      put(131 + 8 * axis, bytes(scale[axis]));
      put(155 + 8 * axis, bytes(offset[axis]));
    }
    return text + points;
  }
};

std::string complaint_about(const std::string& content) {
  return complaint("c.las", content, [](const std::filesystem::path& file) {
    PointShift shift;
    load_shifted_las(file, shift);
  });
}

TEST(Las, VersionsAndFormatsKeepMillimetersOfLargeCoordinates) {
  const TemporaryFolder folder;
  for (const auto& [minor, format, point_bytes] :
       {std::tuple{0, 0, 20U}, {1, 1, 28U}, {2, 3, 34U}, {3, 5, 63U}, {4, 6, 30U}, {4, 7, 40U}}) {
    SCOPED_TRACE(format);
    LasFile las{.minor = minor, .format = format, .point_bytes = point_bytes};
    las.add(1'234, -2'001, 150, 700);
    las.add(1'235, -2'001, -50, 65'535);
    write_bytes(folder / "c.las", las.text());
    PointShift shift;
    const std::vector<ScannerPoint> points = load_shifted_las(folder / "c.las", shift);
    EXPECT_EQ(shift.origin, Eigen::Vector3d(500'000.0, 5'400'000.0, 100.0));
    EXPECT_FALSE(shift.is_single_precision);
    ASSERT_EQ(points.size(), 2U);
    EXPECT_NEAR(points[0].x, 1.234F, 1e-6F);
    EXPECT_NEAR(points[0].y, -2.001F, 1e-6F);
    EXPECT_NEAR(points[0].z, 1.5F, 1e-6F);
    EXPECT_EQ(points[0].intensity, 700.0F);
    EXPECT_NEAR(points[1].x, 1.235F, 1e-6F);
    EXPECT_NEAR(points[1].z, -0.5F, 1e-6F);
    EXPECT_EQ(points[1].intensity, 65'535.0F);
  }
}

TEST(Las, PointsOfNoiseAndWithheldOnesAreLeftOut) {
  const TemporaryFolder folder;
  for (const int format : {0, 6}) {
    SCOPED_TRACE(format);
    LasFile las{.minor = 4, .format = format, .point_bytes = 30};
    las.add(1, 1, 1, 1, 7);
    las.add(2, 2, 2, 2, 6);
    las.add(3, 3, 3, 3, 6, true);
    las.add(4, 4, 4, 4, 18);
    write_bytes(folder / "c.las", las.text());
    PointShift shift;
    const std::vector<ScannerPoint> points = load_shifted_las(folder / "c.las", shift);
    ASSERT_EQ(points.size(), 1U);
    EXPECT_EQ(points[0].intensity, 2.0F);
    EXPECT_EQ(shift.num_dropped, 3U);
  }
}

TEST(Las, OtherFilesAreRefused) {
  LasFile las;
  las.add(1, 2, 3, 4);
  const std::string text = las.text();
  const auto with = [&](std::size_t begin, const std::string& value) {
    return complaint_about(std::string(text).replace(begin, value.size(), value));
  };
  EXPECT_EQ(complaint_about("LASF"), "c.las: is not a LAS file");
  EXPECT_EQ(with(0, "LASX"), "c.las: is not a LAS file");
  EXPECT_EQ(with(25, "\x05"), "c.las: LAS version 1.5 is not supported (known: 1.0 to 1.4)");
  EXPECT_EQ(with(104, "\x83"),
            "c.las: LAZ, which is compressed, is not supported: convert to LAS, for example with pdal translate");
  EXPECT_EQ(with(104, "\x0B"), "c.las: point format 11 is not supported (known: 0 to 10)");
  EXPECT_EQ(with(104, "\x01"), "c.las: points of 20 bytes are too short for point format 1");
  EXPECT_EQ(with(107, bytes(std::uint32_t{2})), "c.las: ends too early for 2 points of 20 bytes");
  EXPECT_EQ(with(96, bytes(std::uint32_t{4'000'000'000})), "c.las: ends too early for 1 points of 20 bytes");
  EXPECT_EQ(with(131, bytes(0.0)), "c.las: scales must be positive and offsets finite");
  EXPECT_EQ(with(155, bytes(std::nan(""))), "c.las: scales must be positive and offsets finite");
}

}  // namespace
}  // namespace patrol::io::las_test
