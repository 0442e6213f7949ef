// The head of a request, whatever bytes come, and what is made of its query.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "ipc/web/access.hpp"
#include "ipc/web/client_message.hpp"
#include "ipc/web/http_request.hpp"
#include "ipc/web/websocket.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror::web;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  constexpr std::size_t kMostBody = 1000;
  const ReadHead head = read_http_head(text, kMostBody);
  if (head.refused || head.bytes == 0) return 0;
  const HttpRequest& request = head.request;
  if (head.bytes > size || request.body_bytes > kMostBody) std::abort();
  if (!request.path.starts_with('/') || request.path.find("/../") != std::string::npos) std::abort();
  if (request.header("host") == nullptr) std::abort();
  static const AccessRules rules("127.0.0.1", 8420, {"https://cell.example.org"});
  static_cast<void>(rules.host_allowed(*request.header("host")));
  static_cast<void>(rules.origin_allowed(request.header("origin")));
  static_cast<void>(token_matches(bearer_token(request), "0123456789abcdef"));
  if (opening_token(request).size() > size) std::abort();
  static_cast<void>(websocket_accept(request));
  if (const auto picture = read_picture_query(request.query); picture && !check_picture_request(*picture)) std::abort();
  return 0;
}
