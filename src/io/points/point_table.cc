#include "io/points/point_table.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "io/files/atomic_file.h"
#include "io/files/line_tokenizer.h"

namespace patrol::io {
namespace {

static_assert(std::endian::native == std::endian::little && sizeof(ScannerPoint) == 4 * sizeof(float));

constexpr std::array kNames = {"x", "y", "z", "intensity"};
constexpr std::uintmax_t kMaxBytes = std::uintmax_t{4} << 30;

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

/// Converts numbers to a point; returns false if one is not finite as a float.
bool make_point(const std::array<double, 4>& numbers, ScannerPoint& point) {
  constexpr double kMaxValue = 1e30;
  for (const double number : numbers) {
    if (!(std::abs(number) < kMaxValue)) return false;
  }
  point = {static_cast<float>(numbers[0]), static_cast<float>(numbers[1]), static_cast<float>(numbers[2]),
           static_cast<float>(numbers[3])};
  return true;
}

}  // namespace

std::size_t bytes_of(NumberType type) {
  constexpr std::size_t kBytes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kBytes[static_cast<std::size_t>(type)];
}

FileText::FileText(const std::filesystem::path& file) : file_(file.string()) {
  std::error_code is_no_file;  // set if there is no file; the size is then undefined
  if (const std::uintmax_t size = std::filesystem::file_size(file, is_no_file); !is_no_file && size > kMaxBytes) {
    throw InputError(fmt::format("{}: is larger than {} bytes", file_, kMaxBytes));
  }
  text_ = load_text(file);
}

std::optional<std::string_view> FileText::next_line() {
  if (begin_ >= text_.size()) return std::nullopt;
  ++line_;
  const std::size_t end = std::min(text_.find('\n', begin_), text_.size());
  std::string_view line = std::string_view(text_).substr(begin_, end - begin_);
  begin_ = std::min(end + 1, text_.size());
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

void FileText::refuse(const std::string& what) const { throw input_error(file_, line_, what); }

Eigen::Vector3d origin_of(const Eigen::Vector3d& first, double unit_m) {
  constexpr double kNear_m = 10'000.0, kStep_m = 100.0;
  if (unit_m * first.cwiseAbs().maxCoeff() <= kNear_m) return Eigen::Vector3d::Zero();
  const double step = kStep_m / unit_m;
  return step * (first / step).array().round();
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

bool PointTable::append(std::array<double, 4> numbers, std::vector<ScannerPoint>& points) {
  ScannerPoint point{};
  if (shift_ != nullptr) {
    const Eigen::Vector3d position(numbers[0], numbers[1], numbers[2]);
    if (!position.allFinite() || !std::isfinite(numbers[3])) {
      ++shift_->num_dropped;
      return true;
    }
    if (!shift_->origin) shift_->origin = origin_of(position, shift_->unit_m);
    for (int axis = 0; axis < 3; ++axis) numbers[static_cast<std::size_t>(axis)] -= (*shift_->origin)[axis];
  }
  if (!make_point(numbers, point)) return false;
  points.push_back(point);
  return true;
}

std::vector<ScannerPoint> PointTable::read_binary(std::endian order) {
  const std::string_view rows = text_.rest();
  if (num_points_ > rows.size() / row_bytes_) {
    throw InputError(
        fmt::format("{}: ends too early for {} points of {} bytes", text_.file(), num_points_, row_bytes_));
  }
  if (shift_ != nullptr) shift_->is_single_precision = sources_[0]->type == NumberType::kFloat32;
  std::vector<ScannerPoint> points;
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
    if (!append(numbers, points)) throw InputError(fmt::format("{}: point {} is not finite", text_.file(), i + 1));
  }
  num_bytes_read_ = num_points_ * row_bytes_;
  return points;
}

std::vector<ScannerPoint> PointTable::read_ascii() {
  // Each number takes at least a digit and a blank: check the count before memory is allocated.
  if (num_points_ > (text_.rest().size() + 1) / (2 * row_numbers_)) {
    throw InputError(fmt::format("{}: ends too early for {} points", text_.file(), num_points_));
  }
  std::vector<ScannerPoint> points;
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
      if (!append(numbers, points)) text_.refuse("is not finite");
    } catch (const ParseError&) {
      text_.refuse(fmt::format("must be {} numbers", row_numbers_));
    }
  }
  return points;
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
