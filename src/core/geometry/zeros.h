#pragma once

namespace patrol {

/// Returns an array of vectors or matrices of Eigen that are zero. Eigen leaves the elements of `Array{}` without a
/// value.
template <typename Array>
Array zeros() {
  Array all;
  all.fill(Array::value_type::Zero());
  return all;
}

}  // namespace patrol
