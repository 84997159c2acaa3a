#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

#include "core/grid.h"
#include "core/state/aggregate_fields.h"
#include "core/state/state_archive_fwd.h"

namespace patrol {

/// Creates the object that a restored element of a container or a pointer is loaded into. Specialized for types without
/// a default constructor.
template <typename T>
struct StateMaker {
  static T make() { return T{}; }
};

/// Base class whose state is the whole state of an aggregate that derives from it; void for other types.
template <typename T>
struct StateBase {
  using type = void;
};

namespace state_traits {

/// Whether the bytes of an object without fields are its value.
template <typename T>
struct Flat : std::bool_constant<std::is_arithmetic_v<T> || std::is_enum_v<T>> {};
template <typename Count, typename Period>
struct Flat<std::chrono::duration<Count, Period>> : std::true_type {};
template <typename Scalar, int kRows, int kCols, int kOptions, int kMaxRows, int kMaxCols>
struct Flat<Eigen::Matrix<Scalar, kRows, kCols, kOptions, kMaxRows, kMaxCols>>
    : std::bool_constant<kRows != Eigen::Dynamic && kCols != Eigen::Dynamic> {};
template <typename Scalar, int kOptions>
struct Flat<Eigen::Quaternion<Scalar, kOptions>> : std::true_type {};
template <typename T, std::size_t kSize>
struct Flat<std::array<T, kSize>> : Flat<T> {};

template <typename T>
inline constexpr bool kIsStdArray = false;
template <typename T, std::size_t kSize>
inline constexpr bool kIsStdArray<std::array<T, kSize>> = true;

}  // namespace state_traits

/// Saves or restores the mutable state of objects as bytes.
///
/// A stateful class has a member `serialize_state(archive)` that passes its members to the archive. The same member
/// saves and restores, so that both agree. Aggregates need none: their fields are found by themselves. An object is
/// restored in place: it has been constructed as at the start of the run, with the same settings. Pointers other than
/// std::unique_ptr and std::shared_ptr are refused by the compiler. Shared objects stay shared.
class StateArchive {
 public:
  /// Creates an archive that saves.
  StateArchive() = default;
  /// Creates an archive that restores from `bytes`.
  explicit StateArchive(std::string bytes) : bytes_(std::move(bytes)), is_loading_(true) {}

  /// Creates an archive that saves for a comparison with another state. Bytes that no result depends on may be left
  /// out.
  static StateArchive for_comparison() {
    StateArchive archive;
    archive.is_comparing_ = true;
    return archive;
  }

  bool is_loading() const { return is_loading_; }
  bool is_comparing() const { return is_comparing_; }
  const std::string& bytes() const { return bytes_; }
  /// Returns whether everything has been restored.
  bool is_at_end() const { return position_ == bytes_.size(); }

  /// Saves or restores values, in this order. Throws std::runtime_error if the bytes end too early.
  template <typename... Values>
  void operator()(Values&... values) {
    (value(values), ...);
  }

  /// Writes a name, or checks that it is the next one. Throws std::runtime_error if the bytes have another name.
  void section(std::string_view name) {
    std::string found(name);
    value(found);
    if (found != name)
      throw std::runtime_error("state of '" + std::string(name) + "' expected, '" + found.substr(0, 40) + "' found");
  }

  /// Saves or restores `count` values without padding that lie one after the other.
  template <typename T>
  void raw(T* first, std::size_t count) {
    const std::size_t size = count * sizeof(T);
    if (size == 0) return;
    if (is_loading_) {
      std::memcpy(static_cast<void*>(first), take(size), size);
    } else {
      bytes_.append(reinterpret_cast<const char*>(first), size);
    }
  }

  /// Saves a size, or returns the stored one.
  std::size_t size_of(std::size_t size) {
    auto stored = static_cast<std::uint64_t>(size);
    raw(&stored, 1);
    return static_cast<std::size_t>(stored);
  }

  /// Restores the elements of a container whose number does not change. Throws std::runtime_error if it has changed.
  template <typename Container>
  void in_place(Container& container) {
    if (size_of(container.size()) != container.size()) throw std::runtime_error("number of parts has changed");
    for (auto& element : container) value(element);
  }

