#pragma once

namespace patrol::io {

/// Limit of the coordinates in messages of a stack, for maps, poses and events, m. Contains the coordinates of map
/// projections.
inline constexpr double kMaxCoordinate_m = 1e7;

/// Returns the largest magnitude of a coordinate in the poses and target positions of a message, m. Precondition: the
/// numbers of the message are finite.
template <typename Message>
double max_coordinate_m(const Message& message);

}  // namespace patrol::io
