#include "app/gateway/monitor_page.hpp"

#include <unistd.h>

#include <utility>

#include "ipc/control/instance.hpp"
#include "rt_core/base/log.hpp"

namespace cellmirror::app {

namespace {

// Gateways with a name of their own may run beside each other: they take a free port.
int port_of(const MonitorPage::Options& options) {
  if (options.port) return *options.port;
  if (options.instance != kDefaultInstance) return 0;
  return options.settings.port.value_or(web::kDefaultPort);
}

}  // namespace

MonitorPage::MonitorPage(const Options& options, WebBackend::Parts backend) {
  state_.on = options.wanted && options.settings.enabled;
  state_.read_only = options.settings.read_only;
  if (!state_.on) return;
  backend.server_status = [this] { return server_ ? server_->status() : web::ServerStatus{}; };
  backend_ = std::make_unique<WebBackend>(std::move(backend));
  start(options);
}

MonitorPage::~MonitorPage() = default;

void MonitorPage::start(const Options& options) {
  web::ServerOptions to;
  to.address = options.settings.address;
  to.port = port_of(options);
  to.read_only = options.settings.read_only;
  to.origins = options.settings.origins;
  to.version = CELLMIRROR_VERSION;
  to.cell = options.cell;
  to.instance = options.instance;
  // Beside the locks: what lies in the instance's own folder ends with the gateway.
  auto token = web::kept_token(options.folder.parent_path() / ".locks" / ("page-token-" + options.instance));
  if (!token) {
    state_.problem = token.error().text();
    return log_warning("web", "{}", state_.problem);
  }
  to.token = *token;
  auto server = web::Server::start(to, *backend_);
  if (!server) {
    state_.problem = server.error().text();
    return log_warning("web", "{}", state_.problem);
  }
  server_ = std::move(*server);
  const web::PageAddress page{to.address, server_->port(), to.token, to.read_only};
  state_.address = page.url();
  // Without the file the page only shows, since nobody can know the token.
  if (const auto written = web::write_page_address(options.folder, page); !written)
    log_warning("web", "{}", written.error().text());
}

PageReport MonitorPage::report() const {
  PageReport out = state_;
  if (server_) out.server = server_->status();
  return out;
}

}  // namespace cellmirror::app
