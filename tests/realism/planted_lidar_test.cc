#include "realism/planted_lidar.h"

#include <cstdlib>
#include "realism/edge_fit.h"

#include <gtest/gtest.h>

namespace patrol::realism {
namespace {

TEST(PlantedTry, Print) {
  const char* first = std::getenv("TRY_FIRST");
  const char* last = std::getenv("TRY_LAST");
  const bool noisy = std::getenv("TRY_NOISY") != nullptr;
  const Site site = planted_site(false);
  for (int seed = first ? std::atoi(first) : 1; seed <= (last ? std::atoi(last) : 1); ++seed) {
    PlantedTrialSettings settings;
    if (noisy) settings.path_std_m = 0.03, settings.path_yaw_std_deg = 0.5;
    const PlantedTrial trial = run_planted_trial(site, settings, static_cast<std::uint64_t>(seed));
    std::printf("seed %d hits %zu edges %zu returns %zu out %.4f edge out %.3f\n", seed, trial.fit.num_hits, trial.fit.num_edges,
                trial.fit.num_returns, trial.fit.outlier_ratio, trial.fit.edge_outlier_ratio);
    for (const auto& [name, value] : trial.values) {
      const FittedParameter& p = trial.fit.of(name);
      std::printf("  %-26s true %10.6f fit %10.6f [%10.6f, %10.6f] %s %s %s\n", name.c_str(), value, p.value, p.low, p.high,
                  p.contains(value) ? "in " : "OUT", p.is_seen ? "seen" : "not", p.reason.c_str());
    }
  }
}

}  // namespace
}  // namespace patrol::realism
