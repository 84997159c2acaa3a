#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "importer/normalizer.h"

namespace patrol::importer {

/// Reports a mass that no robot for inspection has.
void Normalizer::check_mass() {
  constexpr double kMax_kg = 20000.0;
  const double mass_kg = total_mass_kg();
  if (mass_kg <= kMax_kg) return;
  const auto mass_of = [](const NormalizedLink& link) { return link.inertial ? link.inertial->mass_kg : 0.0; };
  const auto heaviest = std::max_element(
      result_.links.begin(), result_.links.end(),
      [&mass_of](const NormalizedLink& a, const NormalizedLink& b) { return mass_of(a) < mass_of(b); });
  assume("mass",
         fmt::format("{:.0f} kg of the file are kept, although more than {:.0f} kg are unlikely: {} has {:.0f} kg",
                     mass_kg, kMax_kg, heaviest->name, mass_of(*heaviest)),
         "<mass> of the links");
}

/// Reports links that are denser than any material. Links without a considerable part of the mass do not count.
void Normalizer::check_densities() {
  constexpr double kMax_kgpm3 = 25000.0, kConsiderable = 0.01;  // of osmium: 22,600 kg/m3; to the mass of the robot
  for (const SourceLink& link : source_.links) {
    if (!link.inertial || link.inertial->mass_kg < kConsiderable * source_kg_ || !link.has_shapes()) continue;
    const auto volume_of = [](const std::vector<Shape>& shapes) {
      double sum_m3 = 0.0;
      for (const Shape& shape : shapes) sum_m3 += solid_of(shape).volume_m3;
      return sum_m3;
    };
    const double volume_m3 = std::max(volume_of(link.collisions), volume_of(link.visuals));
    if (volume_m3 <= 0.0 || link.inertial->mass_kg <= kMax_kgpm3 * volume_m3) continue;
    assume(
        link.name,
        fmt::format("{:.3g} kg of the file are kept, although its shapes of {:.3g} m3 would be of {:.0f} kg/m3: more "
                    "than {:.0f} kg/m3 are unlikely",
                    link.inertial->mass_kg, volume_m3, link.inertial->mass_kg / volume_m3, kMax_kgpm3),
        "<mass> of the link, in kg, or its shapes, in m");
  }
}

}  // namespace patrol::importer
