#pragma once

#include <Eigen/Core>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/settings.h"
#include "core/time.h"

namespace patrol::sim {

struct WaypointSettings {
  double x_m = 0.0;
  double y_m = 0.0;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("x_m", self.x_m);
    visit("y_m", self.y_m);
  }
};

/// Somebody who moves through the world on a path of their own, and stops for the robot.
struct ActorSettings {
  std::string name;                     ///< of the world's mocap body, e.g. "pedestrian_1"
  std::string kind = "pedestrian";
  std::vector<WaypointSettings> path;
  double speed_mps = 1.2;
  double start_s = 0.0;
  bool loop = true;                     ///< there and back again (a car reverses); otherwise it stops at the end
  double yield_distance_m = 1.5;        ///< stops while the robot's middle is this near ahead of it

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("name", self.name);
    visit("kind", self.kind, one_of({"pedestrian", "car"}));
    visit("path", self.path);
    visit("speed_mps", self.speed_mps, between(0.0, 10.0));
    visit("start_s", self.start_s, at_least(0.0));
    visit("loop", self.loop);
    visit("yield_distance_m", self.yield_distance_m, between(0.0, 20.0));
  }
};

/// What somebody sees of the robot, in world.
struct RobotInView {
  Eigen::Vector2d p_world;
  Eigen::Vector2d v_world_mps = Eigen::Vector2d::Zero();
  double radius_m = 0.0;  ///< of the circle about its outline
};

/// A polyline walked at constant speed, with rounded heading at its corners.
class ActorPath {
 public:
  ActorPath() = default;
  explicit ActorPath(const std::vector<WaypointSettings>& waypoints);

  double length_m() const { return along_.empty() ? 0.0 : along_.back(); }
  Eigen::Vector2d position(double along_m) const;
  /// Direction of travel, smoothed over the corner, rad.
  double heading_rad(double along_m) const;

 private:
  std::vector<Eigen::Vector2d> points_;
  std::vector<double> along_;  ///< [point]: way from the start, m
};

/// People and cars: mocap bodies moved along their paths. Where they are depends on nothing but time and the robot's way, so the
/// same run has the same traffic. They stop for a robot that is in their way, or will be if it goes on as it does; one who
/// already walks across the robot's way walks on.
///
/// A pedestrian's legs swing with the way walked: the foot that stands stays where it is. Parts are found by name: `<name>`,
/// `<name>_thigh_left`, `<name>_shank_left`, `..._right`.
class Actors {
 public:
  /// Throws InputError when the world has no such actor.
  Actors(const mjModel& model, const std::vector<ActorSettings>& settings);

  /// Moves everybody on to `now` and writes their poses.
  void advance(Time now, const RobotInView& robot, mjData& data);

  /// Where everybody is, in world.
  std::vector<Eigen::Vector2d> positions() const;

 private:
  struct Actor {
    ActorSettings settings;
    ActorPath path;
    std::array<int, 5> mocap;  ///< body, thigh and shank left, thigh and shank right; -1 where there is none
    double base_height_m;      ///< of the body's origin, as the world's file puts it over its ground
    std::vector<double> ground_m;  ///< height of the ground every kGroundStep_m of the path
    double walked_m = 0.0;     ///< in all
    double speed_mps = 0.0;
  };

  void place(const Actor& actor, mjData& data) const;
  void place_legs(const Actor& actor, const Eigen::Vector3d& hip, double heading_rad, mjData& data) const;
  static double along_path(const Actor& actor);
  static bool is_returning(const Actor& actor);
  static double course_rad(const Actor& actor);
  static bool must_wait(const Actor& actor, const RobotInView& robot);

  std::vector<Actor> actors_;
  Time last_{};
};

}  // namespace patrol::sim
