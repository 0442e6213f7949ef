// The wall behind its page: takes what has arrived, keeps the cells, makes documents. It commands nothing.
#pragma once

#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/wall/thumbnails.hpp"
#include "app/wall/wall_cells.hpp"
#include "app/wall/wall_document.hpp"
#include "app/wall/wall_inbox.hpp"
#include "ipc/web/web_server.hpp"
#include "ipc/web/web_site.hpp"

namespace cellmirror::app {

// Any thread.
class WallSite final : public web::Site {
 public:
  static constexpr Nanoseconds kLivePeriod{250'000'000};

  // `clock` outlives it. `version` of the program.
  WallSite(const WallSettings& settings, const Clock& clock, const std::string& version);

  [[nodiscard]] WallInbox& inbox() { return inbox_; }
  [[nodiscard]] Thumbnails& thumbnails() { return thumbnails_; }
  // For /metrics; null before it has started and from the time when it ends.
  void set_server(const web::Server* server);

  void remember(const std::vector<RememberedCell>& cells);
  [[nodiscard]] std::vector<RememberedCell> remembered() const;
  // Takes what has arrived since the last call. Several times a second.
  void drain();
  // As of now: /api/wall.
  [[nodiscard]] std::string whole_json();
  [[nodiscard]] std::string metrics_text();

  [[nodiscard]] const Clock& clock() const override { return clock_; }
  [[nodiscard]] std::span<const web::PageFile> files() const override { return web::wall_page_files(); }
  [[nodiscard]] std::string live_json() override;
  [[nodiscard]] Nanoseconds live_period() const override { return kLivePeriod; }
  [[nodiscard]] web::MakeDocument document(std::string_view path, std::string_view query) override;
  [[nodiscard]] web::Health health() override { return {true, "ok"}; }

 private:
  void drain_locked(Timestamp now);
  [[nodiscard]] web::MakeDocument picture(std::string_view query);

  const Clock& clock_;
  WallInbox inbox_;
  Thumbnails thumbnails_;
  std::mutex server_mutex_;
  const web::Server* server_ = nullptr;  // under it
  mutable std::mutex mutex_;             // of what follows
  WallCells cells_;
  WallDocuments documents_;
};

}  // namespace cellmirror::app
