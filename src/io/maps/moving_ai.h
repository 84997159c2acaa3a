#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/grid.h"

namespace patrol::io {

/// Map of the MovingAI benchmarks [Sturtevant12] (movingai.com/benchmarks/formats.html). Files list rows from the top;
/// here, as in every grid, row 0 is the lowest. A cell is 1 m wide.
struct MovingAiMap {
  Grid<char> terrain;  ///< '.' and 'G' ground, 'S' swamp, 'W' water, '@' and 'O' out of bounds, 'T' trees
};

/// Reads a .map file. Throws InputError with file and line. Memory is proportional to the file size and limited to 10^8
/// cells.
MovingAiMap load_moving_ai_map(const std::filesystem::path& file);

/// Converts a map to free and occupied cells for an agent at `start`. On land, ground and swamp are free; in water,
/// only water is free; the two are not connected. If `start` is not traversable or is outside the map, the rules for
/// land apply.
OccupancyGrid to_occupancy(const MovingAiMap& map, Cell start);

/// Path problem: one line of a .scen file.
struct MovingAiProblem {
  int bucket = 0;
  std::string map;            ///< map name in the file
  int width = 0, height = 0;  ///< size of the map in cells
  Cell start = {}, goal = {};
  /// Optimal path length, cells: 8-connected, sqrt 2 per diagonal step, no step past the corner of a blocked cell.
  double optimal_length = 0.0;
  /// Maximum rounding error of `optimal_length`, cells, from the number of digits in the file.
  double length_rounding = 0.0;
  int line = 0;  ///< line number in the file
};

/// Returns the maximum rounding error of a length as written: half a unit of its last significant digit, or of the
/// sixth if it has fewer. Many .scen files print six significant digits without trailing zeros: "1024" may mean
/// 1024.004.
double rounding_of(std::string_view length);

/// Reads a .scen file. Throws InputError with file and line.
std::vector<MovingAiProblem> load_moving_ai_problems(const std::filesystem::path& file);

}  // namespace patrol::io
