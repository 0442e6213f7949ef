// Any text as a program of RAPID.
#include <cstdint>

#include "scripts/programs/rapid/rapid.hpp"
#include "tests/support/program_fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror::program;
  read_fuzzed(rapid_language(), {reinterpret_cast<const char*>(data), size});
  return 0;
}
