#include "io/ros/ros_fields.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <map>
#include <sstream>
#include <system_error>

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastcdr/exceptions/Exception.h>
#include <fastcdr/exceptions/NotEnoughMemoryException.h>
#include <fmt/format.h>

#include "core/error.h"
#include "io/files/one_line.h"

namespace patrol::io {
namespace {

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;

constexpr std::size_t kMaxPadding = 3;  ///< bytes after the last field, to a multiple of 4

enum class Count { kOne, kFixed, kSequence };

struct Member {
  std::string type, name;
  Count count = Count::kOne;
  std::size_t size = 1;  ///< size of a fixed array
};
using Types = std::map<std::string, std::vector<Member>>;

/// Removes the middle of "pkg/msg/Type", which definitions leave out.
std::string short_name(std::string type) {
  const std::size_t middle = type.find("/msg/");
  if (middle != std::string::npos) type.erase(middle, 4);
  return type;
}

/// Returns whether a name is "package/msg/Type", with letters, digits and underscores.
bool is_type_name(std::string_view name) {
  const auto is_word = [](std::string_view word) {
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    return !word.empty() && is_letter(word.front()) &&
           std::ranges::all_of(word, [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; });
  };
  const std::size_t middle = name.find("/msg/");
  return middle != std::string_view::npos && is_word(name.substr(0, middle)) && is_word(name.substr(middle + 5));
}

/// Parses a line such as "float64[36] covariance" to a member; constants and comments are skipped.
void parse_line(const std::string& line, std::vector<Member>& members) {
  std::istringstream words(line.substr(0, line.find('#')));
  Member member;
  std::string value;
  if (!(words >> member.type >> member.name)) return;
  words >> value;
  if (member.name.find('=') != std::string::npos || value.starts_with('=')) return;  // a constant
  const std::size_t bracket = member.type.find('[');
  if (bracket != std::string::npos) {
    const std::string inside = member.type.substr(bracket + 1, member.type.size() - bracket - 2);
    const bool is_fixed = !inside.empty() && inside.front() != '<';
    member.count = is_fixed ? Count::kFixed : Count::kSequence;
    if (is_fixed) {
      const auto [end, error] = std::from_chars(inside.data(), inside.data() + inside.size(), member.size);
      if (error != std::errc{} || end != inside.data() + inside.size() || member.size == 0)
        throw InputError("message definition: invalid size of an array: " + member.type);
    }
    member.type.resize(bracket);
  }
  member.type.resize(std::min(member.type.find("<="), member.type.size()));  // bounded string
  member.type = short_name(member.type);
  members.push_back(std::move(member));
}

/// Parses a definition: the fields of its own type, then "====" and "MSG: pkg/Type" before the fields of each used
/// type.
Types parse_definition(const std::string& type, const std::string& definition) {
  Types types;
  std::string current = short_name(type);
  types[current];
  std::istringstream lines(definition);
  for (std::string line; std::getline(lines, line);) {
    if (line.ends_with('\r')) line.pop_back();
    if (line.starts_with("===")) continue;
    if (line.starts_with("MSG: ")) {
      current = short_name(line.substr(5));
      types[current];
    } else {
      parse_line(line, types[current]);
    }
  }
  return types;
}

/// Reads a message; keeps its fields if `keeps_fields`.
class FieldReader {
 public:
  FieldReader(const Types& types, Cdr& cdr, std::size_t num_bytes, bool keeps_fields)
      : types_(types), cdr_(cdr), num_bytes_(num_bytes), keeps_fields_(keeps_fields) {}

  void read_message(const std::string& type, const std::string& prefix) {
    const auto members = types_.find(type);
    if (members == types_.end()) throw InputError("message definition: type not found: " + type);
    if (++depth_ > kMaxDepth) throw InputError("message definition: too many types in each other: " + type);
    const std::string package = type.substr(0, type.find('/') + 1);
    if (members->second.empty()) take<std::uint8_t>();  // ROS 2 gives a type without fields one byte
    for (const Member& member : members->second) {
      const std::string path = prefix.empty() || !keeps_fields_ ? member.name : prefix + "." + member.name;
      const std::string in_package = package + member.type;
      const std::string& member_type = types_.contains(in_package) ? in_package : member.type;
      if (member.count == Count::kOne) read_value(member_type, path);
      else read_values(member, member_type, path);
    }
    --depth_;
  }

  std::vector<RosField> take_fields() { return std::move(fields_); }

 private:
  static constexpr int kMaxDepth = 50;

