#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace patrol::io {

/// Station of a tour, a traveling-salesman problem with time windows.
struct TourStation {
  std::string name = {};
  double x = 0.0, y = 0.0;                 ///< position in the coordinates of the map of the tour
  std::optional<double> heading_deg = {};  ///< heading at the station; none: any
  double service_s = 0.0;                  ///< time spent at the station
  /// Time window for the start of the service, since the start of the tour.
  double earliest_s = 0.0, latest_s = std::numeric_limits<double>::infinity();
  int priority = 0;  ///< stations with lower values are all visited first
  int line = 0;      ///< line number in the file
};

/// Reads stations from CSV (RFC 4180). Columns, in any order: name, x, y and optionally heading_deg,
/// service_s, earliest_s, latest_s, priority. An empty cell of an optional column means its default. Throws InputError
/// with file and line.
std::vector<TourStation> load_tour_stations(const std::filesystem::path& file);

}  // namespace patrol::io
