// The monitor page of a running gateway: its server, where it is reached, and what status tells of it.
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "app/gateway/web_backend.hpp"
#include "app/report/page_report.hpp"
#include "config/web_settings.hpp"
#include "ipc/web/page_address.hpp"
#include "ipc/web/web_server.hpp"

namespace cellmirror::app {

class MonitorPage {
 public:
  struct Options {
    bool wanted = true;
    WebSettings settings;
    std::optional<int> port;  // of the command line; goes before the cell file's
    std::string cell;         // its name
    std::string instance;
    std::filesystem::path folder;  // of the instance: the address and the token are left there for its owner
  };

  // Serves nobody yet: open() is called once the page itself can be asked for its report, which its clients do.
  MonitorPage(Options options, WebBackend::Parts backend);
  ~MonitorPage();
  MonitorPage(const MonitorPage&) = delete;
  MonitorPage& operator=(const MonitorPage&) = delete;

  // Where the page cannot be served a warning is logged, and the gateway goes on without.
  void open();
  // Ends all connections, and waits for what is being done for them. Nobody is called back after that.
  void close();

  // Any thread, before open(), during close() and after it too.
  [[nodiscard]] PageReport report() const;
  // 0: there is no page. Any thread.
  [[nodiscard]] std::uint16_t port() const;

 private:
  Result<std::unique_ptr<web::Server>> start_server();
  void refuse(const Error& error);

  Options options_;
  std::unique_ptr<WebBackend> backend_;
  mutable std::mutex mutex_;  // of what follows
  PageReport state_;          // but for the counters
  std::unique_ptr<web::Server> server_;
};

}  // namespace cellmirror::app
