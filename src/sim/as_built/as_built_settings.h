#pragma once

#include <string>

#include "core/settings.h"
#include "sim/as_built/scanner_tolerances.h"

/// Tolerances of the as-built robot.
///
/// The stack is given the nominal robot: URDF, data sheets, survey. The simulator simulates one robot that is built
/// within these tolerances; the seed of the run selects it. A tolerance of 0 removes the term and changes no other
/// draw.
///
/// Unless a field says otherwise, a tolerance is the bound of a uniform distribution about zero: a tolerance states
/// limits and nothing about the distribution within [GUM08, section 4.3.7]. Fields with `std` are standard deviations.
namespace patrol::sim {

/// Mounting poses of all sensor frames. Default: brackets with drilled holes, as is usual without a measuring machine
/// (assumption).
struct MountingTolerances {
  static constexpr const char* kSource = "assumption: brackets with drilled holes, not measured";

  double position_m = 0.003;  ///< tolerance of each coordinate
  double angle_deg = 0.3;     ///< tolerance of the rotation about each axis

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("position_m", self.position_m, between(0.0, 0.5));
    visit("angle_deg", self.angle_deg, between(0.0, 45.0));
  }
};

/// Clocks of the devices relative to the computer of the stack. Sensors that the firmware reads share one clock; every
/// other sensor has its own. Defaults: network time synchronization on one machine and a crystal oscillator
/// (assumptions).
struct ClockTolerances {
  static constexpr const char* kSource = "assumption: time synchronization by network; crystal oscillators";

  double offset_s = 0.002;            ///< tolerance of the offset of a clock at the start
  double drift_ppm = 20.0;            ///< tolerance of the relative rate error of a clock
  double transport_jitter_s = 0.001;  ///< mean of the exponential delay of each message in addition to its latency

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("offset_s", self.offset_s, between(0.0, 1.0));
    visit("drift_ppm", self.drift_ppm, between(0.0, 1000.0));
    visit("transport_jitter_s", self.transport_jitter_s, between(0.0, 1.0));
  }
};

/// Systematic errors of the 2D and 3D lidars.
///
/// Slamtec's data sheets of the RPLIDAR C1 and S series state +-30 mm at 25 degrees Celsius on 10 to 90 % reflectivity.
/// That bound covers noise and bias together. Read as two standard deviations, it is split into white noise of 9.6 mm
/// (`noise_ratio` times the 15 mm of sensors.lidar) and systematic errors of 11.5 mm: an offset (8.7 mm), the range
/// walk with the returned light (5.8 mm between 10 and 50 % reflectivity) and the incidence angle (4.6 mm at grazing
/// incidence). The white part follows the repeatability that manufacturers of this class state (Hokuyo UTM-30LX: below
/// 10 mm to 10 m); the split of the systematic part is an assumption.
///
/// SICK states both parts of the TiM571's error (LidarSettings::of_preset): its noise is that of sensors.lidar and its
/// range offset has the bounds of the systematic error, +-60 mm. A scenario or robot profile that selects another
/// preset of sensors.lidar starts from the tolerances of that preset; values in section as_built.lidar win. A rear
/// and a 3D lidar share the tolerances, but not the measured errors, which are those of the device at frame `lidar`.
struct LidarTolerances {
  static constexpr const char* kSource =
      "Slamtec RPLIDAR C1 and S series data sheets: accuracy 30 mm, flatness 0 to 1.5 deg, rate 5 %; preset tim571: "
      "SICK 8015886, noise ratio 1, range offset 60 mm";

