#include "sim/actors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/error.h"
#include "core/frames.h"
#include "core/text.h"
#include "sim/mujoco.h"

namespace patrol::sim {
namespace {

constexpr double kCorner_m = 0.4;  // the heading is smoothed over this length on both sides of a corner
constexpr double kGroundStep_m = 0.1;
constexpr double kAcceleration_mps2 = 1.5;
constexpr double kHipWidth_m = 0.09;  // lateral offset of each hip from the center
constexpr double kThigh_m = 0.43, kShank_m = 0.43;
constexpr double kStep_m = 0.65;  // length of a step; a stride is two steps

constexpr double kPredictionHorizon_s = 1.5;  // prediction horizon for the robot's position
constexpr double kPredictionStep_s = 0.25;

/// Half extents of an actor along and across its course; the lateral one includes a comfort margin.
struct Extent {
  double half_length_m, half_width_m;
};

Extent extent_of(const ActorSettings& settings) {
  return settings.kind == "car" ? Extent{.half_length_m = 2.2, .half_width_m = 1.6}
                                : Extent{.half_length_m = 0.3, .half_width_m = 0.4};
}

int mocap_of(const mjModel& model, const std::string& name) {
  const int body = mj_name2id(&model, mjOBJ_BODY, name.c_str());
  return body < 0 ? -1 : model.body_mocapid[body];
}

std::string known_actors(const mjModel& model) {
  std::vector<std::string> names;
  for (int body = 0; body < model.nbody; ++body) {
    const std::string name(name_of(model, mjOBJ_BODY, body));
    const bool is_part = name.find("_thigh_") != std::string::npos || name.find("_shank_") != std::string::npos;
    if (model.body_mocapid[body] >= 0 && !name.empty() && !is_part) names.push_back(name);
  }
  return join(names, ", ");
}

/// Returns the ground height at a position: the highest static collision surface below knee height, for a person on
/// ground of height `from_m`.
double ground_at(const mjModel& model, const mjData& data, const Eigen::Vector2d& p_world, double from_m) {
  constexpr double kKnee_m = 0.5, kThrough_m = 1e-6;
  const mjtNum down[3] = {0.0, 0.0, -1.0};
  const mjtByte can_carry[mjNGROUP] = {1, 0, 1, 1, 0, 0};
  for (double height = from_m + kKnee_m;;) {
    const mjtNum from[3] = {p_world.x(), p_world.y(), height};
    int geom = -1;
    const mjtNum distance = mj_ray(&model, &data, from, down, can_carry, true, -1, &geom, nullptr);
    if (distance < 0.0) return 0.0;
    height -= distance;
    const bool is_actor = model.body_mocapid[model.body_rootid[model.geom_bodyid[geom]]] >= 0;
    if (!is_actor) return height;
    height -= kThrough_m;
  }
}

void set_pose(mjData& data, int mocap, const Eigen::Vector3d& position, const Eigen::Quaterniond& rotation) {
  if (mocap < 0) return;
  std::copy_n(position.data(), 3, data.mocap_pos + 3 * mocap);
  const mjtNum quaternion[4] = {rotation.w(), rotation.x(), rotation.y(), rotation.z()};
  std::copy_n(quaternion, 4, data.mocap_quat + 4 * mocap);
}

constexpr double kLeg_m = kThigh_m + kShank_m - 0.012;  // distance from hip to ankle when standing with a slightly bent
                                                        // knee

/// Returns the fraction of the full stride length that is used at a speed.
double stride_fraction(double speed_mps) { return std::min(speed_mps / 0.4, 1.0); }

/// Returns the phase of a foot in its stride: stance for 0 ... 0.5, then swing. `side` 0 is left.
double stride_phase(double walked_m, int side) {
  const double stride = walked_m / (2.0 * kStep_m) + 0.5 * side;
  return stride - std::floor(stride);
}

/// Returns the distance of a foot ahead of the hip.
double foot_forward_m(double phase) { return kStep_m * (phase < 0.5 ? 0.5 - 2.0 * phase : -0.5 + 2.0 * (phase - 0.5)); }

/// Returns the drop of the hip as it passes over the stance foot like the end of a stiff pendulum.
double hip_drop_m(double walked_m, double speed_mps) {
  const double left = stride_phase(walked_m, 0);
  const double forward = stride_fraction(speed_mps) * foot_forward_m(left < 0.5 ? left : stride_phase(walked_m, 1));
  return kLeg_m - std::sqrt(kLeg_m * kLeg_m - forward * forward);
}

/// Returns the angles of thigh and knee that put the ankle at (forward, down) from the hip. Both are about y; the thigh
/// is positive forward.
std::pair<double, double> leg_angles(double forward_m, double down_m) {
  const double reach = std::min(std::hypot(forward_m, down_m), kThigh_m + kShank_m - 1e-3);
  const double cos_knee = (reach * reach - kThigh_m * kThigh_m - kShank_m * kShank_m) / (2.0 * kThigh_m * kShank_m);
  const double knee = std::acos(std::clamp(cos_knee, -1.0, 1.0));
  const double lead = std::atan2(kShank_m * std::sin(knee), kThigh_m + kShank_m * std::cos(knee));
  return {std::atan2(forward_m, down_m) + lead, knee};
}

}  // namespace

ActorPath::ActorPath(const std::vector<WaypointSettings>& waypoints) {
  for (const WaypointSettings& waypoint : waypoints) {
    const Eigen::Vector2d point(waypoint.x_m, waypoint.y_m);
    along_.push_back(points_.empty() ? 0.0 : along_.back() + (point - points_.back()).norm());
    points_.push_back(point);
  }
}

Eigen::Vector2d ActorPath::position(double along_m) const {
  const auto next = std::upper_bound(along_.begin(), along_.end(), along_m);
  if (next == along_.begin()) return points_.front();
  if (next == along_.end()) return points_.back();
  const auto i = static_cast<std::size_t>(next - along_.begin());
  const double fraction = (along_m - along_[i - 1]) / (along_[i] - along_[i - 1]);
  return points_[i - 1] + fraction * (points_[i] - points_[i - 1]);
}

double ActorPath::heading_rad(double along_m) const {
  const double reach = std::min(kCorner_m, length_m() / 2.0);
  const Eigen::Vector2d ahead = position(std::min(along_m + reach, length_m()));
  const Eigen::Vector2d behind = position(std::max(along_m - reach, 0.0));
  return std::atan2((ahead - behind).y(), (ahead - behind).x());
}

Actors::Actors(const mjModel& model, const std::vector<ActorSettings>& settings) {
  const DataPtr data = make_data(model);
  mj_kinematics(&model, data.get());
  for (const ActorSettings& actor_settings : settings) {
    validate(actor_settings, "actors." + actor_settings.name);
    const std::string& name = actor_settings.name;
    const int body = mj_name2id(&model, mjOBJ_BODY, name.c_str());
    if (mocap_of(model, name) < 0) {
      throw InputError(fmt::format("actors: unknown name '{}' (known: {})", name, known_actors(model)));
    }
    if (actor_settings.path.size() < 2)
      throw InputError(fmt::format("actors.{}.path: must have at least two points", name));
    Actor actor{.settings = actor_settings,
                .path = ActorPath(actor_settings.path),
                .mocap = {mocap_of(model, name), mocap_of(model, name + "_thigh_left"),
                          mocap_of(model, name + "_shank_left"), mocap_of(model, name + "_thigh_right"),
                          mocap_of(model, name + "_shank_right")},
                .base_height_m = 0.0,
                .ground_m = {}};
    if (actor.path.length_m() <= 0.0)
      throw InputError(fmt::format("actors.{}.path: length is zero: must be positive", name));
    const Eigen::Vector3d placed(model.body_pos + 3 * body);
    actor.base_height_m = placed.z() - ground_at(model, *data, placed.head<2>(), 0.0);
    double ground = 0.0;
    for (double along = 0.0; along < actor.path.length_m() + kGroundStep_m; along += kGroundStep_m) {
      ground = ground_at(model, *data, actor.path.position(along), ground);
      actor.ground_m.push_back(ground);
    }
    actors_.push_back(std::move(actor));
  }
}

double Actors::along_path(const Actor& actor) {
  const double length = actor.path.length_m();
  if (!actor.settings.loop) return std::min(actor.walked_m, length);
  const double lap = std::fmod(actor.walked_m, 2.0 * length);
  return lap <= length ? lap : 2.0 * length - lap;
}

bool Actors::is_returning(const Actor& actor) {
  return actor.settings.loop && std::fmod(actor.walked_m, 2.0 * actor.path.length_m()) > actor.path.length_m();
}

double Actors::course_rad(const Actor& actor) {
  return actor.path.heading_rad(along_path(actor)) + (is_returning(actor) ? std::numbers::pi : 0.0);
}

bool Actors::must_yield(const Actor& actor, const ObservedRobot& robot) {
  const double course = course_rad(actor);
  const Eigen::Vector2d ahead(std::cos(course), std::sin(course));
  const Eigen::Vector2d p_actor = actor.path.position(along_path(actor));
  const Extent extent = extent_of(actor.settings);
  for (double in_s = 0.0; in_s <= kPredictionHorizon_s; in_s += kPredictionStep_s) {
    const Eigen::Vector2d to_robot = robot.p_world + in_s * robot.v_world_mps - p_actor;
    const double gap_m = to_robot.dot(ahead) - extent.half_length_m;
    const double across_m = std::abs(to_robot.x() * ahead.y() - to_robot.y() * ahead.x());
    const double min_gap_m = in_s > 0.0 ? robot.radius_m : -extent.half_length_m;  // an actor closer than this clears
                                                                                   // the robot's path sooner by walking
                                                                                   // on
    if (gap_m > min_gap_m && gap_m < actor.settings.yield_distance_m && across_m < extent.half_width_m + robot.radius_m)
      return true;
  }
  return false;
}

void Actors::advance(Time now, const ObservedRobot& robot, mjData& data) {
  const double dt_s = to_seconds(now - last_);
  last_ = now;
  for (Actor& actor : actors_) {
    const bool waits = must_yield(actor, robot);
    const bool is_over = !actor.settings.loop && actor.walked_m >= actor.path.length_m();
    const double wanted = waits || is_over || to_seconds(now) < actor.settings.start_s ? 0.0 : actor.settings.speed_mps;
    const double change = (waits ? 4.0 : 1.0) * kAcceleration_mps2 * dt_s;
    actor.speed_mps += std::clamp(wanted - actor.speed_mps, -change, change);
    actor.walked_m += actor.speed_mps * dt_s;
    write_pose(actor, data);
  }
}

std::vector<Eigen::Vector2d> Actors::positions() const {
  std::vector<Eigen::Vector2d> positions;
  for (const Actor& actor : actors_) positions.push_back(actor.path.position(along_path(actor)));
  return positions;
}

void Actors::write_pose(const Actor& actor, mjData& data) {
  const double along = along_path(actor);
  const bool is_facing_back = is_returning(actor) && actor.settings.kind != "car";  // a car reverses
  const double heading = actor.path.heading_rad(along) + (is_facing_back ? std::numbers::pi : 0.0);
  // Average the ground height so that the hip rises at curbs over a step length instead of at once.
  const auto ground_at_index = [&](double at) {
    const auto i =
        static_cast<std::size_t>(std::clamp(at / kGroundStep_m, 0.0, static_cast<double>(actor.ground_m.size() - 1)));
    return actor.ground_m[i];
  };
  const double ground = (ground_at_index(along - 0.2) + ground_at_index(along) + ground_at_index(along + 0.2)) / 3.0;
  const Eigen::Vector2d p_world = actor.path.position(along);
  const bool has_legs = actor.mocap[1] >= 0;
  const double drop = has_legs ? hip_drop_m(actor.walked_m, actor.speed_mps) : 0.0;
  const Eigen::Vector3d origin(p_world.x(), p_world.y(), ground + actor.base_height_m - drop);
  set_pose(data, actor.mocap[0], origin, quaternion_from_yaw(heading));
  if (has_legs) write_leg_poses(actor, origin, heading, data);
}

// Each foot is in stance for half a stride while the hip passes over it, then swings forward at twice the speed.
void Actors::write_leg_poses(const Actor& actor, const Eigen::Vector3d& hip, double heading_rad, mjData& data) {
  const Eigen::Quaterniond yaw = quaternion_from_yaw(heading_rad);
  const double fraction = stride_fraction(actor.speed_mps);
  const double hip_height = kLeg_m - hip_drop_m(actor.walked_m, actor.speed_mps);
  for (int side = 0; side < 2; ++side) {
    const double phase = stride_phase(actor.walked_m, side);
    const double lift = phase < 0.5 ? 0.0 : fraction * 0.10 * std::sin(2.0 * std::numbers::pi * (phase - 0.5));
    const auto [thigh, knee] = leg_angles(fraction * foot_forward_m(phase), hip_height - lift);
    const Eigen::Vector3d top = hip + yaw * Eigen::Vector3d(0.0, side == 0 ? kHipWidth_m : -kHipWidth_m, 0.0);
    const Eigen::Quaterniond q_thigh = yaw * Eigen::AngleAxisd(-thigh, Eigen::Vector3d::UnitY());
    const Eigen::Quaterniond q_shank = yaw * Eigen::AngleAxisd(knee - thigh, Eigen::Vector3d::UnitY());
    set_pose(data, actor.mocap[static_cast<std::size_t>(1 + 2 * side)], top, q_thigh);
    set_pose(data, actor.mocap[static_cast<std::size_t>(2 + 2 * side)],
             top + q_thigh * Eigen::Vector3d(0.0, 0.0, -kThigh_m), q_shank);
  }
}

}  // namespace patrol::sim
