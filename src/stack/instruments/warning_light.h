#pragma once

#include <optional>

#include "stack/output/stack_output.h"

namespace patrol::stack {

/// Warning light and siren. The light stays on from the first warning; the siren sounds for `siren_duration_s` at every
/// alarm.
class WarningLight {
 public:
  explicit WarningLight(double siren_duration_s) : siren_s_(siren_duration_s) {}

  void warn(Time now, WarningLevel level, StackOutput& output);
  /// Switches the siren off after its duration. Call once per control period.
  void step(Time now, StackOutput& output);

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(max_warning_, siren_until_);
  }

 private:
  double siren_s_;
  WarningLevel max_warning_ = WarningLevel::kNone;
  std::optional<Time> siren_until_;
};

}  // namespace patrol::stack
