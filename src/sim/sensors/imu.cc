#include "sim/sensors/imu.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/geometry/angles.h"
#include "sim/sensors/sensor.h"

namespace patrol::sim {
namespace {

constexpr const char* kGyro = "imu/gyro";
constexpr const char* kAccel = "imu/accel";

double quantized(double value, double resolution) {
  return resolution > 0.0 ? resolution * std::round(value / resolution) : value;
}

}  // namespace

ImuSensor::ImuSensor(const ImuSettings& settings, const mjModel& model, std::uint64_t seed, const ImuErrors& errors)
    : site_(mj_name2id(&model, mjOBJ_SITE, "imu")),
      errors_(errors),
      gyro_(make_triad(seed, kGyro, gyro_sheet(settings), model.opt.timestep)),
      accel_(make_triad(seed, kAccel, accel_sheet(settings), model.opt.timestep)) {
  validate(settings, "sensors.imu");
  add_errors(errors.gyro, gyro_);
  add_errors(errors.accel, accel_);
}

ImuErrors ImuSensor::constant_biases(const ImuSettings& settings, std::uint64_t seed) {
  ImuErrors errors;
  constexpr double kTick_s = 1.0;  // biases do not depend on it
  errors.gyro.bias = make_triad(seed, kGyro, gyro_sheet(settings), kTick_s).bias;
  errors.accel.bias = make_triad(seed, kAccel, accel_sheet(settings), kTick_s).bias;
  return errors;
}

ImuSensor::TriadSheet ImuSensor::gyro_sheet(const ImuSettings& settings) {
  return {.noise_density = settings.gyro_noise_density_radps_per_sqrt_hz,
          .bias_std = settings.gyro_bias_std_radps,
          .bias_random_walk = settings.gyro_bias_random_walk_radps_per_sqrt_s,
          .range = settings.gyro_range_radps,
          .resolution = settings.gyro_resolution_radps,
          .scale_error_std = settings.scale_error_std,
          .misalignment_std_deg = settings.misalignment_std_deg};
}

ImuSensor::TriadSheet ImuSensor::accel_sheet(const ImuSettings& settings) {
  return {.noise_density = settings.accel_noise_density_mps2_per_sqrt_hz,
          .bias_std = settings.accel_bias_std_mps2,
          .bias_random_walk = settings.accel_bias_random_walk_mps2_per_sqrt_s,
          .range = settings.accel_range_mps2,
          .resolution = settings.accel_resolution_mps2,
          .scale_error_std = settings.scale_error_std,
          .misalignment_std_deg = settings.misalignment_std_deg};
}

void ImuSensor::add_errors(const TriadErrors& errors, Triad& triad) {
  triad.bias += errors.bias;
  triad.bias_per_k = errors.bias_per_k;
  triad.distortion += errors.distortion;
}

ImuSensor::Triad ImuSensor::make_triad(std::uint64_t seed, const char* name, const TriadSheet& sheet, double tick_s) {
  const std::string stream(name);
  const RandomStream constant(seed, stream + "/constant");
  Triad triad{.noise = RandomStream(seed, stream + "/noise"),
              .walk = RandomStream(seed, stream + "/walk"),
              .distortion = Eigen::Matrix3d::Identity(),
              .bias = Eigen::Vector3d::Zero(),
              .bias_per_k = Eigen::Vector3d::Zero(),
              .noise_std = sheet.noise_density / std::sqrt(tick_s),
              .walk_std = sheet.bias_random_walk * std::sqrt(tick_s),
              .range = sheet.range,
              .resolution = sheet.resolution};
  const double misalignment_rad = to_rad(sheet.misalignment_std_deg);
  std::uint64_t draw = 0;
  for (int row = 0; row < 3; ++row) {
    triad.bias[row] = sheet.bias_std * constant.normal(0, draw++);
    for (int col = 0; col < 3; ++col) {
      triad.distortion(row, col) +=
          (row == col ? sheet.scale_error_std : misalignment_rad) * constant.normal(0, draw++);
    }
  }
  return triad;
}

Eigen::Vector3d ImuSensor::measure(Triad& triad, const Eigen::Vector3d& truth, double temperature_rise_k,
                                   std::uint64_t tick) {
  Eigen::Vector3d reading = triad.distortion * truth + temperature_rise_k * triad.bias_per_k;
  for (int axis = 0; axis < 3; ++axis) {
    const auto index = static_cast<std::uint64_t>(axis);
    triad.bias[axis] += triad.walk_std * triad.walk.normal(tick, index);
    const double value = reading[axis] + triad.bias[axis] + triad.noise_std * triad.noise.normal(tick, index);
    reading[axis] = std::clamp(quantized(value, triad.resolution), -triad.range, triad.range);
  }
  return reading;
}

Imu ImuSensor::corrupt(const Eigen::Vector3d& rate_radps, const Eigen::Vector3d& force_mps2, Time now,
                       std::uint64_t tick) {
  const double rise_k = errors_.temperature_rise_k(now);
  return {.stamp = now,
          .angular_velocity_radps = measure(gyro_, rate_radps + errors_.g_sensitivity * force_mps2, rise_k, tick),
          .linear_acceleration_mps2 = measure(accel_, force_mps2, rise_k, tick)};
}

Imu ImuSensor::read(const mjModel& model, mjData& data, Time now, std::uint64_t tick) {
  // After mj_rnePostConstraint, MuJoCo's accelerations include gravity as an upward acceleration: the specific force.
  mj_rnePostConstraint(&model, &data);
  mjtNum velocity[6], acceleration[6];  // angular, then linear part, in the site's frame
  mj_objectVelocity(&model, &data, mjOBJ_SITE, site_, velocity, 1);
  mj_objectAcceleration(&model, &data, mjOBJ_SITE, site_, acceleration, 1);
  return corrupt(Eigen::Vector3d(velocity), Eigen::Vector3d(acceleration + 3), now, tick);
}

namespace {

class ImuOnBody : public Sensor {
 public:
  explicit ImuOnBody(const SensorContext& context)
      : is_enabled_(context.settings.imu.enabled),
        schedule_(context.settings.imu.rate_hz),
        imu_(context.settings.imu, context.physics, context.seed, context.as_built.imu()) {}

  void step(const SensorTick& tick, std::vector<SensorMessage>& readings) override {
    tick.newest.imu = imu_.read(tick.physics, tick.data, tick.now, tick.count);
    if (is_enabled_ && schedule_.is_due(tick.now)) readings.emplace_back(tick.newest.imu);
  }

  void serialize_state(StateArchive& archive) override { archive(schedule_, imu_); }

 private:
  bool is_enabled_;
  SensorSchedule schedule_;
  ImuSensor imu_;
};

}  // namespace

template <>
std::unique_ptr<Sensor> make_sensor<Imu>(const SensorContext& context) {
  return std::make_unique<ImuOnBody>(context);
}

}  // namespace patrol::sim
