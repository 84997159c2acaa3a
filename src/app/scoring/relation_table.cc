#include "app/scoring/relation_table.h"

#include <fmt/format.h>

namespace patrol::app {
namespace {

/// Formats a line "  translation squared, m2       0.0011     0.0042".
std::string spread_text(const char* name, const score::ErrorSpread& spread, int digits) {
  return fmt::format("  {:<24} {:>10.{}f} {:>10.{}f}", name, spread.mean, digits, spread.std, digits);
}

}  // namespace

std::string relation_table(const score::RelationError& error) {
  const std::size_t num_nearest = error.num_stamps - error.num_interpolated - error.num_outside - error.num_in_holes;
  std::string table = fmt::format(
      "{} of {} relations scored, {} stamps: {} nearest poses, {} interpolated, {} outside the estimate, {} "
      "in its holes\n\n",
      error.num_relations, error.num_given, error.num_stamps, num_nearest, error.num_interpolated, error.num_outside,
      error.num_in_holes);
  table += fmt::format("  {:<24} {:>10} {:>10} {:>10} {:>10}\n", "", "mean", "std", "median", "max");
  table += spread_text("translation, m", error.trans_m, 4) +
           fmt::format(" {:>10.4f} {:>10.3f}\n", error.trans_median_m, error.trans_max_m);
  table += spread_text("translation squared, m2", error.squared_trans_m2, 4) + "\n";
  table += spread_text("rotation, deg", error.rot_deg, 3) +
           fmt::format(" {:>10.3f} {:>10.2f}\n", error.rot_median_deg, error.rot_max_deg);
  table += spread_text("rotation squared, deg2", error.squared_rot_deg2, 3) + "\n";
  return table;
}

io::Metrics relation_json(const score::RelationError& error) {
  const auto spread = [](const score::ErrorSpread& value) {
    return io::Metrics{{"mean", value.mean}, {"std", value.std}};
  };
  io::Metrics json{{"relations", error.num_relations},
                   {"given", error.num_given},
                   {"stamps", error.num_stamps},
                   {"interpolated", error.num_interpolated},
                   {"outside", error.num_outside},
                   {"in_holes", error.num_in_holes},
                   {"translation_m", spread(error.trans_m)},
                   {"squared_translation_m2", spread(error.squared_trans_m2)},
                   {"rotation_deg", spread(error.rot_deg)},
                   {"squared_rotation_deg2", spread(error.squared_rot_deg2)}};
  json["translation_m"]["median"] = error.trans_median_m;
  json["translation_m"]["max"] = error.trans_max_m;
  json["rotation_deg"]["median"] = error.rot_median_deg;
  json["rotation_deg"]["max"] = error.rot_max_deg;
  return json;
}

}  // namespace patrol::app
