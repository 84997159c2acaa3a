#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "core/dock_detection.h"
#include "core/sensors/gnss.h"
#include "core/site/site_frame.h"
#include "core/site/site_registration.h"
#include "core/uwb.h"
#include "localize/registration/register_to_site.h"

namespace patrol::stack {

/// Pose of the body relative to a scan: it follows the scan's pose when the map changes.
struct PoseFromScan {
  std::size_t scan = 0;  ///< index of the scan
  Pose2 T_scan_body;     ///< pose relative to the scan, by odometry
  Pose2 T_map_body;      ///< pose in the present map
};

/// Position of the GNSS antenna in site.
struct GnssPosition {
  Time stamp{};
  bool is_float = false;            ///< true: float solution, false: RTK fix
  double correlation_time_s = 0.0;  ///< correlation time of the receiver's error
  localize::AntennaPosition content;
};

/// Keeps measurements of the survey and estimates the pose of `map` in `site` from them.
///
/// A measurement refers to the scan before it. Each estimation takes the present poses of the scans, so the
/// registration follows loop closures. Poses that a fixed map has given are kept as they were.
class SiteRegistrar {
 public:
  /// `given`: registration of a given map, which is the prior instead of that of the settings. `uwb`: bias of the
  /// ranges. Throws InputError if a setting is out of range.
  SiteRegistrar(const localize::RegistrationSettings& settings, const SiteFrame& site,
                const std::optional<SiteRegistration>& given = {}, UwbCalibration uwb = {});

  /// Returns whether GNSS fixes are used: the site has a datum.
  bool uses_gnss() const { return settings_.use_gnss && site_.datum.has_value(); }
  /// Adds a UWB range to an anchor in site. `pose`: body at the stamp of the range. `p_level_antenna`: raised as by
  /// uwb_antenna_in_level. Ranges that are too close to the previous one to the anchor are ignored.
  void add(const UwbRange& range, const UwbAnchor& anchor_in_site, const PoseFromScan& pose,
           const Eigen::Vector3d& p_level_antenna);
  /// Adds a detection of the charging post at its surveyed place. `pose`: body at the stamp of the detection.
  /// Detections that are too close to the previous one are ignored.
  void add(const DockDetection& detection, const Pose2& T_site_docked, const PoseFromScan& pose);
  /// Returns the position of a GNSS fix in site; none if the fix has no solution or GNSS is not used.
  std::optional<GnssPosition> position_of(const GnssFix& fix, const Eigen::Vector2d& p_level_antenna) const;
  /// Adds a GNSS position. `pose`: body at its stamp. Positions that are too close to the previous one are ignored.
  void add(const GnssPosition& position, const PoseFromScan& pose);

  std::size_t num_measurements() const { return entries_.size(); }
  bool is_due(Time now) const { return now >= next_; }
  void request() { next_ = Time{}; }  ///< makes an estimation due at once
  /// Estimates the registration and returns it if it has changed, the prior at the first call. `path`: present poses of
  /// all scans, [scan]; empty for a fixed map. Precondition: `is_due(now)`.
  std::optional<SiteRegistration> update(Time now, const std::vector<Pose2>& path);

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(prior_, spacing_factor_, entries_, last_poses_, last_stamps_, published_, next_);
  }

 private:
  struct Entry {
    localize::SiteMeasurement measurement;
    PoseFromScan pose;
  };

  bool is_spaced(int source, Time stamp, const Pose2& T_map_body) const;
  void add(localize::SiteMeasurement measurement, const PoseFromScan& pose);
  void thin_out();

  localize::RegistrationSettings settings_;
  SiteFrame site_;
  UwbCalibration uwb_;
  localize::SitePoseGaussian prior_;
  double spacing_factor_ = 1.0;  ///< factor of the minimum distances, doubled each time the entries are thinned out
  std::vector<Entry> entries_;   ///< in ascending time order
  std::map<int, PoseFromScan> last_poses_;  ///< [source] pose of the newest entry
  std::map<int, Time> last_stamps_;         ///< [source] stamp of the newest entry
  std::optional<SiteRegistration> published_;
  Time next_{};
};

}  // namespace patrol::stack
