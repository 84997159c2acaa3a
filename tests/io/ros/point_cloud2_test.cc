#include "io/ros/point_cloud2.h"

#include <cstring>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/ros/ros_messages.h"

namespace patrol::io::point_cloud2_test {
namespace {

using namespace std::chrono_literals;

/// Little-endian CDR of a message, member by member.
class Bytes {
 public:
  Bytes() : bytes_("\0\1\0\0", 4) {}
  template <typename T>
  Bytes& add(T value) {
    while ((bytes_.size() - 4) % sizeof(T) != 0) bytes_.push_back('\0');
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  Bytes& add(const std::string& text) {
    add(static_cast<std::uint32_t>(text.size() + 1));
    bytes_.append(text.c_str(), text.size() + 1);
    return *this;
  }
  const std::string& text() const { return bytes_; }

 private:
  std::string bytes_;
};

struct Field {
  std::string name;
  std::uint32_t offset;
  std::uint8_t type;
};

/// Cloud at 5 s: an organized one of two rows, each with 4 bytes that belong to no point.
std::string organized_cloud(const std::vector<Field>& fields, std::uint32_t point_step, const std::string& first_row,
                            const std::string& second_row) {
  Bytes bytes;
  bytes.add<std::int32_t>(5).add<std::uint32_t>(0).add(std::string("os_lidar"));
  const auto width = static_cast<std::uint32_t>(first_row.size() / point_step);
  bytes.add<std::uint32_t>(2).add(width).add(static_cast<std::uint32_t>(fields.size()));
  for (const Field& field : fields) bytes.add(field.name).add(field.offset).add(field.type).add<std::uint32_t>(1);
  bytes.add<std::uint8_t>(0).add(point_step).add(point_step * width + 4);
  const std::string data = first_row + "...." + second_row + "....";
  bytes.add(static_cast<std::uint32_t>(data.size()));
  for (const char byte : data) bytes.add(byte);
  bytes.add<std::uint8_t>(0);
  return bytes.text();
}

template <typename... Values>
std::string point(Values... values) {
  std::string bytes;
  (bytes.append(reinterpret_cast<const char*>(&values), sizeof values), ...);
  return bytes;
}

const std::vector<Field> kOuster{{"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}, {"t", 12, 6}};

TEST(PointCloud2, ReadsAnOrganizedCloudWithTimesInNanosecondsWithoutItsInvalidPoints) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const std::string bytes =
      organized_cloud(kOuster, 16, point(1.0F, 2.0F, 3.0F, 50'000'000U) + point(kNan, 0.0F, 0.0F, 0U),
                      point(4.0F, 5.0F, 6.0F, 10'000'000U) + point(7.0F, 8.0F, 9.0F, 90'000'000U));
  const PointCloud cloud = decode_point_cloud(bytes);
  EXPECT_EQ(cloud.stamp, 5010ms);
  ASSERT_EQ(cloud.points.size(), 3U);
  EXPECT_EQ(cloud.points[1].x, 4.0F);
  EXPECT_EQ(cloud.points[2].z, 9.0F);
  EXPECT_FLOAT_EQ(cloud.points[0].time_s, 0.04F);
  EXPECT_FLOAT_EQ(cloud.points[1].time_s, 0.0F);
  EXPECT_FLOAT_EQ(cloud.points[2].time_s, 0.08F);
}

TEST(PointCloud2, ReadsAbsoluteTimesInSecondsAndTimesBeforeTheStamp) {
  const std::vector<Field> absolute{{"timestamp", 0, 8}, {"x", 8, 7}, {"y", 12, 7}, {"z", 16, 7}};
  // 5 s on the wire is far from 10^6 s, so these are relative to the stamp: the last point is at the stamp.
  const PointCloud relative =
      decode_point_cloud(organized_cloud(absolute, 20, point(-0.1, 1.0F, 0.0F, 0.0F), point(0.0, 2.0F, 0.0F, 0.0F)));
  EXPECT_EQ(relative.stamp, 4900ms);
  EXPECT_FLOAT_EQ(relative.points[1].time_s, 0.1F);
  // A clock that differs from that of the header by days gives no times.
  const PointCloud other_clock =
      decode_point_cloud(organized_cloud(absolute, 20, point(1.7e9, 1.0F, 0.0F, 0.0F), point(1.7e9, 2.0F, 0.0F, 0.0F)));
  EXPECT_EQ(other_clock.stamp, 5s);
  EXPECT_EQ(other_clock.points[1].time_s, 0.0F);
}

TEST(PointCloud2, ReadsACloudWithoutColumnsAndOneWithTimesThatAreNotFinite) {
  EXPECT_TRUE(decode_point_cloud(organized_cloud(kOuster, 16, "", "")).points.empty());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Field> fields{{"time", 0, 8}, {"x", 8, 7}, {"y", 12, 7}, {"z", 16, 7}};
  const PointCloud cloud =
      decode_point_cloud(organized_cloud(fields, 20, point(0.1, 1.0F, 0.0F, 0.0F), point(nan, 2.0F, 0.0F, 0.0F)));
  EXPECT_EQ(cloud.stamp, 5s);
  for (const CloudPoint& read : cloud.points) EXPECT_EQ(read.time_s, 0.0F);
}

TEST(PointCloud2, ReadsTheCloudsOfARun) {
  PointCloud cloud{.stamp = 3s, .points = {}};
  cloud.points.push_back({.x = 1.0F, .y = 2.0F, .z = 3.0F, .intensity = 9.0F, .time_s = 0.0F, .ring = 1});
  cloud.points.push_back({.x = 4.0F, .y = 5.0F, .z = 6.0F, .intensity = 9.0F, .time_s = 0.05F, .ring = 2});
  const PointCloud read = decode_point_cloud(encode(cloud));
  EXPECT_EQ(read.stamp, 3s);
  ASSERT_EQ(read.points.size(), 2U);
  EXPECT_EQ(read.points[1].y, 5.0F);
  EXPECT_EQ(read.points[1].time_s, 0.05F);
}

TEST(PointCloud2, RefusesFieldsThatDoNotFitTheData) {
  const std::string row = point(1.0F, 2.0F, 3.0F, 0U);
  EXPECT_THROW(decode_point_cloud(organized_cloud({{"x", 0, 7}, {"y", 4, 7}}, 16, row, row)), DecodeError) << "no z";
  EXPECT_THROW(decode_point_cloud(organized_cloud({{"x", 0, 8}, {"y", 8, 7}, {"z", 12, 7}}, 16, row, row)), DecodeError)
      << "x is not float32";
  EXPECT_THROW(decode_point_cloud(organized_cloud({{"x", 0, 7}, {"y", 4, 7}, {"z", 13, 7}}, 16, row, row)), DecodeError)
      << "z ends after the point";
  EXPECT_THROW(decode_point_cloud(organized_cloud(kOuster, 16, row + row, row)), DecodeError) << "a row is missing";
  const std::string whole = organized_cloud(kOuster, 16, row, row);
  for (std::size_t size = 0; size + 1 < whole.size(); ++size)
    EXPECT_THROW(decode_point_cloud(whole.substr(0, size)), DecodeError) << size;
}

}  // namespace
}  // namespace patrol::io::point_cloud2_test
