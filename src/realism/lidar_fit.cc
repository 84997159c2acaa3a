#include "realism/lidar_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "core/geometry/angles.h"
#include "realism/edge_fit.h"
#include "realism/expected_scan.h"
#include "realism/hit_fit.h"
#include "realism/range_step.h"
#include "realism/return_fit.h"

namespace patrol::realism {
namespace {

constexpr double kMaxIncidence_deg = 90.0, kMaxReach_m = 100.0;
constexpr double kMaxHitIncidence_deg = 80.0;  ///< incidence up to which the site's normals are used for noise

double incidence_deg(const Beam& beam) { return std::acos(std::clamp(beam.expected.cosine, -1.0, 1.0)) * kDegPerRad; }

/// Maximum range on 10 % reflectivity from which on the surface of the beam returns.
double needed_reach_m(const Beam& beam) {
  return beam.expected.range_m /
         std::sqrt(beam.expected.reflectivity * std::sqrt(std::max(1e-6, beam.expected.cosine)) / 0.1);
}

/// Limits of incidence and range, with what they leave of the beams.
struct Limits {
  LimitFit incidence, reach;

  bool is_inside(const Beam& beam, double margin_deg, double factor) const {
    return incidence_deg(beam) < incidence.value - margin_deg && needed_reach_m(beam) < factor * reach.value;
  }
};

class Fitter {
 public:
  Fitter(const Site& site, const ScanSet& set, const LidarDevice& base, const LidarFitSettings& settings)
      : site_(site), set_(set), settings_(settings), device_(base) {}

  LidarFit fit() {
    fit_step();
    limits_ = fit_limits(0.05);
    fit_noise();
    limits_ = fit_limits(hits_.values[kAngleNoise_rad] * kDegPerRad);
    add_limits();
    fit_dropout();
    fit_edges();
    return std::move(result_);
  }

 private:
  std::size_t block_of(const Beam& beam) const {
    return static_cast<std::size_t>(beam.scan) * static_cast<std::size_t>(settings_.blocks) / set_.scans.size();
  }
  double range_max_m(const Beam& beam) const { return set_.scans[beam.scan].scan.range_max_m; }

  /// Whether the beam shows if its surface returns.
  bool is_return_sample(const Beam& beam) const {
    return beam.expected.is_smooth && !beam.expected.is_glass && beam.kind != BeamClass::kNear &&
           beam.kind != BeamClass::kMoving && beam.expected.range_m < range_max_m(beam) - 0.5;
  }

  void add(FittedParameter parameter) { result_.parameters.push_back(std::move(parameter)); }

  void fit_step() {
    std::vector<float> ranges_m;
    for (const PosedScan& posed : set_.scans) {
      if (ranges_m.size() > 200000) break;
      ranges_m.insert(ranges_m.end(), posed.scan.ranges_m.begin(), posed.scan.ranges_m.end());
    }
    FittedParameter step = fit_range_step(ranges_m);
    device_.settings.range_quantization_m = step.is_seen ? step.value : 0.0;
    add(std::move(step));
  }

  LimitFit fit_incidence(double reach_m, double angle_noise_deg) const {
    std::vector<ReturnSample> samples;
    const double blur = std::max(0.02, std::hypot(angle_noise_deg, settings_.path_yaw_std_deg));
    for (const Beam& beam : set_.beams) {
      if (!is_return_sample(beam) || needed_reach_m(beam) > 0.9 * reach_m) continue;
      samples.push_back({incidence_deg(beam), blur, beam.is_return(), block_of(beam)});
    }
    return fit_limit(std::move(samples), kMaxIncidence_deg);
  }

