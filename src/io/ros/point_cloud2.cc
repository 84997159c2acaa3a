#include "io/ros/point_cloud2.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "io/ros/ros_codec.h"

namespace patrol::io {
namespace {

// Data types of sensor_msgs/PointField.
constexpr std::uint8_t kTypeUint32 = 6, kTypeFloat32 = 7, kTypeFloat64 = 8;
constexpr double kAbsolute_s = 1e6;  // larger times count from the epoch
constexpr double kMaxDuration_s = 1.0;

struct Layout {
  std::uint32_t height = 0, width = 0, point_step = 0, row_step = 0;
  std::vector<ros::CloudField> fields;
  bool is_big_endian = false;
  std::vector<std::uint8_t> data;
};

std::size_t size_of(std::uint8_t type) { return type == kTypeFloat64 ? 8 : 4; }

/// Returns the field, or null if the cloud has none with this name and one of these types.
const ros::CloudField* find_field(const Layout& layout, const std::string& name,
                                  std::initializer_list<std::uint8_t> types) {
  for (const ros::CloudField& field : layout.fields) {
    if (field.name != name || std::find(types.begin(), types.end(), field.type) == types.end()) continue;
    if (field.offset + size_of(field.type) > layout.point_step)
      throw DecodeError(fmt::format("point cloud: field {} exceeds the point", name));
    return &field;
  }
  return nullptr;
}

const ros::CloudField* find_time(const Layout& layout) {
  for (const char* name : {"time", "t", "timestamp", "time_stamp", "offset_time"}) {
    if (const auto* field = find_field(layout, name, {kTypeUint32, kTypeFloat32, kTypeFloat64})) return field;
  }
  return nullptr;
}

template <typename T>
T read_at(const std::uint8_t* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

/// Returns the time of a point after the stamp of the header.
double time_after(Time stamp, const std::uint8_t* point, const ros::CloudField& field) {
  const std::uint8_t* from = point + field.offset;
  if (field.type == kTypeUint32) return 1e-9 * read_at<std::uint32_t>(from);
  const double time_s = field.type == kTypeFloat32 ? static_cast<double>(read_at<float>(from)) : read_at<double>(from);
  return time_s >= kAbsolute_s ? time_s - to_seconds(stamp) : time_s;
}

void set_times(PointCloud& cloud, const std::vector<double>& times_s) {
  if (times_s.empty()) return;
  if (!std::all_of(times_s.begin(), times_s.end(), [](double time_s) { return std::isfinite(time_s); })) return;
  const auto [first, last] = std::minmax_element(times_s.begin(), times_s.end());
  const bool is_plausible = *last - *first <= kMaxDuration_s && std::abs(*first) <= kMaxDuration_s;
  if (!is_plausible) return;
  for (std::size_t i = 0; i < times_s.size(); ++i) cloud.points[i].time_s = static_cast<float>(times_s[i] - *first);
  cloud.stamp += from_seconds(*first);
}

Layout read_layout(std::string_view bytes, Time& stamp) {
  Layout layout;
  ros::read_cdr(bytes, kRosType<PointCloud>, [&](ros::Reader& reader) {
    ros::header(reader, stamp, {});
    reader(layout.height);
    reader(layout.width);
    ros::list(reader, layout.fields, [&](ros::CloudField& field) {
      reader(field.name);
      reader(field.offset);
      reader(field.type);
      reader(field.count);
    });
    reader(layout.is_big_endian);
    reader(layout.point_step);
    reader(layout.row_step);
    reader(layout.data);
  });
  if (layout.is_big_endian) throw DecodeError("point cloud: big-endian data");
  const std::uint64_t row_bytes = std::uint64_t{layout.point_step} * layout.width;
  if (layout.height == 0 || layout.width == 0) layout.height = layout.width = 0;
  const bool fits = layout.height == 0 || (row_bytes <= layout.row_step &&
                                           std::uint64_t{layout.row_step} * layout.height <= layout.data.size());
  if (!fits) throw DecodeError("point cloud: less data than points");
  return layout;
}

}  // namespace

PointCloud decode_point_cloud(std::string_view bytes) {
  PointCloud cloud;
  const Layout layout = read_layout(bytes, cloud.stamp);
  const ros::CloudField* const x = find_field(layout, "x", {kTypeFloat32});
  const ros::CloudField* const y = find_field(layout, "y", {kTypeFloat32});
  const ros::CloudField* const z = find_field(layout, "z", {kTypeFloat32});
  if (x == nullptr || y == nullptr || z == nullptr) throw DecodeError("point cloud: no float32 fields x, y and z");
  const ros::CloudField* const time = find_time(layout);
  std::vector<double> times_s;
  for (std::uint32_t row = 0; row < layout.height; ++row) {
    for (std::uint32_t col = 0; col < layout.width; ++col) {
      const std::uint8_t* from =
          layout.data.data() + std::size_t{row} * layout.row_step + std::size_t{col} * layout.point_step;
      const CloudPoint point{.x = read_at<float>(from + x->offset),
                             .y = read_at<float>(from + y->offset),
                             .z = read_at<float>(from + z->offset),
                             .intensity = 0.0F,
                             .time_s = 0.0F,
                             .ring = 0};
      if (!std::isfinite(point.x) || !std::isfinite(point.y) || !std::isfinite(point.z)) continue;
      cloud.points.push_back(point);
      if (time != nullptr) times_s.push_back(time_after(cloud.stamp, from, *time));
    }
  }
  set_times(cloud, times_s);
  return cloud;
}

}  // namespace patrol::io
