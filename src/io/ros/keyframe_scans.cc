// Codec of the scans of a keyframe.
#include <cmath>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>

#include "io/ros/ros_codec.h"

namespace patrol::io {
namespace ros {
namespace {

constexpr std::uint32_t kScanAt = 24, kHitAt = 26, kStep = 27;
constexpr std::uint8_t kUint8 = 2;

std::vector<std::uint8_t> to_points(const std::vector<LevelScan>& scans, std::uint32_t num_points) {
  std::vector<std::uint8_t> data(std::size_t{kStep} * num_points);
  std::uint8_t* to = data.data();
  for (std::size_t s = 0; s < scans.size(); ++s) {
    const Eigen::Vector2f lidar = scans[s].origin_m.cast<float>();
    const auto index = static_cast<std::uint16_t>(s);
    for (const LevelScan::Beam& beam : scans[s].beams) {
      const float values[6] = {beam.end_m.x(), beam.end_m.y(), 0.0F, lidar.x(), lidar.y(), 0.0F};
      std::memcpy(to, values, sizeof values);
      std::memcpy(to + kScanAt, &index, sizeof index);
      to[kHitAt] = beam.is_hit ? 1 : 0;
      to += kStep;
    }
  }
  return data;
}

std::vector<LevelScan> to_scans(const std::vector<std::uint8_t>& data, Time stamp) {
  std::vector<LevelScan> scans;
  for (std::size_t at = 0; at + kStep <= data.size(); at += kStep) {
    float values[6];
    std::uint16_t index = 0;
    std::memcpy(values, &data[at], sizeof values);
    std::memcpy(&index, &data[at + kScanAt], sizeof index);
    for (const float value : values) {
      if (!std::isfinite(value)) throw DecodeError("keyframe: points must be finite");
    }
    if (index + 1U < scans.size()) DecodeError(fmt::format("keyframe: scan {} is not in order", index));
    while (scans.size() <= index) {
      scans.emplace_back();
      scans.back().stamp = stamp;
      scans.back().origin_m = Eigen::Vector2f(values[3], values[4]).cast<double>();
    }
    scans.back().beams.push_back({.end_m = {values[0], values[1]}, .is_hit = data[at + kHitAt] != 0});
  }
  if (scans.empty()) scans.push_back({.stamp = stamp, .beams = {}});
  return scans;
}

}  // namespace

template <typename Codec>
void describe(Codec& codec, KeyframeScans& keyframe) {
  header(codec, keyframe.stamp, "keyframe");
  std::uint32_t num_points = 0;
  for (const LevelScan& scan : keyframe.scans) num_points += static_cast<std::uint32_t>(scan.beams.size());
  cloud_layout(codec, num_points, kStep,
               {{"x", 0, kFloat32},
                {"y", 4, kFloat32},
                {"z", 8, kFloat32},
                {"vp_x", 12, kFloat32},
                {"vp_y", 16, kFloat32},
                {"vp_z", 20, kFloat32},
                {"scan", kScanAt, kUint16},
                {"hit", kHitAt, kUint8}});
  std::vector<std::uint8_t> data;
  if constexpr (Codec::kWrites) data = to_points(keyframe.scans, num_points);
  codec(data);
  bool is_dense = true;
  codec(is_dense);
  if constexpr (!Codec::kWrites) keyframe.scans = to_scans(data, keyframe.stamp);
}

}  // namespace ros

PATROL_ROS_MESSAGE(KeyframeScans);

}  // namespace patrol::io
