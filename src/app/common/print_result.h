#pragma once

#include <cstdint>
#include <string>

#include "io/json/metrics_json.h"

namespace patrol::app {

/// Form in which a command prints its results to standard output.
enum class ResultForm : std::uint8_t { kText, kJson };

/// Prints `text`, or `json` indented by two spaces. NaN and infinity become null.
void print_result(ResultForm form, const std::string& text, const io::Metrics& json);

}  // namespace patrol::app
