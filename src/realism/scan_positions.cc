#include "realism/scan_positions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "realism/expected_scan.h"

namespace patrol::realism {
namespace {

/// Share of the scans that the earlier passes use: the range offset does not need all of them.
constexpr std::size_t kScansOfPass = 100;

}  // namespace

PositionedScans position_scans(const Site& site, const std::vector<PosedScan>& scans, const PositionSettings& settings,
                               const std::function<bool(std::size_t done, std::size_t total)>& on_scan) {
  PositionedScans result;
  const std::size_t stride = std::max<std::size_t>(1, scans.size() / kScansOfPass);
  const std::size_t num_passes = settings.align ? static_cast<std::size_t>(settings.error_passes) : 1;
  const std::size_t per_pass = (scans.size() + stride - 1) / stride;
  const std::size_t total = (num_passes - 1) * per_pass + scans.size();
  std::size_t done = 0;
  for (std::size_t number = 0; number < num_passes; ++number) {
    const bool is_last = number + 1 == num_passes;
    SystematicErrorFit fit(settings.alignment);
    ScanSet set;
    set.rules = settings.rules;
    double absorbed = 0.0, num_beams = 0.0;
    for (std::size_t k = 0; k < scans.size(); k += is_last ? 1 : stride) {
      ScanAlignment aligned = settings.align
                                  ? align_scan(site, scans[k], settings.rules, settings.alignment, result.errors)
                                  : ScanAlignment{.posed = scans[k]};
      const std::vector<ExpectedBeam> expected = expected_beams(site, aligned.posed, settings.rules);
      if (settings.align) fit.add(aligned, expected, result.errors);
      absorbed += aligned.absorbed_bias;
      num_beams += static_cast<double>(aligned.num_beams);
      if (is_last && settings.align) result.corrections.push_back(aligned.correction);
      if (is_last) set.append(std::move(aligned.posed), expected);
      if (on_scan && !on_scan(++done, total)) return result;
    }
    if (!is_last) {
      result.errors = fit.improved(result.errors);
      continue;
    }
    set.absorbed_bias = set.scans.empty() ? 0.0 : absorbed / static_cast<double>(set.scans.size());
    if (settings.align) {
      constexpr double kParameters = 3.0;  // x, y, yaw
      const double per_scan =
          std::max(2.0 * kParameters, num_beams / std::max(1.0, static_cast<double>(set.scans.size())));
      set.interval_factors = fit.interval_factors();
      set.noise_factor = std::sqrt(per_scan / (per_scan - kParameters));
    }
    result.set = std::move(set);
  }
  return result;
}

}  // namespace patrol::realism
