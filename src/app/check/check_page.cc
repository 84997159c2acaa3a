#include "app/check/check_page.h"

#include <utility>

#include <fmt/format.h>

#include "app/check/check_output.h"
#include "core/geometry/angles.h"
#include "core/text.h"

namespace patrol::app {
namespace {

using report::SeriesColor;
using report::Tone;

report::TableCell verdict_cell(const ManeuverResult& result) {
  return result.is_passed() ? report::TableCell{"passed", Tone::kGood} : report::TableCell{"FAILED", Tone::kBad};
}

report::VerdictBlock verdict_block(const CheckResult& result) {
  report::VerdictBlock verdict{.word = result.is_passed() ? "Passed" : "Failed",
                               .tone = result.is_passed() ? Tone::kGood : Tone::kBad,
                               .reason = verdict_text(result),
                               .checks = {.caption = "", .columns = {{"maneuver"}, {"verdict"}}, .rows = {}}};
  if (!result.is_passed()) verdict.checks.columns.push_back({"reason"});
  for (const ManeuverResult& each : result.maneuvers) {
    verdict.checks.rows.push_back({{each.maneuver.title}, verdict_cell(each)});
    if (!result.is_passed()) verdict.checks.rows.back().push_back({join(each.failures, "; ")});
  }
  return verdict;
}

report::TableCell value_cell(const Figure& figure) {
  return {value_text(figure), figure.is_met() ? Tone::kPlain : Tone::kBad};
}

report::TableBlock figure_table(const CheckResult& result) {
  report::TableBlock table{
      .caption = "",
      .columns = {{"maneuver"}, {"figure"}, {"measured", true}, {"limit", true}, {"reason of the limit"}},
      .rows = {}};
  for (const ManeuverResult& each : result.maneuvers) {
    std::string title = each.maneuver.title;
    for (const Figure& figure : each.figures) {
      table.rows.push_back({{std::exchange(title, "")},
                            {label_of(figure)},
                            value_cell(figure),
                            {limit_text(figure)},
                            {figure.limit_reason, Tone::kFaint}});
    }
  }
  return table;
}

report::PlanView path_view(const ManeuverResult& result) {
  constexpr double kMargin_m = 0.3;
  report::PlanView view{.caption = result.maneuver.title,
                        .x_title = "ahead of the start, m",
                        .y_title = "to the left, m",
                        .paths = {},
                        .marks = {{.label = "start", .color = SeriesColor::kEvent, .p_m = Eigen::Vector2d::Zero()}}};
  report::MapPath commanded{.name = "commanded", .color = SeriesColor::kBound, .pieces_m = {{}}};
  report::MapPath truth{.name = "true", .color = SeriesColor::kTruth, .pieces_m = {{}}};
  for (const DriveSample& sample : result.record.samples) {
    commanded.pieces_m[0].push_back(sample.T_start_commanded.position());
    truth.pieces_m[0].push_back(sample.T_start_center.position());
    for (const Eigen::Vector2d& p_m : {commanded.pieces_m[0].back(), truth.pieces_m[0].back()}) {
      view.low_m = view.low_m.cwiseMin(p_m);
      view.high_m = view.high_m.cwiseMax(p_m);
    }
  }
  view.low_m.array() -= kMargin_m;
  view.high_m.array() += kMargin_m;
  view.paths = {std::move(commanded), std::move(truth)};
  return view;
}

report::Curve curve_of(const ManeuverResult& result, std::string name, SeriesColor color,
                       double (*value)(const DriveSample& sample)) {
  report::Curve curve{.name = std::move(name), .color = color, .is_dashed = false, .points = {}};
  for (const DriveSample& sample : result.record.samples) curve.points.emplace_back(sample.time_s, value(sample));
  return curve;
}

report::LinePlot plot_of(const ManeuverResult& result, const std::string& title, const std::string& unit,
                         std::vector<report::Curve> curves) {
  return {.title = title,
          .unit = unit,
          .axis = {.label = "time, s", .max = result.record.samples.back().time_s},
          .max = {},
          .curves = std::move(curves),
          .marks = {},
          .spans = {}};
}

std::vector<report::Block> time_plots(const ManeuverResult& result) {
  return {plot_of(result, "Forward speed", "m/s",
                  {curve_of(result, "commanded", SeriesColor::kBound,
                            [](const DriveSample& sample) { return sample.commanded_speed_mps; }),
                   curve_of(result, "true", SeriesColor::kTruth,
                            [](const DriveSample& sample) { return sample.speed_mps; })}),
          plot_of(result, "Yaw rate", "rad/s",
                  {curve_of(result, "commanded", SeriesColor::kBound,
                            [](const DriveSample& sample) { return sample.commanded_yaw_rate_radps; }),
                   curve_of(result, "true", SeriesColor::kTruth,
                            [](const DriveSample& sample) { return sample.yaw_rate_radps; })}),
          plot_of(result, "Largest torque and speed of a motor", "% of its limit",
                  {curve_of(result, "torque", SeriesColor::kEstimate,
                            [](const DriveSample& sample) { return 100.0 * sample.max_torque_ratio; }),
                   curve_of(result, "speed", SeriesColor::kConfidence,
                            [](const DriveSample& sample) { return 100.0 * sample.max_speed_ratio; })}),
          plot_of(result, "Tilt", "°", {curve_of(result, "tilt", SeriesColor::kOdometry, [](const DriveSample& sample) {
                    return to_deg(sample.tilt_rad);
                  })})};
}

bool has_time_plots(const ManeuverResult& result) {
  return result.maneuver.name != "stand" && result.maneuver.name != "slope_stand";
}

bool has_path(const ManeuverResult& result) {
  return result.maneuver.name == "square" || result.maneuver.name == "circle" || result.maneuver.name == "turn";
}

std::vector<std::pair<std::string, std::string>> facts_of(const CheckResult& result) {
  const CheckRobot& robot = result.robot;
  std::vector<std::pair<std::string, std::string>> facts = {
      {"drive", name_of(robot.kind)},
      {"mass", fmt::format("{:.1f} kg", robot.description.mass_kg)},
      {"maximum speed", fmt::format("{:.2f} m/s", robot.limits.max_speed_mps)},
      {"maximum yaw rate", fmt::format("{:.2f} rad/s", robot.limits.max_yaw_rate_radps)},
      {"seed", fmt::format("{}", robot.seed)}};
  if (!result.warnings.empty()) facts.emplace_back("warnings", join(result.warnings, "; "));
  if (!robot.overrides.empty()) facts.emplace_back("settings", join(robot.overrides, ", "));
  facts.emplace_back("patrol", PATROL_VERSION);
  return facts;
}

}  // namespace

report::Page check_page(const CheckResult& result, const std::vector<CheckPicture>& pictures) {
  report::Page page{.kind = "check drive",
                    .title = fmt::format("Check drive of {}", result.robot.name),
                    .facts = facts_of(result),
                    .sections = {{.title = "", .blocks = {verdict_block(result)}}},
                    .footer = "Generated by patrol check. All figures are by ground truth and also in check.json."};
  if (!pictures.empty()) {
    report::Section section{.title = "Pictures", .blocks = {}};
    for (const CheckPicture& picture : pictures)
      section.blocks.emplace_back(report::PictureBlock{.png = picture.png, .caption = picture.caption});
    page.sections.push_back(std::move(section));
  }
  page.sections.push_back({"Figures", {figure_table(result)}});
  report::Section paths{.title = "Paths", .blocks = {}};
  for (const ManeuverResult& each : result.maneuvers) {
    if (has_path(each)) paths.blocks.emplace_back(path_view(each));
  }
  page.sections.push_back(std::move(paths));
  for (const ManeuverResult& each : result.maneuvers) {
    if (has_time_plots(each)) page.sections.push_back({each.maneuver.title, time_plots(each)});
  }
  return page;
}

}  // namespace patrol::app
