#include "app/report/error_plots.h"

#include <cmath>

#include "app/report/event_timeline.h"
#include "core/geometry/angles.h"
#include "score/pose/trajectory_error.h"

namespace patrol::app {
namespace {

using report::Curve;
using report::LinePlot;
using report::SeriesColor;

Curve position_curve(const std::string& name, SeriesColor color, const std::vector<score::MatchedPose>& poses) {
  Curve curve{.name = name, .color = color, .points = {}};
  for (const score::MatchedPose& pose : poses)
    curve.points.emplace_back(to_seconds(pose.stamp), pose.position_error_m());
  return curve;
}

Curve heading_curve(const std::string& name, SeriesColor color, const std::vector<score::MatchedPose>& poses) {
  Curve curve{.name = name, .color = color, .points = {}};
  for (const score::MatchedPose& pose : poses)
    curve.points.emplace_back(to_seconds(pose.stamp), kDegPerRad * std::abs(pose.heading_error_rad()));
  return curve;
}

/// Curve of twice the estimate's own standard deviation. For the position it is the root of the sum of both variances
/// (2 DRMS), which contains 95 to 98 % of Gaussian errors.
template <typename Deviation>
Curve bound_curve(const std::string& name, const RunRecord& record, const Deviation& deviation) {
  Curve curve{.name = name, .color = SeriesColor::kBound, .is_dashed = true, .points = {}};
  for (std::size_t i = 0; i < record.covariances.size(); ++i) {
    curve.points.emplace_back(to_seconds(record.T_map_body[i].stamp), 2.0 * deviation(record.covariances[i]));
  }
  return curve;
}

/// Plots on a common time axis.
class Plots {
 public:
  explicit Plots(const RunContents& run)
      : axis_{.label = "time, s", .max = run.end_s()}, marks_(marks_of(run)), spans_(spans_of(run)) {}

  report::EventTimeline lanes(const RunContents& run) const {
    return {.title = "Events", .axis = axis_, .lanes = make_lanes(run), .spans = spans_};
  }
  LinePlot lines(const std::string& title, const std::string& unit, std::vector<Curve> curves) const {
    return {.title = title,
            .unit = unit,
            .axis = axis_,
            .max = {},
            .curves = std::move(curves),
            .marks = marks_,
            .spans = spans_};
  }

 private:
  report::PlotAxis axis_;
  std::vector<report::PlotMark> marks_;
  std::vector<report::PlotSpan> spans_;
};

LinePlot confidence_plot(const Plots& plots, const std::vector<LocalizationConfidence>& confidences) {
  Curve confidence{.name = "0: lost, 1: certain", .color = SeriesColor::kConfidence, .points = {}};
  for (const LocalizationConfidence& one : confidences)
    confidence.points.emplace_back(to_seconds(one.stamp), one.confidence);
  LinePlot plot = plots.lines("Localization confidence", "", {confidence});
  plot.max = 1.05;
  return plot;
}

LinePlot unaided_plot(const Plots& plots, const RunContents& run) {
  const RunRecord& record = run.record;
  const Pose2 T_world_odom = score::align_at_start(record.T_odom_body, record.T_world_body);
  std::vector<Curve> curves = {position_curve(
      "odometry", SeriesColor::kOdometry, score::pair_poses(record.T_odom_body, T_world_odom, record.T_world_body))};
  if (!record.T_map_body_by_ranges.empty()) {
    curves.push_back(
        position_curve("odometry and UWB ranges", SeriesColor::kRanges,
                       score::pair_poses(record.T_map_body_by_ranges, run.T_world_map, record.T_world_body)));
  }
  return plots.lines("Without map and lidar", "m", std::move(curves));
}

}  // namespace

std::vector<report::Block> error_blocks(const RunContents& run) {
  const RunRecord& record = run.record;
  const Plots plots(run);
  std::vector<report::Block> blocks;
  if (!record.events.empty() || !record.collisions.empty()) blocks.emplace_back(plots.lanes(run));
  if (!overlap(record.T_map_body, record.T_world_body) || !overlap(record.T_odom_body, record.T_world_body))
    return blocks;
  const std::vector<score::MatchedPose> estimate =
      score::pair_poses(record.T_map_body, run.T_world_map, record.T_world_body);
  const auto position_std_m = [](const Eigen::Matrix3d& covariance) {
    return std::sqrt(covariance(0, 0) + covariance(1, 1));
  };
  const auto heading_std_deg = [](const Eigen::Matrix3d& covariance) {
    return kDegPerRad * std::sqrt(covariance(2, 2));
  };
  blocks.emplace_back(plots.lines("Position error", "m",
                                  {position_curve("estimate", SeriesColor::kEstimate, estimate),
                                   bound_curve("estimated 2σ", record, position_std_m)}));
  blocks.emplace_back(unaided_plot(plots, run));
  blocks.emplace_back(plots.lines("Heading error", "°",
                                  {heading_curve("estimate", SeriesColor::kEstimate, estimate),
                                   bound_curve("estimated 2σ", record, heading_std_deg)}));
  if (!record.confidences.empty()) blocks.emplace_back(confidence_plot(plots, record.confidences));
  report::TextBlock note;
  note.text =
      "Map and world are aligned at the start only. 2σ of the position: twice the root of the sum of both variances. "
      "Lines: failures, recoveries, relocalizations. Shaded: faults, reported delocalization.";
  blocks.emplace_back(note);
  return blocks;
}

}  // namespace patrol::app
