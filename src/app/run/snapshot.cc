#include "app/run/snapshot.h"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/scenario/run_hash.h"
#include "app/scenario/settings_difference.h"
#include "core/error.h"
#include "core/text.h"
#include "io/files/atomic_file.h"
#include "io/files/digest.h"
#include "io/files/zstd_bytes.h"

namespace patrol::app {
namespace {

constexpr std::string_view kMagic = "PATROL SNAPSHOT 2 ";  ///< followed by the checksum of the rest, and a line end
constexpr const char* kExtension = ".snap";

/// Name of the snapshot of an instant: its seconds, exact to the nanosecond.
std::string name_of(Time time) {
  std::string seconds = fmt::format("{}.{:09}", time.count() / 1'000'000'000, time.count() % 1'000'000'000);
  seconds.erase(seconds.find_last_not_of('0') + 1);
  if (seconds.ends_with('.')) seconds.pop_back();
  return seconds + kExtension;
}

/// Time by the name of a snapshot, none for other files.
std::optional<Time> time_of(const std::filesystem::path& file) {
  if (file.extension() != kExtension) return std::nullopt;
  std::istringstream stem(file.stem().string());
  double seconds = 0.0;
  if (!(stem >> seconds) || !stem.eof()) return std::nullopt;
  return from_seconds(seconds);
}

RunState read_snapshot(const std::filesystem::path& file, const std::string& content) {
  const std::string all_bytes = io::load_text(file);
  std::string_view bytes = all_bytes;
  if (!bytes.starts_with(kMagic)) throw InputError(file.string() + ": is not a snapshot of this version");
  bytes.remove_prefix(kMagic.size());
  const std::size_t checksum_end = bytes.find('\n');
  const std::string_view checksum = bytes.substr(0, checksum_end);
  bytes.remove_prefix(checksum_end == std::string_view::npos ? bytes.size() : checksum_end + 1);
  if (checksum != io::sha256(bytes)) throw InputError(file.string() + ": is damaged");
  try {
    const std::size_t header_end = bytes.find('\n');
    const auto header = nlohmann::json::parse(bytes.substr(0, header_end));
    if (header.at("content").get<std::string>() != content) {
      throw InputError(
          fmt::format("{}: belongs to another build of patrol, or the scenario or its files have changed "
                      "since: repeat the run with --snapshot-every",
                      file.string()));
    }
    return {.time = Time{header.at("time_ns").get<std::int64_t>()},
            .bytes = io::zstd_decompressed(bytes.substr(header_end + 1), header.at("size").get<std::uint64_t>())};
  } catch (const nlohmann::json::exception&) {
    throw InputError(file.string() + ": is damaged");
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw InputError(fmt::format("{}: is damaged: {}", file.string(), error.what()));
  }
}

bool may_change(const std::string& path) {
  return std::ranges::any_of(branch_settings(), [&](const std::string& setting) {
    if (setting.ends_with('.')) return path.starts_with(setting);
    return path == setting || path.starts_with(setting + ".");  // entries of a list
  });
}

/// Scenario of the events up to an instant alone. The readings at the instant have been taken, kidnaps come after it.
Scenario past_events(const Scenario& scenario, Time at) {
  Scenario past;
  std::ranges::copy_if(scenario.faults, std::back_inserter(past.faults),
                       [&](const auto& fault) { return from_seconds(fault.start_s) <= at; });
  std::ranges::copy_if(scenario.kidnaps, std::back_inserter(past.kidnaps),
                       [&](const auto& kidnap) { return from_seconds(kidnap.at_s) < at; });
  return past;
}

}  // namespace

std::string content_hash(const Scenario& scenario, const std::filesystem::path& data_root) {
  return RunHasher(data_root).hash(scenario);
}

SnapshotFolder::SnapshotFolder(std::filesystem::path folder, std::string content, std::string name)
    : folder_(std::move(folder)), content_(std::move(content)), name_(std::move(name)) {}

void SnapshotFolder::save(const RunState& state) const {
  std::filesystem::create_directories(folder_);
  const nlohmann::ordered_json header = {
      {"name", name_}, {"content", content_}, {"time_ns", state.time.count()}, {"size", state.bytes.size()}};
  const std::string rest = header.dump() + '\n' + io::zstd_compressed(state.bytes);
  io::save_text(folder_ / name_of(state.time), fmt::format("{}{}\n{}", kMagic, io::sha256(rest), rest));
}

std::vector<Time> snapshot_times(const std::filesystem::path& folder) {
  std::vector<Time> times;
  if (!std::filesystem::is_directory(folder)) return times;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (const std::optional<Time> time = time_of(entry.path())) times.push_back(*time);
  }
  std::ranges::sort(times);
  return times;
}

