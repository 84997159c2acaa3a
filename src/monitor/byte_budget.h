#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

namespace patrol::monitor {

/// Limit on the number of bytes held by all connections together. Not thread-safe.
class ByteBudget {
 public:
  explicit ByteBudget(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  /// Reserved part of a budget, released by the destructor. The budget must outlive it.
  class Claim {
   public:
    Claim(ByteBudget& budget, std::size_t bytes) : budget_(&budget), bytes_(bytes) { budget_->used_ += bytes_; }
    Claim(Claim&& other) noexcept : budget_(std::exchange(other.budget_, nullptr)), bytes_(other.bytes_) {}
    Claim& operator=(Claim&&) = delete;
    Claim(const Claim&) = delete;
    Claim& operator=(const Claim&) = delete;
    ~Claim() {
      if (budget_ != nullptr) budget_->used_ -= bytes_;
    }

   private:
    ByteBudget* budget_;
    std::size_t bytes_;
  };

  /// Reserves bytes, none when too few are left. The first claim is always granted, whatever its size.
  std::optional<Claim> claim(std::size_t bytes) {
    if (used_ > 0 && bytes > max_bytes_ - std::min(used_, max_bytes_)) return std::nullopt;
    return Claim(*this, bytes);
  }

 private:
  std::size_t max_bytes_;
  std::size_t used_ = 0;
};

}  // namespace patrol::monitor