  double noise_ratio = 0.64;      ///< range noise relative to the `range_noise_std_m` of the sensor's settings; 1
                                  ///< reads the whole accuracy of the sheet as noise
  double range_offset_m = 0.015;  ///< tolerance of the range offset
  double range_scale = 0.0002;    ///< tolerance of the relative range error: crystal and refraction (assumption)
  double reflectivity_m = 0.010;  ///< tolerance of the range error on 10 % reflectivity relative to 50 %
  double incidence_m = 0.008;     ///< tolerance of the range error at grazing incidence relative to normal incidence
  double axis_tilt_deg = 0.2;     ///< tolerance of the tilt of the rotation axis in the housing, about x and y
                                  ///< (assumption)
  double cone_deg = 1.5;          ///< maximum elevation of the beams above the plane of rotation, from 0: scan field
                                  ///< flatness, RPLIDAR C1 data sheet, figure 2-1: 0 to 1.5 degrees
  double rate_std = 0.01;         ///< standard deviation of the relative revolution rate, which varies with a
                                  ///< correlation time of 5 s; the sheet bounds fluctuations by 5 %. Messages state the
                                  ///< nominal rate
  double measured_range_offset_m = 0.0;  ///< range offset of the device at frame `lidar` by calibration (patrol
                                         ///< calibrate --sensor lidar), added to the draw within the tolerance
  double measured_range_scale = 0.0;     ///< relative range error by calibration, added to the draw
  double measured_reflectivity_m = 0.0;  ///< range error on 10 % reflectivity relative to 50 % by calibration, added
                                         ///< to the draw
  double measured_incidence_m = 0.0;     ///< range error at grazing incidence relative to normal incidence by
                                         ///< calibration, added to the draw

  /// Returns the tolerances of a preset of sensors.lidar.
  static LidarTolerances for_preset(const std::string& preset) {
    LidarTolerances tolerances;
    if (preset == "tim571") tolerances.noise_ratio = 1.0, tolerances.range_offset_m = 0.06;
    return tolerances;
  }

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("noise_ratio", self.noise_ratio, between(0.0, 1.0));
    visit("range_offset_m", self.range_offset_m, between(0.0, 1.0));
    visit("range_scale", self.range_scale, between(0.0, 0.1));
    visit("reflectivity_m", self.reflectivity_m, between(0.0, 1.0));
    visit("incidence_m", self.incidence_m, between(0.0, 1.0));
    visit("axis_tilt_deg", self.axis_tilt_deg, between(0.0, 10.0));
    visit("cone_deg", self.cone_deg, between(0.0, 10.0));
    visit("rate_std", self.rate_std, between(0.0, 0.1));
    visit("measured_range_offset_m", self.measured_range_offset_m, between(-1.0, 1.0));
    visit("measured_range_scale", self.measured_range_scale, between(-0.1, 0.1));
    visit("measured_reflectivity_m", self.measured_reflectivity_m, between(-1.0, 1.0));
    visit("measured_incidence_m", self.measured_incidence_m, between(-1.0, 1.0));
  }
};

/// Joint encoders of the legs (assumptions for a planetary gear with a motor-side encoder).
struct JointTolerances {
  static constexpr const char* kSource = "assumption: planetary gear with an encoder at the motor";

  double zero_offset_deg = 0.3;  ///< tolerance of the zero position of each joint
  double play_deg = 0.1;         ///< maximum total play between encoder and joint; the load decides the side. The play
                                 ///< of each joint is uniform between half of it and all of it. Gears of one type
                                 ///< have the same clearance by design, and wear and manufacturing add up to as much
                                 ///< again (assumption)

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("zero_offset_deg", self.zero_offset_deg, between(0.0, 10.0));
    visit("play_deg", self.play_deg, between(0.0, 5.0));
  }
};

/// Track drives (assumptions: wear and manufacturing of the sprockets, electromagnetic interference). No data sheet
/// states a tolerance of the gauge: the frame is assumed to be welded within class A of ISO 13920, table 1, for 400 to
/// 1000 mm.
struct TrackTolerances {
  static constexpr const char* kSource =
      "assumption: manufacturing and wear of the sprockets; frame welded within ISO 13920, class A";

