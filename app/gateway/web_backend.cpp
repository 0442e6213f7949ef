#include "app/gateway/web_backend.hpp"

#include <utility>

#include "app/report/metrics.hpp"
#include "app/report/tree_document.hpp"
#include "ipc/wire/script_message.hpp"
#include "scripts/lang/help.hpp"

namespace cellmirror::app {

namespace {

std::unexpected<Error> no_pictures() {
  return fail("this gateway draws no pictures", "start it without --headless, and with [display] on in the cell file");
}

}  // namespace

WebBackend::WebBackend(Parts parts)
    : parts_(std::move(parts)),
      live_({parts_.topics, parts_.board, parts_.home, parts_.loop_rate_hz,
             [this](std::string_view command, const web::CommandOrigin& origin,
                    std::function<void(const web::CommandReply&)> reply) {
               execute(command, origin, std::move(reply));
             }}) {}

std::string WebBackend::live_json() {
  std::string out;
  parts_.at([&](const LiveSources& sources) {
    const std::scoped_lock lock(mutex_);
    out = live_document(sources, window_, tree_revision_.of(sources.cell_state.cell));
  });
  return out;
}

std::string WebBackend::tree_json() {
  const auto cell_state = parts_.board->latest();
  return tree_document(*cell_state, tree_revision_.of(cell_state->cell));
}

std::string WebBackend::commands_json() { return script::commands_as_json(); }

std::string WebBackend::names_json() { return names_document(*parts_.board->latest(), parts_.home->root()); }

std::string WebBackend::metrics_text() {
  std::string out;
  parts_.at([&](const LiveSources& sources) { out = metrics_document(sources, parts_.server_status()); });
  return out;
}

void WebBackend::execute(std::string_view command, const web::CommandOrigin& origin,
                         std::function<void(const web::CommandReply&)> reply) {
  const script::CommandSource source = script::CommandSource::page(origin.session, origin.peer);
  const auto refuse = [&](const std::string& why) {
    if (parts_.refused) parts_.refused(command, source, why);
    reply({false, why});
  };
  // The same checks as for messages; a tag is not for people.
  const ScriptEnvelope envelope = parse_script_message(command);
  if (command.starts_with('@')) return refuse("a command does not begin with @");
  if (!envelope.text) return refuse(envelope.text.error().text());
  if (commands_waiting_->fetch_add(1, std::memory_order_relaxed) >= kMostCommandsWaiting) {
    commands_waiting_->fetch_sub(1, std::memory_order_relaxed);
    return refuse("too many commands wait for their acknowledgement; try again");
  }
  script::ScriptCommand queued{
      *envelope.text, source, [waiting = commands_waiting_, answer = reply](const Result<std::string>& result) {
        waiting->fetch_sub(1, std::memory_order_relaxed);
        answer(result ? web::CommandReply{true, *result} : web::CommandReply{false, result.error().text()});
      }};
  if (parts_.owner->offer(queued)) return;
  const std::string why = "too many commands wait to be executed; try again";
  if (parts_.refused) parts_.refused(command, source, why);
  queued.reply(fail(why));
}

void WebBackend::expect_pictures() {
  if (parts_.renderer != nullptr) parts_.renderer->expect_pictures();
}

Result<std::unique_ptr<PictureStream>> WebBackend::open_pictures(const PictureRequest& request) {
  if (parts_.renderer == nullptr) return no_pictures();
  return parts_.renderer->open_pictures(request);
}

void WebBackend::ask_picture(const PictureRequest& request, ImageFormat format, PictureReply reply) {
  if (parts_.renderer == nullptr) return reply(no_pictures());
  parts_.renderer->ask_picture(request, format, std::move(reply));
}

void WebBackend::ask_pick(const PictureRequest& request, int x, int y, PickReply reply) {
  if (parts_.renderer == nullptr) return reply(no_pictures());
  parts_.renderer->ask_pick(request, x, y, std::move(reply));
}

}  // namespace cellmirror::app
