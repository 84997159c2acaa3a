#include "sim/sensors/tem.h"

#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "sim/sensors/sensor.h"

namespace patrol::sim {
namespace {

TemGateLayout reported_window(const TemSettings& settings) {
  validate(settings, "sensors.tem");
  TemGateLayout window{.gate_s = {}, .ramp_s = settings.ramp_s, .gate_width = settings.relative_gate_width};
  const double step = std::pow(10.0, 1.0 / settings.gates_per_decade);
  // Rounding must not remove the gate at the upper limit.
  for (double gate_s = settings.first_gate_s; gate_s <= (1.0 + 1e-9) * settings.last_gate_s; gate_s *= step)
    window.gate_s.push_back(gate_s);
  if (window.gate_s.size() < 3) {
    throw InputError(fmt::format("sensors.tem.last_gate_s = {}: must leave at least three gates after first_gate_s",
                                 settings.last_gate_s));
  }
  return window;
}

TemGateLayout shift(TemGateLayout window, double shift_s) {
  for (double& gate_s : window.gate_s) gate_s += shift_s;
  return window;
}

/// Returns the decay of the steel response, normalized to 1 at 10 us.
double steel_decay(double time_s) {
  struct Part {
    double weight, tau_s;
  };
  constexpr std::array<Part, 3> kParts = {{{0.70, 15e-6}, {0.22, 60e-6}, {0.08, 250e-6}}};
  double now = 0.0, at_10us = 0.0;
  for (const Part& part : kParts) {
    now += part.weight * std::exp(-time_s / part.tau_s);
    at_10us += part.weight * std::exp(-10e-6 / part.tau_s);
  }
  return now / at_10us;
}

}  // namespace

Tem::Tem(const TemSettings& settings, const RockSettings& rock, std::vector<WaterBodySettings> bodies,
         std::uint64_t seed)
    : settings_(settings),
      window_(reported_window(settings)),
      // The actual gates, with the time shift.
      subsurface_(sample_subsurface({rock, std::move(bodies)}, seed),
                  TemGates(shift(window_, settings.time_shift_std_s * RandomStream(seed, "tem/time_shift").normal(0)))),
      gain_(1.0 + settings.gain_std * RandomStream(seed, "tem/gain").normal(0)),
      noise_(seed, "tem/noise"),
      relative_noise_(seed, "tem/relative_noise"),
      current_(seed, "tem/current") {
  const RandomStream steel(seed, "tem/steel");
  steel_rate_ = settings.steel_response * std::exp(settings.steel_log_std * steel.normal(0));
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) {
      const double entry = settings.steel_anisotropy_std * steel.normal(1, static_cast<std::uint64_t>(3 * i + j));
      steel_form_(i, j) = steel_form_(j, i) = entry;
    }
  }
}

void Tem::start(Time now) {
  if (start_) return;
  start_ = now;
  ticks_ = 0;
  sum_p_.setZero();
  sum_axes_.setZero();
}

std::optional<TemSounding> Tem::step(const Pose3& T_world_tem, Time now) {
  if (!start_) return std::nullopt;
  const Eigen::Vector3d axis = T_world_tem.rotation * Eigen::Vector3d::UnitX();
  ++ticks_;
  sum_p_ += T_world_tem.position;
  sum_axes_ += axis * axis.transpose();
  if (now - *start_ < from_seconds(settings_.stacking_s)) return std::nullopt;
  start_.reset();
  return sound(sum_p_ / ticks_, sum_axes_ / ticks_, count_++, now);
}

TemSounding Tem::sound(const Eigen::Vector3d& p_world, const Eigen::Matrix3d& axes, std::uint64_t count,
                       Time end) const {
  const Eigen::VectorXd rate = subsurface_.gated_rate(p_world, axes);
  const double steel = steel_rate_ * (1.0 + steel_form_.cwiseProduct(axes).sum());

  TemSounding sounding{
      .stamp = end, .moment_am2 = settings_.moment_am2, .gate_s = window_.gate_s, .rate_tps = {}, .std_tps = {}};
  const double moment_am2 = settings_.moment_am2 * (1.0 + settings_.relative_moment_std * current_.normal(count));
  for (std::size_t gate = 0; gate < window_.gate_s.size(); ++gate) {
    const double gate_s = window_.gate_s[gate];
    const double clean_tps = gain_ * moment_am2 * (rate[static_cast<Eigen::Index>(gate)] + steel * steel_decay(gate_s));
    const double noise_std_tps = settings_.noise_std_tps / std::sqrt(settings_.stacking_s * gate_s / 1e-3);
    const double relative_tps = settings_.relative_noise_std * clean_tps;
    sounding.rate_tps.push_back(clean_tps + noise_std_tps * noise_.normal(count, gate) +
                                relative_tps * relative_noise_.normal(count, gate));
    sounding.std_tps.push_back(std::hypot(noise_std_tps, relative_tps));
  }
  return sounding;
}

namespace {

class TemOnMount : public Sensor {
 public:
  explicit TemOnMount(const SensorContext& context)
      : coil_(mj_name2id(&context.physics, mjOBJ_BODY, "tem")),
        tem_(context.settings.tem, context.subsurface.rock, context.subsurface.water_bodies, context.seed) {}

  void step(const SensorTick& tick, std::vector<SensorMessage>& readings) override {
    if (!tem_.is_sounding()) return;
    const mjtNum* position = tick.data.xpos + 3 * coil_;
    const mjtNum* q = tick.data.xquat + 4 * coil_;
    const Pose3 T_world_tem{Eigen::Vector3d(position), Eigen::Quaterniond(q[0], q[1], q[2], q[3])};
    const std::optional<TemSounding> sounding = tem_.step(T_world_tem, tick.now);
    if (sounding) readings.emplace_back(*sounding);
  }
  void command(const InstrumentCommand& command, Time now, const Pose3&) override {
    if (std::holds_alternative<SoundingCommand>(command)) tem_.start(now);
  }
  bool is_busy() const override { return tem_.is_sounding(); }

  void serialize_state(StateArchive& archive) override { archive(tem_); }

 private:
  int coil_;  ///< body id of the link `tem`
  Tem tem_;
};

}  // namespace

template <>
std::unique_ptr<Sensor> make_sensor<TemSounding>(const SensorContext& context) {
  if (!context.settings.tem.enabled) return nullptr;
  if (!context.robot.antenna) throw InputError("robot " + context.robot.name + ": link not found: tem_mount");
  return std::make_unique<TemOnMount>(context);
}

}  // namespace patrol::sim