  void read_values(const Member& member, const std::string& type, const std::string& path) {
    std::size_t size = member.size;
    if (member.count == Count::kSequence) {
      size = take<std::uint32_t>();
      if (keeps_fields_) fields_.push_back({path + ".size", fmt::format("{}", size)});
    }
    const auto expect_room = [&](bool has_room) {
      if (!has_room) throw InputError(fmt::format("{} elements of {} do not fit in the message", size, member.name));
    };
    expect_room(size <= num_bytes_);  // an element has at least one byte
    if (keeps_fields_) {
      for (std::size_t i = 0; i < size; ++i) read_value(type, fmt::format("{}[{}]", path, i));
    } else if (const std::size_t bytes = bytes_of(type); bytes > 0 && size > 0) {
      read_value(type, path);  // aligns the next ones
      expect_room(cdr_.jump(bytes * (size - 1)));
    } else {
      for (std::size_t i = 0; i < size; ++i) read_value(type, path);
    }
  }

  template <typename Value>
  Value take() {
    Value value{};
    cdr_ >> value;
    return value;
  }

  template <typename Value>
  void read_plain(const std::string& path) {
    const auto value = take<Value>();
    if (keeps_fields_) fields_.push_back({path, fmt::format("{}", value)});
  }

  void read_value(const std::string& type, const std::string& path) {
    if (type == "float64") read_plain<double>(path);
    else if (type == "float32") read_plain<float>(path);
    else if (type == "int8") read_byte<std::int8_t>(path);
    else if (type == "uint8" || type == "byte" || type == "char") read_byte<std::uint8_t>(path);
    else if (type == "int16") read_plain<std::int16_t>(path);
    else if (type == "uint16") read_plain<std::uint16_t>(path);
    else if (type == "int32") read_plain<std::int32_t>(path);
    else if (type == "uint32") read_plain<std::uint32_t>(path);
    else if (type == "int64") read_plain<std::int64_t>(path);
    else if (type == "uint64") read_plain<std::uint64_t>(path);
    else if (type == "bool") read_plain<bool>(path);
    else if (type == "string") read_string(path);
    else if (type == "wstring") throw InputError("message definition: wstring is not supported: must be string");
    else read_message(type, path);
  }

  template <typename Byte>
  void read_byte(const std::string& path) {
    const auto value = take<Byte>();
    if (keeps_fields_) fields_.push_back({path, fmt::format("{}", static_cast<int>(value))});
  }

  void read_string(const std::string& path) {
    std::string value = take<std::string>();
    if (keeps_fields_) fields_.push_back({path, '"' + value + '"'});
  }

  /// Returns the size of a number; 0 for other types.
  static std::size_t bytes_of(const std::string& type) {
    if (type == "float64" || type == "int64" || type == "uint64") return 8;
    if (type == "float32" || type == "int32" || type == "uint32") return 4;
    if (type == "int16" || type == "uint16") return 2;
    return type == "int8" || type == "uint8" || type == "byte" || type == "char" ? 1 : 0;
  }

  const Types& types_;
  Cdr& cdr_;
  std::size_t num_bytes_;
  bool keeps_fields_;
  int depth_ = 0;
  std::vector<RosField> fields_;
};

/// Returns the fields of a message, none unless `keeps_fields`. `num_left`: number of bytes after the last field.
std::vector<RosField> read_fields(const std::string& type, const std::string& definition, std::string_view bytes,
                                  bool keeps_fields, std::size_t& num_left) {
  const Types types = parse_definition(type, definition);
  try {
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): only read from
    FastBuffer buffer(const_cast<char*>(bytes.data()), bytes.size());
    Cdr cdr(buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR);
    cdr.read_encapsulation();
    FieldReader reader(types, cdr, bytes.size(), keeps_fields);
    reader.read_message(short_name(type), "");
    num_left = bytes.size() - cdr.getSerializedDataLength();
    return reader.take_fields();
  } catch (const eprosima::fastcdr::exception::NotEnoughMemoryException&) {
    throw InputError("not a " + type + ": the message is cut off");
  } catch (const eprosima::fastcdr::exception::Exception& error) {
    throw InputError("not a " + type + ": " + error.what());
  }
}

}  // namespace

std::vector<RosField> ros_fields(const std::string& type, const std::string& definition, std::string_view bytes) {
  std::size_t num_left = 0;
  return read_fields(type, definition, bytes, true, num_left);
}

void check_ros_message(const std::string& type, const std::string& definition, std::string_view bytes) {
  if (!is_type_name(type)) throw InputError(fmt::format("type {}: must be PACKAGE/msg/NAME", on_one_line(type)));
  if (bytes.size() >= 2 && (bytes[0] != 0 || (bytes[1] != 0 && bytes[1] != 1)))
    throw InputError(fmt::format("not a {}: does not begin with the header of CDR", type));
  std::size_t num_left = 0;
  read_fields(type, definition, bytes, false, num_left);
  if (num_left > kMaxPadding && definition.find_first_not_of(" \t\r\n") == std::string::npos)
    throw InputError(fmt::format("definition of {} is empty: must have the fields of the message", type));
  if (num_left > kMaxPadding) throw InputError(fmt::format("not a {}: {} bytes follow the last field", type, num_left));
}

}  // namespace patrol::io
