#pragma once

#include "core/sensors/sensor_traits.h"
#include "core/settings.h"
#include "core/time.h"

namespace patrol {

/// Servo readings of the antenna mount. The coil's axis is x of `tem`, rotated by yaw (to the left) and then by pitch
/// (downward, REP 103).
struct AntennaState {
  Time stamp{};
  double yaw_rad = 0.0;
  double pitch_rad = 0.0;
};

/// Two digital servos with the data of Robotis' MX-64R (emanual.robotis.com): RS-485, 12-bit contactless encoder,
/// backlash of 20 arcmin, 6.0 N m. The torque limit is in the URDF. Alignment, gains and low speed are assumptions.
struct AntennaSettings {
  double rate_hz = 10.0;                 ///< rate of the servo readings
  double max_speed_radps = 1.0;          ///< commanded speed limit; low because a loop on a post oscillates
  double max_acceleration_radps2 = 2.0;  ///< limit of the angular acceleration of the servo's set point
  double stiffness_nm_per_rad = 60.0;    ///< stiffness of the position loop
  double damping_nms_per_rad = 6.0;      ///< damping of the position loop
  double dead_band_deg = 0.1;            ///< dead band: a servo at rest exerts no position torque below this error
  double resolution_deg = 0.088;         ///< step of the servo's encoder
  double backlash_deg = 0.33;            ///< total backlash between encoder and coil
  double alignment_std_deg = 0.3;        ///< standard deviation of the alignment of a servo on its bracket, constant
                                         ///< over a run
  double latency_s = 0.02;               ///< delay from the measurement to the delivery of the message

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("rate_hz", self.rate_hz, between(0.1, 500.0));
    visit("max_speed_radps", self.max_speed_radps, between(0.01, 6.0));
    visit("max_acceleration_radps2", self.max_acceleration_radps2, between(0.01, 50.0));
    visit("stiffness_nm_per_rad", self.stiffness_nm_per_rad, between(1.0, 500.0));
    visit("damping_nms_per_rad", self.damping_nms_per_rad, between(0.0, 50.0));
    visit("dead_band_deg", self.dead_band_deg, between(0.0, 5.0));
    visit("resolution_deg", self.resolution_deg, between(0.0, 5.0));
    visit("backlash_deg", self.backlash_deg, between(0.0, 5.0));
    visit("alignment_std_deg", self.alignment_std_deg, between(0.0, 5.0));
    visit("latency_s", self.latency_s, between(0.0, 10.0));
  }
};

template <>
struct SensorTraits<AntennaState> {
  struct Settings {
    AntennaSettings antenna;
  };
  static constexpr auto kSettings = &Settings::antenna;
  static constexpr SensorInfo kInfo = {.name = "antenna",
                                       .topic = "/tem/antenna",
                                       .ros_type = "patrol_msgs/msg/AntennaState",
                                       .summary = "servos of the antenna mount",
                                       .fault_matrix_exclusion_reason =
                                           "used only for TEM soundings, outside the fault window of the matrix"};

  static void add_to_reading(AntennaState& antenna, double offset_rad) { antenna.yaw_rad += offset_rad; }
};

}  // namespace patrol
