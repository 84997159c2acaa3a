#include <cstdio>

#include "core/trajectory.h"
#include "slam/grid_map.h"

int main() {
  patrol::slam::GridMap map(0.05, 10.0);
  map.add_hit({0.5, 0.25});
  std::printf("%s\n", map.find(map.cell_at({0.5, 0.25}))->is_observed() ? "known" : "unknown");
}
