#include "app/check/check_output.h"

#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "core/text.h"

namespace patrol::app {
namespace {

std::string key_figures(const ManeuverResult& result) {
  std::vector<std::string> texts;
  for (const Figure& figure : result.figures) {
    if (figure.is_key) texts.push_back(label_of(figure) + " " + value_text(figure));
  }
  return join(texts, ", ");
}

/// Rounds to nine significant digits, so that the file has no digits without meaning.
double rounded(double value) { return std::isfinite(value) ? std::stod(fmt::format("{:.9g}", value)) : value; }

io::Metrics json_of(const Figure& figure) {
  io::Metrics limits;
  if (figure.min) limits["min"] = rounded(*figure.min);
  if (figure.max) limits["max"] = rounded(*figure.max);
  limits["reason"] = figure.limit_reason;
  limits["is_met"] = figure.is_met();
  return limits;
}

io::Metrics json_of(const ManeuverResult& result) {
  io::Metrics json = {{"name", result.maneuver.name},
                      {"title", result.maneuver.title},
                      {"verdict", result.is_passed() ? "passed" : "failed"},
                      {"failures", result.failures},
                      {"duration_s", rounded(result.record.samples.back().time_s)},
                      {"figures", io::Metrics::object()},
                      {"limits", io::Metrics::object()}};
  for (const Figure& figure : result.figures) {
    json["figures"][figure.name] = rounded(figure.value);
    if (figure.min || figure.max) json["limits"][figure.name] = json_of(figure);
  }
  return json;
}

}  // namespace

std::string verdict_text(const CheckResult& result) {
  if (result.is_passed()) return fmt::format("All {} maneuvers passed.", result.maneuvers.size());
  std::vector<std::string> failed;
  for (const ManeuverResult& each : result.maneuvers) {
    if (!each.is_passed()) failed.push_back(each.maneuver.name);
  }
  return fmt::format("{} of {} maneuvers failed: {}.", failed.size(), result.maneuvers.size(), join(failed, ", "));
}

std::string check_table(const CheckResult& result, TextStyle style) {
  const CheckRobot& robot = result.robot;
  std::string text =
      fmt::format("{}, {}, {:.1f} kg, seed {}: {}\n\n", robot.name, name_of(robot.kind), robot.description.mass_kg,
                  robot.seed, colored(result.is_passed() ? "passed" : "FAILED", result.is_passed(), style));
  for (const ManeuverResult& each : result.maneuvers) {
    const std::string verdict = fmt::format("{:<7}", each.is_passed() ? "passed" : "FAILED");
    text += fmt::format("{}  {:<15} {}\n", colored(verdict, each.is_passed(), style), each.maneuver.name,
                        key_figures(each));
    for (const std::string& failure : each.failures) text += fmt::format("{:>25}{}\n", "", failure);
  }
  text += "\n";
  for (const std::string& warning : result.warnings) text += "warning: " + warning + "\n";
  return text + verdict_text(result) + "\n";
}

io::Metrics check_json(const CheckResult& result) {
  const CheckRobot& robot = result.robot;
  const DriveLimits& limits = robot.limits;
  io::Metrics json = {{"robot", robot.name},
                      {"drive", name_of(robot.kind)},
                      {"seed", robot.seed},
                      {"settings", robot.overrides},
                      {"verdict", result.is_passed() ? "passed" : "failed"},
                      {"mass_kg", rounded(robot.description.mass_kg)},
                      {"limits",
                       {{"max_speed_mps", rounded(limits.max_speed_mps)},
                        {"max_yaw_rate_radps", rounded(limits.max_yaw_rate_radps)},
                        {"max_acceleration_mps2", rounded(limits.max_acceleration_mps2)},
                        {"max_yaw_acceleration_radps2", rounded(limits.max_yaw_acceleration_radps2)},
                        {"min_turning_radius_m", rounded(limits.min_turning_radius_m)}}},
                      {"warnings", result.warnings},
                      {"maneuvers", io::Metrics::array()}};
  if (limits.max_lateral_speed_mps > 0.0)
    json["limits"]["max_lateral_speed_mps"] = rounded(limits.max_lateral_speed_mps);
  for (const ManeuverResult& each : result.maneuvers) json["maneuvers"].push_back(json_of(each));
  return json;
}

}  // namespace patrol::app
