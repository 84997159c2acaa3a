#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "sim/sensors/lidar.h"
#include "sim/sensors/sensor.h"

namespace patrol::sim {
namespace {

/// Lidar that publishes its scans as messages of the type `Scan`.
template <typename Scan>
class LidarOnBody : public Sensor {
 public:
  LidarOnBody(const SensorContext& context, const LidarSettings& settings, const std::string& frame, RayMask housing)
      : lidar_(settings, context.scene, context.robot.T_body(frame), housing, context.seed, frame,
               context.settings.dust, context.as_built.lidar(frame), &context.worker) {}

  void step(const SensorTick& tick, std::vector<SensorMessage>& readings) override {
    if (tick.is_first()) return;
    const auto timer = tick.clock.time_stage("lidar");
    lidar_.advance(tick.last, tick.now, tick.T_world_body_last, tick.T_world_body);
    for (Lidar::FiredRevolution& fired : lidar_.take_fired()) {
      if (lidar_.has_rings()) {
        readings.emplace_back(std::in_place_type<PointCloud>);
        std::get<PointCloud>(readings.back()).stamp = fired.revolution->cloud.stamp;
      } else {
        readings.emplace_back(std::in_place_type<Scan>);
        std::get<Scan>(readings.back()).stamp = fired.revolution->scan.stamp;
      }
      fired_.push_back(std::move(fired));
    }
  }

  void complete(SensorMessage& reading) override {
    Lidar::Revolution& measured = lidar_.measured(fired_.front());
    if (lidar_.has_rings()) reading = std::move(measured.cloud);
    else reading = Scan{std::move(measured.scan)};
    fired_.pop_front();
  }

  void serialize_state(StateArchive& archive) override { archive(lidar_); }

 private:
  Lidar lidar_;
  std::deque<Lidar::FiredRevolution> fired_;  ///< revolutions whose messages have to be completed, in order
};

}  // namespace

template <>
std::unique_ptr<Sensor> make_sensor<LaserScan>(const SensorContext& context) {
  const LidarSettings& settings = context.settings.lidar;
  return settings.enabled ? std::make_unique<LidarOnBody<LaserScan>>(context, settings, "lidar", kRayLidar2d) : nullptr;
}

template <>
std::unique_ptr<Sensor> make_sensor<PointCloud>(const SensorContext& context) {
  const LidarSettings& settings = context.settings.lidar3d;
  return settings.enabled ? std::make_unique<LidarOnBody<LaserScan>>(context, settings, "lidar3d", kRayLidar3d)
                          : nullptr;
}

template <>
std::unique_ptr<Sensor> make_sensor<RearLaserScan>(const SensorContext& context) {
  const LidarSettings& settings = context.settings.lidar_rear;
  return settings.enabled ? std::make_unique<LidarOnBody<RearLaserScan>>(context, settings, "lidar_rear", kRayLidarRear)
                          : nullptr;
}

}  // namespace patrol::sim
