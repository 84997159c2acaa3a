#include "io/logs/mcap_scan_log.h"
#include "tests/fuzz/scan_log_checks.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  patrol::test::check_log<patrol::io::McapScanLog>(patrol::test::MemoryFile(data, size));
  return 0;
}
