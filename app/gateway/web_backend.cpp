#include "app/gateway/web_backend.hpp"

#include <utility>

#include "app/gateway/metrics.hpp"
#include "app/gateway/tree_document.hpp"
#include "ipc/wire/script_message.hpp"
#include "scripts/lang/help.hpp"

namespace cellmirror::app {

namespace {

std::unexpected<Error> no_pictures() {
  return fail("this gateway takes no pictures", "start it without --headless, and with [display] on in the cell file");
}

}  // namespace

std::string WebBackend::live_json() {
  std::string out;
  parts_.at([&](const LiveSources& sources) {
    const std::scoped_lock lock(mutex_);
    out = live_document(sources, window_, tree_revision_.of(sources.picture.cell));
  });
  return out;
}

std::string WebBackend::tree_json() {
  const auto picture = parts_.board->look();
  return tree_document(*picture, tree_revision_.of(picture->cell));
}

std::string WebBackend::commands_json() { return script::commands_as_json(); }

std::string WebBackend::names_json() { return names_document(*parts_.board->look(), parts_.home); }

std::string WebBackend::metrics_text() {
  std::string out;
  parts_.at([&](const LiveSources& sources) { out = metrics_document(sources, parts_.server_status()); });
  return out;
}

void WebBackend::execute(std::string_view command, std::function<void(const web::CommandReply&)> reply) {
  ScriptMessage message;
  // The same checks as for messages; a tag is not for people.
  const ScriptEnvelope envelope = parse_script_message(command);
  if (command.starts_with('@')) return reply({false, "a command does not begin with @"});
  if (!envelope.text) return reply({false, envelope.text.error().text()});
  message.text = *envelope.text;
  const auto tag = parts_.commands->add(reply);
  if (!tag) return reply({false, "too many commands wait for their acknowledgement; try again"});
  message.tag = *tag;
  if (parts_.owner->offer(message)) return;
  if (const auto back = parts_.commands->take(*tag))
    (*back)({false, "too many commands wait to be executed; try again"});
}

void WebBackend::expect_pictures() {
  if (parts_.studio != nullptr) parts_.studio->expect_pictures();
}

Result<std::unique_ptr<PictureStream>> WebBackend::open_pictures(const PictureRequest& wish) {
  if (parts_.studio == nullptr) return no_pictures();
  return parts_.studio->open_pictures(wish);
}

void WebBackend::ask_picture(const PictureRequest& wish, ImageFormat format, PictureReply reply) {
  if (parts_.studio == nullptr) return reply(no_pictures());
  parts_.studio->ask_picture(wish, format, std::move(reply));
}

void WebBackend::ask_pick(const PictureRequest& wish, int x, int y, PickReply reply) {
  if (parts_.studio == nullptr) return reply(no_pictures());
  parts_.studio->ask_pick(wish, x, y, std::move(reply));
}

}  // namespace cellmirror::app
