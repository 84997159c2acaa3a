#pragma once

#include <optional>
#include <string>

namespace patrol::app {

/// Measured value of a maneuver with its limits. The end of the name is the unit: "_m", "_deg", "_s", "_mps", "_ratio".
struct Figure {
  std::string name;
  double value = 0.0;
  std::optional<double> min = std::nullopt;
  std::optional<double> max = std::nullopt;
  std::string limit_reason = "";  ///< why these limits
  bool is_key = false;            ///< shown on the terminal

  bool is_met() const { return !(min && !(value >= *min)) && !(max && !(value <= *max)); }
};

/// "slip ratio" of "slip_ratio": the name without underscores and without the units of lengths, angles and times.
std::string label_of(const Figure& figure);
/// Value with a unit that suits its magnitude, and with enough digits to tell it from a limit that it does not meet.
std::string value_text(const Figure& figure);
/// "at most 5.0 cm", "at least 9.6 m", "0.900 to 1.100"; empty without limits.
std::string limit_text(const Figure& figure);

}  // namespace patrol::app