  double sprocket_scale = 0.005;          ///< tolerance of the relative pitch radius of each sprocket
  double friction_scale = 0.2;            ///< tolerance of the relative friction of the tracks on the ground
  double missed_edge_probability = 1e-5;  ///< maximum probability that a Hall edge is not counted, from 0
  double gauge_m = 0.002;                 ///< tolerance of the distance between the center lines of the tracks

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("sprocket_scale", self.sprocket_scale, between(0.0, 0.2));
    visit("friction_scale", self.friction_scale, between(0.0, 0.9));
    visit("missed_edge_probability", self.missed_edge_probability, between(0.0, 0.5));
    visit("gauge_m", self.gauge_m, between(0.0, 0.1));
  }
};

/// Wheels (assumptions: manufacturing, wear and pressure of pneumatic tires; frame as for tracks).
struct WheelTolerances {
  static constexpr const char* kSource =
      "assumption: manufacturing, wear and pressure of tires; frame welded within ISO 13920, class A";

  double radius_scale = 0.01;   ///< tolerance of the relative radius of each wheel
  double friction_scale = 0.2;  ///< tolerance of the relative friction of the tires on the ground
  double gauge_m = 0.002;       ///< tolerance of the distance between the wheels of the two sides

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("radius_scale", self.radius_scale, between(0.0, 0.2));
    visit("friction_scale", self.friction_scale, between(0.0, 0.9));
    visit("gauge_m", self.gauge_m, between(0.0, 0.1));
  }
};

/// Legs and ground.
struct LegTolerances {
  static constexpr const char* kSource = "assumption: dry and wet ground";

  double friction_scale = 0.2;  ///< tolerance of the relative friction of the feet (assumption)

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("friction_scale", self.friction_scale, between(0.0, 0.9));
  }
};

/// Inertial measurement unit, in addition to sensors.imu. Values: Analog Devices ADIS16448 data sheet, Rev. H, table 1.
/// Repeatabilities and coefficients without sign are standard deviations, as the table's footnotes state. Biases and
/// scale have another share in sensors.imu; the root sum of squares of both shares is the value of the sheet.
struct ImuTolerances {
  static constexpr const char* kSource = "Analog Devices ADIS16448 data sheet, table 1; warming: assumption";

  double gyro_bias_std_radps = 0.0085;  ///< turn-on bias: with the 0.002 of sensors.imu, bias repeatability of
                                        ///< 0.5 deg/s
  double accel_bias_std_mps2 = 0.194;   ///< turn-on bias: with the 0.03 of sensors.imu, bias repeatability of 20 mg
  double scale_std = 0.0049;            ///< scale of each axis: with the 0.001 of sensors.imu, sensitivity
                                        ///< repeatability of 1 %, read as two standard deviations
  /// Standard deviation of the misalignment between axes: 0.05 deg, read as two standard deviations; the alignment with
  /// the frame is part of the mounting.
  double misalignment_std_deg = 0.025;
  double g_sensitivity_std_radps_per_mps2 = 2.67e-5;  ///< linear acceleration effect on the gyro bias: 0.015 deg/s/g
  double warming_k = 10.0;                    ///< rise of the sensor's temperature above that at power-up (assumption)
  double warming_time_s = 300.0;              ///< time constant of the warming (assumption)
  double gyro_bias_std_radps_per_k = 8.7e-5;  ///< temperature coefficient of the gyro bias: 0.005 deg/s/K
  double accel_bias_std_mps2_per_k = 1.5e-3;  ///< temperature coefficient of the accelerometer bias: 0.15 mg/K

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("gyro_bias_std_radps", self.gyro_bias_std_radps, between(0.0, 1.0));
    visit("accel_bias_std_mps2", self.accel_bias_std_mps2, between(0.0, 10.0));
    visit("scale_std", self.scale_std, between(0.0, 0.5));
    visit("misalignment_std_deg", self.misalignment_std_deg, between(0.0, 10.0));
    visit("g_sensitivity_std_radps_per_mps2", self.g_sensitivity_std_radps_per_mps2, between(0.0, 0.1));
    visit("warming_k", self.warming_k, between(0.0, 60.0));
    visit("warming_time_s", self.warming_time_s, between(0.1, 1e5));
    visit("gyro_bias_std_radps_per_k", self.gyro_bias_std_radps_per_k, between(0.0, 0.1));
    visit("accel_bias_std_mps2_per_k", self.accel_bias_std_mps2_per_k, between(0.0, 1.0));
  }
};