  LimitFit fit_reach(double max_incidence_deg, double angle_noise_deg) const {
    std::vector<ReturnSample> samples;
    const double angle_rad = std::hypot(angle_noise_deg, settings_.path_yaw_std_deg) * kDegree;
    for (const Beam& beam : set_.beams) {
      if (!is_return_sample(beam) || incidence_deg(beam) > std::min(75.0, max_incidence_deg - 2.0)) continue;
      const double range_std_m = std::hypot(1.25 * beam.expected.slope_m_per_rad * angle_rad, settings_.path_std_m);
      const double reach_m = needed_reach_m(beam);
      const double blur = reach_m * std::clamp(range_std_m / beam.expected.range_m, 1e-3, 0.05);
      samples.push_back({reach_m, blur, beam.is_return(), block_of(beam)});
    }
    return fit_limit(std::move(samples), kMaxReach_m);
  }

  Limits fit_limits(double angle_noise_deg) const {
    std::vector<TwoLimitSample> samples;
    for (const Beam& beam : set_.beams) {
      if (is_return_sample(beam)) samples.push_back({incidence_deg(beam), needed_reach_m(beam), beam.is_return()});
    }
    const double reach_m = rough_limits(samples, kMaxIncidence_deg, kMaxReach_m).second;
    Limits limits;
    limits.incidence = fit_incidence(reach_m, angle_noise_deg);
    limits.reach = fit_reach(limits.incidence.value, angle_noise_deg);
    limits.incidence = fit_incidence(limits.reach.value, angle_noise_deg);
    return limits;
  }

  /// Samples below `angle_noise_rad` and the step of the beams do not differ by the jump of a mixed pixel.
  std::vector<HitSample> hit_samples(double angle_noise_rad) const {
    std::vector<HitSample> samples;
    for (const Beam& beam : set_.beams) {
      const bool is_hit =
          beam.kind == BeamClass::kStatic || beam.kind == BeamClass::kShort || beam.kind == BeamClass::kFar;
      if (!is_hit || incidence_deg(beam) > kMaxHitIncidence_deg || !limits_.is_inside(beam, 2.0, 0.95)) continue;
      // After a jump of the range, the range is a mean over the beam width.
      const double step_rad = std::abs(set_.scans[beam.scan].scan.angle_increment_rad) + 4.3 * angle_noise_rad;
      if (std::abs(beam.expected.slope_m_per_rad) * step_rad > 0.1) continue;
      samples.push_back({.residual_m = beam.residual_m(),
                         .range_m = beam.expected.range_m,
                         .slope_m_per_rad = beam.expected.slope_m_per_rad,
                         .cosine = beam.expected.cosine,
                         .darkness = std::log(0.5 / std::min(1.0, beam.expected.reflectivity)) / std::log(5.0),
                         .block = block_of(beam)});
    }
    return thinned(samples, static_cast<std::size_t>(settings_.max_hits));
  }

  /// Returns at most `count` samples, evenly over the log.
  static std::vector<HitSample> thinned(const std::vector<HitSample>& samples, std::size_t count) {
    if (samples.size() <= count) return samples;
    std::vector<HitSample> kept;
    for (std::size_t k = 0; k < count; ++k) kept.push_back(samples[k * samples.size() / count]);
    return kept;
  }

