#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/background_worker.h"
#include "core/messages.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"
#include "core/stage_profiler.h"
#include "core/state/message_state.h"
#include "sim/as_built/as_built_robot.h"
#include "sim/gas_plume.h"
#include "sim/lidar_scene.h"
#include "sim/sensors/depth_camera.h"
#include "sim/sensors/sensor_suite_settings.h"
#include "sim/subsurface.h"

namespace patrol::sim {

/// Arguments for making a sensor. Sensors may keep references to `scene`, `view` and `worker` only.
struct SensorContext {
  const SensorSuiteSettings& settings;
  const AsBuiltRobot& as_built;
  const RobotDescription& robot;  ///< the robot with the actual poses of its sensors
  const mjModel& physics;
  const mjModel& view;
  const LidarScene& scene;
  const GasPlume& plume;
  const Subsurface& subsurface;
  const DepthImagerFactory& make_depth_imager;
  BackgroundWorker& worker;  ///< worker for expensive readings
  std::uint64_t seed;
};

/// Newest reading of each sensor that the firmware reads directly; empty if the robot has no such sensor.
struct NewestReadings {
  Imu imu;
  JointState joints;
  FootContacts feet;
  TrackTicks ticks;
};

/// State of the simulation at a tick. Kinematics, accelerations and the lidar scene are those of `now`.
struct SensorTick {
  const mjModel& physics;
  mjData& data;
  std::uint64_t count;  ///< ticks before this one
  Time now;
  Pose3 T_world_body;
  Time last;                ///< instant of the previous tick; `now` at the first one
  Pose3 T_world_body_last;  ///< body pose at `last`
  NewestReadings& newest;
  StageProfiler& clock;  ///< timer of sensors that report their computing time separately

  bool is_first() const { return count == 0; }
};

/// Interface of one sensor of the robot.
class Sensor {
 public:
  virtual ~Sensor() = default;

  /// Appends the readings that are complete to `readings`. Called once per tick.
  virtual void step(const SensorTick& tick, std::vector<SensorMessage>& readings) = 0;

  /// Waits for the parts of a reading that the worker computes, and fills them in. Called once for each reading, in
  /// order, before the reading is changed or delivered. The caller keeps the reading's stamp, which has become that of
  /// the device's clock.
  virtual void complete(SensorMessage& /*reading*/) {}

  /// Passes a command of the stack; `now` and the pose are of the newest tick.
  virtual void command(const InstrumentCommand&, Time /*now*/, const Pose3& /*T_world_body*/) {}

  /// Returns whether the sensor is taking a measurement for which the robot must stand still.
  virtual bool is_busy() const { return false; }

  /// Saves or restores the state.
  virtual void serialize_state(StateArchive& /*archive*/) {}
};

/// Schedule of a constant rate, starting at time 0.
class SensorSchedule {
 public:
  explicit SensorSchedule(double rate_hz) : rate_hz_(rate_hz) {}

  /// Returns whether the next reading is due, and advances to the following one if so.
  bool is_due(Time now) {
    if (now < from_seconds(static_cast<double>(count_) / rate_hz_)) return false;
    ++count_;
    return true;
  }
  /// Returns the number of the last reading that was due, from 0.
  std::uint64_t index() const { return count_ - 1; }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(count_);
  }

 private:
  double rate_hz_;
  std::uint64_t count_ = 0;
};

/// Sensor that takes a reading at a constant rate.
class PeriodicSensor : public Sensor {
 public:
  explicit PeriodicSensor(double rate_hz) : schedule_(rate_hz) {}

  void step(const SensorTick& tick, std::vector<SensorMessage>& readings) final {
    if (schedule_.is_due(tick.now)) read(tick, schedule_.index(), readings);
  }

  void serialize_state(StateArchive& archive) override { schedule_.serialize_state(archive); }

 protected:
  /// Takes reading number `index`.
  virtual void read(const SensorTick& tick, std::uint64_t index, std::vector<SensorMessage>& readings) = 0;

 private:
  SensorSchedule schedule_;
};

/// Makes the sensor that publishes `Message`; null if the settings disable it or the robot cannot carry it. The source
/// file of each sensor specializes it. Throws InputError when an enabled sensor has no frame on the robot or requires
/// something that the world lacks.
template <typename Message>
std::unique_ptr<Sensor> make_sensor(const SensorContext& context);

}  // namespace patrol::sim
