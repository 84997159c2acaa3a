#pragma once

#include <string>

#include "report/blocks.h"

namespace patrol::app {

/// Result of checking a mapped log.
struct MappingVerdict {
  std::string word;
  report::Tone tone;
  std::string reason;

  std::string line() const { return word + ": " + reason; }
};

}  // namespace patrol::app
