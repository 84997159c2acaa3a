#pragma once

#include <cstdint>

#include "core/grid.h"
#include "core/settings.h"
#include "plan/perception/costmap.h"

namespace patrol::plan {

struct GeneratedGridSettings {
  std::string kind = "random";  ///< random: lethal cells by chance; rooms: walls with doors; maze: corridors, one way between any two of them
  int size_cells = 50;          ///< square
  double lethal_share = 0.25;   ///< of random's cells
  int room_cells = 10;          ///< of rooms, wall to wall
  int door_cells = 2;           ///< width of the rooms' doors
  int corridor_cells = 1;       ///< width of the maze's

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("kind", self.kind, one_of({"random", "rooms", "maze"}));
    visit("size_cells", self.size_cells, between(1, 10000));
    visit("lethal_share", self.lethal_share, between(0.0, 0.4));
    visit("room_cells", self.room_cells, between(3, 1000));
    visit("door_cells", self.door_cells, between(1, 100));
    visit("corridor_cells", self.corridor_cells, between(1, 100));
  }
};

/// A grid of free and lethal cells, and two ends far apart between which there is a way.
struct GeneratedGrid {
  Grid<Cost> costs;
  Cell start;  ///< near the lower-left corner, as in paper 003
  Cell goal;   ///< near the upper-right
};

/// The same settings and seed give the same grid. Throws InputError if a hundred draws leave no way between the corners.
GeneratedGrid generate_grid(const GeneratedGridSettings& settings, std::uint64_t seed);

}  // namespace patrol::plan