/// Ultra-wideband ranging: antenna delays that remain after the calibration of a type instead of each device (Decawave
/// APS014, section 2; uncalibrated devices err by 0.1 to 0.5 m).
struct UwbTolerances {
  static constexpr const char* kSource = "Decawave APS014, section 2: antenna delay calibrated by type, not by device";

  double anchor_delay_m = 0.1;  ///< tolerance of the range error of each anchor
  double tag_delay_m = 0.1;     ///< tolerance of the range error of the robot's antenna
  /// Standard deviation of the gains of the robot's antenna, of an anchor's, and of its variation around it. The bias
  /// of the receiver depends on the received power (APS011, table 2), and the stack's correction assumes isotropic
  /// antennas. Printed antennas vary by +-3 dB in their plane, read as two standard deviations (assumption).
  double received_power_std_db = 1.5;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("anchor_delay_m", self.anchor_delay_m, between(0.0, 5.0));
    visit("tag_delay_m", self.tag_delay_m, between(0.0, 5.0));
    visit("received_power_std_db", self.received_power_std_db, between(0.0, 20.0));
  }
};

/// Depth camera: factory calibration and its aging. Intel's D400 data sheet (337029) states a depth accuracy of 2 % at
/// 2 m; the split is an assumption.
struct DepthCameraTolerances {
  static constexpr const char* kSource = "Intel D400 data sheet 337029: depth accuracy 2 % at 2 m; split: assumption";

  double focal_scale = 0.003;          ///< tolerance of the relative focal length
  double principal_point_px = 0.5;     ///< tolerance of each coordinate of the principal point, pixels of the
                                       ///< simulated image
  double inverse_depth_per_m = 0.003;  ///< tolerance of the inverse depth: misalignment of the two imagers

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("focal_scale", self.focal_scale, between(0.0, 0.2));
    visit("principal_point_px", self.principal_point_px, between(0.0, 100.0));
    visit("inverse_depth_per_m", self.inverse_depth_per_m, between(0.0, 0.1));
  }
};

/// Placement of the robot at the surveyed start by a person.
struct PlacementTolerances {
  static constexpr const char* kSource = "assumption: placed by a person at marks on the ground";

  double position_m = 0.02;  ///< tolerance of each coordinate
  double yaw_deg = 0.5;      ///< tolerance of the heading

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("position_m", self.position_m, between(0.0, 1.0));
    visit("yaw_deg", self.yaw_deg, between(0.0, 45.0));
  }
};

/// Section `as_built` of a scenario, where it is enabled by default.
struct AsBuiltSettings {
  bool enabled = false;  ///< presence of tolerances; false: the robot is nominal
  MountingTolerances mounting;
  ClockTolerances clock;
  LidarTolerances lidar;
  JointTolerances joint_encoders;
  TrackTolerances tracks;
  WheelTolerances wheels;
  LegTolerances legs;
  ImuTolerances imu;
  UwbTolerances uwb;
  DepthCameraTolerances depth_camera;
  ScannerTolerances scanner;
  PlacementTolerances placement;

  /// Returns the default tolerances, enabled.
  static AsBuiltSettings as_delivered() {
    AsBuiltSettings settings;
    settings.enabled = true;
    return settings;
  }

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("mounting", self.mounting);
    visit("clock", self.clock);
    visit("lidar", self.lidar);
    visit("joint_encoders", self.joint_encoders);
    visit("tracks", self.tracks);
    visit("wheels", self.wheels);
    visit("legs", self.legs);
    visit("imu", self.imu);
    visit("uwb", self.uwb);
    visit("depth_camera", self.depth_camera);
    visit("scanner", self.scanner);
    visit("placement", self.placement);
  }
};

}  // namespace patrol::sim
