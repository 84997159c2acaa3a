#include "io/atomic_file.h"

#include <unistd.h>

#include <fstream>
#include <sstream>
#include <system_error>

#include "core/error.h"

namespace patrol::io {

void save_text(const std::filesystem::path& file, std::string_view text) {
  // Of this process alone: others may write the same file.
  const std::filesystem::path temporary = file.string() + "." + std::to_string(::getpid()) + ".part";
  std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
  out << text;
  out.close();
  std::error_code error;
  if (out) std::filesystem::rename(temporary, file, error);
  if (!out || error) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw InputError(file.string() + ": cannot be written");
  }
}

std::string load_text(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) throw InputError(file.string() + ": there is no such file");
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in || std::filesystem::is_directory(file)) throw InputError(file.string() + ": cannot be read");
  return std::move(text).str();
}

}  // namespace patrol::io
