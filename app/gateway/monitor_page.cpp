#include "app/gateway/monitor_page.hpp"

#include <unistd.h>

#include <utility>

#include "ipc/control/instance.hpp"
#include "rt_core/base/log.hpp"

namespace cellmirror::app {

namespace {

// Gateways with a name of their own may run beside each other: where nobody chose a port they take a free one.
int port_of(const MonitorPage::Options& options) {
  if (options.port) return *options.port;
  if (options.settings.port) return *options.settings.port;
  return options.instance == kDefaultInstance ? web::kDefaultPort : 0;
}

}  // namespace

MonitorPage::MonitorPage(Options options, WebBackend::Parts backend) : options_(std::move(options)) {
  state_.on = options_.wanted && options_.settings.enabled;
  state_.read_only = options_.settings.read_only;
  backend.server_status = [this] { return report().server; };
  backend_ = std::make_unique<WebBackend>(std::move(backend));
}

MonitorPage::~MonitorPage() { close(); }

void MonitorPage::open() {
  if (!options_.wanted || !options_.settings.enabled) return;
  auto server = start_server();
  if (!server) return refuse(server.error());
  const web::PageAddress page{options_.settings.address, (*server)->port(), (*server)->token(),
                              options_.settings.read_only};
  {
    const std::scoped_lock lock(mutex_);
    server_ = std::move(*server);
    state_.address = page.url();
    state_.listens_on = page.address;
  }
  // Without the file the page only shows, since nobody can know the token.
  if (const auto written = web::write_page_address(options_.folder, page); !written)
    log_warning("web", "{}", written.error().text());
}

std::uint16_t MonitorPage::port() const {
  const std::scoped_lock lock(mutex_);
  return server_ ? static_cast<std::uint16_t>(server_->port()) : std::uint16_t{0};
}

void MonitorPage::close() {
  std::unique_ptr<web::Server> ended;
  {
    const std::scoped_lock lock(mutex_);
    ended = std::move(server_);
  }
  // Without the lock: what is still being done for clients asks for the report.
  ended.reset();
}

Result<std::unique_ptr<web::Server>> MonitorPage::start_server() {
  web::ServerOptions to;
  to.address = options_.settings.address;
  to.port = port_of(options_);
  to.read_only = options_.settings.read_only;
  to.origins = options_.settings.origins;
  to.version = CELLMIRROR_VERSION;
  to.cell = options_.cell;
  to.instance = options_.instance;
  // Beside the locks: what lies in the instance's own folder ends with the gateway.
  auto token = web::kept_token(options_.folder.parent_path() / ".locks" / ("page-token-" + options_.instance));
  if (!token) return std::unexpected(token.error());
  to.token = *token;
  return web::Server::start(to, *backend_);
}

void MonitorPage::refuse(const Error& error) {
  log_warning("web", "{}", error.text());
  const std::scoped_lock lock(mutex_);
  state_.problem = error.text();
}

PageReport MonitorPage::report() const {
  const std::scoped_lock lock(mutex_);
  PageReport out = state_;
  if (server_) out.server = server_->status();
  return out;
}

}  // namespace cellmirror::app
