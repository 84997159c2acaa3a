#include "realism/scan_positions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "realism/expected_scan.h"
#include "realism/residual_statistics.h"

namespace patrol::realism {
namespace {

/// Share of the scans that the earlier passes use: the range offset does not need all of them.
constexpr std::size_t kScansOfPass = 100;

struct Pass {
  const Site& site;
  const PositionSettings& settings;
  double bias_m = 0.0;

  ScanAlignment align(const PosedScan& posed) const {
    if (!settings.align) return {.posed = posed};
    return align_scan(site, posed, settings.rules, settings.alignment, bias_m);
  }
};

}  // namespace

PositionedScans position_scans(const Site& site, const std::vector<PosedScan>& scans, const PositionSettings& settings,
                               const std::function<bool(std::size_t done, std::size_t total)>& on_scan) {
  PositionedScans result;
  Pass pass{.site = site, .settings = settings};
  const std::size_t stride = std::max<std::size_t>(1, scans.size() / kScansOfPass);
  const std::size_t num_passes = settings.align ? static_cast<std::size_t>(settings.bias_passes) : 1;
  const std::size_t per_pass = (scans.size() + stride - 1) / stride;
  const std::size_t total = (num_passes - 1) * per_pass + scans.size();
  std::size_t done = 0;
  for (std::size_t number = 0; number < num_passes; ++number) {
    const bool is_last = number + 1 == num_passes;
    ScanSet set;
    set.rules = settings.rules;
    double absorbed = 0.0;
    for (std::size_t k = 0; k < scans.size(); k += is_last ? 1 : stride) {
      ScanAlignment aligned = pass.align(scans[k]);
      absorbed += aligned.absorbed_bias;
      if (is_last && settings.align) result.corrections.push_back(aligned.correction);
      const std::vector<ExpectedBeam> expected = expected_beams(site, aligned.posed, settings.rules);
      set.append(std::move(aligned.posed), expected);
      if (on_scan && !on_scan(++done, total)) return result;
    }
    set.absorbed_bias = set.scans.empty() ? 0.0 : absorbed / static_cast<double>(set.scans.size());
    result.bias_m = pass.bias_m;
    if (is_last) {
      result.set = std::move(set);
      break;
    }
    const double left_m = distribution_of(residuals_of(set.beams, BeamClass::kStatic)).median_m - pass.bias_m;
    pass.bias_m += left_m / std::max(0.1, 1.0 - set.absorbed_bias);
  }
  return result;
}

}  // namespace patrol::realism