  /// Restores a part that exists from the start of the run or not at all. Throws std::runtime_error if that has
  /// changed.
  template <typename T>
  void part(std::optional<T>& optional) {
    if (size_of(optional ? 1 : 0) != (optional ? 1U : 0U)) throw std::runtime_error("a part is missing");
    if (optional) value(*optional);
  }

 private:
  /// Returns whether the bytes of an object are its values: no padding, no pointers.
  template <typename T>
  static constexpr bool is_flat() {
    if constexpr (state_traits::Flat<T>::value) {
      return true;
    } else if constexpr (std::is_aggregate_v<T> && std::is_copy_constructible_v<T> && !state_traits::kIsStdArray<T> &&
                         !has_own_state<T> && std::is_void_v<typename StateBase<T>::type>) {
      using Sizes = decltype(with_fields(std::declval<T&>(), [](auto&... fields) {
        return std::integral_constant < std::size_t, (... && is_flat<std::remove_reference_t<decltype(fields)>>())
                                                         ? (std::size_t{0} + ... + sizeof(fields))
                                                         : 0 > {};
      }));
      return Sizes::value == sizeof(T);
    } else {
      return false;
    }
  }

  template <typename T>
  static constexpr bool has_own_state = requires(T& object, StateArchive& archive) {
    object.serialize_state(archive);
  };

  template <typename T>
  void value(T& object) {
    static_assert(!std::is_pointer_v<T> && !std::is_const_v<T>);
    if constexpr (has_own_state<T>) {
      object.serialize_state(*this);
    } else if constexpr (is_flat<T>()) {
      raw(&object, 1);
    } else if constexpr (!std::is_void_v<typename StateBase<T>::type>) {
      value(static_cast<typename StateBase<T>::type&>(object));
    } else if constexpr (std::is_aggregate_v<T>) {
      with_fields(object, [this](auto&... fields) { (value(fields), ...); });
    } else {
      static_assert(has_own_state<T>, "a class needs a member serialize_state");
    }
  }

  void value(std::string& text) {
    const std::size_t size = size_of(text.size());
    if (is_loading_) {
      text.assign(take(size), size);
    } else {
      bytes_.append(text);
    }
  }

  template <typename T>
  void value(std::vector<T>& vector) {
    const std::size_t size = size_of(vector.size());
    if constexpr (std::is_same_v<T, bool>) {
      if (is_loading_) vector.resize(checked(size, 1));
      for (std::size_t i = 0; i < size; ++i) {
        auto bit = static_cast<std::uint8_t>(vector[i]);
        raw(&bit, 1);
        vector[i] = bit != 0;
      }
    } else if constexpr (is_flat<T>()) {
      if (is_loading_) resize(vector, checked(size, sizeof(T)));
      raw(vector.data(), size);
    } else {
      if (is_loading_) resize(vector, checked(size, 1));
      for (T& element : vector) value(element);
    }
  }

  template <typename T>
  void value(std::deque<T>& deque) {
    const std::size_t size = size_of(deque.size());
    if (is_loading_) resize(deque, checked(size, 1));
    for (T& element : deque) value(element);
  }

  template <typename T, std::size_t kSize>
  void value(std::array<T, kSize>& array) {
    if constexpr (is_flat<T>()) {
      raw(array.data(), kSize);
    } else {
      for (T& element : array) value(element);
    }
  }

  template <typename Key, typename T, typename Compare>
  void value(std::map<Key, T, Compare>& map) {
    const std::size_t size = size_of(map.size());
    if (!is_loading_) {
      for (auto& [key, element] : map) {
        Key copy = key;
        value(copy);
        value(element);
      }
      return;
    }
    map.clear();
    for (std::size_t i = 0; i < size; ++i) {
      Key key{};
      value(key);
      value(map.emplace_hint(map.end(), std::move(key), StateMaker<T>::make())->second);
    }
  }

  template <typename First, typename Second>
  void value(std::pair<First, Second>& pair) {
    value(pair.first);
    value(pair.second);
  }

