#include "app/record/outbox.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <stdexcept>

#include <fmt/format.h>

#include "core/error.h"
#include "io/files/atomic_file.h"
#include "io/files/output_error.h"

namespace patrol::app {
namespace {

constexpr std::size_t kReadAhead = 1 << 20;  // bytes

std::filesystem::path sent_file(const std::filesystem::path& root) { return root / "outbox.sent"; }
std::filesystem::path refused_file(const std::filesystem::path& root) { return root / "outbox.refused.jsonl"; }

std::uint64_t sent_bytes(const std::filesystem::path& root) {
  if (!std::filesystem::exists(sent_file(root))) return 0;
  const std::string text = io::load_text(sent_file(root));
  std::uint64_t sent = 0;
  std::from_chars(text.data(), text.data() + text.size(), sent);
  return sent;
}

/// Number of complete lines in a file, from the byte `from` on.
std::size_t num_lines(const std::filesystem::path& file, std::uint64_t from) {
  std::ifstream in(file, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(from));
  return static_cast<std::size_t>(std::count(std::istreambuf_iterator<char>(in), {}, '\n'));
}

}  // namespace

Outbox::Outbox(std::filesystem::path root) : root_(std::move(root)), sent_(sent_bytes(root_)) {
  file_ = ::open(file().c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (file_ < 0) throw InputError(fmt::format("{}: cannot write", file().string()));
  written_ = static_cast<std::uint64_t>(::lseek(file_, 0, SEEK_END));
  sent_ = std::min<std::uint64_t>(sent_, written_);
}

Outbox::~Outbox() { ::close(file_); }

void Outbox::add(const monitor::Result& result) {
  const std::string line = monitor::to_json(result) + "\n";
  const ssize_t count = ::write(file_, line.data(), line.size());
  if (count != static_cast<ssize_t>(line.size())) {
    const bool is_cut_back = ::ftruncate(file_, static_cast<off_t>(written_.load())) == 0;
    throw std::runtime_error(
        fmt::format("{}: cannot write{}", file().string(), is_cut_back ? "" : ", and the last line is incomplete"));
  }
  written_ += line.size();
}

Outbox::Batch Outbox::next(std::size_t max_results, std::size_t max_bytes) {
  Batch batch{.results = {}, .end = sent_};
  const std::uint64_t end = written_;
  if (batch.end >= end) return batch;
  ::fdatasync(file_);
  std::string text;
  std::size_t bytes = 0;
  for (std::uint64_t read_to = sent_; batch.results.size() < max_results;) {
    const std::size_t newline = text.find('\n');
    if (newline == std::string::npos) {
      std::string more(std::min<std::uint64_t>(kReadAhead, end - read_to), '\0');
      const ssize_t count = more.empty() ? 0 : ::pread(file_, more.data(), more.size(), static_cast<off_t>(read_to));
      if (count <= 0) break;  // the remainder is incomplete: its writer died while writing
      text.append(more, 0, static_cast<std::size_t>(count));
      read_to += static_cast<std::uint64_t>(count);
      continue;
    }
    bytes += newline + 1;
    if (bytes > max_bytes && !batch.results.empty()) break;
    batch.results.push_back(text.substr(0, newline));
    batch.end += newline + 1;
    text.erase(0, newline + 1);
  }
  return batch;
}

void Outbox::mark_sent(const Batch& batch) {
  sent_ = batch.end;
  io::save_text(sent_file(root_), fmt::format("{}\n", sent_));
}

void Outbox::set_aside(const std::string& result) {
  const std::filesystem::path file = refused_file(root_);
  std::error_code ignored;
  const std::uintmax_t size = std::filesystem::exists(file, ignored) ? std::filesystem::file_size(file, ignored) : 0;
  std::ofstream out(file, std::ios::binary | std::ios::app);
  out << result << "\n" << std::flush;
  if (out) return;
  out.close();
  std::filesystem::resize_file(file, size, ignored);
  throw io::OutputError(fmt::format("{}: cannot be written", file.string()));
}

std::size_t Outbox::num_pending() const { return num_pending_results(root_); }
std::size_t Outbox::num_rejected() const { return num_lines(refused_file(root_), 0); }

std::size_t num_pending_results(const std::filesystem::path& root) {
  return num_lines(root / "outbox.jsonl", sent_bytes(root));
}

}  // namespace patrol::app
