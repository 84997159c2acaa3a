#include "localize/line_of_sight_monitor.h"

#include "core/error.h"

namespace patrol::localize {

LineOfSightMonitor::LineOfSightMonitor(const LineOfSightMonitorSettings& settings) : settings_(settings) {
  validate(settings, "line_of_sight");
  if (settings.window_ranges < settings.min_ranges)
    throw InputError("line_of_sight.window_ranges: must be at least line_of_sight.min_ranges");
}

bool LineOfSightMonitor::add(int anchor, Time stamp, double innovation_m) {
  std::deque<Sample>& window = windows_[anchor];
  window.push_back({stamp, innovation_m});
  while (window.size() > static_cast<std::size_t>(settings_.window_ranges) ||
         stamp - window.front().stamp > from_seconds(settings_.max_age_s))
    window.pop_front();
  if (window.size() < static_cast<std::size_t>(settings_.min_ranges)) return false;
  const double count = static_cast<double>(window.size());
  double mean_m = 0.0, squares_m2 = 0.0;
  for (const Sample& sample : window) mean_m += sample.innovation_m / count;
  for (const Sample& sample : window) squares_m2 += (sample.innovation_m - mean_m) * (sample.innovation_m - mean_m);
  const double max_std_m = settings_.max_std_ratio * settings_.range_std_m;
  return squares_m2 <= (count - 1.0) * max_std_m * max_std_m;
}

}  // namespace patrol::localize
