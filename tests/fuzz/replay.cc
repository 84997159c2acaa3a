#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

#include "tests/fuzz/fuzz_input.h"

namespace {

using Bytes = std::vector<std::uint8_t>;

void run(const Bytes& bytes) { LLVMFuzzerTestOneInput(bytes.data(), bytes.size()); }

/// Changes a few bytes or numbers, removes or repeats a part, or appends a part of another input.
Bytes mutated(Bytes bytes, const std::vector<Bytes>& corpus, std::mt19937_64& draw) {
  const auto below = [&](std::size_t limit) { return std::size_t{draw() % std::max<std::size_t>(limit, 1)}; };
  for (std::size_t count = 1 + below(4); count > 0 && !bytes.empty(); --count) {
    const std::size_t at = below(bytes.size()), size = std::min(below(16) + 1, bytes.size() - at);
    const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    switch (below(6)) {
      case 0:
        bytes[at] = static_cast<std::uint8_t>(draw());
        break;
      case 1:
        bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ (1U << below(8)));
        break;
      case 2: {  // a length or an index at its limits
        const std::uint32_t extreme[] = {0, 1, 0x7fffffff, 0xffffffff, static_cast<std::uint32_t>(bytes.size())};
        std::memcpy(&bytes[at], &extreme[below(5)], std::min<std::size_t>(4, bytes.size() - at));
        break;
      }
      case 3:
        bytes.erase(begin, begin + static_cast<std::ptrdiff_t>(size));
        break;
      case 4: {
        const Bytes part(begin, begin + static_cast<std::ptrdiff_t>(size));
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), part.begin(), part.end());
        break;
      }
      default: {
        const Bytes& other = corpus[below(corpus.size())];
        bytes.resize(at);
        bytes.insert(bytes.end(), other.begin() + static_cast<std::ptrdiff_t>(below(other.size())), other.end());
      }
    }
  }
  return bytes;
}

}  // namespace

/// Calls the entry point once for each file of the folders that it is given, as libFuzzer does with -runs=0, and then
/// with N mutations of them: FUZZER [--mutations=N] FOLDER...
int main(int argc, char** argv) {
  std::vector<Bytes> corpus;
  long num_mutations = 0;
  for (int i = 1; i < argc; ++i) {
    if (std::strncmp(argv[i], "--mutations=", 12) == 0) {
      num_mutations = std::strtol(argv[i] + 12, nullptr, 10);
      continue;
    }
    for (const auto& entry : std::filesystem::directory_iterator(argv[i])) {
      std::ifstream file(entry.path(), std::ios::binary);
      corpus.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    }
  }
  for (const Bytes& bytes : corpus) run(bytes);
  std::mt19937_64 draw(1);
  for (long i = 0; i < num_mutations && !corpus.empty(); ++i)
    run(mutated(corpus[draw() % corpus.size()], corpus, draw));
  std::printf("%zu inputs, %ld mutations\n", corpus.size(), num_mutations);
  return corpus.empty() ? 1 : 0;
}
