#include "importer/xacro.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <vector>

#include <fmt/format.h>
#include <tinyxml2.h>

#include "core/error.h"
#include "importer/xacro_script.h"
#include "io/files/atomic_file.h"
#include "io/files/one_line.h"

namespace patrol::importer {
namespace {

/// Output of a finished program.
struct Output {
  std::string out = {};
  std::string error = {};
  int exit_code = 0;
};

/// Closes a descriptor at the end of its scope.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

 private:
  int number_;
};

/// Reads both pipes to their ends.
void read_all(int out, int error, Output& output) {
  std::array<pollfd, 2> pipes = {pollfd{out, POLLIN, 0}, pollfd{error, POLLIN, 0}};
  std::array<std::string*, 2> texts = {&output.out, &output.error};
  std::array<char, 65536> block{};
  while (pipes[0].fd >= 0 || pipes[1].fd >= 0) {
    if (::poll(pipes.data(), pipes.size(), -1) < 0 && errno != EINTR) return;
    for (std::size_t i = 0; i < 2; ++i) {
      if (pipes[i].fd < 0 || pipes[i].revents == 0) continue;
      const ssize_t count = ::read(pipes[i].fd, block.data(), block.size());
      if (count > 0) texts[i]->append(block.data(), static_cast<std::size_t>(count));
      else if (count == 0 || errno != EINTR) pipes[i].fd = -1;
    }
  }
}

/// Runs a program without a shell. Returns -1 as exit code if it cannot be started.
Output run_python(const std::vector<std::string>& words) {
  std::array<int, 2> out{}, error{};
  if (::pipe2(out.data(), O_CLOEXEC) != 0) throw InputError("cannot create a pipe");
  Descriptor out_read(out[0]), out_write(out[1]);
  if (::pipe2(error.data(), O_CLOEXEC) != 0) throw InputError("cannot create a pipe");
  Descriptor error_read(error[0]), error_write(error[1]);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, out_write.number(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, error_write.number(), STDERR_FILENO);
  std::vector<char*> arguments;
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): posix_spawnp does not change the words
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  pid_t pid = 0;
  const int failure = ::posix_spawnp(&pid, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  out_write.close();
  error_write.close();
  if (failure != 0) return {.error = std::strerror(failure), .exit_code = -1};
  Output output;
  read_all(out_read.number(), error_read.number(), output);
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {}
  output.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return output;
}

/// Returns a text of several lines in one line.
std::string joined_lines(const std::string& text) {
  std::string line;
  for (const char c : text) {
    if (c == '\n' || c == '\r' || c == '\t') {
      if (!line.empty() && line.back() != ' ') line += ' ';
    } else {
      line += c;
    }
  }
  while (line.ends_with(' ')) line.pop_back();
  return io::on_one_line(line);
}

/// Returns whether an element, or one below it, belongs to xacro or has an expression of xacro in an attribute.
bool has_xacro(const tinyxml2::XMLElement& element) {
  const std::string name = element.Name();
  if (name.starts_with("xacro:")) return true;
  if (name == "gazebo") return false;
  for (const tinyxml2::XMLAttribute* at = element.FirstAttribute(); at != nullptr; at = at->Next()) {
    const std::string value = at->Value();
    if (value.find("$(") != std::string::npos || value.find("${") != std::string::npos) return true;
  }
  for (const auto* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    if (has_xacro(*child)) return true;
  }
  return false;
}

void take_positions_of(tinyxml2::XMLElement& element, std::map<int, std::string>& positions) {
  if (const char* position = element.Attribute(kPositionAttribute)) {
    positions.try_emplace(element.GetLineNum(), position);
    element.DeleteAttribute(kPositionAttribute);
  }
  for (auto* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement())
    take_positions_of(*child, positions);
}

}  // namespace

bool has_xacro_text(const std::string& text) {
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) return false;
  const tinyxml2::XMLElement* root = document.RootElement();
  return root != nullptr && has_xacro(*root);
}

bool is_xacro(const std::filesystem::path& file) { return file.extension() == ".xacro"; }

ExpandedFile load_expanded(const std::filesystem::path& file, const XacroOptions& options) {
  ExpandedFile loaded{.text = io::load_text(file)};
  const bool is_hidden = !is_xacro(file) && has_xacro_text(loaded.text);
  if (!is_hidden && !is_xacro(file)) {
    if (options.arguments.empty()) return loaded;
    throw InputError(fmt::format("{}: --xacro-arg {}: unknown argument: the file has no expressions of xacro",
                                 file.string(), io::on_one_line(options.arguments.begin()->first)));
  }
  loaded.text = expand_xacro(file, options);
  loaded.is_expanded = true;
  if (is_hidden)
    loaded.rows.push_back({.subject = file.filename().string(),
                           .text = "has expressions of xacro and is expanded by xacro",
                           .override_with = "--xacro-arg NAME=VALUE and environment variables, or an expanded file"});
  return loaded;
}

std::map<int, std::string> take_positions(tinyxml2::XMLDocument& document) {
  std::map<int, std::string> positions;
  if (tinyxml2::XMLElement* root = document.RootElement()) take_positions_of(*root, positions);
  return positions;
}

std::string location_in(const std::string& file, const std::map<int, std::string>& positions, int line) {
  const auto found = positions.find(line);
  if (found != positions.end()) return found->second;
  return positions.empty() && line > 0 ? fmt::format("{}:{}", file, line) : file;
}

std::string expand_xacro(const std::filesystem::path& file, const XacroOptions& options) {
  const char* named = std::getenv("PATROL_PYTHON");
  const std::string interpreter = named != nullptr && *named != '\0' ? named : options.python;
  std::vector<std::string> words = {
      interpreter, "-c", kXacroScript, file.string(), kPositionAttribute, std::to_string(options.packages.size())};
  for (const auto& [name, folder] : options.packages) words.push_back(name + "=" + folder.string());
  for (const auto& [name, value] : options.arguments) words.push_back(name + "=" + value);
  Output output = run_python(words);
  if (output.exit_code == 0) return std::move(output.out);
  std::string message = joined_lines(output.error);
  if (output.exit_code == -1 || output.exit_code == 3) {
    throw InputError(fmt::format(
        "{}: xacro is not available{}: {}: {}: install it with \"pip install xacro\", or set PATROL_PYTHON to a Python "
        "interpreter that has it",
        file.string(), is_xacro(file) ? "" : " to expand its $(...), ${...} and <xacro:...>", interpreter, message));
  }
  if (output.exit_code == 4) throw InputError(joined_lines(output.out));
  throw InputError(fmt::format("{}: xacro: {}", file.string(), message.empty() ? "failed" : message));
}

}  // namespace patrol::importer
