#pragma once

#include <cstdint>

#include "core/grid.h"
#include "core/settings.h"
#include "plan/perception/costmap.h"

namespace patrol::plan {

struct GeneratedGridSettings {
  std::string kind = "random";    ///< random: independent lethal cells; rooms: walls with doors; maze: corridor tree
  int size_cells = 50;            ///< side of the square grid
  double lethal_fraction = 0.25;  ///< probability of a lethal cell, kind random
  int room_cells = 10;            ///< size of a room, from wall to wall
  int door_cells = 2;             ///< width of the doors of rooms
  int corridor_cells = 1;         ///< width of the corridors of a maze

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("kind", self.kind, one_of({"random", "rooms", "maze"}));
    visit("size_cells", self.size_cells, between(1, 10000));
    visit("lethal_fraction", self.lethal_fraction, between(0.0, 0.4));
    visit("room_cells", self.room_cells, between(3, 1000));
    visit("door_cells", self.door_cells, between(1, 100));
    visit("corridor_cells", self.corridor_cells, between(1, 100));
  }
};

/// Grid of free and lethal cells with two distant ends that are connected.
struct GeneratedGrid {
  Grid<Cost> costs;
  Cell start;  ///< near the lower-left corner, as in [Li22]
  Cell goal;   ///< near the upper-right corner
};

/// Generates a grid; equal settings and seeds give equal grids. Throws InputError if the corners are not connected in
/// any of 100 samples.
GeneratedGrid generate_grid(const GeneratedGridSettings& settings, std::uint64_t seed);

}  // namespace patrol::plan
