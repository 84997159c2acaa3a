#include "io/files/digest.h"

#include <algorithm>
#include <array>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <openssl/sha.h>

#include "io/files/atomic_file.h"

namespace patrol::io {

std::string sha256(std::string_view content) {
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
  SHA256(reinterpret_cast<const unsigned char*>(content.data()), content.size(), digest.data());
  return fmt::format("{:02x}", fmt::join(digest, ""));
}

std::string sha256_of_file(const std::filesystem::path& file) { return sha256(load_text(file)); }

std::string sha256_of_folder(const std::filesystem::path& folder, const std::string& except) {
  std::vector<std::filesystem::path> files;
  std::error_code ignored;  // symbolic link loop
  for (auto entry = std::filesystem::recursive_directory_iterator(folder); entry != std::filesystem::end(entry);
       ++entry) {
    const std::string name = entry->path().filename().string();
    const bool is_left_out = name.starts_with('.') || (entry.depth() == 0 && name == except);
    if (is_left_out && entry->is_directory(ignored)) entry.disable_recursion_pending();
    if (!is_left_out && entry->is_regular_file(ignored)) files.push_back(entry->path());
  }
  std::sort(files.begin(), files.end());
  std::string listing;
  for (const std::filesystem::path& file : files) {
    listing += fmt::format("{}  {}\n", sha256_of_file(file), file.lexically_relative(folder).generic_string());
  }
  return sha256(listing);
}

}  // namespace patrol::io
