#include "render/overlay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "core/time.h"
#include "render/palette.h"
#include "render/world_ink.h"

namespace patrol::render {
namespace {

std::string clock_text(Time time) {
  const double seconds = to_seconds(time);
  const int minutes = static_cast<int>(seconds / 60.0);
  return fmt::format("{:d}:{:04.1f}", minutes, seconds - 60.0 * minutes);
}

}  // namespace

Overlay::Overlay(int frame_height)
    : figures_(std::max(12, frame_height / 30), true), words_(std::max(11, frame_height / 40)) {}

void Overlay::draw(Frame& frame, const std::vector<float>& depth, const View& view,
                   const RunSnapshot& snapshot) {
  const Projector projector(view, frame.width(), frame.height());
  WorldInk ink(frame, depth, projector);
  ink.polyline(snapshot.planned_path, 0.03, {kPlanColor, 0.85});
  ink.polyline(snapshot.true_path, 0.06, {kTruthColor, 0.85});
  ink.polyline(snapshot.estimated_path, 0.03, {kEstimateColor, 0.95});
  ink.dots(snapshot.scan, 0.02, {kScanColor, 0.9});
  inset_.draw(frame, snapshot);
  draw_figures(frame, snapshot);
  draw_legend(frame);
}

void Overlay::draw_figures(Frame& frame, const RunSnapshot& snapshot) {
  const int margin = figures_.height_px() / 2;
  const int line = words_.height_px() + margin;
  fill_rectangle(frame, 0, 0, frame.width(), figures_.height_px() + 2 * margin + line, {kPanelColor, 0.6});
  const std::string text =
      fmt::format("{}    position error {:.3f} m    heading error {:.2f}°    {} {:.1f} m",
                  clock_text(snapshot.state.stamp), snapshot.position_error_m,
                  std::abs(snapshot.heading_error_rad) * 180.0 / std::numbers::pi,
                  snapshot.is_driving ? "driven" : "walked", snapshot.travelled_m);
  const int baseline = margin + figures_.height_px();
  const int width = frame.width() - 4 * margin;
  figures_.draw(frame, 2 * margin, baseline, figures_.fitted(text, width), {kTextColor, 1.0});
  words_.draw(frame, 2 * margin, baseline + line, words_.fitted(snapshot.event, width),
              {snapshot.is_alarm ? kAlarmColor : kTextColor, 1.0});
}

void Overlay::draw_legend(Frame& frame) {
  static constexpr std::array<std::pair<const char*, Color>, 4> kEntries = {
      {{"true path", kTruthColor},
       {"estimated path", kEstimateColor},
       {"plan", kPlanColor},
       {"scan", kScanColor}}};
  const int line = words_.height_px() + words_.height_px() / 2;
  int baseline = frame.height() - line / 2 - line * static_cast<int>(kEntries.size() - 1);
  const int left = line;
  fill_rectangle(frame, left / 2, baseline - line, 11 * words_.height_px(),
                 line * static_cast<int>(kEntries.size()) + line / 2, {kPanelColor, 0.5});
  for (const auto& [name, color] : kEntries) {
    const double y = baseline - 0.35 * words_.height_px();
    draw_line(frame, {left, y}, {left + 1.2 * words_.height_px(), y}, 4.0, {color, 1.0});
    words_.draw(frame, left + 2 * words_.height_px(), baseline, name, {kTextColor, 1.0});
    baseline += line;
  }
}

}  // namespace patrol::render
