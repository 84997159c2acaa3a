#include "render/overlay.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/geometry/angles.h"
#include "core/time.h"
#include "render/scene/ghost.h"
#include "render/scene/palette.h"
#include "render/world_overlay.h"

namespace patrol::render {
namespace {

constexpr double kDrift_mps = 0.35;  // drift of gas puffs in film time

std::string clock_text(Time time) {
  const double seconds = to_seconds(time);
  const int minutes = static_cast<int>(seconds / 60.0);
  return fmt::format("{:d}:{:04.1f}", minutes, seconds - 60.0 * minutes);
}

std::string values_text(const RunSnapshot& snapshot) {
  const std::string errors =
      snapshot.T_true_estimate
          ? fmt::format("    position error {:.3f} m    heading error {:.2f}°",
                        snapshot.T_true_estimate->position().norm(), to_deg(std::abs(snapshot.T_true_estimate->yaw)))
          : "";
  return fmt::format("{}{}    {} {:.1f} m", clock_text(snapshot.state.stamp), errors,
                     snapshot.is_driving ? "driven" : "walked", snapshot.traveled_m);
}

/// Reading of the methane meter and playback speed.
std::string status_text(const RunSnapshot& snapshot, const std::optional<FilmNote>& note) {
  std::string text;
  if (snapshot.gas) text += fmt::format("methane {:.0f} ppm m", snapshot.gas->column_ppm_m);
  if (note) text += fmt::format("    {:.0f}×", note->speed);
  return text;
}

Color color_of(const LiningMark& mark) { return mark.is_alarm ? kAlarmColor : kFindingColor; }

}  // namespace

Overlay::Overlay(int frame_height, GasCloud gas)
    : scale_(frame_height / 720.0),
      values_(std::max(12, frame_height / 30), true),
      texts_(std::max(11, frame_height / 40)),
      title_(std::max(12, frame_height / 24), true),
      gas_(std::move(gas)) {}

void Overlay::draw(Frame& frame, const std::vector<float>& depth, const View& view, const RunSnapshot& snapshot,
                   const std::optional<FilmNote>& note) {
  const Projector projector(view, frame.width(), frame.height());
  draw_puffs(frame, depth, projector,
             gas_.puffs(to_seconds(snapshot.state.stamp), note ? kDrift_mps * note->film_s : 0.0));
  WorldOverlay overlay(frame, depth, projector);
  overlay.polyline(snapshot.planned_path, 0.03, {kPlanColor, 0.85});
  overlay.polyline(snapshot.true_path, 0.06, {kTruthColor, 0.85});
  overlay.polyline(snapshot.estimated_path, 0.03, {kEstimateColor, 0.95});
  overlay.dots(snapshot.scan, 0.02, {kScanColor, 0.9});
  for (const LiningMark& mark : snapshot.lining_marks) overlay.polyline(mark.outline, 0.06, {color_of(mark), 0.95});
  draw_lining_labels(frame, depth, projector, snapshot);
  inset_.draw(frame, snapshot);
  draw_figures(frame, snapshot, note);
  const int free_bottom = draw_legend(frame, snapshot);
  if (!note) return;
  draw_caption(frame, note->caption, free_bottom);
  draw_timeline(frame, *note);
}

/// Texts beside the findings on the lining that are in view.
void Overlay::draw_lining_labels(Frame& frame, const std::vector<float>& depth, const Projector& projector,
                                 const RunSnapshot& snapshot) {
  constexpr double kReadable_m = 25.0, kBehind_m = 0.5;
  for (const LiningMark& mark : snapshot.lining_marks) {
    const Eigen::Vector3d in_camera = projector.to_camera(mark.p_world_m);
    if (in_camera.z() < projector.near_m() || in_camera.z() > kReadable_m) continue;
    const Projected at = projector.project_camera(in_camera);
    const int x = static_cast<int>(std::lround(at.pixel.x())), y = static_cast<int>(std::lround(at.pixel.y()));
    const int above_px = static_cast<int>(projector.focal_px() * kLiningMarkRadius_m / at.distance_m);
    if (x < 0 || y < 0 || x >= frame.width() || y >= frame.height()) continue;
    if (at.distance_m > projector.distance_m(depth[static_cast<std::size_t>(y * frame.width() + x)]) + kBehind_m)
      continue;
    const int pad = texts_.height_px() / 3, width = texts_.width_px(mark.text);
    const int baseline = y - above_px - 2 * pad;
    fill_rectangle(frame, x - width / 2 - pad, baseline - texts_.height_px(), width + 2 * pad,
                   texts_.height_px() + 2 * pad, {kPanelColor, 0.6});
    texts_.draw(frame, x - width / 2, baseline, mark.text, {color_of(mark), 1.0});
  }
}

void Overlay::draw_figures(Frame& frame, const RunSnapshot& snapshot, const std::optional<FilmNote>& note) {
  const int margin = values_.height_px() / 2;
  const int line = texts_.height_px() + margin;
  fill_rectangle(frame, 0, 0, frame.width(), values_.height_px() + 2 * margin + line, {kPanelColor, 0.6});
  const int baseline = margin + values_.height_px();
  const int width = frame.width() - 4 * margin;
  values_.draw(frame, 2 * margin, baseline, values_.fitted(values_text(snapshot), width), {kTextColor, 1.0});
  const std::string status = status_text(snapshot, note);
  const int status_width = texts_.width_px(status);
  texts_.draw(frame, frame.width() - 2 * margin - status_width, baseline + line, status, {kTextColor, 1.0});
  texts_.draw(frame, 2 * margin, baseline + line, texts_.fitted(snapshot.event, width - status_width - 2 * margin),
              {snapshot.is_alarm ? kAlarmColor : kTextColor, 1.0});
}

int Overlay::draw_legend(Frame& frame, const RunSnapshot& snapshot) {
  std::vector<std::pair<const char*, Color>> entries = {
      {"true path", kTruthColor}, {"estimated path", kEstimateColor}, {"plan", kPlanColor}, {"scan", kScanColor}};
  if (!snapshot.particles.empty()) entries.emplace_back("particles", kParticleColor);
  if (!snapshot.lining_marks.empty()) entries.emplace_back("lining finding", kFindingColor);
  if (!gas_.is_empty()) entries.emplace_back("methane", kGasColor);
  if (snapshot.T_true_estimate && ghost_opacity(*snapshot.T_true_estimate) > 0.0)
    entries.emplace_back("estimated pose", kEstimateColor);
  const int line = texts_.height_px() + texts_.height_px() / 2;
  const int left = line, text_left = left + 2 * texts_.height_px();
  int width = 9 * texts_.height_px();
  for (const auto& [name, color] : entries) width = std::max(width, texts_.width_px(name));
  int baseline = frame.height() - line / 2 - line * static_cast<int>(entries.size() - 1);
  const int top = baseline - line;
  fill_rectangle(frame, left / 2, top, text_left + width, line * static_cast<int>(entries.size()) + line / 2,
                 {kPanelColor, 0.5});
  for (const auto& [name, color] : entries) {
    const double y = baseline - 0.35 * texts_.height_px();
    draw_line(frame, {left, y}, {left + 1.2 * texts_.height_px(), y}, 4.0 * scale_, {color, 1.0});
    texts_.draw(frame, text_left, baseline, name, {kTextColor, 1.0});
    baseline += line;
  }
  return top;
}

void Overlay::draw_caption(Frame& frame, const std::vector<std::string>& lines, int bottom) {
  if (lines.empty()) return;
  const int pad = title_.height_px() / 2, left = texts_.height_px() * 3 / 4, bar = std::max(2, title_.height_px() / 5);
  const int line = title_.height_px() * 5 / 4, height = line * static_cast<int>(lines.size()) + pad,
            top = bottom - height - pad;
  int width = 0;
  for (const std::string& text : lines) width = std::max(width, title_.width_px(text));
  width = std::min(width, frame.width() - 2 * (left + bar + pad));
  fill_rectangle(frame, left, top, bar + width + 2 * pad, height, {kPanelColor, 0.72});
  fill_rectangle(frame, left, top, bar, height, {kEstimateColor, 1.0});
  int baseline = top + pad / 2 + title_.height_px();
  for (const std::string& text : lines) {
    title_.draw(frame, left + bar + pad, baseline, title_.fitted(text, width), {kTextColor, 1.0});
    baseline += line;
  }
}

/// Progress bar of the film with marks at the highlights.
void Overlay::draw_timeline(Frame& frame, const FilmNote& note) const {
  const int height = std::max(2, static_cast<int>(std::lround(4.0 * scale_))), top = frame.height() - height;
  const auto at = [&](double film_s) {
    return static_cast<int>(std::lround(frame.width() * std::clamp(film_s / std::max(note.length_s, 1e-9), 0.0, 1.0)));
  };
  fill_rectangle(frame, 0, top, frame.width(), height, {kPanelColor, 0.8});
  fill_rectangle(frame, 0, top, at(note.film_s), height, {kTextColor, 0.8});
  for (const double mark_s : note.marks_s)
    fill_rectangle(frame, at(mark_s) - height / 2, top - height / 2, height, 2 * height, {kEstimateColor, 1.0});
}

}  // namespace patrol::render
