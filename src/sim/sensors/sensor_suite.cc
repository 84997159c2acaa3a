#include "sim/sensors/sensor_suite.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/overloaded.h"

namespace patrol::sim {
namespace {

Pose3 body_pose(const mjData& data, int body) {
  const mjtNum* q = data.xquat + 4 * body;
  return {Eigen::Vector3d(data.xpos + 3 * body), Eigen::Quaterniond(q[0], q[1], q[2], q[3])};
}

std::optional<Lidar> make_lidar(const LidarSettings& settings, const LidarScene& scene, const RobotDescription& robot,
                                const std::string& frame, RayMask housing, const DustSettings& dust, std::uint64_t seed) {
  if (!settings.enabled) return std::nullopt;
  return Lidar(settings, scene, robot.T_body(frame), housing, seed, frame, dust);
}

std::optional<Uwb> make_uwb(const UwbSettings& settings, const mjModel& view, const RobotDescription& robot, std::uint64_t seed) {
  if (!settings.enabled) return std::nullopt;
  robot.T_body("uwb");  // or says that there is none
  return Uwb(settings, view, seed);
}

std::optional<UltrasonicRing> make_ultrasonic(const UltrasonicSettings& settings, const LidarScene& scene,
                                              const RobotDescription& robot, std::uint64_t seed) {
  if (!settings.enabled) return std::nullopt;
  return UltrasonicRing(settings, scene, robot, seed);
}

std::optional<DepthCamera> make_depth_camera(const SensorSuiteSettings& settings, const mjModel& view, const RobotDescription& robot,
                                             const DepthImagerFactory& make_imager, std::uint64_t seed) {
  const DepthCameraSettings& camera = settings.depth_camera;
  if (!camera.enabled) return std::nullopt;
  validate(camera, "sensors.depth_camera");
  robot.T_body("depth_camera");  // or says that there is none
  if (!make_imager) throw InputError("sensors.depth_camera is enabled, but there is no renderer for it here");
  constexpr double kNear_m = 0.05;  // what is nearer is the housing's
  return DepthCamera(camera, settings.dust, make_imager(view, lens_of(camera), kNear_m, 1.1 * camera.range_max_m), seed);
}

std::optional<PanoramicScanner> make_scanner(const SensorSuiteSettings& settings, const LidarScene& scene, const RobotDescription& robot,
                                             std::uint64_t seed) {
  if (!settings.scanner.enabled) return std::nullopt;
  return std::optional<PanoramicScanner>(std::in_place, settings.scanner, scene, robot.T_body("scanner"), seed, settings.dust);
}

std::optional<Tem> make_tem(const TemSettings& settings, const Underground& underground, const RobotDescription& robot, std::uint64_t seed) {
  if (!settings.enabled) return std::nullopt;
  if (!robot.antenna) throw InputError("robot " + robot.name + ": there is no link named tem_mount");
  return Tem(settings, underground.rock, underground.water, seed);
}

constexpr double kSpikeProbability = 0.1;  // of a message, while the fault lasts

/// Adds `offset` to the message's main reading, as drift and spikes do.
struct OffsetBy {
  double offset;
  void operator()(LaserScan& scan) const {
    for (float& range : scan.ranges_m) range += static_cast<float>(offset);
  }
  void operator()(PointCloud& cloud) const {
    for (CloudPoint& point : cloud.points) point.x += static_cast<float>(offset);
  }
  void operator()(Imu& imu) const { imu.angular_velocity_radps.z() += offset; }
  void operator()(JointState& joints) const { joints.position_rad.front() += offset; }
  void operator()(FootContacts& contacts) const { contacts.force_n.front() += offset; }
  void operator()(GasReading& gas) const { gas.column_ppm_m += offset; }
  void operator()(GnssFix& fix) const { fix.altitude_m += offset; }
  void operator()(TrackTicks& ticks) const { ticks.left += std::llround(offset); }
  void operator()(UwbRange& range) const { range.range_m += offset; }
  void operator()(UltrasonicRange& range) const { range.range_m += static_cast<float>(offset); }
  void operator()(DepthImage& image) const {
    for (std::uint16_t& depth_mm : image.depth_mm) {
      if (depth_mm == 0) continue;
      depth_mm = static_cast<std::uint16_t>(std::clamp(std::lround(depth_mm + 1000.0 * offset), 0L, 65535L));
    }
  }
  void operator()(RemoteCommand& command) const { command.vx_mps += offset; }
  void operator()(PanoramicScan& scan) const {
    for (ScannerPoint& point : scan.points) {
      const float range = std::hypot(point.x, point.y, point.z), scale = 1.0F + static_cast<float>(offset) / range;
      point.x *= scale, point.y *= scale, point.z *= scale;
    }
  }
  void operator()(AntennaState& antenna) const { antenna.yaw_rad += offset; }
  void operator()(TemSounding& sounding) const {
    for (double& rate : sounding.rate_tps) rate += offset;
  }
};

}  // namespace

SensorSuite::SensorSuite(const SensorSuiteSettings& settings, const RobotDescription& robot, const mjModel& physics,
                         const mjModel& view, GasPlume plume, const std::vector<FaultSettings>& faults, std::uint64_t seed,
                         const DepthImagerFactory& make_depth_imager, const Underground& underground)
    : settings_(settings),
      robot_(robot),
      body_(mj_name2id(&physics, mjOBJ_BODY, frame_id::kBody)),
      scene_(view),
      plume_(std::move(plume)),
      imu_(settings.imu, physics, seed),
      joint_encoders_(settings.joint_encoders, physics, robot.joint_names),
      foot_contact_(settings.foot_contact, physics, robot.legs, seed),
      hall_(robot.tracks ? std::optional<HallSensors>(std::in_place, settings.hall, physics, robot.joint_names, seed)
                         : std::nullopt),
      tdlas_(settings.tdlas, seed),
      gnss_(settings.gnss, seed),
      lidar_(make_lidar(settings.lidar, scene_, robot, "lidar", kRayLidar2d, settings.dust, seed)),
      lidar3d_(make_lidar(settings.lidar3d, scene_, robot, "lidar3d", kRayLidar3d, settings.dust, seed)),
      uwb_(make_uwb(settings.uwb, view, robot, seed)),
      ultrasonic_(make_ultrasonic(settings.ultrasonic, scene_, robot, seed)),
      depth_camera_(make_depth_camera(settings, view, robot, make_depth_imager, seed)),
      scanner_(make_scanner(settings, scene_, robot, seed)),
      tem_(make_tem(settings.tem, underground, robot, seed)),
      coil_(mj_name2id(&physics, mjOBJ_BODY, "tem")),
      spikes_(seed, "fault/spikes"),
      jitter_(seed, "fault/jitter") {
  validate(settings.dust, "sensors.dust");
  for (const FaultSettings& fault : faults) faults_.push_back({.fault = fault});
}

bool SensorSuite::is_due(double rate_hz, std::uint64_t& count, Time now) const {
  if (now < from_seconds(static_cast<double>(count) / rate_hz)) return false;
  ++count;
  return true;
}

void SensorSuite::step(const mjModel& physics, mjData& data, Time now) {
  newest_imu_ = imu_.read(physics, data, now, tick_);
  newest_joints_ = joint_encoders_.read(data, now);
  newest_contacts_ = foot_contact_.read(physics, data, now, tick_);
  if (hall_) newest_ticks_ = hall_->read(data, now);
  ++tick_;
  if (settings_.imu.enabled && is_due(settings_.imu.rate_hz, imu_count_, now)) {
    deliver("imu", now, settings_.imu.latency_s, newest_imu_);
  }
  if (settings_.joint_encoders.enabled && !robot_.legs.empty() && is_due(settings_.joint_encoders.rate_hz, joint_count_, now)) {
    deliver("joint_encoders", now, settings_.joint_encoders.latency_s, newest_joints_);
  }
  if (settings_.foot_contact.enabled && !robot_.legs.empty() && is_due(settings_.foot_contact.rate_hz, contact_count_, now)) {
    deliver("foot_contact", now, settings_.foot_contact.latency_s, newest_contacts_);
  }
  if (hall_ && settings_.hall.enabled && is_due(settings_.hall.rate_hz, hall_count_, now)) {
    deliver("hall", now, settings_.hall.latency_s, newest_ticks_);
  }

  const auto start = std::chrono::steady_clock::now();
  const Pose3 T_world_body = body_pose(data, body_);
  scene_.update(data);
  if (last_body_) {
    const auto& [last_time, last_pose] = *last_body_;
    if (lidar_) {
      lidar_->advance(last_time, now, last_pose, T_world_body);
      for (LaserScan& scan : lidar_->take_scans()) deliver("lidar", now, settings_.lidar.latency_s, std::move(scan));
    }
    if (lidar3d_) {
      lidar3d_->advance(last_time, now, last_pose, T_world_body);
      for (PointCloud& cloud : lidar3d_->take_clouds()) deliver("lidar3d", now, settings_.lidar3d.latency_s, std::move(cloud));
    }
  }
  lidar_seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (scanner_ && scanner_->is_busy()) scan_panorama(T_world_body, now);
  last_body_ = {now, T_world_body};

  if (settings_.tdlas.enabled && is_due(settings_.tdlas.rate_hz, tdlas_count_, now)) {
    deliver("tdlas", now, settings_.tdlas.latency_s,
            tdlas_.read(scene_, plume_, T_world_body * robot_.T_body("tdlas"), now, tdlas_count_ - 1));
  }
  if (settings_.gnss.enabled && is_due(settings_.gnss.rate_hz, gnss_count_, now)) {
    deliver("gnss", now, settings_.gnss.latency_s,
            gnss_.read(scene_, T_world_body * robot_.T_body("gnss").position, now, gnss_count_ - 1));
  }
  if (uwb_) poll_uwb(T_world_body, now);
  if (ultrasonic_) ping_ultrasonic(T_world_body, now);
  if (depth_camera_) take_depth_image(data, T_world_body, now);
  if (tem_ && tem_->is_sounding()) {
    const auto sounding = tem_->step(body_pose(data, coil_), now);
    if (sounding) deliver("tem", now, settings_.tem.latency_s, *sounding);
  }
}

void SensorSuite::command(const InstrumentCommand& command) {
  std::visit(Overloaded{[&](const ScanCommand&) {
                          if (scanner_ && last_body_) scanner_->begin(last_body_->first, last_body_->second);
                        },
                        [&](const SoundingCommand&) {
                          if (tem_ && last_body_) tem_->start(last_body_->first);
                        },
                        [](const AntennaCommand&) {}, [](const WarningCommand&) {}},
             command);
}

void SensorSuite::scan_panorama(const Pose3& T_world_body, Time now) {
  const auto start = std::chrono::steady_clock::now();
  scanner_->advance(last_body_->first, now, last_body_->second, T_world_body);
  for (PanoramicScan& scan : scanner_->take_scans()) deliver("scanner", now, settings_.scanner.latency_s, std::move(scan));
  scanner_seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void SensorSuite::poll_uwb(const Pose3& T_world_body, Time now) {
  if (!is_due(settings_.uwb.rate_hz, uwb_count_, now)) return;
  const auto range = uwb_->read(scene_, T_world_body * robot_.T_body("uwb").position, now, uwb_count_ - 1);
  if (range) deliver("uwb", now, settings_.uwb.latency_s, *range);
}

void SensorSuite::ping_ultrasonic(const Pose3& T_world_body, Time now) {
  if (!is_due(settings_.ultrasonic.ping_rate_hz, ultrasonic_count_, now)) return;
  for (const UltrasonicRange& range : ultrasonic_->ping(T_world_body, now, ultrasonic_count_ - 1)) {
    deliver("ultrasonic", now, settings_.ultrasonic.latency_s, range);
  }
}

void SensorSuite::take_depth_image(const mjData& data, const Pose3& T_world_body, Time now) {
  if (!is_due(settings_.depth_camera.rate_hz, depth_camera_count_, now)) return;
  const auto start = std::chrono::steady_clock::now();
  deliver("depth_camera", now, settings_.depth_camera.latency_s,
          depth_camera_->take(data, T_world_body * robot_.T_body("depth_camera"), now, depth_camera_count_ - 1));
  depth_camera_seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void SensorSuite::deliver(const char* sensor, Time ready, double latency_s, SensorMessage message) {
  Time due = ready + from_seconds(latency_s);
  if (!apply_faults(sensor, ready, due, message)) return;
  const auto later = std::upper_bound(queue_.begin(), queue_.end(), due,
                                      [](Time time, const Delivery& delivery) { return time < delivery.due; });
  queue_.insert(later, Delivery{due, std::move(message)});
}

/// False when the message is lost.
bool SensorSuite::apply_faults(const char* sensor, Time ready, Time& due, SensorMessage& message) {
  if (faults_.empty()) return true;
  auto good = std::find_if(last_good_.begin(), last_good_.end(), [&](const auto& entry) { return entry.first == sensor; });
  bool is_frozen = false;
  for (FaultReport& report : faults_) {
    const FaultSettings& fault = report.fault;
    if (fault.sensor != sensor || !fault.is_active(ready)) continue;
    const bool is_spiked = fault.kind == "spikes" && spikes_.uniform(spike_count_++) < kSpikeProbability;
    const bool can_freeze = good != last_good_.end();
    report.is_executed |= (fault.kind != "spikes" || is_spiked) && (fault.kind != "freeze" || can_freeze);
    if (fault.kind == "silence") return false;
    if (fault.kind == "delay") due += from_seconds(fault.magnitude);
    if (fault.kind == "jitter") due += from_seconds(std::abs(fault.magnitude * jitter_.normal(jitter_count_++)));
    if (fault.kind == "clock_offset") std::visit([&](auto& content) { content.stamp += from_seconds(fault.magnitude); }, message);
    if (fault.kind == "drift") std::visit(OffsetBy{fault.magnitude * (to_seconds(ready) - fault.start_s)}, message);
    if (is_spiked) std::visit(OffsetBy{fault.magnitude}, message);
    if (fault.kind == "freeze" && can_freeze) {
      const Time stamp = std::visit([](const auto& content) { return content.stamp; }, message);
      message = good->second;
      std::visit([&](auto& content) { content.stamp = stamp; }, message);
      is_frozen = true;
    }
  }
  if (is_frozen) return true;
  if (good == last_good_.end()) {
    last_good_.emplace_back(sensor, message);
  } else {
    good->second = message;
  }
  return true;
}

std::vector<SensorMessage> SensorSuite::take_due(Time now) {
  const auto first_later = std::find_if(queue_.begin(), queue_.end(), [&](const Delivery& delivery) { return delivery.due > now; });
  std::vector<SensorMessage> due;
  for (auto delivery = queue_.begin(); delivery != first_later; ++delivery) due.push_back(std::move(delivery->message));
  queue_.erase(queue_.begin(), first_later);
  return due;
}

}  // namespace patrol::sim
