#pragma once

#include <CLI/CLI.hpp>

#include "io/json/metrics_json.h"

namespace patrol::app {

/// Data of the reference pages, which tools/reference writes: commands, settings, metrics, events and topics.
io::Metrics reference_json(const CLI::App& app);

}  // namespace patrol::app
