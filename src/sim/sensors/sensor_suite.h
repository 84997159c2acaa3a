#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/messages.h"
#include "core/robot_description.h"
#include "sim/antenna_mount.h"
#include "sim/dust.h"
#include "sim/gas_plume.h"
#include "sim/lidar_scene.h"
#include "sim/sensors/depth_camera.h"
#include "sim/sensors/fault.h"
#include "sim/sensors/foot_contact.h"
#include "sim/sensors/gnss.h"
#include "sim/sensors/hall_sensors.h"
#include "sim/sensors/imu.h"
#include "sim/sensors/joint_encoders.h"
#include "sim/sensors/lidar.h"
#include "sim/sensors/panoramic_scanner.h"
#include "sim/sensors/tdlas.h"
#include "sim/sensors/tem.h"
#include "sim/sensors/ultrasonic.h"
#include "sim/sensors/uwb.h"

namespace patrol::sim {

struct SensorSuiteSettings {
  LidarSettings lidar = LidarSettings::of_preset("rplidar_s2");
  LidarSettings lidar3d = disabled_lidar3d();
  ImuSettings imu;
  JointEncoderSettings joint_encoders;
  FootContactSettings foot_contact;
  HallSettings hall;
  TdlasSettings tdlas;
  GnssSettings gnss;
  UwbSettings uwb;
  UltrasonicSettings ultrasonic;
  DepthCameraSettings depth_camera;
  PanoramicScannerSettings scanner;
  AntennaSettings antenna;
  TemSettings tem;
  DustSettings dust;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("lidar", self.lidar);
    visit("lidar3d", self.lidar3d);
    visit("imu", self.imu);
    visit("joint_encoders", self.joint_encoders);
    visit("foot_contact", self.foot_contact);
    visit("hall", self.hall);
    visit("tdlas", self.tdlas);
    visit("gnss", self.gnss);
    visit("uwb", self.uwb);
    visit("ultrasonic", self.ultrasonic);
    visit("depth_camera", self.depth_camera);
    visit("scanner", self.scanner);
    visit("antenna", self.antenna);
    visit("tem", self.tem);
    visit("dust", self.dust);
  }

 private:
  static LidarSettings disabled_lidar3d() {
    LidarSettings settings = LidarSettings::of_preset("vlp16");
    settings.enabled = false;
    return settings;
  }
};

/// What became of a fault that a scenario declares.
struct FaultReport {
  FaultSettings fault;
  bool is_executed = false;  ///< at least one message was touched
};

/// All sensors of the robot. Messages come out when they are delivered: latency after the instant they are true of.
class SensorSuite {
 public:
  /// `view` must outlive the suite; `plume` is in world. Throws InputError when an enabled sensor has no frame on the robot,
  /// or nothing in the world to speak to; and when the depth camera is enabled and there is no `make_depth_imager`.
  SensorSuite(const SensorSuiteSettings& settings, const RobotDescription& robot, const mjModel& physics,
              const mjModel& view, GasPlume plume, const std::vector<FaultSettings>& faults, std::uint64_t seed,
              const DepthImagerFactory& make_depth_imager = {}, const Underground& underground = {});

  /// Once a tick, with kinematics and accelerations of `now` in `data`.
  void step(const mjModel& physics, mjData& data, Time now);

  /// What comes in by radio from the remote control.
  void hear(const RemoteCommand& command) { deliver("remote", command.stamp, 0.0, command); }
  /// What the antenna's servos read.
  void hear(const AntennaState& state) { deliver("antenna", state.stamp, settings_.antenna.latency_s, state); }

  /// What the stack asks of the instruments; of one that is switched off, nothing comes. The antenna is the twin's (sim/antenna_mount.h).
  void command(const InstrumentCommand& command);
  /// An instrument is at work for which the robot must stand still.
  bool is_busy() const { return (scanner_ && scanner_->is_busy()) || (tem_ && tem_->is_sounding()); }

  /// Messages due by `now`, in order of delivery.
  std::vector<SensorMessage> take_due(Time now);

  /// What the firmware reads directly, every tick.
  const Imu& latest_imu() const { return newest_imu_; }
  const JointState& latest_joint_state() const { return newest_joints_; }
  const FootContacts& latest_foot_contacts() const { return newest_contacts_; }
  const TrackTicks& latest_track_ticks() const { return newest_ticks_; }

  const std::vector<FaultReport>& faults() const { return faults_; }
  double lidar_seconds() const { return lidar_seconds_; }
  double depth_camera_seconds() const { return depth_camera_seconds_; }
  double scanner_seconds() const { return scanner_seconds_; }

 private:
  struct Delivery {
    Time due;
    SensorMessage message;
  };

  void deliver(const char* sensor, Time ready, double latency_s, SensorMessage message);
  bool apply_faults(const char* sensor, Time ready, Time& due, SensorMessage& message);
  bool is_due(double rate_hz, std::uint64_t& count, Time now) const;
  void scan_panorama(const Pose3& T_world_body, Time now);
  void poll_uwb(const Pose3& T_world_body, Time now);
  void ping_ultrasonic(const Pose3& T_world_body, Time now);
  void take_depth_image(const mjData& data, const Pose3& T_world_body, Time now);

  SensorSuiteSettings settings_;
  RobotDescription robot_;
  int body_;
  LidarScene scene_;
  GasPlume plume_;
  ImuSensor imu_;
  JointEncoders joint_encoders_;
  FootContactSensor foot_contact_;
  std::optional<HallSensors> hall_;
  Tdlas tdlas_;
  Gnss gnss_;
  std::optional<Lidar> lidar_, lidar3d_;
  std::optional<Uwb> uwb_;
  std::optional<UltrasonicRing> ultrasonic_;
  std::optional<DepthCamera> depth_camera_;
  std::optional<PanoramicScanner> scanner_;
  std::optional<Tem> tem_;
  int coil_ = -1;  ///< body of the link `tem`
  std::vector<FaultReport> faults_;
  std::vector<std::pair<std::string, SensorMessage>> last_good_;  ///< by sensor, for a freeze
  RandomStream spikes_, jitter_;
  std::uint64_t spike_count_ = 0, jitter_count_ = 0;

  std::uint64_t tick_ = 0;
  std::uint64_t hall_count_ = 0;
  std::uint64_t imu_count_ = 0, joint_count_ = 0, contact_count_ = 0, tdlas_count_ = 0, gnss_count_ = 0;
  std::uint64_t uwb_count_ = 0, ultrasonic_count_ = 0, depth_camera_count_ = 0;
  Imu newest_imu_;
  JointState newest_joints_;
  FootContacts newest_contacts_;
  TrackTicks newest_ticks_;
  std::optional<std::pair<Time, Pose3>> last_body_;
  std::vector<Delivery> queue_;
  double lidar_seconds_ = 0.0, depth_camera_seconds_ = 0.0, scanner_seconds_ = 0.0;
};

}  // namespace patrol::sim
