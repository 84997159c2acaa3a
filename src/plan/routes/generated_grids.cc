#include "plan/routes/generated_grids.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "core/random.h"
#include "plan/routes/route_planner.h"

namespace patrol::plan {
namespace {

constexpr std::uint64_t kMaxSamples = 100;

bool are_connected(const Grid<Cost>& costs, Cell start, Cell goal) {
  const std::vector<Cell> reached = reachable_cells(costs, start);
  return std::find(reached.begin(), reached.end(), goal) != reached.end();
}

void fill(Grid<Cost>& costs, Cell first, int width, int height, Cost cost) {
  for (int row = first.row; row < std::min(first.row + height, costs.geometry().height); ++row) {
    for (int col = first.col; col < std::min(first.col + width, costs.geometry().width); ++col)
      costs.at({col, row}) = cost;
  }
}

void generate_random(const GeneratedGridSettings& settings, RandomSequence random, GeneratedGrid& grid) {
  for (Cost& cost : grid.costs.values()) cost = random.uniform() < settings.lethal_fraction ? kLethalCost : kFreeCost;
  grid.costs.at(grid.start) = grid.costs.at(grid.goal) = kFreeCost;
}

/// Walls one cell thick every `room_cells`. Three in four walls between two rooms have a door, at a random position.
void generate_rooms(const GeneratedGridSettings& settings, RandomSequence random, GeneratedGrid& grid) {
  constexpr double kDoorProbability = 0.75;
  const int size = settings.size_cells, room = settings.room_cells;
  for (int wall = room - 1; wall < size; wall += room) {
    fill(grid.costs, {wall, 0}, 1, size, kLethalCost);
    fill(grid.costs, {0, wall}, size, 1, kLethalCost);
  }
  const auto door_width = [&](int first) { return std::min({settings.door_cells, room - 1, size - first}); };
  for (int wall = room - 1; wall + 1 < size; wall += room) {
    for (int first = 0; first < size; first += room) {
      const int length = std::min(room - 1, size - first), width = std::min(door_width(first), length);
      for (const bool is_vertical : {true, false}) {
        const int position = first + static_cast<int>(random.index(static_cast<std::size_t>(length - width + 1)));
        if (random.uniform() >= kDoorProbability) continue;
        if (is_vertical) fill(grid.costs, {wall, position}, 1, width, kFreeCost);
        else fill(grid.costs, {position, wall}, width, 1, kFreeCost);
      }
    }
  }
}

/// Depth-first carving: from the last corridor cell with an uncarved neighbor, to a random one of these.
void generate_maze(const GeneratedGridSettings& settings, RandomSequence random, GeneratedGrid& grid) {
  const int corridor = settings.corridor_cells, pitch = corridor + 1,
            count = std::max(1, (settings.size_cells + 1) / pitch);
  fill(grid.costs, {0, 0}, settings.size_cells, settings.size_cells, kLethalCost);
  Grid<std::uint8_t> is_carved({.resolution_m = 1.0, .width = count, .height = count}, 0);
  std::vector<Cell> path{{0, 0}};
  is_carved.at({0, 0}) = 1;
  fill(grid.costs, {0, 0}, corridor, corridor, kFreeCost);
  while (!path.empty()) {
    const Cell here = path.back();
    std::vector<GridStep> open;
    for (std::size_t direction = 0; direction < kFirstDiagonal; ++direction) {
      const Cell next{here.col + kGridSteps[direction].col, here.row + kGridSteps[direction].row};
      if (is_carved.contains(next) && is_carved.at(next) == 0) open.push_back(kGridSteps[direction]);
    }
    if (open.empty()) {
      path.pop_back();
      continue;
    }
    const GridStep step = open[random.index(open.size())];
    const Cell next{here.col + step.col, here.row + step.row};
    const Cell first{pitch * std::min(here.col, next.col), pitch * std::min(here.row, next.row)};
    fill(grid.costs, first, step.col != 0 ? corridor + pitch : corridor, step.row != 0 ? corridor + pitch : corridor,
         kFreeCost);
    is_carved.at(next) = 1;
    path.push_back(next);
  }
  grid.goal = {pitch * (count - 1), pitch * (count - 1)};
}

}  // namespace

GeneratedGrid generate_grid(const GeneratedGridSettings& settings, std::uint64_t seed) {
  validate(settings, "grid");
  const int size = settings.size_cells;
  const RandomStream stream(seed, "plan/routes/grid/" + settings.kind);
  const GridGeometry geometry{.resolution_m = 1.0, .width = size, .height = size};
  // The last row and column are walls if the size is a multiple of the room size.
  const int far = settings.kind == "rooms" && size % settings.room_cells == 0 ? size - 2 : size - 1;
  for (std::uint64_t sample = 0; sample < kMaxSamples; ++sample) {
    GeneratedGrid grid{.costs = Grid<Cost>(geometry, kFreeCost), .start = {0, 0}, .goal = {far, far}};
    const RandomSequence random(stream, sample);
    if (settings.kind == "random") generate_random(settings, random, grid);
    else if (settings.kind == "rooms") generate_rooms(settings, random, grid);
    else generate_maze(settings, random, grid);
    if (are_connected(grid.costs, grid.start, grid.goal)) return grid;
  }
  throw InputError(fmt::format("grid: corners not connected in {} samples of {} x {} cells, {}", kMaxSamples, size,
                               size, settings.kind));
}

}  // namespace patrol::plan
