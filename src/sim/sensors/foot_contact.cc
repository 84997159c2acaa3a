#include "sim/sensors/foot_contact.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "sim/sensors/sensor.h"

namespace patrol::sim {

FootContactSensor::FootContactSensor(const FootContactSettings& settings, const mjModel& model,
                                     const std::vector<LegGeometry>& legs, std::uint64_t seed)
    : settings_(settings), noise_(seed, "foot_contact/noise") {
  validate(settings, "sensors.foot_contact");
  const RandomStream offset(seed, "foot_contact/offset");
  for (const LegGeometry& leg : legs) {
    const int geom = mj_name2id(&model, mjOBJ_GEOM, leg.foot_link.c_str());
    if (geom < 0) throw InputError("robot model: foot geom not found: " + leg.foot_link);
    offset_n_.push_back(settings.offset_std_n * offset.normal(0, foot_geoms_.size()));
    foot_geoms_.push_back(geom);
  }
}

FootContacts FootContactSensor::read(const mjModel& model, const mjData& data, Time now, std::uint64_t tick) const {
  FootContacts contacts{.stamp = now, .force_n = std::vector<double>(foot_geoms_.size(), 0.0)};
  for (int i = 0; i < data.ncon; ++i) {
    for (std::size_t leg = 0; leg < foot_geoms_.size(); ++leg) {
      const mjContact& contact = data.contact[i];
      if (contact.geom[0] != foot_geoms_[leg] && contact.geom[1] != foot_geoms_[leg]) continue;
      mjtNum force[6];  // force[0] is the normal force
      mj_contactForce(&model, &data, i, force);
      contacts.force_n[leg] += force[0];
    }
  }
  for (std::size_t leg = 0; leg < foot_geoms_.size(); ++leg) {
    double& force = contacts.force_n[leg];
    force += offset_n_[leg] + settings_.noise_std_n * noise_.normal(tick, leg);
    if (settings_.resolution_n > 0.0) force = settings_.resolution_n * std::round(force / settings_.resolution_n);
    force = std::clamp(force, -settings_.range_n, settings_.range_n);
  }
  return contacts;
}

namespace {

class SensorsOnFeet : public Sensor {
 public:
  explicit SensorsOnFeet(const SensorContext& context)
      : is_enabled_(context.settings.foot_contact.enabled && is_fitted<FootContacts>(context.robot)),
        schedule_(context.settings.foot_contact.rate_hz),
        feet_(context.settings.foot_contact, context.physics, context.robot.legs, context.seed) {}

  void step(const SensorTick& tick, std::vector<SensorMessage>& readings) override {
    tick.newest.feet = feet_.read(tick.physics, tick.data, tick.now, tick.count);
    if (is_enabled_ && schedule_.is_due(tick.now)) readings.emplace_back(tick.newest.feet);
  }

  void serialize_state(StateArchive& archive) override { archive(schedule_); }

 private:
  bool is_enabled_;
  SensorSchedule schedule_;
  FootContactSensor feet_;
};

}  // namespace

template <>
std::unique_ptr<Sensor> make_sensor<FootContacts>(const SensorContext& context) {
  return std::make_unique<SensorsOnFeet>(context);
}

}  // namespace patrol::sim
