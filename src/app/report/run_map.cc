#include "app/report/run_map.h"

#include <algorithm>
#include <map>

#include "app/report/event_timeline.h"
#include "app/report/verdict.h"

namespace patrol::app {
namespace {

using report::MapMark;
using report::SeriesColor;

/// Divides a trajectory into polylines at jumps of the robot or of its estimate.
std::vector<std::vector<Eigen::Vector2d>> pieces_of(const Trajectory& T_frame_body, const Pose2& T_world_frame) {
  constexpr double kJump_m = 0.5;  // between poses at most 0.1 s apart
  std::vector<std::vector<Eigen::Vector2d>> pieces;
  for (const StampedPose& entry : T_frame_body) {
    const Eigen::Vector2d p_world = T_world_frame * to_pose2(entry.pose).position();
    if (pieces.empty() || (p_world - pieces.back().back()).norm() > kJump_m) pieces.emplace_back();
    pieces.back().push_back(p_world);
  }
  return pieces;
}

Eigen::AlignedBox2d extent_of(const std::vector<report::MapPath>& paths) {
  Eigen::AlignedBox2d extent;
  for (const report::MapPath& path : paths) {
    for (const std::vector<Eigen::Vector2d>& piece : path.pieces_m) {
      for (const Eigen::Vector2d& p_world : piece) extent.extend(p_world);
    }
  }
  return extent;
}

/// Marks on the map; marks that would overlap share a label.
class Marks {
 public:
  void add(const std::string& label, SeriesColor color, const Eigen::Vector2d& p_world) {
    constexpr double kShared_m = 1.5;
    if (!num_by_label_.emplace(label, 0).second && color != SeriesColor::kAlarm)
      return;  // goals are reached repeatedly
    const auto near = std::find_if(marks_.begin(), marks_.end(), [&](const MapMark& mark) {
      return mark.color == color && (mark.p_m - p_world).norm() < kShared_m;
    });
    if (near == marks_.end()) marks_.push_back({.label = label, .color = color, .p_m = p_world});
    else if (near->label.find(label) == std::string::npos) near->label += ", " + label;
  }
  std::vector<MapMark> take() { return std::move(marks_); }

 private:
  std::map<std::string, int> num_by_label_;
  std::vector<MapMark> marks_;
};

std::vector<MapMark> marks_on_map(const RunContents& run) {
  Marks marks;
  const auto truth_at = [&](Time stamp) {
    const std::optional<Pose3> truth = pose_at(run.record.T_world_body, stamp);
    return truth ? to_pose2(*truth).position() : to_pose2(run.record.T_world_body.back().pose).position();
  };
  marks.add("start", SeriesColor::kEvent, to_pose2(run.record.T_world_body.front().pose).position());
  for (const Event& event : run.record.events) {
    const EventKind kind = event.kind;
    if (kind == EventKind::kStationReached || kind == EventKind::kGoalSaved || kind == EventKind::kGoalReached)
      marks.add(event.subject, SeriesColor::kEvent, truth_at(event.stamp));
    if (kind == EventKind::kDocked) marks.add("dock", SeriesColor::kEvent, truth_at(event.stamp));
    if (class_of(kind) == EventClass::kHazard)
      marks.add(kind == EventKind::kGasAlarm ? "alarm" : event.subject, SeriesColor::kAlarm,
                run.T_world_map * event.p_map_target);
    if (class_of(kind) == EventClass::kTaskFailed)
      marks.add(event.subject + " failed", SeriesColor::kAlarm, truth_at(event.stamp));
    if (kind == EventKind::kFall) marks.add("fall", SeriesColor::kAlarm, truth_at(event.stamp));
  }
  for (const Collision& collision : run.record.collisions)
    marks.add("collision", SeriesColor::kAlarm, truth_at(collision.stamp));
  for (const KidnapSettings& kidnap : run.scenario.kidnaps) {
    if (was_triggered(kidnap, run.record.T_world_body))
      marks.add("kidnapped to", SeriesColor::kAlarm, {kidnap.x_m, kidnap.y_m});
  }
  return marks.take();
}

}  // namespace

std::vector<report::Block> map_blocks(const RunContents& run) {
  const RunRecord& record = run.record;
  if (record.map.values().empty()) return {};
  const report::MapLayers layers{
      .built = record.map, .T_world_map = run.T_world_map, .truth = run.truth_map, .error_m = run.map_errors_m};
  const std::vector<report::MapPath> paths = {
      {"true path", SeriesColor::kTruth, pieces_of(record.T_world_body, {})},
      {"estimated path", SeriesColor::kEstimate, pieces_of(record.T_map_body, run.T_world_map)}};
  const report::MapBlock map{
      .picture = report::map_picture(layers, extent_of(paths)), .paths = paths, .marks = marks_on_map(run)};
  std::string note = "World frame, x to the right, y up; paths to 1 cm.";
  if (run.truth_map)
    note += " True surfaces: observable on this run, at the lidar's height; errors: distance to any surface.";
  if (!map.picture.has_errors)
    note += " map_errors.pgm not found (written by patrol score): the map has a single color.";
  return {map, report::TextBlock{note}};
}

}  // namespace patrol::app
