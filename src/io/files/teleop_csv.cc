#include "io/files/teleop_csv.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "io/files/atomic_file.h"

namespace patrol::io {
namespace {

constexpr std::array<const char*, 5> kTeleopColumns = {"time_s", "vx_mps", "yaw_rate_radps", "mark", "hand_over"};
constexpr double kMaxTeleopDuration_s = 86400.0;  // maximum time limit of a scenario
constexpr double kMaxTeleopSpeed = 100.0;         // m/s, rad/s; larger values are treated as input errors

using Row = std::array<double, kTeleopColumns.size()>;

std::string header() { return join(kTeleopColumns, ","); }

/// Reads one number per column. `refuse` does not return.
template <typename Refuse>
Row read_row(const std::string& line, const Refuse& refuse) {
  const auto num_cells = static_cast<std::size_t>(std::count(line.begin(), line.end(), ',')) + 1;
  if (num_cells != kTeleopColumns.size())
    refuse(fmt::format("must be {} numbers with commas between, {}", kTeleopColumns.size(), header()));
  Row row{};
  const char* cell = line.data();
  for (std::size_t i = 0; i < row.size(); ++i) {
    const char* const end = std::find(cell, line.data() + line.size(), ',');
    const auto [rest, error] = std::from_chars(cell, end, row[i]);
    if (error != std::errc() || rest != end || !std::isfinite(row[i])) {
      refuse(fmt::format("{} = {}: must be a number", kTeleopColumns[i], std::string(cell, end)));
    }
    cell = end + 1;
  }
  return row;
}

/// Reads a command. `since`: stamp of the previous command.
template <typename Refuse>
TeleopCommand read_command(const std::string& line, std::optional<Time> since, const Refuse& refuse) {
  const auto [time_s, vx_mps, yaw_rate_radps, save_goal, hand_over] = read_row(line, refuse);
  if (time_s < 0.0 || time_s > kMaxTeleopDuration_s)
    refuse(fmt::format("time_s = {}: must be in [0, {}]", time_s, kMaxTeleopDuration_s));
  const Time stamp = from_seconds(time_s);
  if (since && stamp <= *since) refuse(fmt::format("time_s = {}: must be later than in the line before", time_s));
  const auto check_speed = [&](const char* key, double value) {
    if (std::abs(value) > kMaxTeleopSpeed)
      refuse(fmt::format("{} = {}: must be in [-{}, {}]", key, value, kMaxTeleopSpeed, kMaxTeleopSpeed));
  };
  const auto check_button = [&](const char* key, double value) {
    if (value != 0.0 && value != 1.0) refuse(fmt::format("{} = {}: must be 0 or 1", key, value));
  };
  check_speed("vx_mps", vx_mps);
  check_speed("yaw_rate_radps", yaw_rate_radps);
  check_button("mark", save_goal);
  check_button("hand_over", hand_over);
  return {.stamp = stamp,
          .vx_mps = vx_mps,
          .yaw_rate_radps = yaw_rate_radps,
          .save_goal = save_goal == 1.0,
          .hand_over = hand_over == 1.0};
}

}  // namespace

std::vector<TeleopCommand> load_teleop(const std::filesystem::path& file) {
  std::istringstream lines(load_text(file));
  std::vector<TeleopCommand> commands;
  std::optional<Time> since;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.ends_with('\r')) line.pop_back();
    const auto refuse = [&](const std::string& what) { throw input_error(file.string(), number, what); };
    if (number == 1) {
      if (line != header()) refuse("the first line must be " + header());
      continue;
    }
    commands.push_back(read_command(line, since, refuse));
    since = commands.back().stamp;
  }
  if (commands.empty()) throw InputError(file.string() + ": contains no commands");
  return commands;
}

void save_teleop(const std::filesystem::path& file, const std::vector<TeleopCommand>& commands) {
  std::string text = header() + "\n";
  for (const TeleopCommand& command : commands) {
    text += fmt::format("{},{},{},{:d},{:d}\n", to_seconds(command.stamp), command.vx_mps, command.yaw_rate_radps,
                        command.save_goal, command.hand_over);
  }
  save_text(file, text);
}

}  // namespace patrol::io
