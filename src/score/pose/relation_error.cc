#include "score/pose/relation_error.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "core/upper_median.h"
#include "score/pose/interpolation_limit.h"
#include "score/statistics.h"

namespace patrol::score {
namespace {

/// Poses of the trajectory at the relations' stamps. Each stamp is looked up once.
class PoseLookup {
 public:
  PoseLookup(const Trajectory& T_map_body, const RelationSettings& settings)
      : trajectory_(T_map_body),
        max_dt_(from_seconds(settings.max_dt_s)),
        max_step_(max_interpolated_step(T_map_body)),
        T_body_reference_{settings.reference_x_m, 0.0, 0.0} {}

  /// Nullopt: the trajectory has no pose for the stamp.
  const std::optional<Pose2>& T_map_reference(Time stamp) {
    const auto known = found_.find(stamp);
    return known != found_.end() ? known->second : found_.emplace(stamp, find(stamp)).first->second;
  }

  void count(RelationError& error) const {
    error.num_stamps = found_.size();
    error.num_interpolated = num_interpolated_;
    error.num_outside = num_outside_;
    error.num_in_holes = num_in_holes_;
  }

 private:
  Pose2 reference_at(const StampedPose& entry) const { return to_pose2(entry.pose) * T_body_reference_; }

  std::optional<Pose2> find(Time stamp) {
    const auto after = std::lower_bound(trajectory_.begin(), trajectory_.end(), stamp,
                                        [](const StampedPose& entry, Time t) { return entry.stamp < t; });
    const auto before = after == trajectory_.begin() ? after : after - 1;
    const bool after_is_nearer =
        after != trajectory_.end() && after->stamp - stamp < std::chrono::abs(stamp - before->stamp);
    const StampedPose& nearest = after_is_nearer ? *after : *before;
    if (std::chrono::abs(nearest.stamp - stamp) <= max_dt_) return reference_at(nearest);
    if (after == trajectory_.begin() || after == trajectory_.end()) {
      ++num_outside_;
      return std::nullopt;
    }
    if (after->stamp - before->stamp > max_step_) {
      ++num_in_holes_;
      return std::nullopt;
    }
    ++num_interpolated_;
    return between(*before, *after, stamp);
  }

  /// Interpolates linearly in x, y and yaw, the yaw along the shorter arc.
  Pose2 between(const StampedPose& before, const StampedPose& after, Time stamp) const {
    const Pose2 a = reference_at(before), b = reference_at(after);
    const double fraction = to_seconds(stamp - before.stamp) / to_seconds(after.stamp - before.stamp);
    return {a.x + fraction * (b.x - a.x), a.y + fraction * (b.y - a.y),
            wrap_angle(a.yaw + fraction * wrap_angle(b.yaw - a.yaw))};
  }

  const Trajectory& trajectory_;
  Time max_dt_, max_step_;
  Pose2 T_body_reference_;
  std::map<Time, std::optional<Pose2>> found_;
  std::size_t num_interpolated_ = 0, num_outside_ = 0, num_in_holes_ = 0;
};

ErrorSpread to_spread(const std::vector<double>& values) {
  const double center = mean(values);
  double sum = 0.0;
  for (const double value : values) sum += (value - center) * (value - center);
  return {.mean = center, .std = std::sqrt(sum / static_cast<double>(values.size()))};
}

std::vector<double> squares(std::vector<double> values) {
  for (double& value : values) value *= value;
  return values;
}

}  // namespace

RelationError relation_error(const Trajectory& T_map_body, const std::vector<PoseRelation>& relations,
                             const RelationSettings& settings) {
  validate(settings, "relations");
  if (T_map_body.empty()) throw InputError("estimate: no poses");
  if (relations.empty()) throw InputError("relations: none to score");
  PoseLookup lookup(T_map_body, settings);
  std::vector<double> trans_m, rot_deg;
  for (const PoseRelation& relation : relations) {
    const std::optional<Pose2>& T_map_from = lookup.T_map_reference(relation.from);
    const std::optional<Pose2>& T_map_to = lookup.T_map_reference(relation.to);
    if (!T_map_from || !T_map_to) continue;
    const Pose2 T_from_to = T_map_from->inverse() * *T_map_to;
    trans_m.push_back((T_from_to.position() - relation.T_from_to.position()).norm());
    rot_deg.push_back(kDegPerRad * std::abs(wrap_angle(T_from_to.yaw - relation.T_from_to.yaw)));
  }
  if (trans_m.empty()) {
    const PoseRelation& first = relations.front();
    throw InputError(fmt::format(
        "estimate: no relation has poses at both stamps: poses are from {:.3f} s to {:.3f} s, the first relation is "
        "from {:.3f} s to {:.3f} s",
        to_seconds(T_map_body.front().stamp), to_seconds(T_map_body.back().stamp), to_seconds(first.from),
        to_seconds(first.to)));
  }
  RelationError error{.num_relations = trans_m.size(),
                      .num_given = relations.size(),
                      .trans_m = to_spread(trans_m),
                      .squared_trans_m2 = to_spread(squares(trans_m)),
                      .trans_median_m = upper_median(trans_m),
                      .trans_max_m = maximum(trans_m),
                      .rot_deg = to_spread(rot_deg),
                      .squared_rot_deg2 = to_spread(squares(rot_deg)),
                      .rot_median_deg = upper_median(rot_deg),
                      .rot_max_deg = maximum(rot_deg)};
  lookup.count(error);
  return error;
}

}  // namespace patrol::score
