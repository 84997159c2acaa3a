#pragma once

#include "io/files/table.h"
#include "io/json/metrics_json.h"

namespace patrol::io {

/// Rows of a table as a list of objects, one key per column; an empty cell is null.
Metrics to_json(const Table& table);

}  // namespace patrol::io
