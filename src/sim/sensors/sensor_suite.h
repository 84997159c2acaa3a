#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/background_worker.h"
#include "core/messages.h"
#include "core/sensors/registry.h"
#include "core/stage_profiler.h"
#include "sim/as_built/as_built_robot.h"
#include "sim/gas_plume.h"
#include "sim/lidar_scene.h"
#include "sim/sensors/delivery_queue.h"
#include "sim/sensors/fault_injector.h"
#include "sim/sensors/sensor.h"
#include "sim/sensors/sensor_suite_settings.h"
#include "sim/subsurface.h"

namespace patrol::sim {

/// All sensors of the robot, made from the registry. A message has the stamp of its device's clock and is delivered
/// after its sensor's latency and the random delay of its transport, in the order of its device. Faults of the scenario
/// change message and delivery.
class SensorSuite {
 public:
  /// `view` must outlive the suite; `plume` is in world. Throws InputError when an enabled sensor has no frame on the
  /// robot or requires something that the world lacks. Throws InputError also when the depth camera is enabled without
  /// `make_depth_imager`. With `has_thread`, lidars and depth camera are computed in a thread of their own, with the
  /// same messages.
  SensorSuite(const SensorSuiteSettings& settings, const AsBuiltRobot& robot, const mjModel& physics,
              const mjModel& view, const GasPlume& plume, const std::vector<FaultSettings>& faults, std::uint64_t seed,
              const DepthImagerFactory& make_depth_imager = {}, const Subsurface& subsurface = {},
              bool has_thread = false);

  /// Steps all sensors. Called once per tick, with kinematics and accelerations of `now` in `data`.
  void step(const mjModel& physics, mjData& data, Time now);

  /// Adds the reading of a sensor that another component models: teleoperation, servos of the antenna.
  template <IsSensorMessage Message>
  void add(const Message& reading) {
    deliver(reading.stamp, latency_s<Message>(settings_), reading);
  }

  /// Passes a command of the stack to the instruments. The antenna itself is moved by AntennaMount
  /// (sim/antenna_mount.h).
  void command(const InstrumentCommand& command);
  /// Returns whether an instrument is taking a measurement for which the robot must stand still.
  bool is_busy() const;

  /// Removes and returns the messages due by `now`, in order of delivery.
  std::vector<SensorMessage> take_due(Time now);

  /// Returns the readings of this tick for the firmware.
  const NewestReadings& newest() const { return newest_; }

  const std::vector<FaultStatus>& faults() const { return faults_.reports(); }
  /// Returns the computing time of the sensors that report it separately: "lidar", "depth_camera", "scanner".
  const StageProfiler& clock() const { return clock_; }
  /// Returns the computing time of the thread for expensive sensors.
  double thread_s() const { return worker_.busy_s(); }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive.section("sensors");
    queue_.for_each([this](QueuedMessage& queued) { complete(queued); });
    for (Channel& channel : channels_) archive(channel.num_messages, channel.last_due);
    for (Entry& entry : sensors_) archive(entry.sensor);
    archive(faults_, queue_, newest_, tick_, last_body_);
  }

 private:
  /// Way of one type of messages from the device to the stack.
  struct Channel {
    DeviceClock clock;
    std::uint64_t num_messages = 0;
    Time last_due{};
  };
  struct Entry {
    double latency_s;
    std::unique_ptr<Sensor> sensor;
  };
  struct BodyState {
    Time time;
    Pose3 T_world_body;
  };

  void complete(QueuedMessage& queued);
  void add_sensors(const SensorContext& context, bool are_read_by_firmware);
  void step_sensor(Entry& entry, const SensorTick& tick);
  /// `incomplete` is the sensor that still has to complete the message, or null.
  void deliver(Time ready, double latency_s, SensorMessage message, Sensor* incomplete = nullptr);

  SensorSuiteSettings settings_;
  std::array<Channel, std::variant_size_v<SensorMessage>> channels_;  ///< [type of the message]
  int body_;
  LidarScene scene_;
  BackgroundWorker worker_;
  std::vector<Entry> sensors_;  ///< sensors in the order of their steps
  FaultInjector faults_;
  DeliveryQueue queue_;
  NewestReadings newest_;
  StageProfiler clock_;
  std::uint64_t tick_ = 0;
  std::optional<BodyState> last_body_;
  std::vector<SensorMessage> readings_;  ///< readings of one sensor in one step
};

}  // namespace patrol::sim
