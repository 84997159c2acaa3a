#include "app/scoring/goal_table.h"

#include <array>

#include <fmt/format.h>

namespace patrol::app {
namespace {

/// Published mean and standard deviation over ten navigations.
struct PublishedGoal {
  double position_cm, position_std_cm;
  double heading_deg, heading_std_deg;
};
constexpr std::array<PublishedGoal, 3> kTable2 = {
    {{17.06, 2.77, 4.71, 1.74}, {18.40, 2.36, 5.20, 1.76}, {18.79, 2.89, 5.25, 1.84}}};

std::string line(const io::Metrics& goal, const PublishedGoal* published) {
  const io::Metrics &position = goal.at("position_error_m"), &heading = goal.at("heading_error_deg");
  std::string text = fmt::format("  {:<8} {:>8}   {:>6.2f} +- {:<6.2f} {:>7.2f} +- {:<6.2f}",
                                 goal.at("name").get<std::string>(), goal.at("arrivals").get<int>(),
                                 100.0 * position.at("mean").get<double>(), 100.0 * position.at("std").get<double>(),
                                 heading.at("mean").get<double>(), heading.at("std").get<double>());
  if (published == nullptr) return text + "\n";
  return text + fmt::format(" {:>9.2f} +- {:<5.2f} {:>6.2f} +- {:<5.2f}\n", published->position_cm,
                            published->position_std_cm, published->heading_deg, published->heading_std_deg);
}

}  // namespace

std::string goal_table(const io::Metrics& metrics) {
  if (!metrics.contains("goals")) return "";
  std::string text;
  std::size_t row = 0;
  for (const io::Metrics& goal : metrics.at("goals")) {
    const PublishedGoal* published = row < kTable2.size() ? &kTable2[row] : nullptr;
    ++row;
    const double arrivals = io::metric_at(goal, "arrivals").value_or(0.0),
                 failed = io::metric_at(goal, "failed").value_or(0.0);
    if (arrivals > 0.0) text += line(goal, published);
    if (failed > 0.0)
      text += fmt::format("  {:<8} not reached {:.0f} of {:.0f} times\n", goal.at("name").get<std::string>(), failed,
                          arrivals + failed);
  }
  if (text.empty()) return "";
  return "  goal     arrivals   position, cm     heading, deg     [Liu21], table 2\n" + text;
}

}  // namespace patrol::app
