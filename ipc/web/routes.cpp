#include "ipc/web/routes.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "ipc/web/client_message.hpp"
#include "ipc/web/page_files.hpp"
#include "ipc/web/server_message.hpp"
#include "ipc/web/websocket.hpp"

namespace cellmirror::web {

namespace {

Answer refused(ServerContext& context, int status, std::string text) {
  count(context.counters.refused);
  return text_answer(status, std::move(text));
}

std::optional<Answer> check_access(const HttpRequest& request, ServerContext& context) {
  if (!context.access.host_allowed(*request.header("host")))
    return refused(context, 421,
                   context.gateway == nullptr
                       ? "unknown host name; use the address of the server"
                       : "unknown host name; use the address of the server, or add the origin of the page to [web] "
                         "origins of the cell file");
  if (!context.access.origin_allowed(request.header("origin")))
    return refused(context, 403,
                   context.gateway == nullptr
                       ? "this origin is not allowed"
                       : "this origin is not allowed; [web] origins of the cell file adds origins");
  return std::nullopt;
}

std::optional<Route> document(const HttpRequest& request, ServerContext& context) {
  MakeDocument make = context.site.document(request.path, request.query);
  if (!make) return std::nullopt;
  return Work([make = std::move(make)] { return document_answer(make()); });
}

// For those who watch the gateway and decide by the status alone.
Answer health_answer(Site& site) {
  const Health health = site.health();
  return text_answer(health.ok ? 200 : 503, health.text);
}

std::optional<Route> snapshot(const HttpRequest& request, ServerContext& context) {
  const bool png = request.path == "/snapshot.png";
  if (!png && request.path != "/snapshot.jpg") return std::nullopt;
  const auto picture = read_picture_query(request.query);
  if (!picture) return refused(context, 400, picture.error().text());
  return TakeSnapshot{*picture, png ? ImageFormat::png : ImageFormat::jpeg};
}

Answer too_many_wrong_tokens(ServerContext& context, int wait_s) {
  Answer answer = refused(context, 429, too_many_wrong_tokens_text(wait_s));
  answer.headers.emplace_back("Retry-After", std::to_string(wait_s));
  return answer;
}

// Checks the credentials of a client if it sent any; requests without credentials are not limited.
TokenTries::Check check_shown(std::string_view shown, ServerContext& context, const Requester& from) {
  return shown.empty() ? TokenTries::Check() : check_token(context, shown, from.peer(), from.now);
}

Route command(const HttpRequest& request, ServerContext& context, const Requester& from) {
  if (request.method != "POST") return refused(context, 405, "commands need POST");
  if (context.options.read_only) return refused(context, 403, "this gateway was started read-only");
  const TokenTries::Check checked = check_shown(shown_credentials(request), context, from);
  if (checked.verdict == TokenTries::Verdict::unread) return too_many_wrong_tokens(context, checked.wait_s);
  if (!checked.right()) {
    Answer answer = refused(context, 401,
                            checked.verdict == TokenTries::Verdict::none
                                ? "commands need the header Authorization: Bearer TOKEN; cellmirror page --json "
                                  "prints the token"
                                : "wrong token: it belongs to another gateway or an older run; cellmirror page --json "
                                  "prints the current one, for the header Authorization: Bearer TOKEN");
    answer.headers.emplace_back("WWW-Authenticate", "Bearer");
    return answer;
  }
  return ExecuteBody{};
}

Route live(const HttpRequest& request, ServerContext& context, const Requester& from) {
  auto accept = websocket_accept(request);
  if (accept) {
    const TokenTries::Check checked = check_shown(opening_token(request), context, from);
    if (checked.verdict == TokenTries::Verdict::unread) return too_many_wrong_tokens(context, checked.wait_s);
    return OpenWebSocket{std::move(*accept), checked.right(),
                         offers_subprotocol(request) ? std::string(kSubprotocol) : std::string(), nullptr};
  }
  Answer answer = refused(context, 426, "this URL is a WebSocket, version 13");
  answer.headers.emplace_back("Upgrade", "websocket");
  answer.headers.emplace_back("Sec-WebSocket-Version", "13");
  return answer;
}

// Clients of the Foxglove protocol give the address of the server without a path.
std::optional<Route> foxglove_client(const HttpRequest& request, ServerContext& context, const Requester& from) {
  if (request.path != "/" && request.path != "/foxglove") return std::nullopt;
  auto accept = websocket_accept(request);
  if (!accept) return std::nullopt;
  LiveData* data = context.gateway == nullptr ? nullptr : context.gateway->live_data();
  const auto offered = std::ranges::find_if(foxglove::kSubprotocols, [&](std::string_view name) {
    return request.header_has("sec-websocket-protocol", name);
  });
  if (data == nullptr || offered == foxglove::kSubprotocols.end()) {
    return refused(context, 400,
                   "a WebSocket here needs the subprotocol foxglove.websocket.v1 or foxglove.sdk.v1; the page's is at "
                   "/live");
  }
  const TokenTries::Check checked = check_shown(opening_token(request), context, from);
  if (checked.verdict == TokenTries::Verdict::unread) return too_many_wrong_tokens(context, checked.wait_s);
  return OpenWebSocket{std::move(*accept), checked.right(), std::string(*offered), data};
}

// What only a gateway has; decided before the method is looked at.
std::optional<Route> gateway_route(const HttpRequest& request, ServerContext& context, const Requester& from) {
  if (context.gateway == nullptr) return std::nullopt;
  if (auto found = foxglove_client(request, context, from)) return found;
  if (request.path == "/api/command") return command(request, context, from);
  if (request.method != "GET" && request.method != "HEAD") return std::nullopt;
  if (request.path == "/") context.gateway->expect_pictures();
  if (auto found = snapshot(request, context)) return found;
  if (request.path != "/scene.glb") return std::nullopt;
  const std::string* known = request.header("if-none-match");
  return TakeGeometry{known == nullptr ? std::string() : *known};
}

}  // namespace

Route route(const HttpRequest& request, ServerContext& context, const Requester& from) {
  if (auto answer = check_access(request, context)) return std::move(*answer);
  if (request.path == "/live") return live(request, context, from);
  if (auto found = gateway_route(request, context, from)) return std::move(*found);
  if (request.method != "GET" && request.method != "HEAD") {
    Answer answer = refused(context, 405, "only GET and HEAD are allowed");
    answer.headers.emplace_back("Allow", "GET, HEAD");
    return answer;
  }
  if (const PageFile* file = find_page_file(context.site.files(), request.path)) return file_answer(*file, request);
  if (request.path == "/healthz") return Work([&site = context.site] { return health_answer(site); });
  if (auto found = document(request, context)) return std::move(*found);
  return text_answer(404, "not found");
}

}  // namespace cellmirror::web
