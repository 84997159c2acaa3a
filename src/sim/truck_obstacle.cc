#include "sim/truck_obstacle.h"

namespace patrol::sim {
namespace {

using Color = std::array<float, 4>;
constexpr Color kCab = {0.86f, 0.62f, 0.06f, 1.0f}, kTub = {0.36f, 0.37f, 0.38f, 1.0f},
                kIron = {0.15f, 0.15f, 0.16f, 1.0f}, kRubber = {0.05f, 0.05f, 0.05f, 1.0f},
                kPane = {0.10f, 0.13f, 0.16f, 1.0f}, kSteel = {0.46f, 0.47f, 0.48f, 1.0f},
                kGravel = {0.35f, 0.33f, 0.30f, 1.0f}, kLamp = {1.0f, 0.96f, 0.84f, 1.0f},
                kRed = {0.80f, 0.10f, 0.06f, 1.0f};

/// Returns a box between two corners.
TruckPart box(std::array<double, 2> x, std::array<double, 2> y, std::array<double, 2> z, const Color& rgba) {
  return {.shape = TruckPart::Shape::kBox,
          .center = {(x[0] + x[1]) / 2.0, (y[0] + y[1]) / 2.0, (z[0] + z[1]) / 2.0},
          .half = {(x[1] - x[0]) / 2.0, (y[1] - y[0]) / 2.0, (z[1] - z[0]) / 2.0},
          .rgba = rgba};
}

}  // namespace

std::vector<TruckPart> truck_parts() {
  std::vector<TruckPart> parts = {
      box({-3.6, 3.5}, {-0.45, 0.45}, {0.62, 0.92}, kIron),    // frame
      box({3.55, 3.75}, {-1.22, 1.22}, {0.38, 0.82}, kCab),    // bumper
      box({-3.75, -3.65}, {-1.15, 1.15}, {0.42, 0.66}, kRed),  // underrun guard
      box({2.05, 3.70}, {-1.20, 1.20}, {0.82, 2.30}, kCab),   box({2.05, 3.50}, {-1.12, 1.12}, {2.30, 2.86}, kCab),
      box({3.50, 3.56}, {-1.00, 1.00}, {2.32, 2.78}, kPane),  // windscreen
      box({3.70, 3.72}, {-0.75, 0.75}, {1.10, 1.62}, kIron),  // grille
      box({-3.75, 1.75}, {-1.22, 1.22}, {1.00, 1.14}, kTub),  // dump body: floor, front, rear
      box({1.65, 1.80}, {-1.24, 1.24}, {1.0, 2.75}, kTub),    box({-3.80, -3.68}, {-1.20, 1.20}, {1.0, 2.05}, kTub),
      box({1.70, 2.75}, {-1.20, 1.20}, {2.92, 3.00}, kTub),  // canopy of the dump body over the cab
      box({-3.4, 1.4}, {-1.10, 1.10}, {1.14, 2.10}, kGravel), box({-2.4, 0.4}, {-0.70, 0.70}, {2.10, 2.45}, kGravel),
  };
  for (const double side : {-1.0, 1.0}) {
    const auto across = [side](double inner, double outer) {
      return side > 0.0 ? std::array{inner, outer} : std::array{-outer, -inner};
    };
    parts.push_back(box({-1.3, 1.6}, across(1.12, 1.20), {0.38, 0.78}, kSteel));  // side guard
    parts.push_back(box({-3.75, 1.75}, across(1.15, 1.25), {1.0, 2.20}, kTub));
    parts.push_back(box({2.45, 3.30}, across(1.12, 1.13), {2.34, 2.76}, kPane));
    parts.push_back(box({3.55, 3.62}, across(1.24, 1.44), {1.85, 2.30}, kIron));  // mirror
    parts.push_back(box({3.75, 3.77}, across(0.75, 1.05), {0.88, 1.06}, kLamp));
    parts.push_back(box({-3.82, -3.80}, across(0.80, 1.10), {1.02, 1.14}, kRed));
    for (const double x : {2.75, -1.75, -2.95}) {
      parts.push_back({.shape = TruckPart::Shape::kWheel,
                       .center = {x, 1.02 * side, 0.50},
                       .half = {0.50, 0.19, 0.50},
                       .rgba = kRubber});
      parts.push_back({.shape = TruckPart::Shape::kWheel,
                       .center = {x, 1.20 * side, 0.50},
                       .half = {0.27, 0.02, 0.27},
                       .rgba = kSteel});
    }
  }
  return parts;
}

}  // namespace patrol::sim
