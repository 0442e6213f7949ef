// Requests and answers of the control socket: what is accepted is bounded and read back the same.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "ipc/control/control_request.hpp"
#include "rt_core/base/contract.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  const std::string_view line(reinterpret_cast<const char*>(data), size);
  const auto request = parse_control_request(line);
  if (request) {
    CELLMIRROR_EXPECTS(request->arguments.size() <= 32);
    const std::string text = control_request_line(*request);
    CELLMIRROR_EXPECTS(text.find('\n') == std::string::npos);
    const auto again = parse_control_request(text);
    CELLMIRROR_EXPECTS(again && again->request == request->request && again->arguments == request->arguments);
  } else {
    CELLMIRROR_EXPECTS(control_error_in(control_error(request.error()))->what == request.error().what);
  }
  (void)control_error_in(line);
  return 0;
}
