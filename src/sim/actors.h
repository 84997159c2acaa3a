#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <mujoco/mujoco.h>

#include "core/settings.h"
#include "core/time.h"

namespace patrol::sim {

/// Point of a path in world.
struct WaypointSettings {
  double x_m = 0.0;  ///< x of the waypoint in the world
  double y_m = 0.0;  ///< y of the waypoint in the world

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("x_m", self.x_m);
    visit("y_m", self.y_m);
  }
};

/// Settings of a pedestrian or car that moves along a path and stops for the robot.
struct ActorSettings {
  std::string name;                 ///< name of the world's mocap body, e.g. "pedestrian_1"
  std::string kind = "pedestrian";  ///< kind of the actor: pedestrian or car
  std::vector<WaypointSettings> path;
  double speed_mps = 1.2;  ///< speed along the path
  double start_s = 0.0;    ///< time of the start of the motion
  bool loop = true;  ///< motion back and forth along the path (a car reverses); false: one way, with a stop at the end
  double yield_distance_m = 1.5;  ///< distance to the robot's center ahead within which the actor stops

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

/// Robot as the actors observe it, in world.
struct ObservedRobot {
  Eigen::Vector2d p_world;
  Eigen::Vector2d v_world_mps = Eigen::Vector2d::Zero();
  double radius_m = 0.0;  ///< radius of the circle around the robot's outline
};

/// Polyline traversed at constant speed, with the heading smoothed at its corners.
class ActorPath {
 public:
  ActorPath() = default;
  explicit ActorPath(const std::vector<WaypointSettings>& waypoints);

  double length_m() const { return along_.empty() ? 0.0 : along_.back(); }
  Eigen::Vector2d position(double along_m) const;
  /// Returns the direction of travel, smoothed over the corner, rad.
  double heading_rad(double along_m) const;

 private:
  std::vector<Eigen::Vector2d> points_;
  std::vector<double> along_;  ///< [point], distance along the path from its start, m
};

/// Pedestrians and cars: mocap bodies moved along their paths.
///
/// Their poses depend only on time and on the robot's motion, so runs with equal robot motion have equal traffic. An
/// actor stops for a robot that is, or at its present velocity will be, in the actor's path. A pedestrian that is
/// already crossing the robot's path keeps walking.
///
/// The legs of a pedestrian swing with the walked distance; the stance foot stays in place. Body parts are found by
/// name: `<name>`, `<name>_thigh_left`, `<name>_shank_left`, `..._right`.
class Actors {
 public:
  /// Throws InputError when the world has no such actor.
  Actors(const mjModel& model, const std::vector<ActorSettings>& settings);

  /// Advances all actors to `now` and writes their poses.
  void advance(Time now, const ObservedRobot& robot, mjData& data);

  /// Returns the positions of all actors, in world.
  std::vector<Eigen::Vector2d> positions() const;

  template <typename Archive>
  void serialize_state(Archive& archive) {
    for (Actor& actor : actors_) archive(actor.walked_m, actor.speed_mps);
    archive(last_);
  }

 private:
  struct Actor {
    ActorSettings settings;
    ActorPath path;
    std::array<int, 5> mocap;      ///< mocap ids: body, left thigh, left shank, right thigh, right shank; -1 if absent
    double base_height_m;          ///< height of the body's origin above its ground in the world file
    std::vector<double> ground_m;  ///< ground height at every kGroundStep_m of the path
    double walked_m = 0.0;         ///< total distance walked
    double speed_mps = 0.0;
  };

  static void write_pose(const Actor& actor, mjData& data);
  static void write_leg_poses(const Actor& actor, const Eigen::Vector3d& hip, double heading_rad, mjData& data);
  static double along_path(const Actor& actor);
  static bool is_returning(const Actor& actor);
  static double course_rad(const Actor& actor);
  static bool must_yield(const Actor& actor, const ObservedRobot& robot);

  std::vector<Actor> actors_;
  Time last_{};
};

}  // namespace patrol::sim
