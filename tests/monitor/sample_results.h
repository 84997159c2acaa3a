#pragma once

#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/inspection_result.h"
#include "io/json/inspection_json.h"
#include "monitor/result.h"

namespace patrol::test {

inline constexpr std::int64_t kNoon_ms = 1'795'262'400'000;  // 2026-11-21T12:00:00Z

/// The sequence-th of a run of spot-1's in the street.
inline monitor::Result result_of(const std::string& kind, const nlohmann::json& data, int sequence,
                                 const std::string& run = "run_1", const std::string& robot = "spot-1") {
  return {.id = fmt::format("{}/{}/{}", robot, run, sequence),
          .robot = robot,
          .run = run,
          .world = "street",
          .sequence = sequence,
          .time_s = 1.0 * sequence,
          .created_ms = kNoon_ms + 1000 * sequence,
          .kind = kind,
          .data = data.dump()};
}

inline monitor::Result pose_result(int sequence, double x = 1.0) {
  return result_of("pose", {{"x", x}, {"y", 2.0}, {"yaw", 0.5}}, sequence);
}

inline monitor::Result event_result(int sequence, const std::string& kind, const std::string& subject,
                                    double value = 0.0) {
  return result_of("event",
                   {{"kind", kind},
                    {"subject", subject},
                    {"text", kind + " at " + subject},
                    {"value", value},
                    {"pose", {{"x", 0.0}, {"y", 0.0}, {"yaw", 0.0}}},
                    {"position_m", {3.0, 4.0}}},
                   sequence);
}

inline monitor::Result status_result(int sequence, const std::string& state) {
  const nlohmann::json station = {{"name", "well_1"}, {"type", "inspect"}, {"position_m", {5.0, 6.0}}};
  return result_of(
      "status",
      {{"state", state}, {"scenario", "short"}, {"message", ""}, {"stations", nlohmann::json::array({station})}},
      sequence);
}

/// Ring 3 has moved in by so many millimetres, ring 4 has not.
inline monitor::Result lining_result(int sequence, double inward_mm, const std::string& run = "run_1") {
  LiningResult lining;
  lining.station = "station_1";
  lining.is_registered = true;
  lining.cells = {{.ring = 3, .clock_deg = 60.0, .inward_m = 1e-3 * inward_mm, .std_m = 0.0004, .points = 100},
                  {.ring = 3, .clock_deg = 300.0, .inward_m = 0.0001, .std_m = 0.0004, .points = 100},
                  {.ring = 4, .clock_deg = 60.0, .inward_m = -0.0002, .std_m = 0.0004, .points = 100}};
  lining.lines = {{.ring = 3, .name = "9-3", .change_m = -1e-3 * inward_mm, .std_m = 0.0005}};
  lining.findings = {{.ring = 3,
                      .clock_deg = 60.0,
                      .inward_m = 1e-3 * inward_mm,
                      .std_m = 0.0004,
                      .level = inward_mm >= 10.0 ? WarningLevel::kAlarm : WarningLevel::kNotice,
                      .p_map = {7.0, 8.0, 3.0}}};
  return result_of("lining", io::to_json(lining), sequence, run);
}

}  // namespace patrol::test
