// Codecs of the inspection messages: instrument readings, instrument commands and results.
#include <cstring>

#include "io/ros/ros_codec.h"

namespace patrol::io::ros {

template <typename Codec>
void describe(Codec& codec, PanoramicScan& scan) {
  header(codec, scan.stamp, "scanner_level");
  constexpr std::uint32_t kStep = sizeof(ScannerPoint);
  static_assert(kStep == 16);
  const auto num_points = static_cast<std::uint32_t>(scan.points.size());
  cloud_layout(codec, num_points, kStep,
               {{"x", 0, kFloat32}, {"y", 4, kFloat32}, {"z", 8, kFloat32}, {"intensity", 12, kFloat32}});
  std::vector<std::uint8_t> data(std::size_t{kStep} * num_points);
  if (Codec::kWrites && num_points > 0) std::memcpy(data.data(), scan.points.data(), data.size());
  codec(data);
  bool is_dense = true;
  codec(is_dense);
  if constexpr (!Codec::kWrites) {
    scan.points.resize(data.size() / kStep);
    if (!scan.points.empty()) std::memcpy(scan.points.data(), data.data(), kStep * scan.points.size());
  }
}

template <typename Codec>
void describe(Codec& codec, AntennaState& state) {
  header(codec, state.stamp, frame_id::kBody);
  codec(state.yaw_rad);
  codec(state.pitch_rad);
}

template <typename Codec>
void describe(Codec& codec, TemSounding& sounding) {
  header(codec, sounding.stamp, "tem");
  codec(sounding.moment_am2);
  codec(sounding.gate_s);
  codec(sounding.rate_tps);
  codec(sounding.std_tps);
}

template <typename Codec>
void describe(Codec& codec, ScanCommand& command) {
  header(codec, command.stamp, "scanner");
}

template <typename Codec>
void describe(Codec& codec, AntennaCommand& command) {
  header(codec, command.stamp, frame_id::kBody);
  codec(command.yaw_rad);
  codec(command.pitch_rad);
}

template <typename Codec>
void describe(Codec& codec, SoundingCommand& command) {
  header(codec, command.stamp, "tem");
}

template <typename Codec>
void describe(Codec& codec, WarningCommand& command) {
  header(codec, command.stamp, frame_id::kBody);
  codec(command.light);
  codec(command.siren);
}

template <typename Codec>
void integer(Codec& codec, int& value) {
  auto number = static_cast<std::int32_t>(value);
  codec(number);
  value = number;
}

template <typename Codec>
void level_field(Codec& codec, WarningLevel& level) {
  auto number = static_cast<std::uint8_t>(level);
  codec(number);
  if (number > static_cast<std::uint8_t>(WarningLevel::kAlarm)) throw DecodeError("unknown warning level");
  level = static_cast<WarningLevel>(number);
}

template <typename Codec>
void describe(Codec& codec, LiningResult& result) {
  header(codec, result.stamp, frame_id::kMap);
  codec(result.station);
  pose2(codec, result.T_map_body);
  codec(result.is_registered);
  codec(result.registration_rms_m);
  codec(result.registration_inlier_ratio);
  codec(result.correction_m);
  list(codec, result.cells, [&](LiningCell& cell) {
    integer(codec, cell.ring);
    codec(cell.clock_deg);
    codec(cell.inward_m);
    codec(cell.std_m);
    integer(codec, cell.points);
  });
  list(codec, result.lines, [&](ConvergenceLine& line) {
    integer(codec, line.ring);
    codec(line.name);
    codec(line.change_m);
    codec(line.std_m);
  });
  list(codec, result.findings, [&](RingFinding& finding) {
    integer(codec, finding.ring);
    codec(finding.clock_deg);
    codec(finding.inward_m);
    codec(finding.std_m);
    level_field(codec, finding.level);
    vector3(codec, finding.p_map);
  });
}

template <typename Codec>
void describe(Codec& codec, WaterResult& result) {
  header(codec, result.stamp, frame_id::kMap);
  codec(result.station);
  pose2(codec, result.T_map_body);
  integer(codec, result.soundings);
  codec(result.antenna_error_deg);
  codec(result.rock_spm);
  codec(result.evidence);
  codec(result.is_found);
  level_field(codec, result.level);
  vector3(codec, result.p_map);
  std::array<double, 9> covariance{};
  std::memcpy(covariance.data(), result.covariance_m2.data(), sizeof covariance);  // symmetric: rows or columns
  codec(covariance);
  std::memcpy(result.covariance_m2.data(), covariance.data(), sizeof covariance);
  for (double* value : {&result.distance_m, &result.distance_low_m, &result.distance_high_m, &result.azimuth_deg,
                        &result.elevation_deg, &result.radius_m, &result.radius_low_m, &result.radius_high_m}) {
    codec(*value);
  }
}

}  // namespace patrol::io::ros

namespace patrol::io {

PATROL_ROS_SENSOR(PanoramicScan, "");
PATROL_ROS_SENSOR(AntennaState,
                  "# Servo readings of the antenna mount: yaw, positive to the left, and pitch, positive downward.\n"
                  "std_msgs/Header header\nfloat64 yaw_rad\nfloat64 pitch_rad\n");
PATROL_ROS_SENSOR(
    TemSounding,
    "# -dB/dt along the coil axis after the turn-off of the current, T/s, at the gate centers, and its standard "
    "deviation.\n"
    "std_msgs/Header header\nfloat64 moment_am2\nfloat64[] gate_s\nfloat64[] rate_tps\nfloat64[] std_tps\n");
PATROL_ROS_MESSAGE(ScanCommand);
PATROL_ROS_MESSAGE(AntennaCommand);
PATROL_ROS_MESSAGE(SoundingCommand);
PATROL_ROS_MESSAGE(WarningCommand);
PATROL_ROS_MESSAGE(LiningResult);
PATROL_ROS_MESSAGE(WaterResult);

}  // namespace patrol::io
