#include "app/scoring/metric_infos.h"

#include <fnmatch.h>

#include <algorithm>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "core/error.h"
#include "io/yaml/settings_yaml.h"

namespace patrol::app {
namespace {

/// Metric of a group; `{}` in the summary stands for the subject of the group.
struct Row {
  std::string_view path;
  std::string_view summary;
};

constexpr Row kMission[] = {
    {"completed",
     "whether the robot reported the end of the mission as planned, and its true path contradicts no station or goal"},
    {"reported_completed", "whether the robot reported the end of the mission as planned"},
    {"false_arrivals",
     "number of reported arrivals at stations, goals or the dock with the true position more than 1 m farther away "
     "than "
     "the accuracy of the station or goal"},
    {"fell", "whether the robot fell"},
    {"collisions", "number of unintended contacts of the robot"},
    {"sensor_faults_noticed", "number of sensor faults that the sensor monitor of the stack reported"},
    {"duration_s", "simulated time from the start to the end of the run"},
    {"distance_m", "length of the true path of the robot"},
};

constexpr Row kCourse[] = {
    {"successful", "whether the robot came to the goal of the obstacle course without a collision"},
    {"collided", "whether the robot collided before it came to the goal of the obstacle course"},
    {"duration_s", "time from the first 0.1 m of the way to the arrival at the goal of the obstacle course"},
    {"score", "optimal time of the obstacle course divided by 2 to 8 times as much for the time taken; 0 to 0.5"},
};

constexpr Row kTrajectory[] = {
    {"ate_rmse_m", "root mean square of the position error of {}"},
    {"ate_mean_m", "mean of the position error of {}"},
    {"ate_max_m", "maximum of the position error of {}"},
    {"heading_rmse_deg", "root mean square of the heading error of {}"},
    {"rpe_trans_1m_m", "root mean square of the relative position error of {} over segments with 1 m of true distance"},
    {"rpe_rot_1m_deg", "root mean square of the relative heading error of {} over segments with 1 m of true distance"},
    {"poses", "number of instants at which the error of {} is evaluated"},
};

constexpr Row kPose[] = {
    {"coverage", "fraction of the run within 0.2 s of a timely pose"},
};

constexpr Row kAligned[] = {
    {"rmse_m", "root mean square of the distance in space between {}"},
    {"mean_m", "mean of the distance in space between {}"},
    {"max_m", "maximum of the distance in space between {}"},
    {"pairs", "number of pairs of poses with stamps at most 10 ms apart, of {}"},
};

constexpr Row kNees[] = {
    {"mean",
     "mean normalized squared error of x, y and yaw of the pose in the survey frame; 3 for a consistent estimator"},
    {"per_dimension",
     "mean normalized squared error per dimension; 1 for a consistent estimator, more for an overconfident one"},
    {"within_95", "fraction of the poses whose 95 % ellipsoid contains the true pose"},
    {"instants", "number of published poses with a covariance"},
    {"singular", "number of published poses whose covariance is singular"},
};

constexpr Row kRegistration[] = {
    {"position_error_m",
     "root mean square displacement of the driven path by the error of the registration of the map to the survey"},
    {"yaw_error_deg", "absolute yaw error of the registration of the map to the survey"},
    {"nees",
     "normalized squared error of the last registration in x, y and yaw; 3 is expected, null without a registration"},
    {"updates", "number of registrations that the robot published"},
    {"map_in_site.x_m", "x of the origin of the map in the survey frame, by the last registration"},
    {"map_in_site.y_m", "y of the origin of the map in the survey frame, by the last registration"},
    {"map_in_site.yaw_rad", "yaw of the map in the survey frame, by the last registration"},
};

constexpr Row kCalibration[] = {
    {"*.value", "estimate of the calibration parameter at the end of the run, in the unit of its name"},
    {"*.std", "standard deviation that the robot states for the estimate of the calibration parameter"},
    {"*.truth", "true value of the calibration parameter"},
    {"*.holds", "whether the 95 % interval of the estimate contains the true value"},
    {"*.drawn", "drawn value of a related quantity of the as-built robot, for information"},
    {"parameters", "number of evaluated calibration parameters"},
    {"within_95", "fraction of the calibration parameters whose 95 % interval contains the true value"},
};

constexpr Row kMap[] = {
    {"nearest_mean_m",
     "mean distance from the occupied cells of the map to the nearest true surface; 0.016 for a perfect map of 5 cm "
     "cells"},
    {"nearest_var_m2", "variance of the distance from the occupied cells of the map to the nearest true surface"},
    {"nearest_p95_m", "95th percentile of the distance from the occupied cells of the map to the nearest true surface"},
    {"coverage", "fraction of the observable true surface cells that have an occupied cell of the map within 0.1 m"},
    {"iou", "intersection over union of the occupied cells of map and reference, without tolerance; 1 for equal maps"},
    {"occupied_cells", "number of occupied cells of the map: of 65 or more"},
    {"origin_in_world.x_m", "x of the origin of the map in the world, by the best fit to the true surfaces"},
    {"origin_in_world.y_m", "y of the origin of the map in the world, by the best fit to the true surfaces"},
    {"origin_in_world.yaw_rad", "yaw of the map in the world, by the best fit to the true surfaces"},
    {"reference_agreement",
     "fraction of the reference's surface cells that an independent rendering of the world confirms"},
};

constexpr Row kLocalizability[] = {
    {"poses", "number of true poses at which the accuracy bound of a single scan is evaluated"},
    {"weak_std_median_m",
     "median over the path of the smallest standard deviation that a scan allows in its weakest direction"},
    {"weak_std_max_m",
     "maximum over the path of the smallest standard deviation that a scan allows in its weakest direction"},
    {"degenerate_share", "fraction of the poses whose weakest direction has a bound above 0.1 m"},
    {"covariance_rank_correlation",
     "rank correlation of the stated with the smallest possible standard deviation; 1 is best, null if one does not "
     "vary"},
    {"covariance_detection",
     "probability that a degenerate pose has a larger stated standard deviation than another; 0.5 is chance"},
    {"trust_rank_correlation",
     "rank correlation of the confidence with the smallest possible standard deviation; -1 is best"},
    {"trust_detection", "probability that a degenerate pose has a lower confidence than another; 0.5 is chance"},
    {"weak_direction_error_deg", "mean error of the stated weakest direction at degenerate poses, 0 to 90"},
};

constexpr Row kNavigation[] = {
    {"paths", "number of planned paths"},
    {"detours", "number of times that the robot replanned around an obstacle"},
    {"recoveries", "number of recovery behaviors"},
    {"clearance.mean_m",
     "mean clearance between the outline of the robot and the nearest obstacle along the driven path"},
    {"clearance.p05_m", "5th percentile of the clearance along the driven path"},
    {"clearance.min_m", "minimum of the clearance along the driven path"},
    {"clearance.keep_out_min_m",
     "minimum distance between the outline of the robot and the keep-out lines of the survey; 0: crossed"},
};

constexpr Row kStations[] = {
    {"*.reached",
     "whether the robot reported an arrival at the station with its true position at most 1 m farther away than the "
     "accuracy of the station"},
    {"*.position_error_m",
     "position error of the estimated pose in the survey frame at the reported arrival; null without one"},
    {"*.heading_error_deg",
     "absolute heading error of the estimated pose in the survey frame at the reported arrival; null without one"},
    {"*.stand_error_m",
     "distance between the true position at the reported arrival and the surveyed position of the station; null "
     "without one"},
    {"*.map_error_m",
     "displacement of the station's target in the map, after the best fit of the whole map to the true surfaces"},
    {"*.site_map_error_m",
     "displacement of the station's target in the map, with the map placed by the robot's registration"},
};

constexpr Row kGoal[] = {
    {"arrivals", "number of navigations that arrived at {}, without reports that the true position contradicts"},
    {"failed", "number of navigations that did not arrive at {}"},
};

constexpr Row kSpread[] = {
    {"mean", "mean of the {} over the arrivals; null without an arrival"},
    {"std", "standard deviation of the {} over the arrivals; null without an arrival"},
    {"max", "maximum of the {} over the arrivals; null without an arrival"},
    {"each.*", "{} of one arrival"},
};

constexpr Row kLocalization[] = {
    {"max_error_m", "maximum position error while the localization did not report that it was lost"},
    {"max_error_with_lost_m", "maximum position error, with the time reported lost"},
    {"min_trust", "minimum of the confidence of the localization; 0 lost, 1 certain"},
    {"doubted_s", "time at which the confidence first fell below 0.5; null if it did not"},
    {"strayed_s", "time at which the position error first exceeded 0.5 m while not reported lost; null if it did not"},
    {"doubted_before_straying",
     "whether the confidence fell below 0.5 before the position error exceeded 0.5 m; null without such an error"},
    {"lost_s", "total time during which the localization reported that it was lost"},
    {"kidnaps.*.at_s", "time of the kidnapping"},
    {"kidnaps.*.moved_m", "distance between estimated and true position after the kidnapping"},
    {"kidnaps.*.said_lost_s", "time from the kidnapping to the report of lost localization; null without a report"},
    {"kidnaps.*.relocalized_s",
     "time from the kidnapping to the first of 5 s with less than 0.5 m error; null without such a period before the "
     "next kidnapping"},
};

constexpr Row kInspection[] = {
    {"leaks", "number of gas leaks in the world"},
    {"leaks_found", "number of gas leaks with at least one alarm near them"},
    {"false_alarms", "number of gas alarms without a leak near them"},
    {"findings.*.station", "station of the gas alarm"},
    {"findings.*.column_ppm_m", "measured methane column of the gas alarm"},
    {"findings.*.x_m", "x of the reported leak in the world"},
    {"findings.*.y_m", "y of the reported leak in the world"},
    {"findings.*.leak", "name of the leak that the gas alarm is assigned to; null for a false alarm"},
    {"findings.*.position_error_m", "distance between reported and true leak; null for a false alarm"},
};

constexpr Row kLining[] = {
    {"stations", "number of stations with a panoramic scan"},
    {"registered", "number of stations whose scan was registered to its reference scan"},
    {"moved_rings", "number of moved rings in view of registered stations"},
    {"found", "number of moved rings that the robot reported"},
    {"missed", "number of moved rings that the robot did not report"},
    {"false_findings", "number of reported rings that have not moved"},
    {"max_error_mm",
     "maximum error of the reported displacement of a found ring, at the reported position; null without one"},
    {"max_peak_error_mm",
     "maximum difference between the reported displacement and the true peak of a found ring; null without one"},
    {"max_place_error_m", "maximum position error of a found ring; null without one"},
    {"cells", "number of evaluated cells of the lining"},
    {"cell_rmse_mm", "root mean square error of the displacement of the cells; null without cells"},
    {"cell_coverage_95",
     "fraction of the cells whose 95 % interval contains the true displacement; null without cells"},
    {"rings.*.station", "station from which the ring was scanned"},
    {"rings.*.ring", "number of the ring"},
    {"rings.*.true_peak_mm", "true displacement with the largest magnitude on the ring; positive inward"},
    {"rings.*.is_found", "whether the robot reported the ring"},
    {"rings.*.reported_mm", "reported displacement of the ring; null if not reported"},
    {"rings.*.error_mm", "reported minus true displacement at the reported clock position; null if not reported"},
    {"rings.*.place_error_m",
     "distance from the reported position to the true lining at the ring; null if not reported"},
};

constexpr Row kWater[] = {
    {"stations", "number of stations with electromagnetic soundings"},
    {"bodies", "number of water bodies ahead of the face"},
    {"found", "number of water bodies with at least one finding"},
    {"missed", "number of water bodies without a finding"},
    {"false_alarms", "number of findings without a water body near them"},
    {"findings.*.is_true", "whether the finding is assigned to a water body"},
    {"findings.*.position_error_m", "distance in space between reported and true body; null for a false alarm"},
    {"findings.*.ahead_error_m",
     "error along the line from the antenna to the body, positive if reported too far; null for a false alarm"},
    {"findings.*.radius_error_m", "reported minus true radius of the body; null for a false alarm"},
    {"findings.*.distance_holds", "whether the reported interval contains the true distance; null for a false alarm"},
    {"findings.*.position_holds",
     "whether the reported 95 % ellipsoid contains the true position; null for a false alarm"},
    {"findings.*.radius_holds", "whether the reported interval contains the true radius; null for a false alarm"},
    {"position_error_m", "maximum position error of the findings that are assigned to a body; null without one"},
};

constexpr Row kPublishedTopics[] = {
    {"*", "topic with scored messages that the stack published"},
};

constexpr Row kPerformance[] = {
    {"real_time_factor", "simulated seconds per second of wall time"},
    {"wall_s", "wall time of the simulation"},
    {"cpu_s", "processor time of the simulation, over all threads"},
    {"peak_memory_mb", "maximum memory of the process"},
    {"parts_s.*",
     "wall time of one part of the simulation or of the stack; sensor_thread is the time of the thread of lidars and "
     "depth camera"},
    {"parts_calls.*", "number of calls of the part"},
};

/// Collects the rows of the groups.
class Collector {
 public:
  void add(const std::string& group, std::span<const Row> rows, const std::string& subject = "") {
    for (const Row& row : rows) {
      infos_.push_back({.path = fmt::format("{}.{}", group, row.path), .summary = with_subject(row.summary, subject)});
    }
  }
  std::vector<MetricInfo> take() { return std::move(infos_); }