  /// Systematic errors that the log does not constrain are named and fixed at zero for the others.
  void fit_noise() {
    const LaserScan& scan = set_.scans.front().scan;
    HitModel model{.range_step_m = device_.settings.range_quantization_m,
                   .range_max_m = scan.range_max_m,
                   .range_min_m = scan.range_min_m};
    const double angle_noise_rad =
        fit_hits(thinned(hit_samples(0.1 * kDegree), 5000), model, false).values[kAngleNoise_rad];
    const std::vector<HitSample> samples = hit_samples(angle_noise_rad);
    const HitFit first = fit_hits(samples, model);
    const auto is_loose = [&](std::size_t j, double half_width) {
      return !first.is_free[j] || first.high[j] - first.low[j] > 2.0 * half_width;
    };
    model.is_fixed[kScale] = is_loose(kScale, 0.005);
    model.is_fixed[kIncidence_m] = is_loose(kIncidence_m, 0.03);
    model.is_fixed[kReflectivity_m] = is_loose(kReflectivity_m, 0.02);
    const bool is_any_fixed = std::ranges::find(model.is_fixed, true) != model.is_fixed.end();
    hits_ = is_any_fixed ? fit_hits(samples, model) : first;
    result_.num_hits = hits_.num_samples;
    result_.outlier_ratio = hits_.values[kOutlierRatio];
    // A false return beside another one on a similar range is taken for an unmapped object.
    const double lost_per_rate_m = 4.0 * set_.rules.neighbor_m;
    for (HitVector* values : {&hits_.values, &hits_.low, &hits_.high})
      (*values)[kFalseRate_per_m] /= 1.0 - std::min(0.5, lost_per_rate_m * (*values)[kFalseRate_per_m]);
    for (HitVector* values : {&hits_.values, &hits_.low, &hits_.high}) (*values)[kNoise_m] *= set_.noise_factor;
    add_noise(first, model);
    device_.settings.range_noise_std_m = hits_.values[kNoise_m];
    device_.settings.wide_noise_probability = hits_.is_free[kWideProbability] ? hits_.values[kWideProbability] : 0.0;
    device_.settings.wide_noise_std_m = hits_.is_free[kWideNoise_m] ? hits_.values[kWideNoise_m] : 0.0;
    device_.settings.false_return_rate_per_m = hits_.values[kFalseRate_per_m];
    device_.settings.range_max_m = model.range_max_m;
    device_.errors = {.noise_ratio = 1.0,
                      .range_offset_m = hits_.values[kOffset_m],
                      .range_scale = hits_.values[kScale],
                      .reflectivity_m = hits_.values[kReflectivity_m],
                      .incidence_m = hits_.values[kIncidence_m]};
  }

  static FittedParameter parameter_of(const char* name, const HitFit& fit, std::size_t j, double factor = 1.0) {
    constexpr double kUnbounded = std::numeric_limits<double>::infinity();
    if (!fit.is_free[j]) return {.name = name, .low = j < kNoise_m ? -kUnbounded : 0.0, .high = kUnbounded};
    return {.name = name,
            .value = factor * fit.values[j],
            .low = factor * fit.low[j],
            .high = factor * fit.high[j],
            .is_seen = fit.is_free[j]};
  }

  void add_noise(const HitFit& first, const HitModel& model) {
    const bool has_samples = hits_.num_samples >= 100;
    const std::string too_few = fmt::format("only {} returns on smooth surfaces", hits_.num_samples);
    const auto positive = [&](const char* name, std::size_t j, double factor, const std::string& zero,
                              const std::string& fixed) {
      FittedParameter p = parameter_of(name, hits_, j, factor);
      p.is_seen = has_samples && p.is_seen && p.low > 0.0;
      if (!p.is_seen) p.reason = !has_samples ? too_few : hits_.is_free[j] ? zero : fixed;
      add(std::move(p));
    };
    positive("range_noise_std_m", kNoise_m, 1.0, "consistent with 0 beside the quantization step and the angle noise",
             "");
    const std::string no_tails = "the residuals have no longer tails than noise, false returns and outliers";
    positive("wide_noise_probability", kWideProbability, 1.0, no_tails, no_tails);
    positive("wide_noise_std_m", kWideNoise_m, 1.0, no_tails, no_tails);
    const auto systematic = [&](const char* name, std::size_t j, const std::string& loose) {
      const bool is_fixed = model.is_fixed[j];
      FittedParameter p = parameter_of(name, is_fixed ? first : hits_, j);
      p.is_seen = has_samples && p.is_seen && !is_fixed;
      p.low = p.value - set_.interval_factors[j] * (p.value - p.low);
      p.high = p.value + set_.interval_factors[j] * (p.high - p.value);
      if (!p.is_seen) p.reason = has_samples ? loose : too_few;
      add(std::move(p));
    };
    systematic("measured_range_offset_m", kOffset_m, "");
    FittedParameter& offset = result_.parameters.back();
    if (set_.absorbed_bias > 0.9 && offset.is_seen) {
      offset.is_seen = false;
      offset.reason = fmt::format(
          "the alignment of the scans removes {:.0f} % of a constant range error: the surfaces "
          "are on one side of the lidar",
          100.0 * set_.absorbed_bias);
    }
    systematic("measured_range_scale", kScale,
               fmt::format("the ranges vary by only {:.2f} m (standard deviation)", first.range_spread_m));
    systematic("measured_incidence_m", kIncidence_m, "the angles of incidence vary too little");
    systematic("measured_reflectivity_m", kReflectivity_m, "the surfaces of the site have nearly one reflectivity");
    positive("angle_noise_std_deg", kAngleNoise_rad, kDegPerRad,
             "consistent with 0: below the range noise on the slopes in the log", "all walls are seen head-on");
    positive("false_return_rate_per_m", kFalseRate_per_m, 1.0,
             "consistent with 0: no isolated returns before the surfaces beyond the outliers", "");
  }

