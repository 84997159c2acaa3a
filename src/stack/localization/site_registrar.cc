#include "stack/localization/site_registrar.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/angles.h"

namespace patrol::stack {
namespace {

// Sources of measurements, whose errors are independent of each other.
constexpr int kFixSource = 0;
constexpr int kFloatSource = 1;
constexpr int kDockSource = 2;
constexpr int kFirstAnchorSource = 3;  // plus the number of the anchor

double square(double value) { return value * value; }

}  // namespace

SiteRegistrar::SiteRegistrar(const localize::RegistrationSettings& settings, const SiteFrame& site,
                             const std::optional<SiteRegistration>& given, UwbCalibration uwb)
    : settings_(settings),
      site_(site),
      uwb_(std::move(uwb)),
      prior_(localize::registration_prior(site.T_site_start, settings)) {
  if (given) prior_ = {.T_site_map = given->T_site_map, .covariance = given->covariance};
  validate(settings, "registration");
}

std::optional<GnssPosition> SiteRegistrar::position_of(const GnssFix& fix,
                                                       const Eigen::Vector2d& p_level_antenna) const {
  if (!uses_gnss() || fix.status == GnssStatus::kNone) return std::nullopt;
  const bool is_float = fix.status == GnssStatus::kFloat;
  const localize::AntennaPosition content{
      .p_level_antenna = p_level_antenna,
      .p_site_antenna = to_site(*site_.datum, {.latitude_deg = fix.latitude_deg, .longitude_deg = fix.longitude_deg}),
      .std_m = fix.position_std_m.head<2>().maxCoeff()};
  if (!content.p_site_antenna.allFinite() || !(content.std_m > 0.0)) return std::nullopt;
  return GnssPosition{.stamp = fix.stamp,
                      .is_float = is_float,
                      .correlation_time_s =
                          is_float ? settings_.float_correlation_time_s : settings_.fix_correlation_time_s,
                      .content = content};
}

void SiteRegistrar::add(const GnssPosition& position, const PoseFromScan& pose) {
  add({.stamp = position.stamp,
       .source = position.is_float ? kFloatSource : kFixSource,
       .correlation_time_s = std::max(settings_.map_correlation_time_s, position.correlation_time_s),
       .T_map_body = pose.T_map_body,
       .content = position.content},
      pose);
}

void SiteRegistrar::add(const UwbRange& range, const UwbAnchor& anchor_in_site, const PoseFromScan& pose,
                        const Eigen::Vector3d& p_level_antenna) {
  if (!settings_.use_uwb || !std::isfinite(range.range_m)) return;
  add({.stamp = range.stamp,
       .source = kFirstAnchorSource + anchor_in_site.number,
       .correlation_time_s = settings_.range_correlation_time_s,
       .T_map_body = pose.T_map_body,
       .content = localize::AnchorRange{.anchor_in_site = anchor_in_site,
                                        .p_level_antenna = p_level_antenna,
                                        .range_m = range.range_m,
                                        .std_m = settings_.range_std_m}},
      pose);
}

// The pose of the body at the detection follows from the outline of the post, so a yaw of the lidar on the body
// cancels.
void SiteRegistrar::add(const DockDetection& detection, const Pose2& T_site_docked, const PoseFromScan& pose) {
  if (!settings_.use_dock || !detection.covariance.allFinite()) return;
  const double yaw_var = detection.covariance(2, 2) + square(to_rad(settings_.dock_yaw_std_deg)),
               distance_m = detection.T_level_docked.position().norm();
  const double position_var_m2 =
      detection.covariance.topLeftCorner<2, 2>().trace() + square(settings_.dock_std_m) + square(distance_m) * yaw_var;
  add({.stamp = detection.stamp,
       .source = kDockSource,
       .correlation_time_s = settings_.map_correlation_time_s,
       .T_map_body = pose.T_map_body,
       .content =
           localize::SurveyedPose{.T_site_body = T_site_docked * detection.T_level_docked.inverse(),
                                  .position_std_m = std::sqrt(position_var_m2),
                                  .yaw_std_rad = std::sqrt(yaw_var + square(to_rad(settings_.map_yaw_std_deg)))}},
      pose);
}

bool SiteRegistrar::is_spaced(int source, Time stamp, const Pose2& T_map_body) const {
  const auto last = last_poses_.find(source);
  if (last == last_poses_.end()) return true;
  const Time age = stamp - last_stamps_.at(source);
  if (age <= Time{}) return false;
  const double distance_m = (T_map_body.position() - last->second.T_map_body.position()).norm();
  const double spacing_m = source >= kFirstAnchorSource ? settings_.range_min_distance_m : settings_.min_distance_m;
  return distance_m >= spacing_factor_ * spacing_m || age >= from_seconds(settings_.max_interval_s);
}

void SiteRegistrar::add(localize::SiteMeasurement measurement, const PoseFromScan& pose) {
  if (!is_spaced(measurement.source, measurement.stamp, pose.T_map_body)) return;
  last_poses_[measurement.source] = pose;
  last_stamps_[measurement.source] = measurement.stamp;
  entries_.push_back({.measurement = std::move(measurement), .pose = pose});
  if (entries_.size() > static_cast<std::size_t>(settings_.max_measurements)) thin_out();
}

void SiteRegistrar::thin_out() {
  std::map<int, bool> keeps_next;
  std::erase_if(entries_, [&](const Entry& entry) {
    bool& keeps = keeps_next[entry.measurement.source];
    keeps = !keeps;
    return !keeps;
  });
  spacing_factor_ *= 2.0;
}

std::optional<SiteRegistration> SiteRegistrar::update(Time now, const std::vector<Pose2>& path) {
  next_ = now + from_seconds(settings_.period_s);
  std::vector<localize::SiteMeasurement> measurements;
  for (Entry& entry : entries_) {
    if (entry.pose.scan < path.size()) entry.measurement.T_map_body = path[entry.pose.scan] * entry.pose.T_scan_body;
    measurements.push_back(entry.measurement);
  }
  const localize::SitePoseGaussian estimate = localize::register_to_site(prior_, measurements, settings_, uwb_);
  const bool has_changed = !published_ || published_->T_site_map.vector() != estimate.T_site_map.vector();
  if (!has_changed) return std::nullopt;
  published_ = SiteRegistration{.stamp = now, .T_site_map = estimate.T_site_map, .covariance = estimate.covariance};
  return published_;
}

}  // namespace patrol::stack
