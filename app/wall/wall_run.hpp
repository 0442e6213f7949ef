// A running wall: readers of DDS, a thread that takes what they receive, the page, and the memory of cells.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "app/wall/wall_site.hpp"
#include "config/wall_settings.hpp"
#include "drivers/dds/image_reader.hpp"
#include "drivers/dds/summary_reader.hpp"
#include "ipc/web/web_server.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::app {

struct WallOptions {
  WallSettings settings;
  bool page = true;             // otherwise it only listens
  std::filesystem::path state;  // file of the memory; empty: none
};

class WallRun {
 public:
  // Fails, with a remedy, where the interface, the port or the memory is not what it should be.
  // `clock` outlives it.
  [[nodiscard]] static Result<std::unique_ptr<WallRun>> start(const WallOptions& options, const Clock& clock);
  // Writes the memory once more.
  ~WallRun();
  WallRun(const WallRun&) = delete;
  WallRun& operator=(const WallRun&) = delete;

  // "http://127.0.0.1:8430/"; empty: there is no page.
  [[nodiscard]] std::string url() const;
  [[nodiscard]] WallSite& site() { return site_; }

 private:
  class Inbox;

  WallRun(const WallOptions& options, const Clock& clock);
  Result<void> open();
  Result<void> open_pictures();
  void keep();
  void write_memory();

  const WallOptions options_;
  const Clock& clock_;
  WallSite site_;
  std::unique_ptr<Inbox> inbox_;
  std::atomic<bool> stopping_{false};
  std::thread keeper_;
  std::unique_ptr<web::Server> server_;
  std::unique_ptr<dds::SummaryReader> summaries_;
  std::vector<std::unique_ptr<dds::ImageReader>> pictures_;
};

}  // namespace cellmirror::app
