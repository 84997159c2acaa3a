#include "app/report/event_timeline.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/report/verdict.h"
#include "app/run/run_verdict.h"

namespace patrol::app {
namespace {

using report::PlotMark;
using report::SeriesColor;

const std::string kLostText = "Localization reported lost.";

/// Whether the marks of this lane are also shown in error curves.
bool is_marked_in_plots(const report::EventTimeline::Lane& lane) {
  return lane.marks.front().color == SeriesColor::kAlarm || lane.name == name_of(EventKind::kRecovery) ||
         lane.name == name_of(EventKind::kRelocalized);
}

report::EventTimeline::Lane& lane_named(std::vector<report::EventTimeline::Lane>& lanes, const std::string& name) {
  const auto found = std::find_if(lanes.begin(), lanes.end(), [&](const auto& lane) { return lane.name == name; });
  if (found != lanes.end()) return *found;
  return lanes.emplace_back(report::EventTimeline::Lane{.name = name, .marks = {}});
}

std::string text_of(const Event& event) { return event.text.empty() ? kind_text(event) : event.text; }

}  // namespace

std::vector<report::EventTimeline::Lane> make_lanes(const RunContents& run) {
  std::vector<report::EventTimeline::Lane> lanes;
  const auto add = [&](const std::string& lane, SeriesColor color, double at_s, const std::string& text) {
    lane_named(lanes, lane).marks.push_back({.x = at_s, .text = text, .color = color});
  };
  for (const Event& event : run.record.events) {
    add(kind_text(event), is_failure(event.kind) ? SeriesColor::kAlarm : SeriesColor::kEvent, to_seconds(event.stamp),
        text_of(event));
  }
  for (const Collision& collision : run.record.collisions) {
    add("collision", SeriesColor::kAlarm, to_seconds(collision.stamp),
        fmt::format("{} touched {}.", collision.first, collision.second));
  }
  for (const KidnapSettings& kidnap : run.scenario.kidnaps) {
    if (!was_triggered(kidnap, run.record.T_world_body)) continue;
    add("kidnap", SeriesColor::kAlarm, kidnap.at_s,
        fmt::format("Kidnapped to ({:.1f}, {:.1f}) m.", kidnap.x_m, kidnap.y_m));
  }
  return lanes;
}

std::vector<PlotMark> marks_of(const RunContents& run) {
  std::vector<PlotMark> marks;
  for (const report::EventTimeline::Lane& lane : make_lanes(run)) {
    if (is_marked_in_plots(lane)) marks.insert(marks.end(), lane.marks.begin(), lane.marks.end());
  }
  return marks;
}

std::vector<report::PlotSpan> spans_of(const RunContents& run) {
  std::vector<report::PlotSpan> spans;
  for (const sim::FaultSettings& fault : run.scenario.faults) {
    const double end_s = std::min(fault.start_s + fault.duration_s, run.end_s());
    if (fault.start_s < end_s) spans.push_back({.from = fault.start_s, .to = end_s, .text = name_of(fault)});
  }
  const std::vector<LocalizationConfidence>& confidences = run.record.confidences;
  for (std::size_t i = 0; i + 1 < confidences.size(); ++i) {
    if (!confidences[i].is_lost) continue;
    const std::size_t first = i;
    while (i + 1 < confidences.size() && confidences[i].is_lost) ++i;
    spans.push_back(
        {.from = to_seconds(confidences[first].stamp), .to = to_seconds(confidences[i].stamp), .text = kLostText});
  }
  return spans;
}

report::CollapsibleTables event_table(const RunContents& run) {
  report::TableBlock table{.caption = "", .columns = {{"s", true}, {"event"}, {"about"}, {"text"}}, .rows = {}};
  for (const Event& event : run.record.events) {
    const report::Tone tone = is_failure(event.kind) ? report::Tone::kBad : report::Tone::kPlain;
    table.rows.push_back(
        {{fmt::format("{:.1f}", to_seconds(event.stamp))}, {kind_text(event), tone}, {event.subject}, {event.text}});
  }
  return {.summary = fmt::format("All {} events", table.rows.size()), .tables = {table}};
}

}  // namespace patrol::app
