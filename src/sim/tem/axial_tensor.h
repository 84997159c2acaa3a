#pragma once

namespace patrol::sim {

/// Response tensor with an axis of symmetry: value for a coil axis along it and for one across it.
template <typename Scalar>
struct AxialTensor {
  Scalar along{}, across{};
};

}  // namespace patrol::sim
