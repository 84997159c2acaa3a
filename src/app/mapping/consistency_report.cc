#include "app/mapping/consistency_report.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/geometry/angles.h"
#include "slam/consistency/frozen_scans.h"

namespace patrol::app {
namespace {

constexpr std::size_t kListed = 20;  ///< disagreements in metrics.json
constexpr std::size_t kShown = 8;    ///< disagreements on the page
constexpr std::size_t kMarked = 3;   ///< entries of each kind on the map

std::string place(const Eigen::Vector2d& p_map) { return fmt::format("({:.1f}, {:.1f})", p_map.x(), p_map.y()); }

std::size_t listed(const slam::MapConsistency& consistency) {
  return std::min(kListed, consistency.disagreements.size());
}

}  // namespace

double ConsistencyReport::seconds(std::size_t scan) const { return to_seconds(stamps.at(scan) - stamps.front()); }

MappingVerdict ConsistencyReport::verdict() const {
  if (consistency.is_consistent()) {
    return {.word = "consistent",
            .tone = report::Tone::kGood,
            .reason = fmt::format(
                "{} pairs of segments agree, {:.1f} % of the scans matched no surfaces{}", consistency.num_compared,
                100.0 * consistency.unmatched_ratio(),
                consistency.num_without_returns == 0
                    ? ""
                    : fmt::format(", {:.1f} % have no returns", 100.0 * consistency.without_returns_ratio()))};
  }
  if (!consistency.frozen.empty()) {
    const slam::UnmatchedSegment& segment = consistency.frozen.front();
    return {.word = "look at " + place(segment.p_map),
            .tone = report::Tone::kBad,
            .reason = fmt::format("the lidar is frozen: {} scans repeat the one before while odometry moves, from "
                                  "{:.0f} s",
                                  slam::num_scans_of(consistency.frozen), seconds(segment.first_scan))};
  }
  if (!consistency.disagreements.empty()) {
    const slam::Disagreement& worst = consistency.disagreements.front();
    return {.word = "look at " + place(worst.p_map),
            .tone = report::Tone::kBad,
            .reason = fmt::format(
                "the surfaces seen {} and at {:.0f} s are {:.1f} m and {:.0f} deg apart; {} of {} pairs of segments "
                "disagree",
                worst.first_scan ? fmt::format("at {:.0f} s", seconds(*worst.first_scan)) : "in earlier sessions",
                seconds(worst.second_scan), worst.offset_m, std::abs(kDegPerRad * worst.offset_rad),
                consistency.disagreements.size(), consistency.num_compared)};
  }
  if (consistency.has_too_many_without_returns()) {
    const slam::UnmatchedSegment& segment = consistency.max_without_returns;
    return {.word = "look at " + place(segment.p_map),
            .tone = report::Tone::kBad,
            .reason = fmt::format("{:.0f} % of the scans have no returns, at most {} in a row, from {:.0f} s",
                                  100.0 * consistency.without_returns_ratio(), segment.num_scans,
                                  seconds(segment.first_scan))};
  }
  if (consistency.has_too_many_unmatched()) {
    const slam::UnmatchedSegment& segment = consistency.unmatched_segments.front();
    return {.word = "look at " + place(segment.p_map),
            .tone = report::Tone::kBad,
            .reason =
                fmt::format("{:.0f} % of the scans matched no surfaces, at most {} in a row, from {:.0f} s",
                            100.0 * consistency.unmatched_ratio(), segment.num_scans, seconds(segment.first_scan))};
  }
  if (!consistency.unconnected.empty()) {
    const slam::UnconnectedPart& first = consistency.unconnected.front();
    return {.word = "look at " + place(first.p_map),
            .tone = report::Tone::kBad,
            .reason = fmt::format("from {:.0f} s, only odometry over {:.1f} m connects the map with the part before",
                                  seconds(first.first_scan), first.distance_m)};
  }
  if (!consistency.unsupported.empty()) {
    const slam::UnsupportedPath& worst = consistency.unsupported.front();
    if (worst.gap_s > 0.0) {
      return {.word = "look at " + place(worst.scans.p_map),
              .tone = report::Tone::kBad,
              .reason = fmt::format("until {:.0f} s, scans are missing for {:.1f} s, and odometry contradicts {:.1f} m "
                                    "of the path there",
                                    seconds(worst.scans.first_scan), worst.gap_s, worst.contradiction_m)};
    }
    return {.word = "look at " + place(worst.scans.p_map),
            .tone = report::Tone::kBad,
            .reason =
                fmt::format("from {:.0f} s, {} scans in a row matched no surfaces, and odometry contradicts {:.1f} m "
                            "of the path there",
                            seconds(worst.scans.first_scan), worst.scans.num_scans, worst.contradiction_m)};
  }
  return {.word = "not checked",
          .tone = report::Tone::kWarning,
          .reason = "no two segments of the path saw the same surfaces"};
}

std::string ConsistencyReport::line() const { return verdict().line(); }

io::Metrics ConsistencyReport::metrics() const {
  io::Metrics disagreements = io::Metrics::array();
  for (std::size_t i = 0; i < listed(consistency); ++i) {
    const slam::Disagreement& entry = consistency.disagreements[i];
    disagreements.push_back({{"x_m", entry.p_map.x()},
                             {"y_m", entry.p_map.y()},
                             {"first_s", entry.first_scan ? io::Metrics(seconds(*entry.first_scan)) : nullptr},
                             {"second_s", seconds(entry.second_scan)},
                             {"offset_m", entry.offset_m},
                             {"offset_deg", kDegPerRad * entry.offset_rad}});
  }
  const auto to_metrics = [&](const slam::UnmatchedSegment& segment) {
    return io::Metrics{{"x_m", segment.p_map.x()},
                       {"y_m", segment.p_map.y()},
                       {"from_s", seconds(segment.first_scan)},
                       {"scans", segment.num_scans}};
  };
  io::Metrics unmatched = io::Metrics::array(), unsupported = io::Metrics::array(), frozen = io::Metrics::array();
  for (std::size_t i = 0; i < std::min(kListed, consistency.frozen.size()); ++i)
    frozen.push_back(to_metrics(consistency.frozen[i]));
  for (std::size_t i = 0; i < std::min(kListed, consistency.unmatched_segments.size()); ++i)
    unmatched.push_back(to_metrics(consistency.unmatched_segments[i]));
  for (std::size_t i = 0; i < std::min(kListed, consistency.unsupported.size()); ++i) {
    unsupported.push_back(to_metrics(consistency.unsupported[i].scans));
    unsupported.back()["contradiction_m"] = consistency.unsupported[i].contradiction_m;
    unsupported.back()["gap_s"] = consistency.unsupported[i].gap_s;
  }
  io::Metrics unconnected = io::Metrics::array();
  for (std::size_t i = 0; i < std::min(kListed, consistency.unconnected.size()); ++i) {
    const slam::UnconnectedPart& part = consistency.unconnected[i];
    unconnected.push_back({{"x_m", part.p_map.x()},
                           {"y_m", part.p_map.y()},
                           {"from_s", seconds(part.first_scan)},
                           {"distance_m", part.distance_m}});
  }
  const bool is_checked = consistency.num_compared > 0 || !consistency.disagreements.empty() ||
                          !consistency.unsupported.empty() || !consistency.unconnected.empty() ||
                          !consistency.frozen.empty() || consistency.has_too_many_unmatched() ||
                          consistency.has_too_many_without_returns();
  return {{"consistent", is_checked ? io::Metrics(consistency.is_consistent()) : io::Metrics()},
          {"segments", consistency.num_segments},
          {"compared_pairs", consistency.num_compared},
          {"disagreeing_pairs", consistency.disagreements.size()},
          {"disagreements", disagreements},
          {"unmatched_scans", consistency.num_unmatched},
          {"unmatched_ratio", consistency.unmatched_ratio()},
          {"unmatched_segments", unmatched},
          {"unconnected", unconnected},
          {"unsupported", unsupported},
          {"scans_without_returns", consistency.num_without_returns},
          {"frozen_segments", frozen}};
}

report::VerdictBlock ConsistencyReport::block() const {
  report::TableBlock table{.caption = "",
                           .columns = {{"place in the map, m"},
                                       {"seen at, s", true},
                                       {"and at, s", true},
                                       {"apart, m", true},
                                       {"apart, deg", true}},
                           .rows = {}};
  for (std::size_t i = 0; i < std::min(kShown, consistency.disagreements.size()); ++i) {
    const slam::Disagreement& entry = consistency.disagreements[i];
    table.rows.push_back({{place(entry.p_map)},
                          {entry.first_scan ? fmt::format("{:.0f}", seconds(*entry.first_scan)) : "earlier"},
                          {fmt::format("{:.0f}", seconds(entry.second_scan))},
                          {fmt::format("{:.2f}", entry.offset_m)},
                          {fmt::format("{:.1f}", kDegPerRad * entry.offset_rad)}});
  }
  const MappingVerdict result = verdict();
  return {.word = result.word, .tone = result.tone, .reason = result.reason, .checks = std::move(table)};
}

std::vector<report::MapMark> ConsistencyReport::marks() const {
  std::vector<report::MapMark> marks;
  for (std::size_t i = 0; i < std::min(kMarked, consistency.disagreements.size()); ++i) {
    const slam::Disagreement& entry = consistency.disagreements[i];
    marks.push_back({.label = fmt::format("{:.1f} m apart", entry.offset_m), .p_m = entry.p_map});
  }
  if (consistency.has_too_many_unmatched()) {
    const slam::UnmatchedSegment& segment = consistency.unmatched_segments.front();
    marks.push_back({.label = fmt::format("{} scans unmatched", segment.num_scans), .p_m = segment.p_map});
  }
  if (consistency.has_too_many_without_returns()) {
    const slam::UnmatchedSegment& segment = consistency.max_without_returns;
    marks.push_back({.label = fmt::format("{} scans without returns", segment.num_scans), .p_m = segment.p_map});
  }
  for (std::size_t i = 0; i < std::min(kMarked, consistency.frozen.size()); ++i)
    marks.push_back({.label = "frozen lidar", .p_m = consistency.frozen[i].p_map});
  for (std::size_t i = 0; i < std::min(kMarked, consistency.unconnected.size()); ++i)
    marks.push_back({.label = "not connected", .p_m = consistency.unconnected[i].p_map});
  for (std::size_t i = 0; i < std::min(kMarked, consistency.unsupported.size()); ++i)
    marks.push_back({.label = "not supported", .p_m = consistency.unsupported[i].scans.p_map});
  return marks;
}

}  // namespace patrol::app
