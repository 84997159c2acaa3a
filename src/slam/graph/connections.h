#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

namespace patrol::slam {

/// Union-find structure of elements that are connected with each other.
class Connections {
 public:
  explicit Connections(std::size_t num_elements) : parent_(num_elements), num_parts_(num_elements) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  void connect(std::size_t a, std::size_t b) {
    if (are_connected(a, b)) return;
    parent_[root(a)] = root(b);
    --num_parts_;
  }
  bool are_connected(std::size_t a, std::size_t b) { return root(a) == root(b); }
  /// Returns the number of sets of elements without a connection between them.
  std::size_t num_parts() const { return num_parts_; }

 private:
  std::size_t root(std::size_t s) {
    while (parent_[s] != s) s = parent_[s] = parent_[parent_[s]];
    return s;
  }

  std::vector<std::size_t> parent_;
  std::size_t num_parts_;
};

}  // namespace patrol::slam
