#include "stack/localization/pose_pipeline.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/cycle.h"

namespace patrol::stack {
namespace {

// Accuracy of the pose of a robot that stands at its charging post or has been placed by hand.
constexpr double kSurveyedPosition_m = 0.03;
constexpr double kSurveyedYaw_rad = 0.02;

/// Returns the settings with the prior of the map that the run starts with.
localize::RegistrationSettings for_map(localize::RegistrationSettings settings, bool is_given) {
  if (!is_given) return settings;
  settings.start_position_std_m = settings.given_map_position_std_m;
  settings.start_yaw_std_deg = settings.given_map_yaw_std_deg;
  return settings;
}

/// Returns the settings of the calibration: an anchor that is displaced in a deformed map appears to have a delay.
localize::OnlineCalibratorSettings calibration_on_map(const StackSettings& settings) {
  localize::OnlineCalibratorSettings calibration = settings.calibration;
  double& bias_std_m = calibration.anchor_delays.bias_std_m;
  bias_std_m = std::hypot(bias_std_m, settings.registration.map_std_m);
  return calibration;
}

std::vector<UwbAnchor> placed(std::vector<UwbAnchor> anchors, const Pose2& T_site_start) {
  for (UwbAnchor& anchor : anchors) anchor.p_m.head<2>() = T_site_start * Eigen::Vector2d(anchor.p_m.head<2>());
  return anchors;
}

}  // namespace

Eigen::Matrix3d PosePipeline::surveyed_covariance() {
  return Eigen::Vector3d(kSurveyedPosition_m * kSurveyedPosition_m, kSurveyedPosition_m * kSurveyedPosition_m,
                         kSurveyedYaw_rad * kSurveyedYaw_rad)
      .asDiagonal();
}

PosePipeline::PosePipeline(const StackSettings& settings, const RobotDescription& robot, const Route& site_in_map,
                           const LocalizerStart& start, std::uint64_t seed, const SiteFrame& site, bool has_thread)
    : settle_(from_seconds(settings.odometry_settling_time_s)),
      odometry_(make_odometry_source(settings, robot)),
      leveler_(robot.T_body("lidar"), settings.scan_leveling),
      localizer_(make_localizer(settings, robot, site_in_map, start, seed), from_seconds(settings.slam_delay_s),
                 has_thread),
      registrar_(for_map(settings.registration, start.map.has_value()), site, start.map_registration,
                 settings.uwb_filter.calibration()),
      T_start_site_(site.T_site_start.inverse()),
      max_mapping_tilt_rad_(slam::max_tilt_rad(settings.slam)),
      T_body_lidar_(robot.T_body("lidar")),
      anchors_in_site_(placed(site_in_map.anchors, site.T_site_start)),
      anchors_in_map_(site_in_map.anchors),
      uwb_calibration_(settings.uwb_filter.calibration()),
      line_of_sight_(settings.line_of_sight),
      calibration_period_(from_seconds(settings.calibration.period_s)) {
  if (robot.T_body_sensor.contains("uwb"))
    range_pose_.emplace(settings.uwb_filter, site_in_map.anchors, robot.T_body("uwb"));
  if (robot.T_body_sensor.contains("gnss")) T_body_gnss_ = robot.T_body("gnss");
  if (site_in_map.dock) T_site_docked_ = site.T_site_start * site_in_map.dock->T_route_docked;
  validate(settings.calibration, "calibration");
  if (robot.T_body_sensor.contains("uwb")) T_body_uwb_ = robot.T_body("uwb");
  if (settings.calibration.enabled) {
    const auto imu = robot.T_body_sensor.find("imu");
    calibrator_.emplace(calibration_on_map(settings), T_body_lidar_,
                        imu == robot.T_body_sensor.end() ? Pose3{} : imu->second, site_in_map.anchors,
                        uwb_calibration_);
  }
}

void PosePipeline::add(const SensorMessage& message, StackOutput& output) {
  if (const auto* range = std::get_if<UwbRange>(&message)) return add_range(*range);
  if (const auto* fix = std::get_if<GnssFix>(&message)) return add_fix(*fix);
  const auto timer = output.time_stage("odometry");
  odometry_->add(message);
  if (const auto* imu = std::get_if<Imu>(&message)) add_to_calibration(*imu);
}

void PosePipeline::add_to_calibration(const Imu& imu) {
  if (!calibrator_) return;
  if (const std::optional<Pose3> T_odom_body = odometry_->T_odom_body_at(imu.stamp))
    calibrator_->add(imu, T_odom_body->rotation);
}

/// Uses the height of the UWB filter: tunnels are not level.
void PosePipeline::add_to_calibration(const UwbRange& range, const Pose3& T_odom_body) {
  if (!range_pose_ || !range_pose_->has_started() || !localizer_.has_pose() || localizer_.is_lost()) return;
  calibrator_->add(
      {.range = range,
       .pose = tracker_.at(range.stamp, to_pose2(T_odom_body)),
       .p_level_antenna = uwb_antenna_in_level(T_odom_body.rotation, T_body_uwb_, range_pose_->height_m())});
}

/// Monte Carlo localization takes all ranges: its likelihood contains ranges without line of sight, and it must not
/// select the ranges that could refute its pose.
void PosePipeline::add_range(const UwbRange& range) {
  const std::optional<Pose3> T_odom_body = odometry_->T_odom_body_at(range.stamp);
  if (!T_odom_body) return;
  if (range_pose_) range_pose_->add(range, *T_odom_body);
  const bool is_usable = is_in_line_of_sight(range, *T_odom_body);
  if (is_usable && calibrator_) add_to_calibration(range, *T_odom_body);
  if (is_usable) add_to_registration(range, *T_odom_body);
  if (is_usable || !localizer_.is_mapping())
    localizer_.add(RangeWithOdometry{.range = range, .T_odom_body = *T_odom_body, .height_m = height_m()});
}

/// Returns whether the range is used: true without a pose, which gives no prediction.
bool PosePipeline::is_in_line_of_sight(const UwbRange& range, const Pose3& T_odom_body) {
  if (!localizer_.has_pose() || localizer_.is_lost()) {
    line_of_sight_.reset();
    return true;
  }
  const auto anchor = std::ranges::find(anchors_in_map_, range.anchor, &UwbAnchor::number);
  if (anchor == anchors_in_map_.end() || !std::isfinite(range.range_m)) return true;
  const PredictedRange predicted =
      predict_uwb_range(*anchor, tracker_.at(range.stamp, to_pose2(T_odom_body)).T_map_body,
                        uwb_antenna_in_level(T_odom_body.rotation, T_body_uwb_, height_m()), uwb_calibration_);
  return line_of_sight_.add(range.anchor, range.stamp, range.range_m - predicted.range_m);
}

/// Returns the height of the body above the start, by the UWB filter once it has started: tunnels are not level.
double PosePipeline::height_m() const {
  return range_pose_ && range_pose_->has_started() ? range_pose_->height_m() : odometry_->height_above_ground_m();
}

void PosePipeline::add_to_registration(const UwbRange& range, const Pose3& T_odom_body) {
  const auto anchor = std::ranges::find(anchors_in_site_, range.anchor, &UwbAnchor::number);
  if (anchor == anchors_in_site_.end() || !localizer_.has_pose() || localizer_.is_lost()) return;
  if (const std::optional<PoseFromScan> pose = pose_from_scan(range.stamp))
    registrar_.add(range, *anchor, *pose, uwb_antenna_in_level(T_odom_body.rotation, T_body_uwb_, height_m()));
}

void PosePipeline::set_site(const Route& site_in_map) {
  anchors_in_map_ = site_in_map.anchors;
  localizer_.wait().set_anchors(site_in_map.anchors);
  if (range_pose_) range_pose_->set_anchors(site_in_map.anchors);
}

void PosePipeline::add_fix(const GnssFix& fix) {
  if (!T_body_gnss_ || !registrar_.uses_gnss() || !localizer_.has_pose()) return;
  const std::optional<PoseFromScan> pose = pose_from_scan(fix.stamp);
  const std::optional<StationPose> station = station_pose_at(fix.stamp);
  if (!pose || !station) return;
  const Eigen::Vector2d p_level_antenna = (station->T_level_body * T_body_gnss_->position).head<2>();
  const std::optional<GnssPosition> position = registrar_.position_of(fix, p_level_antenna);
  if (!position) return;
  registrar_.add(*position, *pose);
  localizer_.add(slam::PositionMeasurement{.stamp = fix.stamp,
                                           .p_survey_antenna = T_start_site_ * position->content.p_site_antenna,
                                           .std_m = position->content.std_m,
                                           .correlation_time_s = position->correlation_time_s,
                                           .T_odom_body = to_pose2(*odometry_->T_odom_body_at(fix.stamp)),
                                           .p_level_antenna = p_level_antenna});
}

void PosePipeline::add(const DockDetection& detection) {
  if (!T_site_docked_ || !localizer_.has_pose() || localizer_.is_lost()) return;
  if (const std::optional<PoseFromScan> pose = pose_from_scan(detection.stamp))
    registrar_.add(detection, *T_site_docked_, *pose);
}

/// Returns the body pose at an instant, relative to the newest scan; none before the first scan.
std::optional<PoseFromScan> PosePipeline::pose_from_scan(Time stamp) const {
  const std::optional<Pose3> T_odom_body = odometry_->T_odom_body_at(stamp);
  if (num_scans_ == 0 || !T_odom_body) return std::nullopt;
  const Pose2 T_odom_level = to_pose2(*T_odom_body);
  return PoseFromScan{.scan = num_scans_ - 1,
                      .T_scan_body = T_odom_scan_.inverse() * T_odom_level,
                      .T_map_body = tracker_.at(stamp, T_odom_level).T_map_body};
}

std::optional<SiteRegistration> PosePipeline::register_to_site(Time now) {
  if (num_scans_ == 0 || !registrar_.is_due(now)) return std::nullopt;
  return registrar_.update(now, localizer_.wait().path());
}

bool PosePipeline::awaits_first_scan(Time now) const {
  constexpr Time kMaxWait = std::chrono::seconds(2);
  return localizer_.is_mapping() && num_scans_ == 0 && first_odometry_ && now < *first_odometry_ + settle_ + kMaxWait;
}

std::optional<std::string> PosePipeline::mapping_failure() const {
  if (!localizer_.is_mapping() || scan_counts_.num_used() > 0) return std::nullopt;
  return scan_counts_.failure_text(max_mapping_tilt_rad_);
}

std::optional<localize::MapCorrection> PosePipeline::finish_map(const OdometryEstimate& odometry, StackOutput& output) {
  if (!localizer_.is_mapping()) return std::nullopt;
  correct(Time::max(), output);
  tracker_.move_map(localizer_.wait().finish_map(tracker_.at(odometry.stamp, to_pose2(odometry.T_odom_body))));
  registrar_.request();
  const std::vector<Pose2> path = localizer_.wait().path();
  localize::MapCorrection correction{.stamps = std::move(mapped_), .T_map_old = {}};
  for (std::size_t i = 0; i < correction.stamps.size(); ++i)
    correction.T_map_old.push_back(path[i] * T_map_mapped_[i].inverse());
  return correction;
}

std::optional<OdometryEstimate> PosePipeline::update_odometry() {
  std::optional<OdometryEstimate> odometry = odometry_->estimate();
  if (odometry && !first_odometry_) first_odometry_ = odometry->stamp;
  return odometry;
}

std::optional<LevelScan> PosePipeline::level(const LaserScan& scan, StackOutput& output) {
  std::optional<LevelScan> level;
  if (has_settled(scan.stamp)) level = calibrator_ ? level_corrected(scan, output) : level_as_stamped(scan, output);
  scan_counts_.add(level, max_mapping_tilt_rad_);
  return level;
}

/// Levels the scan with the estimated time offset and lidar yaw, and adds it to the calibration.
std::optional<LevelScan> PosePipeline::level_corrected(const LaserScan& scan, StackOutput& output) {
  const localize::ScanCorrection correction = calibrator_->next_correction(scan.stamp);
  leveler_.set_lidar_pose(
      {T_body_lidar_.position, quaternion_from_yaw(correction.lidar_yaw_rad) * T_body_lidar_.rotation});
  LaserScan corrected = scan;
  corrected.stamp -= from_seconds(correction.time_offset_s);
  std::optional<LevelScan> level = level_as_stamped(corrected, output);
  const std::optional<Pose3> T_odom_begin = odometry_->T_odom_body_at(corrected.stamp);
  if (!level || !T_odom_begin || level->stamp <= corrected.stamp) return level;
  const auto timer = output.time_stage("calibration");
  calibrator_->add(*level, {.stamp = level->stamp,
                            .duration_s = to_seconds(level->stamp - corrected.stamp),
                            .T_odom_begin = to_pose2(*T_odom_begin),
                            .T_odom_end = to_pose2(*odometry_->T_odom_body_at(level->stamp)),
                            .applied_time_offset_s = correction.time_offset_s,
                            .applied_lidar_yaw_rad = correction.lidar_yaw_rad});
  if (const std::optional<localize::ScalarEstimate> bias = calibrator_->take_gyro_bias())
    odometry_->correct_gyro_bias(bias->value, bias->std);
  return level;
}

std::optional<LevelScan> PosePipeline::level_as_stamped(const LaserScan& scan, StackOutput& output) const {
  const auto timer = output.time_stage("odometry");
  return leveler_.level(
      scan, [this](Time stamp) { return odometry_->T_odom_body_at(stamp); }, odometry_->height_above_ground_m());
}

ScanPose PosePipeline::localize(const LevelScan& scan, Time received, StackOutput& output) {
  const Pose2 T_odom_body = to_pose2(*odometry_->T_odom_body_at(scan.stamp));
  localizer_.begin_update(scan, T_odom_body, received);
  correct(received, output);
  return {.T_odom_body = T_odom_body, .T_map_body = tracker_.at(scan.stamp, T_odom_body).T_map_body};
}

void PosePipeline::correct(Time now, StackOutput& output) {
  while (std::optional<PoseCorrection> scan = localizer_.take_due(now)) {
    const PoseEstimate& estimate = scan->estimate;
    tracker_.correct(scan->stamp, scan->T_odom_body, estimate.T_map_body, estimate.covariance);
    ++num_scans_;
    T_odom_scan_ = scan->T_odom_body;
    if (localizer_.is_mapping()) {
      mapped_.push_back(scan->stamp);
      T_map_mapped_.push_back(estimate.T_map_body);
    }
    output.take(std::move(scan->output));
  }
}

/// Starts at the first known pose. Publishes from the first scan on, like the other poses.
void PosePipeline::publish_range_pose(const OdometryEstimate& odometry, const PoseEstimate& pose, StackOutput& output) {
  if (!range_pose_ || !range_pose_->has_anchors()) return;
  if (!range_pose_->has_started()) {
    if (!localizer_.has_pose()) return;
    range_pose_->set_initial_pose(odometry, odometry_->height_above_ground_m(), pose.T_map_body,
                                  localizer_.is_mapping() ? surveyed_covariance() : pose.covariance);
  }
  const UwbPoseEstimate estimate = range_pose_->predict(odometry, odometry_->twist_std());
  if (has_settled(odometry.stamp)) output.publish(estimate);
}

void PosePipeline::publish_calibration(Time now, StackOutput& output) {
  if (!calibrator_ || now < next_calibration_) return;
  next_calibration_ = next_in_cycle(next_calibration_, calibration_period_, now);
  CalibrationEstimate estimate = calibrator_->estimate(now);
  const std::vector<CalibrationValue> by_odometry = odometry_->calibration();
  estimate.values.insert(estimate.values.end(), by_odometry.begin(), by_odometry.end());
  output.publish(std::move(estimate));
}

std::optional<LidarClock> PosePipeline::lidar_clock(Time now) const {
  if (!calibrator_) return std::nullopt;
  return lidar_clock_by(calibrator_->time_offset(now), calibrator_->num_time_offset_steps());
}

std::optional<StationPose> PosePipeline::station_pose_at(Time stamp) const {
  const std::optional<Pose3> T_odom_body = odometry_->T_odom_body_at(stamp);
  if (!T_odom_body) return std::nullopt;
  const Eigen::Quaterniond tilt = quaternion_from_yaw(-to_yaw(T_odom_body->rotation)) * T_odom_body->rotation;
  return StationPose{.T_level_body = {{0.0, 0.0, odometry_->height_above_ground_m()}, tilt},
                     .T_map_body = tracker_.at(stamp, to_pose2(*T_odom_body)).T_map_body};
}

void PosePipeline::restart_at(const Pose2& T_map_body, const OdometryEstimate& odometry) {
  localizer_.wait().set_initial_pose(T_map_body, surveyed_covariance());
  tracker_ = localize::MapPoseTracker();
  tracker_.correct(odometry.stamp, to_pose2(odometry.T_odom_body), T_map_body, surveyed_covariance());
  if (range_pose_)
    range_pose_->set_initial_pose(odometry, odometry_->height_above_ground_m(), T_map_body, surveyed_covariance());
}

}  // namespace patrol::stack
