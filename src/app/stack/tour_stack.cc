#include "app/stack/tour_stack.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/overloaded.h"

namespace patrol::app {
namespace {

constexpr Time kRemoteHold = std::chrono::milliseconds(500);  // a command is followed for so long

// How exactly the robot stands at its post.
constexpr double kDockedPosition_m = 0.03;
constexpr double kDockedYaw_rad = 0.02;

Eigen::Matrix3d docked_covariance() {
  return Eigen::Vector3d(kDockedPosition_m * kDockedPosition_m, kDockedPosition_m * kDockedPosition_m,
                         kDockedYaw_rad * kDockedYaw_rad)
      .asDiagonal();
}

}  // namespace

TourStack::TourStack(const StackSettings& settings, const RobotDescription& robot, const Route& site_in_map, TourStart start,
                     double map_period_s, std::uint64_t seed)
    : RobotStack(settings, robot, site_in_map, map_period_s, seed),
      settings_(settings),
      robot_(robot),
      site_in_map_(site_in_map),
      seed_(seed),
      odometry_(robot, settings.track_odometry),
      leveler_(robot.T_body("lidar"), settings.leveling),
      range_filter_(settings.range_filter, site_in_map.anchors, robot.T_body("uwb")),
      map_(std::move(start.map)),
      docking_(settings.docking),
      tour_(settings.tour, start.goals, start.has_remote, map_.has_value()),
      inspection_(settings.inspection, robot, site_in_map.lining, std::move(start.references), start.goals, seed) {
  if (!map_ && !start.has_remote) throw InputError("tour: there is no map, and no remote control to make one");
  if ((settings.tour.docks || settings.tour.starts_docked) && !site_in_map.dock) {
    throw InputError("tour: docks, but the site's survey has no dock");
  }
  if (site_in_map.dock) dock_detector_.emplace(settings.dock_detector, site_in_map.dock->profile_m);
  if (map_) {
    localizer_.emplace(settings.localization, *map_, anchors_above_body(), robot.T_body("uwb"), seed);
    navigator_.set_map(*map_);
  } else {
    slam_ = make_mapper(settings, start.neighbor_model, seed);
    navigator_.set_map(slam_->map());  // empty yet, but its resolution must suit the costmap's
  }
}

void TourStack::use(const SensorMessage& message) {
  std::visit(Overloaded{
                 [&](const LaserScan& scan) { handle_scan(scan); },
                 [&](const UwbRange& range) { handle_range(range); },
                 [&](const UltrasonicRange& range) { handle_ultrasonic(range); },
                 [&](const DepthImage& image) { handle_depth(image); },
                 [&](const PanoramicScan& scan) { handle_panorama(scan); },
                 [&](const AntennaState& state) { inspection_.add(state); },
                 [&](const TemSounding& sounding) { inspection_.add(sounding); },
                 [&](const RemoteCommand& command) { new_remote_ = last_remote_ = command; },
                 [&](const Imu& imu) {
                   const auto lap = clock_.lap("odometry");
                   odometry_.add(imu);
                 },
                 [&](const TrackTicks& ticks) {
                   const auto lap = clock_.lap("odometry");
                   odometry_.add(ticks);
                 },
                 [](const auto&) {},
             },
             message);
}

void TourStack::handle_scan(const LaserScan& raw) {
  if (!has_settled(raw.stamp)) return;
  std::optional<LevelScan> scan;
  {
    const auto lap = clock_.lap("odometry");
    scan = leveler_.level(
        raw, [this](Time stamp) { return odometry_.T_odom_body_at(stamp); }, odometry_.height_above_ground_m());
  }
  if (!scan) return;
  const Pose2 T_odom_body = to_planar(*odometry_.T_odom_body_at(scan->stamp));
  slam_ ? map_scan(*slam_, *scan, T_odom_body) : localize_scan(*scan, T_odom_body);
  const Pose2 T_map_body = tracker_.at(scan->stamp, T_odom_body).T_map_body;
  const auto lap = clock_.lap("planning");
  navigator_.add_scan(*scan, T_map_body);
  if (docking_.status() == plan::DockingStatus::kDocking) look_for_dock(*scan, T_odom_body, T_map_body);
}

void TourStack::look_for_dock(const LevelScan& scan, const Pose2& T_odom_body, const Pose2& T_map_body) {
  const Pose2 T_level_expected =
      docking_.T_level_docked(T_odom_body).value_or(T_map_body.inverse() * site_in_map_.dock->T_route_docked);
  const std::optional<DockSighting> sighting = dock_detector_->detect(scan, T_level_expected);
  if (sighting) docking_.add(*sighting, T_odom_body);
}

void TourStack::localize_scan(const LevelScan& scan, const Pose2& T_odom_body) {
  const auto lap = clock_.lap("localization");
  localize::LocalizationUpdate update = localizer_->update(scan, T_odom_body);
  tracker_.correct(scan.stamp, T_odom_body, update.estimate.T_map_body, update.estimate.covariance);
  trust_ = update.trust;
  say(update.estimate);
  say(update.trust);
  if (update.particles) say(std::move(*update.particles));
}

void TourStack::handle_range(const UwbRange& range) {
  const std::optional<Pose3> T_odom_body = odometry_.T_odom_body_at(range.stamp);
  if (!T_odom_body) return;
  range_filter_.add(range, *T_odom_body);
  if (localizer_) return localizer_->add(range, *T_odom_body);
  const auto anchor = std::find_if(site_in_map_.anchors.begin(), site_in_map_.anchors.end(),
                                   [&](const UwbAnchor& known) { return known.number == range.anchor; });
  if (anchor == site_in_map_.anchors.end()) return;
  slam_->add({.anchor = *anchor,
              .range_m = range.range_m,
              .T_odom_body = to_planar(*T_odom_body),
              .p_level_antenna = uwb_antenna_in_level(T_odom_body->rotation, robot_.T_body("uwb"), odometry_.height_above_ground_m())});
}

/// Odometry and ranges alone, from where the robot first knows its place; what is said begins with the first scan, as the other
/// poses do.
void TourStack::follow_ranges(const OdometryEstimate& odometry, const PoseEstimate& pose) {
  const bool knows_its_place = slam_ || (trust_.stamp > Time{} && !trust_.is_lost);
  if (site_in_map_.anchors.empty() || !(knows_its_place || range_filter_.has_started())) return;
  if (!range_filter_.has_started()) start_ranges(odometry, pose.T_map_body, slam_ ? docked_covariance() : pose.covariance);
  range_filter_.predict(odometry.stamp, odometry.T_odom_body, odometry_.twist_std());
  if (has_settled(odometry.stamp)) say(RangePoseEstimate{range_filter_.estimate(odometry.stamp, odometry.T_odom_body)});
}

void TourStack::handle_ultrasonic(const UltrasonicRange& range) {
  const auto place = place_at(range.stamp);
  if (place) navigator_.add_range(range, place->T_level_body, place->T_map_body);
}

void TourStack::handle_depth(const DepthImage& image) {
  const auto lap = clock_.lap("planning");
  const auto place = place_at(image.stamp);
  if (place) navigator_.add_depth(image, place->T_level_body, place->T_map_body);
}

void TourStack::handle_panorama(const PanoramicScan& scan) {
  if (const auto place = place_at(scan.stamp)) inspection_.add(scan, *place);
}

/// The localiser counts heights from the body's origin.
std::vector<UwbAnchor> TourStack::anchors_above_body() const {
  std::vector<UwbAnchor> anchors = site_in_map_.anchors;
  for (UwbAnchor& anchor : anchors) anchor.p_m.z() -= odometry_.height_above_ground_m();
  return anchors;
}

/// Where the body was, for what a sensor saw from there.
std::optional<StandingPlace> TourStack::place_at(Time stamp) const {
  const std::optional<Pose3> T_odom_body = odometry_.T_odom_body_at(stamp);
  if (!T_odom_body) return std::nullopt;
  const Eigen::Quaterniond tilt = quaternion_from_yaw(-yaw_of(T_odom_body->rotation)) * T_odom_body->rotation;
  return StandingPlace{.T_level_body = {{0.0, 0.0, odometry_.height_above_ground_m()}, tilt},
               .T_map_body = tracker_.at(stamp, to_planar(*T_odom_body)).T_map_body};
}

void TourStack::handle_fall(Time now) {
  if (!tour_.is_over()) abort(now, EventKind::kFall, "The robot has rolled over.");
}

VelocityCommand TourStack::control(Time now, const OdometryEstimate& odometry) {
  const Pose2 T_odom_body = to_planar(odometry.T_odom_body);
  const PoseEstimate pose = tracker_.at(odometry.stamp, T_odom_body);
  const inspect::TourOutput tour = tour_.step(now, {.pose = pose,
                                                    .is_lost = trust_.is_lost,
                                                    .navigation = navigation_feedback(),
                                                    .docking = docking_feedback_,
                                                    .inspection = inspection_feedback_,
                                                    .remote = std::exchange(new_remote_, std::nullopt)});
  for (const Event& event : tour.events) say(event);
  if (tour.map_is_made) take_over_map(now, pose);
  if (tour.localize_anew) localize_anew(odometry);
  {
    const auto lap = clock_.lap("inspection");
    inspection_feedback_ = inspection_.step(now, tour.mode, tour.station, *place_at(odometry.stamp));
  }
  for (StackMessage& message : inspection_.take_messages()) say(std::move(message));
  follow_ranges(odometry, pose);
  return follow(now, tour, pose, T_odom_body);
}

VelocityCommand TourStack::follow(Time now, const inspect::TourOutput& tour, const PoseEstimate& pose, const Pose2& T_odom_body) {
  const bool is_new_mode = std::exchange(mode_, tour.mode) != tour.mode;
  if (is_new_mode) docking_.stop(), docking_feedback_ = inspect::DockingFeedback::kUnderWay;
  if (tour.mode == inspect::TourMode::kNavigate) return go_to(now, tour.goal, pose);
  if (tour.mode == inspect::TourMode::kDock) return go_to_dock(now, pose, T_odom_body);
  go_to(now, std::nullopt, pose);
  if (tour.mode == inspect::TourMode::kRemote) return follow_remote(now);
  if (tour.mode != inspect::TourMode::kUndock) return {};
  if (is_new_mode) docking_.undock(now, T_odom_body);
  return move_at_dock(now, T_odom_body, pose);
}

VelocityCommand TourStack::follow_remote(Time now) const {
  VelocityCommand command;
  if (!last_remote_ || now - last_remote_->stamp >= kRemoteHold) return command;
  command.vx_mps = last_remote_->vx_mps;
  command.yaw_rate_radps = last_remote_->yaw_rate_radps;
  return command;
}

/// To the place before the post, then in.
VelocityCommand TourStack::go_to_dock(Time now, const PoseEstimate& pose, const Pose2& T_odom_body) {
  if (docking_.status() != plan::DockingStatus::kIdle) return move_at_dock(now, T_odom_body, pose);
  const VelocityCommand command = go_to(now, docking_.staging_goal(site_in_map_.dock->T_route_docked), pose);
  if (navigation_ == plan::NavigationStatus::kArrived) docking_.dock(now);
  if (navigation_ == plan::NavigationStatus::kFailed) docking_feedback_ = inspect::DockingFeedback::kFailed;
  return command;
}

VelocityCommand TourStack::move_at_dock(Time now, const Pose2& T_odom_body, const PoseEstimate& pose) {
  const plan::DockingStep step = docking_.step(now, T_odom_body);
  if (!step.text.empty()) note(now, pose, EventKind::kDocking, step.text);
  switch (step.status) {
    case plan::DockingStatus::kDocked:
    case plan::DockingStatus::kFree:
      docking_feedback_ = inspect::DockingFeedback::kDone;
      break;
    case plan::DockingStatus::kFailed:
      docking_feedback_ = inspect::DockingFeedback::kFailed;
      break;
    default:
      docking_feedback_ = inspect::DockingFeedback::kUnderWay;
  }
  return step.command;
}

VelocityCommand TourStack::go_to(Time now, const std::optional<NavigationGoal>& goal, const PoseEstimate& pose) {
  navigator_.set_goal(goal);
  return navigate(now, pose).command;
}

/// The mapping drive is over: from here on the map is what it is.
void TourStack::take_over_map(Time now, const PoseEstimate& pose) {
  map_ = slam_->map();
  slam_.reset();
  publish_map(now);
  localizer_.emplace(settings_.localization, *map_, anchors_above_body(), robot_.T_body("uwb"), seed_);
  localizer_->start_at(pose.T_map_body, pose.covariance);
}

/// As after switching the robot off and on at its post.
void TourStack::localize_anew(const OdometryEstimate& odometry) {
  if (!settings_.tour.starts_docked) return localizer_->start_anywhere();
  const Pose2& T_map_docked = site_in_map_.dock->T_route_docked;
  localizer_->start_at(T_map_docked, docked_covariance());
  tracker_ = localize::MapPoseTracker();
  tracker_.correct(odometry.stamp, to_planar(odometry.T_odom_body), T_map_docked, docked_covariance());
  start_ranges(odometry, T_map_docked, docked_covariance());
}

void TourStack::start_ranges(const OdometryEstimate& odometry, const Pose2& T_map_body, const Eigen::Matrix3d& covariance) {
  range_filter_.start_at({.stamp = odometry.stamp, .T_map_body = T_map_body, .covariance = covariance}, odometry.T_odom_body,
                         odometry_.height_above_ground_m());
}

}  // namespace patrol::app