std::optional<RunState> load_snapshot(const std::filesystem::path& folder, Time at, const std::string& content) {
  if (!std::filesystem::is_directory(folder)) return std::nullopt;
  std::optional<std::pair<Time, std::filesystem::path>> newest;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::optional<Time> time = time_of(entry.path());
    if (time && *time <= at && (!newest || *time > newest->first)) newest = {*time, entry.path()};
  }
  if (!newest) return std::nullopt;
  return read_snapshot(newest->second, content);
}

const std::vector<std::string>& branch_settings() {
  static const std::vector<std::string> settings = {
      "time_limit_s",
      "expect",
      "faults",
      "kidnaps",
      "leaks",
      "wind.",
      "stack.localization.",
      "stack.sensor_monitor.",
      "stack.docking.",
      "stack.gas_mission.",
      "stack.tunnel_mission.",
      "stack.navigation.local_planner.",
      "stack.navigation.goal_controller.",
      "stack.navigation.global_planner.",
      "stack.navigation.planner_cells_per_s",
      "stack.navigation.replan_period_s",
      "stack.navigation.path_check_distance_m",
      "stack.navigation.max_path_deviation_m",
      "stack.navigation.goal_approach_distance_m",
      "stack.navigation.approach_deceleration_mps2",
      "stack.navigation.turn_in_place_threshold_rad",
      "stack.navigation.turn_in_place_rate_radps",
      "stack.navigation.blocked_timeout_s",
      "stack.navigation.no_progress_timeout_s",
      "stack.navigation.new_obstacle_wait_s",
      "stack.navigation.unmapped_obstacle_slowdown_distance_m",
      "stack.navigation.unmapped_obstacle_max_speed_mps",
      "stack.navigation.no_path_timeout_s",
  };
  return settings;
}

void check_branch_settings(const Scenario& parent, const Scenario& branch, Time at) {
  const auto is_freeze = [](const sim::FaultSettings& fault) {
    return fault.sensor == SensorTraits<PanoramicScan>::kInfo.name && fault.kind == "freeze";
  };
  if (to_yaml(past_events(parent, at)) != to_yaml(past_events(branch, at)))
    throw InputError(fmt::format("--from: faults and kidnaps up to {:.3f} s cannot change", to_seconds(at)));
  if (branch.time_limit_s < to_seconds(at))
    throw InputError(fmt::format("--from: time_limit_s = {:g} is before the branch: must be at least {:.3f} s",
                                 branch.time_limit_s, to_seconds(at)));
  if (std::ranges::any_of(branch.faults, is_freeze) && std::ranges::none_of(parent.faults, is_freeze))
    throw InputError("--from: faults: a branch cannot add the first freeze of the scanner: its last scan is not kept");
  std::vector<SettingDifference> differences = settings_differences(parent, branch);
  for (const SettingDifference& removed : settings_differences(branch, parent)) differences.push_back(removed);
  for (const SettingDifference& difference : differences) {
    if (may_change(difference.path)) continue;
    throw InputError(
        fmt::format("--set {}: cannot change in a branch: it shapes the state of the run; a branch may change: {}",
                    difference.path, join(branch_settings(), ", ")));
  }
}

}  // namespace patrol::app
