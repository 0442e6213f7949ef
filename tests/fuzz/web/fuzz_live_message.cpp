// What a client sends over its WebSocket: frames, joined to messages, read as JSON.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <variant>

#include "ipc/web/client_message.hpp"
#include "ipc/web/websocket.hpp"

namespace {

using namespace cellmirror::web;

constexpr std::size_t kMost = 4096;

void read_message(std::string_view text) {
  const auto message = read_client_message(text);
  if (!message) return;
  if (const auto* picture = std::get_if<PictureMessage>(&*message); picture && !check_picture_request(picture->request))
    std::abort();
  if (const auto* command = std::get_if<CommandMessage>(&*message); command && command->text.size() > kMaxCommandBytes)
    std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  // A text by itself begins with a brace, which is no frame of a client.
  if (bytes.starts_with('{')) {
    read_message(bytes);
    return 0;
  }
  constexpr std::size_t kShortestFrame = 6;
  FrameReader reader(kMost);
  reader.push(bytes);
  while (const auto message = reader.next()) {
    if (reader.take_count() == 0) std::abort();
    if (message->payload.size() > kMost) std::abort();
    if (message->opcode == Opcode::text) read_message(message->payload);
  }
  if (reader.take_count() > size / kShortestFrame) std::abort();
  return 0;
}
