#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace patrol::io {

/// A place that a tour is to visit.
struct TourStation {
  std::string name = {};
  double x = 0.0, y = 0.0;  ///< as the tour's map names places
  double service_s = 0.0;   ///< spent there
  double earliest_s = 0.0, latest_s = std::numeric_limits<double>::infinity();  ///< when the service may begin, from the tour's start
  int priority = 0;         ///< all stations of a lower one come first
  int line = 0;             ///< of the file
};

/// A table (RFC 4180) whose header names, in any order, the columns name, x, y and, if they are there, service_s, earliest_s, latest_s, priority; of
/// these four an empty cell is the default. Throws InputError with the file and the line.
std::vector<TourStation> load_tour_stations(const std::filesystem::path& file);

}  // namespace patrol::io
