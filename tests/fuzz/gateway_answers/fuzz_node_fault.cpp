// Any text as a fault of a node: within the bounds of what nodes can do, or a reason.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "app/gateway/node_fault_request.hpp"
#include "rt_core/base/contract.hpp"
#include "rt_core/ports/io_image.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto fault = app::parse_node_fault(text);
  if (!fault) {
    CELLMIRROR_EXPECTS(!fault.error().what.empty());
    return 0;
  }
  CELLMIRROR_EXPECTS(fault->probability >= 0 && fault->probability <= 1);
  CELLMIRROR_EXPECTS(fault->by.count() >= 0 && fault->by.count() <= 10'000'000'000);
  CELLMIRROR_EXPECTS(fault->input < (fault->analogue ? kIoAnalogues : kIoBits));
  CELLMIRROR_EXPECTS((fault->kind == NodeFaultKind::emergency) == (fault->code != 0));
  return 0;
}
