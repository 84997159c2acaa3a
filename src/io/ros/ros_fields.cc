#include "io/ros/ros_fields.h"

#include <cstdint>
#include <map>
#include <sstream>

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastcdr/exceptions/Exception.h>
#include <fmt/format.h>

#include "core/error.h"

namespace patrol::io {
namespace {

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;

enum class Count { kOne, kFixed, kSequence };

struct Member {
  std::string type, name;
  Count count = Count::kOne;
  std::size_t size = 1;  ///< size of a fixed array
};
using Types = std::map<std::string, std::vector<Member>>;

/// Parses a line such as "float64[36] covariance" to a member; constants and comments are skipped.
void parse_line(const std::string& line, std::vector<Member>& members) {
  const std::string code = line.substr(0, line.find('#'));
  if (code.find('=') != std::string::npos) return;
  std::istringstream words(code);
  Member member;
  if (!(words >> member.type >> member.name)) return;
  const std::size_t bracket = member.type.find('[');
  if (bracket != std::string::npos) {
    const std::string inside = member.type.substr(bracket + 1, member.type.size() - bracket - 2);
    const bool is_fixed = !inside.empty() && inside.front() != '<';
    member.count = is_fixed ? Count::kFixed : Count::kSequence;
    if (is_fixed) member.size = std::stoul(inside);
    member.type.resize(bracket);
  }
  members.push_back(std::move(member));
}

/// Parses a definition: the fields of its own type, then "====" and "MSG: pkg/Type" before the fields of each used
/// type.
Types parse_definition(const std::string& type, const std::string& definition) {
  Types types;
  std::string current = type;
  std::istringstream lines(definition);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("===")) continue;
    if (line.starts_with("MSG: ")) {
      current = line.substr(5);
      types[current];
    } else {
      parse_line(line, types[current]);
    }
  }
  return types;
}

class FieldReader {
 public:
  FieldReader(const Types& types, Cdr& cdr) : types_(types), cdr_(cdr) {}

  void read_message(const std::string& type, const std::string& prefix) {
    const auto members = types_.find(type);
    if (members == types_.end()) throw InputError("message definition: type not found: " + type);
    for (const Member& member : members->second) {
      const std::string path = prefix.empty() ? member.name : prefix + "." + member.name;
      if (member.count == Count::kOne) {
        read_value(member.type, path);
        continue;
      }
      std::size_t size = member.size;
      if (member.count == Count::kSequence) {
        size = take<std::uint32_t>();
        fields_.push_back({path + ".size", fmt::format("{}", size)});
      }
      for (std::size_t i = 0; i < size; ++i) read_value(member.type, fmt::format("{}[{}]", path, i));
    }
  }

  std::vector<RosField> take_fields() { return std::move(fields_); }

 private:
  template <typename Value>
  Value take() {
    Value value{};
    cdr_ >> value;
    return value;
  }

  template <typename Value>
  void read_plain(const std::string& path) {
    fields_.push_back({path, fmt::format("{}", take<Value>())});
  }

  void read_value(const std::string& type, const std::string& path) {
    if (type == "float64") read_plain<double>(path);
    else if (type == "float32") read_plain<float>(path);
    else if (type == "int8") fields_.push_back({path, fmt::format("{}", static_cast<int>(take<std::int8_t>()))});
    else if (type == "uint8" || type == "byte")
      fields_.push_back({path, fmt::format("{}", static_cast<int>(take<std::uint8_t>()))});
    else if (type == "int16") read_plain<std::int16_t>(path);
    else if (type == "uint16") read_plain<std::uint16_t>(path);
    else if (type == "int32") read_plain<std::int32_t>(path);
    else if (type == "uint32") read_plain<std::uint32_t>(path);
    else if (type == "int64") read_plain<std::int64_t>(path);
    else if (type == "uint64") read_plain<std::uint64_t>(path);
    else if (type == "bool") read_plain<bool>(path);
    else if (type == "string") fields_.push_back({path, '"' + take<std::string>() + '"'});
    else read_message(type, path);
  }

  const Types& types_;
  Cdr& cdr_;
  std::vector<RosField> fields_;
};

}  // namespace

std::vector<RosField> ros_fields(const std::string& type, const std::string& definition, std::string_view bytes) {
  const Types types = parse_definition(type, definition);
  try {
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): only read from
    FastBuffer buffer(const_cast<char*>(bytes.data()), bytes.size());
    Cdr cdr(buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR);
    cdr.read_encapsulation();
    FieldReader reader(types, cdr);
    reader.read_message(type, "");
    return reader.take_fields();
  } catch (const eprosima::fastcdr::exception::Exception& error) {
    throw InputError("not a " + type + ": " + error.what());
  }
}

}  // namespace patrol::io
