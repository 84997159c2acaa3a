#pragma once

#include "core/grid.h"

namespace patrol::importer {

/// Marks the cells within a square of `reach` cells to each side of a marked one (not 0).
Grid<char> dilated(const Grid<char>& marked, int reach);

/// Marks the cells without a mark that are connected, by their edges, to the edge of the grid.
Grid<char> outer_cells(const Grid<char>& marked);

}  // namespace patrol::importer
