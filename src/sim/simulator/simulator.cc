#include "sim/simulator/simulator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include "sim/as_built/as_built_model.h"
#include "sim/locomotion/quadruped_drive.h"
#include "sim/locomotion/track_drive.h"
#include "sim/locomotion/wheel_drive.h"
#include "sim/sensors/imu.h"
#include "sim/sensors/uwb.h"

namespace patrol::sim {
namespace {

/// Contacts interrupted for less than this are one contact.
constexpr Time kContactGap = std::chrono::milliseconds(500);

std::string geom_name(const mjModel& model, int geom) {
  if (const std::string_view name = name_of(model, mjOBJ_GEOM, geom); !name.empty()) return std::string(name);
  const std::string_view body = name_of(model, mjOBJ_BODY, model.geom_bodyid[geom]);
  return fmt::format("geom {} of {}", geom, body.empty() ? "?" : body);
}

/// The firmware knows the nominal robot.
std::unique_ptr<Locomotion> make_locomotion(const SimulatorSettings& settings, const AsBuiltRobot& robot,
                                            mjModel& physics) {
  const RobotDescription& nominal = robot.nominal();
  if (nominal.tracks) {
    return std::make_unique<TrackDrive>(nominal, settings.track_drive, settings.sensors.hall.ticks_per_rad(), physics,
                                        robot.tracks());
  }
  if (nominal.wheels.empty()) return std::make_unique<QuadrupedDrive>(nominal, settings.locomotion, physics);
  return std::make_unique<WheelDrive>(nominal, settings.wheel_drive, settings.sensors.joint_encoders.ticks_per_rad(),
                                      physics, robot.wheels());
}

AssembledModel assemble_at(const Pose2& T_world_start, const SimulatorSettings& settings, const AsBuiltRobot& robot) {
  return assemble_model(settings.world_xml, settings.robot_urdf, robot.nominal(), T_world_start,
                        settings.static_obstacles, Textures::kNone);
}

/// Assembles the model with the robot at its start with the placement error. A message about a start that is invalid
/// without this error, too, has the start of the settings.
AssembledModel assemble_at_start(const SimulatorSettings& settings, const AsBuiltRobot& robot) {
  try {
    return assemble_at(robot.start(settings.T_world_start), settings, robot);
  } catch (const InputError& error) {
    assemble_at(settings.T_world_start, settings, robot);
    throw InputError(fmt::format("{}: with the error of as_built.placement; ({:.2f}, {:.2f}) without it is valid",
                                 error.what(), settings.T_world_start.x, settings.T_world_start.y));
  }
}

AssembledModel assemble(const SimulatorSettings& settings, const AsBuiltRobot& robot) {
  AssembledModel model = assemble_at_start(settings, robot);
  apply_as_built(robot, *model.physics);
  deform_lining(settings.lining_deformations, settings.lining, *model.view);
  return model;
}

}  // namespace

Simulator::Simulator(const SimulatorSettings& settings, const RobotDescription& robot, std::uint64_t seed,
                     const DepthImagerFactory& make_depth_imager)
    : seed_(seed),
      robot_(settings.as_built, robot, seed),
      model_(assemble(settings, robot_)),
      data_(make_data(*model_.physics)),
      culler_(*model_.physics),
      ground_(settings.site.ground, *model_.physics),
      robot_body_(mj_name2id(model_.physics.get(), mjOBJ_BODY, frame_id::kBody)),
      robot_radius_m_(robot.outline_radius_m()),
      settings_(settings),
      locomotion_(make_locomotion(settings, robot_, *model_.physics)),
      actors_(*model_.physics, settings.actors),
      sensors_(settings.sensors, robot_, *model_.physics, *model_.view,
               GasPlume(*model_.view, settings.leaks, settings.wind), settings.faults, seed, make_depth_imager,
               settings.subsurface, settings.has_sensor_thread),
      recorded_(settings.recorded),
      tick_(from_seconds(model_.physics->opt.timestep)) {
  if (!settings.teleop_route.empty()) operator_.emplace(settings.teleop_operator, settings.teleop_route, seed);
  if (robot.antenna) antenna_.emplace(settings.sensors.antenna, *robot.antenna, *model_.physics, seed);
  if (robot_body_ < 0)
    throw InputError(fmt::format("{}: link not found: {}", settings.robot_urdf.path, frame_id::kBody));
  std::copy(model_.start_qpos.begin(), model_.start_qpos.end(), data_->qpos);
  actors_.advance(now_, {.p_world = robot_.start(settings.T_world_start).position(), .radius_m = robot_radius_m_},
                  *data_);
  locomotion_->evaluate(*model_.physics, *data_);
  sensors_.step(*model_.physics, *data_, now_);
}

// Between steps, kinematics, forces and readings are those of `now_`; a step integrates the state and evaluates the
// next one. The firmware's torques use readings that are one tick old, as on a real robot.
void Simulator::step() {
  const mjModel* model = model_.physics.get();
  {
    const auto timer = clock_.time_stage("locomotion");
    const NewestReadings& newest = sensors_.newest();
    locomotion_->step({.imu = newest.imu, .joints = newest.joints, .feet = newest.feet, .ticks = newest.ticks},
                      command_, *model_.physics, *data_);
    if (antenna_) antenna_->step(*model_.physics, *data_);
  }
  {
    const auto timer = clock_.time_stage("actors");
    const GroundTruth robot = truth();
    actors_.advance(now_ + tick_,
                    {.p_world = robot.T_world_body.position.head<2>(),
                     .v_world_mps = (robot.T_world_body.rotation * robot.twist.linear).head<2>(),
                     .radius_m = robot_radius_m_},
                    *data_);
  }
  {
    const auto timer = clock_.time_stage("physics");
    suppress_slip();
    mj_Euler(model, data_.get());
    now_ += tick_;
    culler_.update(*data_);
    locomotion_->evaluate(*model, *data_);
    throw_if_diverged();
    record_collisions();
  }
  receive_teleop();
  const auto timer = clock_.time_stage("sensors");
  sensors_.step(*model, *data_, now_);
  if (antenna_) {
    if (const auto state = antenna_->read(*data_, now_)) sensors_.add(*state);
  }
}

void Simulator::command(const InstrumentCommand& command) {
  const auto* antenna = std::get_if<AntennaCommand>(&command);
  if (antenna != nullptr && antenna_) antenna_->command(*antenna);
  sensors_.command(command);
}

// MuJoCo's friction is soft: a standing robot creeps by micrometers and millidegrees per second, up to 0.07 degrees
// during a scan in the tunnel. A parked robot does not creep. So the solver removes the residual slip while an
// instrument needs a stationary robot.
void Simulator::suppress_slip() {
  constexpr int kNoSlipIterations = 3;
  const bool is_asked_to_stand = command_.vx_mps == 0.0 && command_.vy_mps == 0.0 && command_.yaw_rate_radps == 0.0;
  model_.physics->opt.noslip_iterations = sensors_.is_busy() && is_asked_to_stand ? kNoSlipIterations : 0;
}

void Simulator::receive_teleop() {
  if (operator_) {
    if (const auto command = operator_->step(now_, to_pose2(truth().T_world_body), actors_.positions(), is_busy())) {
      sensors_.add(*command);
    }
  }
  while (num_replayed_ < recorded_.size() && recorded_[num_replayed_].stamp <= now_) {
    sensors_.add(recorded_[num_replayed_++]);
  }
}

void Simulator::teleport(const Pose2& T_world_body) {
  mjModel& model = *model_.physics;
  constexpr double kEyeAboveBase_m = 1.0;
  const double max_ground_height_m = truth().T_world_body.position.z() + kEyeAboveBase_m;
  const double ground_m = ground_height_m(model, *data_, model_.stance, T_world_body, max_ground_height_m);
  const Pose3 pose = to_pose3(T_world_body, ground_m + model_.stance.height_m);

  const int root = model.jnt_qposadr[model.body_jntadr[robot_body_]];
  set_standing_posture(model, robot_.nominal(), data_->qpos);
  std::copy_n(pose.position.data(), 3, data_->qpos + root);
  const double quaternion[4] = {pose.rotation.w(), pose.rotation.x(), pose.rotation.y(), pose.rotation.z()};
  std::copy_n(quaternion, 4, data_->qpos + root + 3);
  for (mjtNum* rates : {data_->qvel, data_->qacc_warmstart, data_->qfrc_applied}) std::fill_n(rates, model.nv, 0.0);
  std::fill_n(data_->ctrl, model.nu, 0.0);

  locomotion_->restart();
  mj_kinematics(&model, data_.get());
  culler_.update(*data_);
  locomotion_->evaluate(model, *data_);
}

void Simulator::record_collisions() {
  const mjModel& model = *model_.physics;
  const auto is_robot = [&](int geom) { return model.body_rootid[model.geom_bodyid[geom]] == robot_body_; };
  double lowest_m = std::numeric_limits<double>::infinity();
  for (int i = 0; i < data_->ncon; ++i) {
    const mjContact& contact = data_->contact[i];
    if (is_robot(contact.geom[0]) != is_robot(contact.geom[1])) lowest_m = std::min(lowest_m, contact.pos[2]);
  }
  for (int i = 0; i < data_->ncon; ++i) {
    const mjContact& contact = data_->contact[i];
    int robot_geom = contact.geom[0], other = contact.geom[1];
    if (!is_robot(robot_geom)) std::swap(robot_geom, other);
    if (!is_robot(robot_geom) || is_robot(other)) continue;
    if (ground_.is_footing(model, *data_, contact, other, lowest_m)) continue;

    const Collision collision{.stamp = now_, .first = geom_name(model, robot_geom), .second = geom_name(model, other)};
    const std::string& object = collision.second;
    const auto known = std::find_if(contacts_.begin(), contacts_.end(),
                                    [&](const auto& contact_pair) { return contact_pair.first == object; });
    if (known == contacts_.end()) {
      contacts_.emplace_back(object, now_);
      collisions_.push_back(collision);
    } else {
      if (now_ - known->second > kContactGap) collisions_.push_back(collision);
      known->second = now_;
    }
  }
}

// MuJoCo replaces motor commands that are not finite by zeros and only counts them.
void Simulator::throw_if_diverged() const {
  struct Quantity {
    mjtWarning warning;
    const char* name;
  };
  constexpr std::array kUnstable = std::to_array<Quantity>({{mjWARN_BADQPOS, "a position"},
                                                            {mjWARN_BADQVEL, "a velocity"},
                                                            {mjWARN_BADQACC, "an acceleration"},
                                                            {mjWARN_BADCTRL, "a motor command"}});
  const auto fail = [&](const char* name) {
    throw std::runtime_error(
        fmt::format("physics diverged at {:.3f} s: {} is not finite or too large (time step {:g} s)", to_seconds(now_),
                    name, model_.physics->opt.timestep));
  };
  for (int i = 0; i < model_.physics->nq; ++i) {
    if (!std::isfinite(data_->qpos[i])) fail("a position");
  }
  for (const Quantity& quantity : kUnstable) {
    if (data_->warning[quantity.warning].number > 0) fail(quantity.name);
  }
}

std::vector<SensorMessage> Simulator::take_messages() { return sensors_.take_due(now_); }

AsBuiltTruth Simulator::as_built() const {
  std::vector<int> anchors;
  for (const UwbAnchor& anchor : uwb_anchors(*model_.view)) anchors.push_back(anchor.number);
  const ImuSettings& imu = settings_.sensors.imu;
  AsBuiltTruth truth = robot_.truth(anchors, ImuSensor::constant_biases(imu, seed_));
  if (!truth.values.empty()) {
    truth.values.emplace_back("imu.warming_time_s", settings_.as_built.imu.warming_time_s);
    truth.values.emplace_back("imu.gyro_bias_walk_radps_per_sqrt_s", imu.gyro_bias_random_walk_radps_per_sqrt_s);
    truth.values.emplace_back("imu.accel_bias_walk_mps2_per_sqrt_s", imu.accel_bias_random_walk_mps2_per_sqrt_s);
  }
  truth.stamp = now_;
  return truth;
}

GroundTruth Simulator::truth() const {
  const mjtNum* position = data_->xpos + 3 * robot_body_;
  const mjtNum* rotation = data_->xquat + 4 * robot_body_;
  mjtNum velocity[6];  // angular, then linear part, in the body's frame
  mj_objectVelocity(model_.physics.get(), data_.get(), mjOBJ_XBODY, robot_body_, velocity, 1);
  return {.stamp = now_,
          .T_world_body = {Eigen::Vector3d(position),
                           Eigen::Quaterniond(rotation[0], rotation[1], rotation[2], rotation[3])},
          .twist = {.linear = Eigen::Vector3d(velocity + 3), .angular = Eigen::Vector3d(velocity)}};
}

SimState Simulator::state() const {
  SimState state{.stamp = now_, .qpos = {data_->qpos, data_->qpos + model_.physics->nq}, .mocap = {}};
  for (int body = 0; body < model_.physics->nmocap; ++body) {
    state.mocap.insert(state.mocap.end(), data_->mocap_pos + 3 * body, data_->mocap_pos + 3 * body + 3);
    state.mocap.insert(state.mocap.end(), data_->mocap_quat + 4 * body, data_->mocap_quat + 4 * body + 4);
  }
  return state;
}

std::vector<Collision> Simulator::take_collisions() { return std::exchange(collisions_, {}); }

}  // namespace patrol::sim
