#include "io/remote_csv.h"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>

#include <fmt/format.h>

#include "core/error.h"
#include "io/atomic_file.h"

namespace patrol::io {
namespace {

constexpr const char* kHeader = "time_s,vx_mps,yaw_rate_radps,mark,hand_over";
constexpr std::size_t kColumns = 5;

/// None unless the line is so many numbers with commas between.
std::optional<std::array<double, kColumns>> numbers_of(const std::string& line) {
  std::array<double, kColumns> values{};
  const char *at = line.data(), *const end = line.data() + line.size();
  for (std::size_t i = 0; i < kColumns; ++i) {
    const auto [rest, error] = std::from_chars(at, end, values[i]);
    const bool is_last = i + 1 == kColumns;
    const bool ends_well = is_last ? rest == end : rest != end && *rest == ',';
    if (error != std::errc() || !ends_well || !std::isfinite(values[i])) return std::nullopt;
    if (!is_last) at = rest + 1;
  }
  return values;
}

}  // namespace

std::vector<RemoteCommand> load_remote(const std::filesystem::path& file) {
  std::istringstream lines(load_text(file));
  std::vector<RemoteCommand> commands;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.ends_with('\r')) line.pop_back();
    const auto refuse = [&](const std::string& what) { throw input_error(file.string(), number, what); };
    if (number == 1) {
      if (line != kHeader) refuse(fmt::format("the first line must be {}", kHeader));
      continue;
    }
    const auto values = numbers_of(line);
    if (!values) refuse(fmt::format("must be {} numbers with commas between", kColumns));
    const auto [time_s, vx_mps, yaw_rate_radps, mark, hand_over] = *values;
    if ((mark != 0.0 && mark != 1.0) || (hand_over != 0.0 && hand_over != 1.0)) refuse("a button must be 0 or 1");
    const Time stamp = from_seconds(time_s);
    if (time_s < 0.0 || (!commands.empty() && stamp <= commands.back().stamp)) refuse("times must grow from 0");
    commands.push_back({.stamp = stamp, .vx_mps = vx_mps, .yaw_rate_radps = yaw_rate_radps, .mark = mark == 1.0,
                        .hand_over = hand_over == 1.0});
  }
  if (commands.empty()) throw InputError(file.string() + ": holds no command");
  return commands;
}

void save_remote(const std::filesystem::path& file, const std::vector<RemoteCommand>& commands) {
  std::string text = std::string(kHeader) + "\n";
  for (const RemoteCommand& command : commands) {
    text += fmt::format("{},{},{},{:d},{:d}\n", to_seconds(command.stamp), command.vx_mps, command.yaw_rate_radps, command.mark,
                        command.hand_over);
  }
  save_text(file, text);
}

}  // namespace patrol::io