  template <typename T>
  void value(std::optional<T>& optional) {
    auto has_value = static_cast<std::uint8_t>(optional.has_value());
    raw(&has_value, 1);
    if (has_value == 0) {
      optional.reset();
      return;
    }
    if (!optional) optional.emplace(StateMaker<T>::make());
    value(*optional);
  }

  template <typename... Alternatives>
  void value(std::variant<Alternatives...>& variant) {
    const std::size_t index = size_of(variant.index());
    if (index >= sizeof...(Alternatives)) throw std::runtime_error("unknown kind of a message");
    std::size_t next = 0;
    const auto one = [&]<typename T>(std::type_identity<T> /*alternative*/) {
      if (next++ != index) return;
      if (is_loading_ && variant.index() != index) variant.template emplace<T>(StateMaker<T>::make());
      value(std::get<T>(variant));
    };
    (one(std::type_identity<Alternatives>{}), ...);
  }

  /// State of an object that exists on both sides, or on neither.
  template <typename T>
  void value(std::unique_ptr<T>& pointer) {
    if (size_of(pointer ? 1 : 0) != (pointer ? 1U : 0U)) throw std::runtime_error("a part is missing");
    if (pointer) value(*pointer);
  }

  template <typename T>
  void value(std::shared_ptr<T>& pointer) {
    using Object = std::remove_const_t<T>;
    if (is_loading_) {
      const std::size_t number = size_of(0);
      if (number == 0) {
        pointer.reset();
      } else if (number <= loaded_.size()) {
        pointer = std::static_pointer_cast<T>(loaded_[number - 1]);
      } else {
        std::shared_ptr<Object> object(new Object(StateMaker<Object>::make()));
        loaded_.push_back(object);
        value(*object);
        pointer = std::move(object);
      }
      return;
    }
    if (!pointer) {
      size_of(0);
      return;
    }
    const auto [entry, is_new] = saved_.emplace(pointer.get(), saved_.size() + 1);
    size_of(entry->second);
    if (is_new) value(const_cast<Object&>(*pointer));
  }

  template <typename Value>
  void value(Grid<Value>& grid) {
    GridGeometry geometry = grid.geometry();
    value(geometry);
    if (is_loading_) {
      checked(geometry.size(), sizeof(Value));
      grid = Grid<Value>(geometry);
    }
    static_assert(is_flat<Value>());
    raw(grid.values().data(), grid.values().size());
  }

  template <typename Scalar, int kRows, int kCols, int kOptions, int kMaxRows, int kMaxCols>
  requires(kRows == Eigen::Dynamic ||
           kCols ==
               Eigen::Dynamic) void value(Eigen::Matrix<Scalar, kRows, kCols, kOptions, kMaxRows, kMaxCols>& matrix) {
    const std::size_t rows = size_of(static_cast<std::size_t>(matrix.rows()));
    const std::size_t cols = size_of(static_cast<std::size_t>(matrix.cols()));
    if (is_loading_) {
      checked(rows * cols, sizeof(Scalar));
      matrix.resize(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(cols));
    }
    raw(matrix.data(), rows * cols);
  }

  template <typename Container>
  static void resize(Container& container, std::size_t size) {
    using T = typename Container::value_type;
    if constexpr (std::is_default_constructible_v<T> && std::is_move_constructible_v<T>) {
      container.resize(size);
    } else {
      container.clear();
      for (std::size_t i = 0; i < size; ++i) container.push_back(StateMaker<T>::make());
    }
  }

  /// Returns `count` after the check that the remaining bytes can hold it.
  std::size_t checked(std::size_t count, std::size_t min_size) const {
    if (count > (bytes_.size() - position_) / min_size) throw std::runtime_error("state is truncated");
    return count;
  }

  const char* take(std::size_t size) {
    checked(size, 1);
    const char* first = bytes_.data() + position_;
    position_ += size;
    return first;
  }

  std::string bytes_;
  std::size_t position_ = 0;
  bool is_loading_ = false;
  bool is_comparing_ = false;
  std::map<const void*, std::size_t> saved_;   ///< number of each shared object, from 1
  std::vector<std::shared_ptr<void>> loaded_;  ///< [number - 1]
};

}  // namespace patrol
