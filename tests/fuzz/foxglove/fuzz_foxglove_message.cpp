// What a client of the Foxglove protocol sends: the first byte says text, binary, or a request of the service.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <variant>

#include "ipc/foxglove/client_message.hpp"
#include "ipc/foxglove/server_message.hpp"

namespace {

using namespace cellmirror::foxglove;

constexpr std::size_t kLongestCommand = 8000;

// What the server makes of a message must be bounded, whatever the client wrote.
void look(const ClientMessage& message) {
  if (const auto* subscribe = std::get_if<Subscribe>(&message);
      subscribe && subscribe->subscriptions.size() > kMostOfAMessage)
    std::abort();
  if (const auto* fetch = std::get_if<FetchAsset>(&message); fetch && fetch->uri.size() > kLongestName) std::abort();
  if (const auto* set = std::get_if<SetParameters>(&message);
      set && parameters_message(set->parameters, set->request).empty())
    std::abort();
  if (const auto* call = std::get_if<CallService>(&message);
      call && service_response(*call, "").size() != 13 + call->encoding.size())
    std::abort();
  if (const auto* control = std::get_if<PlaybackControl>(&message);
      control && (!std::isfinite(control->speed) || control->request.size() > kLongestName ||
                  playback_message({}, control->request).size() != 19 + control->request.size()))
    std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (data[0] == 'c') {
    const auto request = read_command_request(bytes, kLongestCommand);
    if (request && (request->command.empty() || request->command.size() > kLongestCommand)) std::abort();
    return 0;
  }
  const auto message = data[0] == 't' ? read_text_message(bytes) : read_binary_message(bytes);
  if (message) {
    look(*message);
  } else if (message.error().empty() || status_message(StatusLevel::error, message.error()).empty()) {
    std::abort();
  }
  return 0;
}