  void add_limits() {
    const LimitFit& incidence = limits_.incidence;
    FittedParameter angle{.name = "max_incidence_deg",
                          .value = incidence.value,
                          .low = std::min(incidence.low, kMaxIncidence_deg),
                          .high = std::min(incidence.high, kMaxIncidence_deg),
                          .is_seen = incidence.has_upper};
    if (!angle.is_seen)
      angle.reason =
          fmt::format("most beams return up to the largest angles in the log; not below {:.0f} deg", angle.low);
    angle.value = std::min(angle.value, kMaxIncidence_deg);
    add(std::move(angle));
    FittedParameter reach{.name = "max_range_10pct_m",
                          .value = limits_.reach.value,
                          .low = limits_.reach.low,
                          .high = limits_.reach.high,
                          .is_seen = limits_.reach.has_upper};
    if (!reach.is_seen)
      reach.reason = fmt::format("all surfaces are near: each returns with {:.1f} m on 10 % reflectivity", reach.low);
    add(std::move(reach));
    device_.settings.max_incidence_deg = result_.of("max_incidence_deg").is_seen ? incidence.value : kMaxIncidence_deg;
    device_.settings.max_range_10pct_m = result_.of("max_range_10pct_m").is_seen ? limits_.reach.value : 0.0;
  }

  void fit_dropout() {
    std::vector<ReturnSample> samples;
    const double margin_deg = std::max(1.0, 5.0 * hits_.values[kAngleNoise_rad] * kDegPerRad);
    for (const Beam& beam : set_.beams) {
      if (!is_return_sample(beam) || !limits_.is_inside(beam, margin_deg, 0.95)) continue;
      samples.push_back({.value = 0.0, .blur = 0.0, .is_return = beam.is_return(), .block = block_of(beam)});
    }
    const RateFit rate = fit_dropouts(samples);
    result_.num_returns = rate.total;
    FittedParameter p{.name = "dropout_probability",
                      .value = rate.value,
                      .low = rate.low,
                      .high = rate.high,
                      .is_seen = rate.count > 0 && rate.low > 0.0};
    if (!p.is_seen) p.reason = fmt::format("consistent with 0: {} of {} beams are lost", rate.count, rate.total);
    add(std::move(p));
    device_.settings.dropout_probability = rate.value;
  }

