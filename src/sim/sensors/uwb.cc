#include "sim/sensors/uwb.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>

#include "core/error.h"
#include "sim/mujoco.h"
#include "sim/sensors/sensor.h"

namespace patrol::sim {
namespace {

/// Returns the number in "uwb_anchor_<number>"; none for any other name.
std::optional<int> anchor_number(std::string_view name) {
  if (!name.starts_with(kUwbAnchor)) return std::nullopt;
  int number = 0;
  const char* const end = name.data() + name.size();
  const auto [stop, error] = std::from_chars(name.data() + kUwbAnchor.size(), end, number);
  if (error != std::errc() || stop != end) return std::nullopt;
  return number;
}

bool is_free(const LidarScene& scene, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d offset = to - from;
  const double length_m = offset.norm();
  return length_m <= 0.0 || !scene.cast(from, offset / length_m, length_m, kRayEverything);
}

}  // namespace

std::vector<UwbAnchor> uwb_anchors(const mjModel& view) {
  const DataPtr data = make_data(view);
  mj_kinematics(&view, data.get());
  std::vector<UwbAnchor> anchors;
  for (int site = 0; site < view.nsite; ++site) {
    const std::optional<int> number = anchor_number(name_of(view, mjOBJ_SITE, site));
    if (number) anchors.push_back({*number, Eigen::Vector3d(data->site_xpos + 3 * site)});
  }
  std::sort(anchors.begin(), anchors.end(), [](const auto& a, const auto& b) { return a.number < b.number; });
  return anchors;
}

double uwb_range_bias_m(double distance_m, double power_offset_db) {
  constexpr double kStrongest_dbm = -61.0, kStep_db = 2.0;
  constexpr std::array kBias_m = {-0.110, -0.105, -0.100, -0.093, -0.082, -0.069, -0.051, -0.027, 0.0,
                                  0.021,  0.035,  0.042,  0.049,  0.062,  0.071,  0.076,  0.081};
  constexpr double kSent_dbm = -14.3;  // -41.3 dBm/MHz over 500 MHz
  constexpr double kChannel2_hz = 3993.6e6, kLight_mps = 299792458.0;
  const double path_loss_db =
      20.0 * std::log10(4.0 * std::numbers::pi * kChannel2_hz * std::max(distance_m, 0.01) / kLight_mps);
  const double row =
      std::clamp((kStrongest_dbm - (kSent_dbm - path_loss_db + power_offset_db)) / kStep_db, 0.0, kBias_m.size() - 1.0);
  const auto above = static_cast<std::size_t>(std::min(row, kBias_m.size() - 2.0));
  return kBias_m[above] + (row - static_cast<double>(above)) * (kBias_m[above + 1] - kBias_m[above]);
}

bool is_uwb_path_nlos(const LidarScene& scene, const Eigen::Vector3d& p_world_antenna,
                      const Eigen::Vector3d& p_world_anchor) {
  constexpr double kHousing_m = 0.1;     // radius of the housings of antenna and anchor; objects inside are ignored
  constexpr double kPathRadius_m = 0.1;  // radius of the bundle halfway; thinner objects are passed by diffraction
  constexpr int kLines = 6;              // lines around the direct one
  const Eigen::Vector3d offset = p_world_anchor - p_world_antenna;
  if (offset.norm() <= 2.0 * kHousing_m) return false;
  const Eigen::Vector3d along = offset.normalized();
  const Eigen::Vector3d start = p_world_antenna + kHousing_m * along, end = p_world_anchor - kHousing_m * along;
  const Eigen::Vector3d middle = 0.5 * (start + end);
  const Eigen::Vector3d across = along.unitOrthogonal(), other = along.cross(across);
  int blocked = is_free(scene, start, end) ? 0 : 1;
  for (int line = 0; line < kLines; ++line) {
    const double angle = (line + 0.25) * 2.0 * std::numbers::pi / kLines;
    const Eigen::Vector3d via = middle + kPathRadius_m * (std::cos(angle) * across + std::sin(angle) * other);
    if (!is_free(scene, start, via) || !is_free(scene, via, end)) ++blocked;
  }
  return 2 * blocked > kLines + 1;
}

Uwb::Uwb(const UwbSettings& settings, const mjModel& view, std::uint64_t seed, const UwbPower& power)
    : settings_(settings),
      anchors_(uwb_anchors(view)),
      power_(power),
      noise_(seed, "uwb/noise"),
      loss_(seed, "uwb/loss"),
      nlos_loss_(seed, "uwb/blocked_loss"),
      nlos_bias_(seed, "uwb/excess") {
  validate(settings, "sensors.uwb");
  if (anchors_.empty()) throw InputError("sensors.uwb.enabled = true: requires a world site named uwb_anchor_<number>");
}

const UwbAnchor* Uwb::next_in_range(const Eigen::Vector3d& p_world_antenna) {
  for (std::size_t asked = 0; asked < anchors_.size(); ++asked) {
    const UwbAnchor& anchor = anchors_[turn_];
    turn_ = (turn_ + 1) % anchors_.size();
    if ((anchor.p_world - p_world_antenna).norm() <= settings_.range_max_m) return &anchor;
  }
  return nullptr;
}

std::optional<UwbRange> Uwb::read(const LidarScene& scene, const Eigen::Vector3d& p_world_antenna, Time now,
                                  std::uint64_t tick) {
  const UwbAnchor* anchor = next_in_range(p_world_antenna);
  if (anchor == nullptr) return std::nullopt;
  const auto index = static_cast<std::uint64_t>(anchor->number);
  const double distance_m = (anchor->p_world - p_world_antenna).norm();
  // Assumption: the loss probability rises with the fourth power of the distance.
  const double loss = settings_.loss_probability +
                      (1.0 - settings_.loss_probability) * std::pow(distance_m / settings_.range_max_m, 4.0);
  if (loss_.uniform(tick, index) < loss) return std::nullopt;

  UwbRange range{.stamp = now, .anchor = anchor->number};
  const double power_offset_db = power_.offset_db(anchor->number, p_world_antenna - anchor->p_world);
  range.range_m = distance_m + settings_.bias_scale * uwb_range_bias_m(distance_m, power_offset_db) +
                  settings_.range_noise_std_m * noise_.normal(tick, index);
  if (is_uwb_path_nlos(scene, p_world_antenna, anchor->p_world)) {
    if (nlos_loss_.uniform(tick, index) < settings_.nlos_loss_probability) return std::nullopt;
    range.range_m -= settings_.nlos_bias_m * std::log(nlos_bias_.uniform(tick, index));
  }
  range.range_m = std::max(range.range_m, 0.0);
  return range;
}

namespace {

class UwbOnBody : public PeriodicSensor {
 public:
  explicit UwbOnBody(const SensorContext& context)
      : PeriodicSensor(context.settings.uwb.rate_hz),
        scene_(context.scene),
        as_built_(context.as_built),
        T_body_uwb_(context.robot.T_body("uwb")),
        uwb_(context.settings.uwb, context.view, context.seed, context.as_built.uwb_power()) {}

  void serialize_state(StateArchive& archive) override {
    PeriodicSensor::serialize_state(archive);
    archive(uwb_);
  }

 private:
  void read(const SensorTick& tick, std::uint64_t index, std::vector<SensorMessage>& readings) override {
    auto range = uwb_.read(scene_, tick.T_world_body * T_body_uwb_.position, tick.now, index);
    if (!range) return;
    range->range_m = std::max(range->range_m + as_built_.uwb_delay_m(range->anchor), 0.0);
    readings.emplace_back(*range);
  }

  const LidarScene& scene_;
  AsBuiltRobot as_built_;
  Pose3 T_body_uwb_;
  Uwb uwb_;
};

}  // namespace

template <>
std::unique_ptr<Sensor> make_sensor<UwbRange>(const SensorContext& context) {
  return context.settings.uwb.enabled ? std::make_unique<UwbOnBody>(context) : nullptr;
}

}  // namespace patrol::sim
