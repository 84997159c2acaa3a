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
#include "io/files/atomic_file.h"
#include "io/files/one_line.h"

namespace patrol::importer {
namespace {

/// Script that calls xacro: arguments FILE, N, N times NAME=FOLDER of packages, then NAME=VALUE of xacro arguments.
/// $(find PKG) is searched as by the class Packages. Exit status 3: xacro is not installed; 4:
/// the expansion failed, with the message on the standard output.
constexpr const char* kScript = R"py(
import os, re, sys
try:
    import xacro
    from xacro import substitution_args
except ImportError as error:
    sys.stderr.write(str(error))
    sys.exit(3)
import xml.dom.minidom
file, count = os.path.abspath(sys.argv[1]), int(sys.argv[2])
given = dict(word.split('=', 1) for word in sys.argv[3:3 + count])
mappings = dict(word.split('=', 1) for word in sys.argv[3 + count:])

def package_name(folder):
    try:
        names = xml.dom.minidom.parse(os.path.join(folder, 'package.xml')).getElementsByTagName('name')
        return names[0].firstChild.data.strip()
    except Exception:
        return ''

def find(package):
    if package in given:
        return os.path.abspath(given[package])
    folder = os.path.dirname(file)
    while True:
        if os.path.basename(folder) == package or package_name(folder) == package:
            return folder
        if os.path.isdir(os.path.join(folder, package)):
            return os.path.join(folder, package)
        above = os.path.dirname(folder)
        if os.path.exists(os.path.join(folder, 'package.xml')):
            for name in sorted(os.listdir(above)):
                if package_name(os.path.join(above, name)) == package:
                    return os.path.join(above, name)
        if above == folder:
            raise Exception('unknown package "%s": give its folder with --package %s=FOLDER' % (package, package))
        folder = above

def location_of(message):
    """File of the error with the line, if one line of it has the text that the message quotes."""
    stack = xacro.macrostack or []
    at = stack[-1].history[-1][-1] if stack else (xacro.filestack or [file])[-1]
    at = at or file
    quoted = re.findall("evaluating expression '(.*?)'", message)[-1:] or re.findall('package "(.*?)"', message)
    if not quoted:
        quoted = [os.path.basename(path) for path in re.findall('directory: ([^ ]*)', message)]
    try:
        with open(at, encoding='utf-8') as text:
            lines = [i for i, line in enumerate(text, 1) if quoted and quoted[0] in line]
    except Exception:
        lines = []
    if os.path.abspath(at) == file:
        at = sys.argv[1]
    return '%s:%d' % (at, lines[0]) if len(lines) == 1 else at

def macros():
    names = [macro.body.getAttribute('name') for macro in reversed(xacro.macrostack or [])]
    return ''.join(', in macro %s' % name for name in dict.fromkeys(names))

substitution_args._eval_find = find
substitution_args._eval_dict['find'] = find
try:
    text = xacro.process_file(file, mappings=mappings).toprettyxml(indent='  ', encoding='utf-8')
except BaseException as error:
    message = str(error) or type(error).__name__
    if not isinstance(error, xacro.XacroException):
        message = '%s: %s' % (type(error).__name__, error)
    message = re.sub(r" \[Errno \d+\].*$", '', ' '.join(message.split()).replace("<class 'Exception'>: ", ''))
    message = re.sub(r'^(.+) \1$', r'\1', message)
    print('%s: xacro: %s%s' % (location_of(message), message, macros()))
    sys.exit(4)
sys.stdout.buffer.write(text)
)py";

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

}  // namespace

bool has_xacro_text(const std::string& text) {
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) return false;
  const tinyxml2::XMLElement* root = document.RootElement();
  return root != nullptr && has_xacro(*root);
}

bool is_xacro(const std::filesystem::path& file) { return file.extension() == ".xacro"; }

ExpandedFile load_expanded(const std::filesystem::path& file, const XacroOptions& options) {
  ExpandedFile loaded{.text = io::load_text(file), .label = file.string()};
  const bool is_hidden = !is_xacro(file) && has_xacro_text(loaded.text);
  if (!is_hidden && !is_xacro(file)) return loaded;
  loaded.text = expand_xacro(file, options);
  loaded.label += " (expanded)";
  if (is_hidden)
    loaded.rows.push_back({.subject = file.filename().string(),
                           .text = "has expressions of xacro and is expanded by xacro",
                           .override_with = "--xacro-arg NAME=VALUE and environment variables, or an expanded file"});
  return loaded;
}

std::string expand_xacro(const std::filesystem::path& file, const XacroOptions& options) {
  const char* named = std::getenv("PATROL_PYTHON");
  const std::string interpreter = named != nullptr && *named != '\0' ? named : options.python;
  std::vector<std::string> words = {interpreter, "-c", kScript, file.string(), std::to_string(options.packages.size())};
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
