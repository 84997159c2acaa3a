#include "sim/sensors/magnetometer.h"

#include <cmath>
#include <numbers>

#include "core/geometry/angles.h"
#include "sim/sensors/sensor.h"
#include "sim/sensors/surface_optics.h"

namespace patrol::sim {
namespace {

Eigen::Vector3d geomagnetic_field_t(const MagnetometerSettings& settings) {
  const double inclination = settings.inclination_deg * kDegree, declination = settings.declination_deg * kDegree;
  const double horizontal = std::cos(inclination);
  return settings.intensity_t * Eigen::Vector3d(horizontal * std::sin(declination), horizontal * std::cos(declination),
                                                -std::sin(inclination));
}

bool is_steel(const mjModel& model, int geom, const std::vector<std::string>& words) {
  if (model.geom_type[geom] == mjGEOM_PLANE || model.geom_type[geom] == mjGEOM_HFIELD) return false;
  return is_named_after(model, geom, words);
}

Eigen::Quaterniond rotation_of(const mjtNum* q) { return {q[0], q[1], q[2], q[3]}; }

}  // namespace

Magnetometer::Magnetometer(const MagnetometerSettings& settings, const mjModel& view, std::uint64_t seed)
    : settings_(settings), geomagnetic_t_(geomagnetic_field_t(settings)), noise_(seed, "magnetometer/noise") {
  validate(settings, "sensors.magnetometer");
  const int robot = mj_name2id(&view, mjOBJ_BODY, frame_id::kBody);
  for (int geom = 0; geom < view.ngeom; ++geom) {
    const int body = view.geom_bodyid[geom];
    const bool is_of_robot = view.body_rootid[body] == robot;
    if (settings.steel_fill <= 0.0 || is_of_robot || !is_steel(view, geom, settings.steel_names)) continue;
    const mjtNum* box = view.geom_aabb + 6 * geom;  // center, half sizes; in the geom's frame
    const double volume_m3 = settings.steel_fill * 8.0 * box[3] * box[4] * box[5];
    const Eigen::Vector3d center = rotation_of(view.geom_quat + 4 * geom) * Eigen::Vector3d(box);
    steel_.push_back({.body = body,
                      .p_body = Eigen::Vector3d(view.geom_pos + 3 * geom) + center,
                      .radius_m = std::cbrt(0.75 * volume_m3 / std::numbers::pi)});
  }
  const RandomStream iron(seed, "magnetometer/iron");
  for (int i = 0; i < 3; ++i) {
    hard_iron_t_[i] = settings.hard_iron_std_t * iron.normal(0, static_cast<std::uint64_t>(i));
    for (int j = 0; j <= i; ++j) {
      const double entry = settings.soft_iron_std * iron.normal(1, static_cast<std::uint64_t>(3 * i + j));
      soft_iron_(i, j) += entry;
      if (j != i) soft_iron_(j, i) += entry;
    }
  }
}

Eigen::Vector3d Magnetometer::field_t(const mjData& data, const Eigen::Vector3d& p_world) const {
  Eigen::Vector3d field_t = geomagnetic_t_;
  for (const SteelSphere& sphere : steel_) {
    const Eigen::Quaterniond rotation = rotation_of(data.xquat + 4 * sphere.body);
    const Eigen::Vector3d center = Eigen::Vector3d(data.xpos + 3 * sphere.body) + rotation * sphere.p_body;
    const Eigen::Vector3d offset = p_world - center;
    const double distance_m = std::max(offset.norm(), sphere.radius_m);  // clamped to the surface of the sphere
    const Eigen::Vector3d direction = offset.normalized();
    // At high permeability, mu0 / (4 pi) times the dipole moment is radius^3 times the field.
    const double ratio = std::pow(sphere.radius_m / distance_m, 3);
    field_t += ratio * (3.0 * direction.dot(geomagnetic_t_) * direction - geomagnetic_t_);
  }
  return field_t;
}

MagneticField Magnetometer::measure(const Eigen::Vector3d& field_t, Time now, std::uint64_t index) const {
  MagneticField reading{.stamp = now, .field_t = soft_iron_ * field_t + hard_iron_t_, .std_t = settings_.noise_std_t};
  for (int axis = 0; axis < 3; ++axis) {
    double& value_t = reading.field_t[axis];
    value_t += settings_.noise_std_t * noise_.normal(index, static_cast<std::uint64_t>(axis));
    if (settings_.resolution_t > 0.0) value_t = settings_.resolution_t * std::round(value_t / settings_.resolution_t);
    value_t = std::clamp(value_t, -settings_.range_t, settings_.range_t);
  }
  return reading;
}

MagneticField Magnetometer::read(const mjData& data, const Pose3& T_world_sensor, Time now, std::uint64_t index) const {
  return measure(T_world_sensor.rotation.inverse() * field_t(data, T_world_sensor.position), now, index);
}

namespace {

class MagnetometerOnBody : public PeriodicSensor {
 public:
  explicit MagnetometerOnBody(const SensorContext& context)
      : PeriodicSensor(context.settings.magnetometer.rate_hz),
        T_body_imu_(context.robot.T_body("imu")),
        magnetometer_(context.settings.magnetometer, context.view, context.seed) {}

 private:
  void read(const SensorTick& tick, std::uint64_t index, std::vector<SensorMessage>& readings) override {
    readings.emplace_back(magnetometer_.read(tick.data, tick.T_world_body * T_body_imu_, tick.now, index));
  }

  Pose3 T_body_imu_;
  Magnetometer magnetometer_;
};

}  // namespace

template <>
std::unique_ptr<Sensor> make_sensor<MagneticField>(const SensorContext& context) {
  return context.settings.magnetometer.enabled ? std::make_unique<MagnetometerOnBody>(context) : nullptr;
}

}  // namespace patrol::sim
