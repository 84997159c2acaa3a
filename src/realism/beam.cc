#include "realism/beam.h"

#include <cmath>

namespace patrol::realism {
namespace {

/// Returns whether a neighboring beam returns from the same object off its own expected surface.
bool is_of_same_object(const Beam& beam, const Beam& neighbor, const BeamRules& rules) {
  if (!neighbor.is_return() || std::abs(neighbor.recorded_m - beam.recorded_m) > rules.neighbor_m) return false;
  if (!neighbor.expected.has_surface()) return true;
  const double residual_m = neighbor.residual_m();
  return std::abs(residual_m) > rules.max_residual_m && (residual_m > 0.0) == (beam.residual_m() > 0.0);
}

BeamClass class_of(const BeamRules& rules, const std::vector<Beam>& beams, std::size_t i) {
  const Beam& beam = beams[i];
  if (beam.recorded_m < 0.0) return BeamClass::kNear;
  if (beam.expected.is_glass) return BeamClass::kGlass;
  if (!beam.expected.has_surface()) return beam.is_return() ? BeamClass::kUnexplained : BeamClass::kEmpty;
  if (!beam.is_return()) return BeamClass::kDropout;
  if (!beam.expected.is_smooth) return BeamClass::kEdge;
  if (std::abs(beam.residual_m()) <= rules.max_residual_m) return BeamClass::kStatic;
  const bool has_neighbor = (i > 0 && is_of_same_object(beam, beams[i - 1], rules)) ||
                            (i + 1 < beams.size() && is_of_same_object(beam, beams[i + 1], rules));
  if (has_neighbor) return BeamClass::kMoving;
  return beam.residual_m() < 0.0 ? BeamClass::kShort : BeamClass::kFar;
}

}  // namespace

void classify(const BeamRules& rules, std::vector<Beam>& beams) {
  for (std::size_t i = 0; i < beams.size(); ++i) beams[i].kind = class_of(rules, beams, i);
}

}  // namespace patrol::realism
