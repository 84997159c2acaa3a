#include "io/points/station_scans.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "core/error.h"
#include "io/files/atomic_file.h"
#include "io/json/json_object.h"
#include "io/points/ply.h"
#include "io/points/point_collector.h"
#include "io/points/point_reading.h"

namespace patrol::io {
namespace {

constexpr std::size_t kMaxScans = 1000;

struct Entry {
  std::string station;
  Pose3 T_map_scanner;
};

std::filesystem::path index_file(const std::filesystem::path& folder) { return folder / "scans.json"; }

std::filesystem::path cloud_file(const std::filesystem::path& folder, const std::string& station) {
  return folder / (station + ".ply");
}

/// Returns whether a name is usable as a file name: letters, digits and underscores, at most 64.
bool is_plain(const std::string& name) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  return !name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), plain);
}

std::vector<Entry> load_index(const std::filesystem::path& folder) {
  const std::filesystem::path file = index_file(folder);
  const Json json = load_json(file, kMaxScans);
  if (!json.is_array()) throw InputError(file.string() + ": must be a list of scans");
  std::vector<Entry> entries;
  std::set<std::string> stations;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const JsonObject reader(fmt::format("{}: [{}]", file.string(), i), json[i], {"station", "position", "orientation"});
    Entry entry{.station = reader.string("station"),
                .T_map_scanner = to_pose3(reader.pose(), reader.numbers("position", 3)[2])};
    if (!is_plain(entry.station))
      reader.fail(fmt::format("station = {}: must be made of letters, digits and underlines", entry.station));
    if (!stations.insert(entry.station).second) reader.fail(fmt::format("station {}: duplicate", entry.station));
    entries.push_back(std::move(entry));
  }
  return entries;
}

}  // namespace

void save_station_scans(const std::filesystem::path& folder, const std::vector<StationScan>& scans) {
  std::filesystem::create_directories(folder);
  Json json = Json::array();
  for (const StationScan& scan : scans) {
    save_ply(cloud_file(folder, scan.station), scan.points, "panoramic scan of " + scan.station + ", in map");
    const Eigen::Vector3d& p = scan.T_map_scanner.position;
    const Eigen::Quaterniond& q = scan.T_map_scanner.rotation;
    json.push_back({{"station", scan.station},
                    {"position", {p.x(), p.y(), p.z()}},
                    {"orientation", {q.x(), q.y(), q.z(), q.w()}}});
  }
  save_text(index_file(folder), json.dump(1) + "\n");
}

std::vector<StationScan> load_station_scans(const std::filesystem::path& folder) {
  std::vector<StationScan> scans;
  for (const auto& [station, T_map_scanner] : load_index(folder)) {
    scans.push_back(
        {.station = station, .T_map_scanner = T_map_scanner, .points = load_ply(cloud_file(folder, station))});
  }
  return scans;
}

RelativeScans load_relative_scans(const std::filesystem::path& folder, double unit_m) {
  RelativeScans relative;
  const std::vector<Entry> entries = load_index(folder);
  if (!entries.empty()) relative.origin = origin_of(entries.front().T_map_scanner.position, unit_m);
  for (const auto& [station, T_map_scanner] : entries) {
    PointShift shift{.origin = relative.origin, .num_dropped = 0, .unit_m = unit_m};
    relative.scans.push_back({.station = station,
                              .T_map_scanner = {T_map_scanner.position - relative.origin, T_map_scanner.rotation},
                              .points = load_shifted_ply(cloud_file(folder, station), shift)});
    relative.num_dropped += shift.num_dropped;
  }
  return relative;
}

std::vector<std::filesystem::path> station_scan_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files = {index_file(folder)};
  for (const Entry& entry : load_index(folder)) files.push_back(cloud_file(folder, entry.station));
  return files;
}

}  // namespace patrol::io
