#include "app/wall/wall_site.hpp"

#include <memory>
#include <optional>
#include <utility>

#include "app/wall/wall_metrics.hpp"
#include "ipc/web/http_request.hpp"
#include "ipc/web/metrics_text.hpp"

namespace cellmirror::app {

namespace {

std::vector<std::string> cells_with_pictures(const WallSettings& settings) {
  std::vector<std::string> out;
  for (const WallCell& cell : settings.cells) {
    if (!cell.thumbnail.empty()) out.push_back(cell.name);
  }
  return out;
}

web::Document document_of(std::string text, std::string content_type) {
  return {200, std::move(content_type), std::make_shared<const std::string>(std::move(text))};
}

}  // namespace

WallSite::WallSite(const WallSettings& settings, const Clock& clock, const std::string& version)
    : clock_(clock), thumbnails_(cells_with_pictures(settings)), cells_(settings), documents_(version) {}

void WallSite::set_server(const web::Server* server) {
  const std::scoped_lock lock(server_mutex_);
  server_ = server;
}

void WallSite::remember(const std::vector<RememberedCell>& cells) {
  const std::scoped_lock lock(mutex_);
  for (const RememberedCell& cell : cells) cells_.remember(cell);
}

std::vector<RememberedCell> WallSite::remembered() const {
  const std::scoped_lock lock(mutex_);
  return cells_.remembered();
}

void WallSite::drain_locked(Timestamp now) {
  const WallInbox::Taken taken = inbox_.take();
  for (const WallMessage& message : taken.messages) cells_.receive(message, to_wall_clock_ns(message.receive_time));
  for (const auto& [sender, refused] : taken.refused) {
    if (refused.dropped > 0) cells_.dropped(sender, refused.dropped, now);
    if (refused.rejected > 0) cells_.rejected(sender, refused.rejected, refused.why);
  }
  for (const std::string& sender : taken.gone) cells_.gone(sender);
  cells_.left_out(taken.left_out);
  cells_.look(now);
}

void WallSite::drain() {
  const std::scoped_lock lock(mutex_);
  drain_locked(clock_.now());
}

std::string WallSite::whole_json() {
  const std::scoped_lock lock(mutex_);
  drain_locked(clock_.now());
  return documents_.whole(cells_, thumbnails_, clock_.now());
}

std::string WallSite::live_json() {
  const std::scoped_lock lock(mutex_);
  drain_locked(clock_.now());
  return documents_.changes(cells_, thumbnails_, clock_.now());
}

std::string WallSite::metrics_text() {
  web::ServerStatus server;
  {
    const std::scoped_lock lock(server_mutex_);
    if (server_ != nullptr) server = server_->status();
  }
  const std::scoped_lock lock(mutex_);
  drain_locked(clock_.now());
  return wall_metrics(cells_, server, clock_.now());
}

web::MakeDocument WallSite::document(std::string_view path, std::string_view query) {
  if (path == "/api/wall") return [this] { return document_of(whole_json(), "application/json"); };
  if (path == "/metrics") return [this] { return document_of(metrics_text(), std::string(web::kMetricsType)); };
  if (path == "/thumbnail.jpg") return picture(query);
  return nullptr;
}

// "cell=NAME", and anything else, such as a number that makes the address of each picture another one.
web::MakeDocument WallSite::picture(std::string_view query) {
  std::string cell;
  if (const auto parts = web::query_parts(query)) {
    for (const auto& [name, value] : *parts) {
      if (name == "cell") cell = value;
    }
  }
  return [this, cell = std::move(cell)] {
    const auto found = thumbnails_.newest(cell);
    if (found) return web::Document{200, "image/jpeg", found->jpeg};
    return web::Document{404, "text/plain; charset=utf-8",
                         std::make_shared<const std::string>("there is no picture of that cell\n")};
  };
}

}  // namespace cellmirror::app