 private:
  static std::string with_subject(std::string_view summary, const std::string& subject) {
    std::string text(summary);
    const std::size_t at = text.find("{}");
    return at == std::string::npos ? text : text.replace(at, 2, subject);
  }

  std::vector<MetricInfo> infos_;
};

void add_goal(Collector& collector, const std::string& group, const std::string& subject) {
  collector.add(group, kGoal, subject);
  collector.add(group + ".position_error_m", kSpread, "position error at " + subject);
  collector.add(group + ".heading_error_deg", kSpread, "absolute heading error at " + subject);
}

}  // namespace

bool matches_metric(std::string_view pattern, const std::string& path) {
  std::string glob;
  for (const char c : pattern) glob += c == '*' ? "?*" : std::string(1, c);
  return fnmatch(glob.c_str(), path.c_str(), 0) == 0;
}

std::vector<MetricInfo> metric_infos() {
  Collector collector;
  collector.add("mission", kMission);
  collector.add("course", kCourse);
  collector.add("pose", kTrajectory, "the online pose (aligned at its first pose or by a given map)");
  collector.add("pose", kPose);
  collector.add("pose.site", kTrajectory, "the online pose in the survey frame, by the robot's registration");
  collector.add("pose.aligned", kAligned, "the path by the online poses and the true path after their best fit");
  collector.add("pose.nees", kNees);
  collector.add("registration", kRegistration);
  collector.add("calibration", kCalibration);
  collector.add("odometry", kTrajectory, "the odometry (aligned at its first pose)");
  collector.add("map", kMap);
  collector.add("localizability", kLocalizability);
  collector.add("navigation", kNavigation);
  collector.add("stations", kStations);
  add_goal(collector, "goals.*", "the goal");
  add_goal(collector, "docking", "the dock");
  collector.add("range_pose", kTrajectory, "the pose by odometry and UWB ranges alone");
  collector.add("localization", kLocalization);
  collector.add("inspection", kInspection);
  collector.add("inspection.lining", kLining);
  collector.add("inspection.water", kWater);
  collector.add("published_topics", kPublishedTopics);
  collector.add("performance", kPerformance);
  return collector.take();
}

std::optional<MetricInfo> find_metric_info(const std::string& path) {
  const std::vector<MetricInfo> infos = metric_infos();
  const auto found =
      std::ranges::find_if(infos, [&](const MetricInfo& info) { return matches_metric(info.path, path); });
  return found == infos.end() ? std::nullopt : std::optional(*found);
}

void check_metric(const std::string& location, const std::string& path) {
  if (find_metric_info(path)) return;
  std::vector<std::string> known;
  for (const MetricInfo& info : metric_infos()) known.push_back(info.path);
  const std::string nearest = io::closest_match(path, known);
  throw InputError(fmt::format("{}unknown metric{} ('patrol list metrics' shows all)", location,
                               nearest.empty() ? "" : "; did you mean " + nearest + "?"));
}

}  // namespace patrol::app
