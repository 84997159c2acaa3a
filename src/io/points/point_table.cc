#include "io/points/point_table.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "io/files/line_tokenizer.h"

namespace patrol::io {
namespace {

static_assert(std::endian::native == std::endian::little && sizeof(ScannerPoint) == 4 * sizeof(float));

constexpr std::array kNames = {"x", "y", "z", "intensity"};

template <typename Number>
double number_at(const char* bytes) {
  Number number;
  std::memcpy(&number, bytes, sizeof(number));
  return static_cast<double>(number);
}

double number_at(const char* bytes, NumberType type) {
  switch (type) {
    case NumberType::kInt8:
      return number_at<std::int8_t>(bytes);
    case NumberType::kUint8:
      return number_at<std::uint8_t>(bytes);
    case NumberType::kInt16:
      return number_at<std::int16_t>(bytes);
    case NumberType::kUint16:
      return number_at<std::uint16_t>(bytes);
    case NumberType::kInt32:
      return number_at<std::int32_t>(bytes);
    case NumberType::kUint32:
      return number_at<std::uint32_t>(bytes);
    case NumberType::kInt64:
      return number_at<std::int64_t>(bytes);
    case NumberType::kUint64:
      return number_at<std::uint64_t>(bytes);
    case NumberType::kFloat32:
      return number_at<float>(bytes);
    case NumberType::kFloat64:
      return number_at<double>(bytes);
  }
  return 0.0;
}

}  // namespace

std::size_t bytes_of(NumberType type) {
  constexpr std::size_t kBytes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kBytes[static_cast<std::size_t>(type)];
}

PointTable::PointTable(FileText& text, std::vector<PointColumn> columns, std::size_t num_points, PointShift* shift)
    : text_(text), shift_(shift), columns_(std::move(columns)), num_points_(num_points) {
  for (const PointColumn& column : columns_) {
    for (std::size_t i = 0; i < kNames.size(); ++i) {
      if (column.name != kNames[i]) continue;
      if (sources_[i]) text_.refuse(fmt::format("{}: duplicate column", column.name));
      sources_[i] = Source{.byte = row_bytes_, .number = row_numbers_, .type = column.type};
    }
    row_bytes_ += column.count * bytes_of(column.type);
    row_numbers_ += column.count;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (!sources_[i]) text_.refuse(fmt::format("the points have no {}", kNames[i]));
  }
}

std::vector<ScannerPoint> PointTable::read_binary(std::endian order) {
  const std::string_view rows = text_.rest();
  if (num_points_ > rows.size() / row_bytes_) {
    throw InputError(
        fmt::format("{}: ends too early for {} points of {} bytes", text_.file(), num_points_, row_bytes_));
  }
  if (shift_ != nullptr) shift_->is_single_precision = sources_[0]->type == NumberType::kFloat32;
  PointCollector points(shift_);
  points.reserve(num_points_);
  for (std::size_t i = 0; i < num_points_; ++i) {
    std::array<double, 4> numbers{};
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      if (!sources_[k]) continue;
      std::array<char, 8> bytes{};
      const std::size_t count = bytes_of(sources_[k]->type);
      std::copy_n(rows.data() + i * row_bytes_ + sources_[k]->byte, count, bytes.begin());
      if (order != std::endian::native) std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
      numbers[k] = number_at(bytes.data(), sources_[k]->type);
    }
    if (!points.add(numbers)) throw InputError(fmt::format("{}: point {} is not finite", text_.file(), i + 1));
  }
  num_bytes_read_ = num_points_ * row_bytes_;
  return points.take();
}

std::vector<ScannerPoint> PointTable::read_ascii() {
  // Each number takes at least a digit and a blank: check the count before memory is allocated.
  if (num_points_ > (text_.rest().size() + 1) / (2 * row_numbers_)) {
    throw InputError(fmt::format("{}: ends too early for {} points", text_.file(), num_points_));
  }
  PointCollector points(shift_);
  points.reserve(num_points_);
  for (std::size_t i = 0; i < num_points_; ++i) {
    const auto line = text_.next_line();
    if (!line) throw InputError(fmt::format("{}: ends too early for {} points", text_.file(), num_points_));
    try {
      LineTokenizer fields(*line);
      std::array<double, 4> numbers{};
      for (std::size_t number = 0; number < row_numbers_; ++number) {
        const double value = fields.any_number("number");
        for (std::size_t k = 0; k < numbers.size(); ++k) {
          if (sources_[k] && sources_[k]->number == number) numbers[k] = value;
        }
      }
      if (!fields.is_empty()) text_.refuse(fmt::format("more than {} numbers", row_numbers_));
      if (!points.add(numbers)) text_.refuse("is not finite");
    } catch (const ParseError&) {
      text_.refuse(fmt::format("must be {} numbers", row_numbers_));
    }
  }
  return points.take();
}

void PointTable::expect_end() const {
  const std::string_view rest = text_.rest().substr(num_bytes_read_);
  const bool is_binary = num_bytes_read_ > 0;
  if (is_binary ? !rest.empty() : rest.find_first_not_of(" \t\r\n") != std::string_view::npos) {
    throw InputError(fmt::format("{}: has data after its {} points", text_.file(), num_points_));
  }
}

std::string to_rows(const std::vector<ScannerPoint>& points) {
  return {reinterpret_cast<const char*>(points.data()), points.size() * sizeof(ScannerPoint)};
}

}  // namespace patrol::io
