#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/grid.h"

namespace patrol::io {

/// A map of the MovingAI benchmarks (Sturtevant, "Benchmarks for grid-based pathfinding", 2012; movingai.com/benchmarks/formats.html). Files count rows from the
/// top; here, as in every grid, row 0 is the lowest. A cell counts as 1 m.
struct MovingAiMap {
  Grid<char> terrain;  ///< '.' and 'G' ground, 'S' swamp, 'W' water, '@' and 'O' out of bounds, 'T' trees
};

/// Throws InputError with the file and the line. Memory stays in proportion to the file, and below 10^8 cells.
MovingAiMap load_moving_ai_map(const std::filesystem::path& file);

/// Free and occupied cells for one who stands at `start`: on land ground and swamp are free, in water only water; from one to the other there is no way.
/// Outside the map and where nobody can stand, land's.
OccupancyGrid to_occupancy(const MovingAiMap& map, Cell start);

/// A line of a .scen file.
struct MovingAiProblem {
  int bucket = 0;
  std::string map;              ///< as the file names it
  int width = 0, height = 0;    ///< of the map
  Cell start = {}, goal = {};
  double optimal_length = 0.0;  ///< cells: eight neighbours, sqrt 2 for a diagonal, none past the corner of a blocked cell
  double length_rounding = 0.0;  ///< cells: largest rounding error of `optimal_length`, by the digits that the file gives
  int line = 0;                 ///< of the file
};

/// Largest rounding error of a length as written: half a unit of its last significant digit, or of the sixth where fewer digits
/// are given. Many .scen files print six significant digits and drop trailing zeros: "1024" may stand for 1024.004.
double rounding_of(std::string_view length);

/// Throws InputError with the file and the line.
std::vector<MovingAiProblem> load_moving_ai_problems(const std::filesystem::path& file);

}  // namespace patrol::io
