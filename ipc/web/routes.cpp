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
                   "unknown host name; use the address of the server, or add the origin of the page to [web] "
                   "origins of the cell file");
  if (!context.access.origin_allowed(request.header("origin")))
    return refused(context, 403, "this origin is not allowed; [web] origins of the cell file adds origins");
  return std::nullopt;
}

std::optional<Route> document(const HttpRequest& request, ServerContext& context) {
  using Make = std::string (Backend::*)();
  constexpr std::array<std::pair<std::string_view, Make>, 7> kDocuments = {
      {{"/api/status", &Backend::status_json},
       {"/api/tree", &Backend::tree_json},
       {"/api/commands", &Backend::commands_json},
       {"/api/names", &Backend::names_json},
       {"/api/command-log", &Backend::command_log_json},
       {"/api/alarms", &Backend::alarms_json},
       {"/metrics", &Backend::metrics_text}}};
  for (const auto& [path, make] : kDocuments) {
    if (request.path != path) continue;
    return Work([&backend = context.backend, one = make, metrics = path == "/metrics"] {
      Answer answer = json_answer((backend.*one)());
      if (metrics) answer.content_type = "text/plain; version=0.0.4; charset=utf-8";
      return answer;
    });
  }
  return std::nullopt;
}

// For those who watch the gateway and decide by the status alone.
Answer health_answer(Backend& backend) {
  const Health health = backend.health();
  return text_answer(health.ok ? 200 : 503, health.text);
}

std::optional<Route> snapshot(const HttpRequest& request, ServerContext& context) {
  const bool png = request.path == "/snapshot.png";
  if (!png && request.path != "/snapshot.jpg") return std::nullopt;
  const auto picture = read_picture_query(request.query);
  if (!picture) return refused(context, 400, picture.error().text());
  return TakeSnapshot{*picture, png ? ImageFormat::png : ImageFormat::jpeg};
}

Route command(const HttpRequest& request, ServerContext& context) {
  if (request.method != "POST") return refused(context, 405, "commands need POST");
  if (context.options.read_only) return refused(context, 403, "this gateway was started read-only");
  if (!token_matches(bearer_token(request), context.options.token)) {
    Answer answer = refused(context, 401,
                            "commands need the header Authorization: Bearer TOKEN; cellmirror page --json "
                            "prints the token");
    answer.headers.emplace_back("WWW-Authenticate", "Bearer");
    return answer;
  }
  return ExecuteBody{};
}

Route live(const HttpRequest& request, ServerContext& context) {
  auto accept = websocket_accept(request);
  if (accept) {
    const bool has_token = token_matches(opening_token(request), context.options.token);
    return OpenWebSocket{std::move(*accept), has_token,
                         offers_subprotocol(request) ? std::string(kSubprotocol) : std::string(), nullptr};
  }
  Answer answer = refused(context, 426, "this URL is a WebSocket, version 13");
  answer.headers.emplace_back("Upgrade", "websocket");
  answer.headers.emplace_back("Sec-WebSocket-Version", "13");
  return answer;
}

// Clients of the Foxglove protocol give the address of the server without a path.
std::optional<Route> foxglove_client(const HttpRequest& request, ServerContext& context) {
  if (request.path != "/" && request.path != "/foxglove") return std::nullopt;
  auto accept = websocket_accept(request);
  if (!accept) return std::nullopt;
  LiveData* data = context.backend.live_data();
  const auto offered = std::ranges::find_if(foxglove::kSubprotocols, [&](std::string_view name) {
    return request.header_has("sec-websocket-protocol", name);
  });
  if (data == nullptr || offered == foxglove::kSubprotocols.end()) {
    return refused(context, 400,
                   "a WebSocket here needs the subprotocol foxglove.websocket.v1 or foxglove.sdk.v1; the page's is at "
                   "/live");
  }
  const bool has_token = token_matches(opening_token(request), context.options.token);
  return OpenWebSocket{std::move(*accept), has_token, std::string(*offered), data};
}

}  // namespace

Route route(const HttpRequest& request, ServerContext& context) {
  if (auto answer = check_access(request, context)) return std::move(*answer);
  if (request.path == "/live") return live(request, context);
  if (auto found = foxglove_client(request, context)) return std::move(*found);
  if (request.path == "/api/command") return command(request, context);
  if (request.method != "GET" && request.method != "HEAD") {
    Answer answer = refused(context, 405, "only GET and HEAD are allowed");
    answer.headers.emplace_back("Allow", "GET, HEAD");
    return answer;
  }
  if (request.path == "/") context.backend.expect_pictures();
  if (const PageFile* file = find_page_file(request.path)) return file_answer(*file, request);
  if (request.path == "/healthz") return Work([&backend = context.backend] { return health_answer(backend); });
  if (auto found = document(request, context)) return std::move(*found);
  if (auto found = snapshot(request, context)) return std::move(*found);
  if (request.path == "/scene.glb") {
    const std::string* known = request.header("if-none-match");
    return TakeGeometry{known == nullptr ? std::string() : *known};
  }
  return text_answer(404, "not found");
}

}  // namespace cellmirror::web
