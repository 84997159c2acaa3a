#include "app/film/shared_progress.h"

#include <sys/mman.h>

#include <new>
#include <numeric>
#include <stdexcept>

namespace patrol::app {

SharedProgress::SharedProgress(std::size_t num_parts) : num_parts_(num_parts) {
  void* memory = ::mmap(nullptr, num_bytes(), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::runtime_error("cannot allocate shared memory");
  done_ = static_cast<std::atomic<double>*>(memory);
  for (std::size_t i = 0; i < num_parts_; ++i) new (done_ + i) std::atomic<double>(0.0);
}

SharedProgress::~SharedProgress() { ::munmap(done_, num_bytes()); }

double SharedProgress::mean() const {
  return std::accumulate(done_, done_ + num_parts_, 0.0) / static_cast<double>(num_parts_);
}

}  // namespace patrol::app
