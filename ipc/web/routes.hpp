// Routes of HTTP requests. Private to this folder.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>

#include "ipc/web/answer.hpp"
#include "ipc/web/live_data.hpp"
#include "ipc/web/server_context.hpp"

namespace cellmirror::web {

// Run by another thread.
using Work = std::function<Answer()>;
// One picture, rendered by another thread.
struct TakeSnapshot {
  PictureRequest request;
  ImageFormat format = ImageFormat::png;
};
// The cell's geometry, made by another thread.
struct TakeGeometry {
  std::string known;  // the header If-None-Match; may be empty
};
// The body is a SCRIPT command.
struct ExecuteBody {};
// The connection becomes a WebSocket.
struct OpenWebSocket {
  std::string accept;  // the header Sec-WebSocket-Accept
  bool has_token = false;
  std::string subprotocol;       // to be selected; empty: none
  LiveData* foxglove = nullptr;  // null: a page
};
using Route = std::variant<Answer, Work, TakeSnapshot, TakeGeometry, ExecuteBody, OpenWebSocket>;

// Sender and time of a request. `peer` calls peer_of(), only if a token must be checked.
struct Requester {
  std::function<std::string()> peer;
  Timestamp now;
};

// Decides by the head alone, access checks included, before any of the body is read.
[[nodiscard]] Route route(const HttpRequest& request, ServerContext& context, const Requester& from);

}  // namespace cellmirror::web