  void fit_edges() {
    std::vector<const Beam*> edges;
    for (const Beam& beam : set_.beams) {
      if (beam.kind == BeamClass::kEdge && beam.expected.is_jump && beam.index > 0) edges.push_back(&beam);
    }
    const std::size_t count = std::min(edges.size(), static_cast<std::size_t>(settings_.max_edges));
    std::vector<EdgeSample> samples;
    for (std::size_t k = 0; k < count; ++k) {
      const Beam& beam = *edges[k * edges.size() / count];
      EdgeSample sample = edge_sample(site_, set_.scans[beam.scan], beam, device_);
      if (sample.has_both_returns()) samples.push_back(std::move(sample));
    }
    const FittedParameter& noise = result_.of("angle_noise_std_deg");
    const EdgeFit fit = fit_beam_width(samples, device_, {noise.value, noise.low, noise.high});
    result_.num_edges = fit.num_samples;
    result_.edge_outlier_ratio = fit.outlier_ratio;
    FittedParameter p{.name = "beam_width_deg",
                      .value = fit.width_deg,
                      .low = fit.low_deg,
                      .high = fit.high_deg,
                      .is_seen = fit.low_deg > 0.0 && fit.has_upper};
    if (fit.num_samples < 30) p.reason = fmt::format("only {} beams after jumps of 0.1 to 1.5 m", fit.num_samples);
    else if (fit.outlier_ratio > 0.5)
      p.is_seen = false,
      p.reason = fmt::format(
          "{:.0f} % of the returns beside edges agree with no width: the edges of the site are not exact enough",
          100.0 * fit.outlier_ratio);
    else if (!p.is_seen) p.reason = "the returns beside edges are consistent with 0 or with more than 2 deg";
    add(std::move(p));
  }

  const Site& site_;
  const ScanSet& set_;
  LidarFitSettings settings_;
  LidarDevice device_;  ///< lidar with the parameters that are fitted
  Limits limits_;
  HitFit hits_;
  LidarFit result_;
};

}  // namespace

void ScanSet::append(PosedScan posed, const std::vector<ExpectedBeam>& expected) {
  const std::vector<Beam> more =
      beams_of(posed, expected, posed.scan.ranges_m, static_cast<std::uint32_t>(scans.size()), rules);
  beams.insert(beams.end(), more.begin(), more.end());
  scans.push_back(std::move(posed));
}

const FittedParameter& LidarFit::of(const std::string& name) const {
  const auto found = std::ranges::find(parameters, name, &FittedParameter::name);
  if (found == parameters.end()) throw std::logic_error("no fitted parameter " + name);
  return *found;
}

LidarDevice LidarFit::device(const LidarDevice& base) const {
  LidarDevice device = base;
  device.errors.noise_ratio = 1.0;
  const auto set = [&](const char* name, double& value) {
    const FittedParameter& p = of(name);
    value = p.is_seen ? p.value : std::clamp(value, p.low, std::max(p.low, p.high));
  };
  LidarSettings& lidar = device.settings;
  set("range_noise_std_m", lidar.range_noise_std_m);
  set("wide_noise_probability", lidar.wide_noise_probability);
  set("wide_noise_std_m", lidar.wide_noise_std_m);
  set("range_quantization_m", lidar.range_quantization_m);
  set("angle_noise_std_deg", lidar.angle_noise_std_deg);
  set("beam_width_deg", lidar.beam_width_deg);
  set("dropout_probability", lidar.dropout_probability);
  set("max_incidence_deg", lidar.max_incidence_deg);
  set("max_range_10pct_m", lidar.max_range_10pct_m);
  set("false_return_rate_per_m", lidar.false_return_rate_per_m);
  const auto set_error = [&](const char* name, double& value) { value = of(name).is_seen ? of(name).value : 0.0; };
  set_error("measured_range_offset_m", device.errors.range_offset_m);
  set_error("measured_range_scale", device.errors.range_scale);
  set_error("measured_incidence_m", device.errors.incidence_m);
  set_error("measured_reflectivity_m", device.errors.reflectivity_m);
  return device;
}

LidarFit fit_lidar(const Site& site, const ScanSet& set, const LidarDevice& base, const LidarFitSettings& settings) {
  return Fitter(site, set, base, settings).fit();
}

}  // namespace patrol::realism
