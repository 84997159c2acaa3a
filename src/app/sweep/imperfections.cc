#include "app/sweep/imperfections.h"

namespace patrol::app {
namespace {

bool has_imu(const Scenario& scenario, const ScenarioFiles&) { return scenario.sensors.imu.enabled; }
bool has_joint_encoders(const Scenario& scenario, const ScenarioFiles&) { return scenario.sensors.joint_encoders.enabled; }
bool has_foot_contact(const Scenario& scenario, const ScenarioFiles&) { return scenario.sensors.foot_contact.enabled; }
bool has_uwb(const Scenario& scenario, const ScenarioFiles&) { return scenario.sensors.uwb.enabled; }
bool has_belts(const Scenario&, const ScenarioFiles& files) { return files.robot.tracks.has_value(); }

}  // namespace

const std::vector<Imperfection>& imperfections() {
  static const std::vector<Imperfection> kAll = {
      {"lidar: range noise", {"sensors.lidar.range_noise_m=0"}},
      {"lidar: range steps", {"sensors.lidar.range_resolution_m=0"}},
      {"lidar: beam direction", {"sensors.lidar.angle_noise_deg=0"}},
      {"lidar: mixed pixels", {"sensors.lidar.beam_width_deg=0"}},
      {"lidar: drop-outs", {"sensors.lidar.dropout=0", "sensors.lidar.grazing_deg=90", "sensors.lidar.dark_range_m=1000"}},
      {"lidar: rain and dust", {"sensors.lidar.rain_rate=0", "sensors.dust.enabled=false"}},
      {"lidar: motion distortion", {"sensors.lidar.motion_distortion=false"}},
      {"lidar: tilt with the body", {"sensors.lidar.stabilized=true", "stack.leveling.stabilized=true"}},
      {"gyro", {"sensors.imu.gyro_noise_radps_rthz=0", "sensors.imu.gyro_bias_radps=0", "sensors.imu.gyro_bias_walk_radps2_rthz=0",
                "sensors.imu.gyro_resolution_radps=0"}, has_imu},
      {"accelerometer", {"sensors.imu.accel_noise_mps2_rthz=0", "sensors.imu.accel_bias_mps2=0", "sensors.imu.accel_bias_walk_mps3_rthz=0",
                         "sensors.imu.accel_resolution_mps2=0"}, has_imu},
      {"IMU: scale and alignment", {"sensors.imu.scale_error=0", "sensors.imu.misalignment_deg=0"}, has_imu},
      {"joint encoders: counts", {"sensors.joint_encoders.counts_per_turn=1000000"}, has_joint_encoders},
      {"foot contact: noise", {"sensors.foot_contact.noise_n=0", "sensors.foot_contact.offset_n=0", "sensors.foot_contact.resolution_n=0"}, has_foot_contact},
      {"Hall ticks: missed", {"sensors.hall.missed_tick_probability=0"}, has_belts},
      {"belts: slip (friction 2)", {"track_drive.friction=2"}, has_belts},
      {"UWB: range noise", {"sensors.uwb.range_noise_m=0"}, has_uwb},
      {"UWB: bias by distance", {"sensors.uwb.bias_scale=0"}, has_uwb},
      {"UWB: blocked paths", {"sensors.uwb.blocked_loss=0", "sensors.uwb.blocked_excess_m=0"}, has_uwb},
      {"UWB: loss", {"sensors.uwb.loss=0"}, has_uwb},
      {"latency of all sensors", {"sensors.lidar.latency_s=0", "sensors.imu.latency_s=0", "sensors.joint_encoders.latency_s=0",
                                  "sensors.foot_contact.latency_s=0", "sensors.hall.latency_s=0", "sensors.uwb.latency_s=0",
                                  "sensors.ultrasonic.latency_s=0", "sensors.depth_camera.latency_s=0", "sensors.tdlas.latency_s=0",
                                  "sensors.gnss.latency_s=0"}},
      {"people and vehicles", {"actors=[]"}},
      {"faults", {"faults=[]"}},
      {"put down off the start", {"start.ahead_m=0", "start.left_m=0", "start.turn_deg=0"}},
      {"map: cells of 5 cm (2.5 cm)", {"stack.slam.resolution_m=0.025", "stack.graph.tracking.resolution_m=0.025"}},
  };
  return kAll;
}

}  // namespace patrol::app
