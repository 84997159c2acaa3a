#include "plan/maneuvers/dubins.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "plan/control/rollouts/rollout.h"

namespace patrol::plan {
namespace {

/// Lengths of the three parts, in radii: a turn, a straight part or a turn, and a turn.
using Parts = std::array<double, 3>;

constexpr double kRounding = 1e-9;  // angles and distances in radii below this are rounding errors

/// Equivalent angle in [0, 2 pi - kRounding]. A turn that is a full circle by rounding only is no turn.
double positive_angle(double angle) {
  const double turn = std::fmod(angle, 2.0 * std::numbers::pi);
  const double positive = turn < 0.0 ? turn + 2.0 * std::numbers::pi : turn;
  return positive > 2.0 * std::numbers::pi - kRounding ? 0.0 : positive;
}

/// Turn, straight part, turn. `first`, `last`: 1 to the left, -1 to the right.
///
/// In units of the radius, the circle of the first turn has its center at (0, first), that of the last turn at
/// (x, y) + last (-sin yaw, cos yaw). Turns to the same side have an outer tangent, others an inner one.
std::optional<Parts> turn_straight_turn(const Pose2& goal, double first, double last) {
  const double dx = goal.x - last * std::sin(goal.yaw), dy = goal.y + last * std::cos(goal.yaw) - first;
  const double distance = std::hypot(dx, dy);
  // The goal is on the circle of the first turn: the straight part has no length and thus no heading.
  if (first == last && distance < kRounding) return Parts{positive_angle(first * goal.yaw), 0.0, 0.0};
  double heading = std::atan2(dy, dx), straight = distance;
  if (first != last) {
    if (distance < 2.0) return std::nullopt;
    straight = std::sqrt(distance * distance - 4.0);
    heading += first * std::atan2(2.0, straight);
  }
  return Parts{positive_angle(first * heading), straight, positive_angle(last * (goal.yaw - heading))};
}

/// Three turns, the middle one to the other side. `side`: side of the first and the last turn.
std::optional<Parts> three_turns(const Pose2& goal, double side) {
  const double dx = goal.x - side * std::sin(goal.yaw), dy = goal.y + side * std::cos(goal.yaw) - side;
  const double distance = std::hypot(dx, dy);
  if (distance > 4.0) return std::nullopt;
  // The centers are the corners of a triangle with the sides 2, 2 and distance.
  const double at_ends = std::acos(distance / 4.0);
  const double middle = 2.0 * std::numbers::pi - 2.0 * std::asin(distance / 4.0);
  const double to_goal = std::atan2(dy, dx);
  const double first = positive_angle(side * to_goal + std::numbers::pi / 2.0 + at_ends);
  return Parts{first, middle, positive_angle(side * goal.yaw - first + middle)};
}

}  // namespace

Pose2 along_arc(const Pose2& T_map_from, double curvature_per_m, double distance_m) {
  return follow_arc(T_map_from, distance_m, curvature_per_m * distance_m, 1.0);
}

std::vector<Arc> dubins_path(const Pose2& T_from_to, double radius_m) {
  const Pose2 goal{T_from_to.x / radius_m, T_from_to.y / radius_m, T_from_to.yaw};
  double shortest = std::numeric_limits<double>::infinity();
  std::vector<Arc> best;
  const auto offer = [&](const std::optional<Parts>& parts, double first, double middle, double last) {
    if (!parts) return;
    const double length = (*parts)[0] + (*parts)[1] + (*parts)[2];
    if (length >= shortest) return;
    shortest = length;
    best = {{first / radius_m, (*parts)[0] * radius_m},
            {middle / radius_m, (*parts)[1] * radius_m},
            {last / radius_m, (*parts)[2] * radius_m}};
  };
  for (const double first : {1.0, -1.0}) {
    for (const double last : {1.0, -1.0}) offer(turn_straight_turn(goal, first, last), first, 0.0, last);
    offer(three_turns(goal, first), first, -first, first);
  }
  return best;
}

double length_m(const std::vector<Arc>& arcs) {
  double sum_m = 0.0;
  for (const Arc& arc : arcs) sum_m += arc.length_m;
  return sum_m;
}

}  // namespace patrol::plan
