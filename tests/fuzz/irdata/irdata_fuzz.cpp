// Text as an IRDATA program; a text with a line "=codes=" has a table of codes behind it.
#include <cstdint>

#include "scripts/programs/irdata/irdata.hpp"
#include "tests/support/program_fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror::program;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  constexpr std::string_view kCodes = "\n=codes=\n";
  const std::size_t codes = text.find(kCodes);
  const bool own = codes != std::string_view::npos;
  read_fuzzed(irdata_language(), text.substr(0, codes), own ? text.substr(codes + kCodes.size()) : std::string_view());
  return 0;
}
