#include "app/wall/wall_run.hpp"

#include <ctime>
#include <utility>

#include "app/wall/wall_memory.hpp"
#include "drivers/dds/network.hpp"
#include "drivers/dds/presence.hpp"
#include "ipc/web/page_address.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/rt/scheduling.hpp"

namespace cellmirror::app {

namespace {

constexpr long kPeriod_ns = 50'000'000;
constexpr Nanoseconds kMemoryPeriod{10'000'000'000};

}  // namespace

// Called by the thread of the participant's link.
class WallRun::Inbox final : public dds::SummaryInbox {
 public:
  explicit Inbox(WallInbox& to) : to_(to) {}
  void received(const dds::ReceivedSummary& summary) override {
    to_.received({summary.summary, summary.sender, summary.receive_time, summary.bytes});
  }
  void rejected(std::string_view sender, const std::string& why) override { to_.rejected(sender, why); }
  void gone(std::string_view sender) override { to_.gone(sender); }

 private:
  WallInbox& to_;
};

WallRun::WallRun(const WallOptions& options, const Clock& clock)
    : options_(options),
      clock_(clock),
      site_(options.settings, clock_, CELLMIRROR_VERSION),
      inbox_(std::make_unique<Inbox>(site_.inbox())) {}

WallRun::~WallRun() {
  pictures_.clear();
  summaries_.reset();
  site_.set_server(nullptr);
  server_.reset();
  stopping_.store(true, std::memory_order_relaxed);
  if (!keeper_.joinable()) return;
  keeper_.join();
  write_memory();
}

Result<std::unique_ptr<WallRun>> WallRun::start(const WallOptions& options, const Clock& clock) {
  std::unique_ptr<WallRun> made(new WallRun(options, clock));
  if (auto opened = made->open(); !opened) return std::unexpected(opened.error());
  return made;
}

Result<void> WallRun::open() {
  const WallSettings& settings = options_.settings;
  if (!options_.state.empty()) {
    const auto known = read_wall_memory(options_.state);
    if (!known) return std::unexpected(known.error());
    site_.remember(*known);
    // At once, so that a file that cannot be written is found at the start.
    if (auto written = write_wall_memory(options_.state, *known); !written) return written;
  }
  dds::set_ros_presence(settings.ros);
  dds::set_network(settings.network);
  if (options_.page) {
    web::ServerOptions to;
    to.address = settings.address;
    to.port = settings.port;
    to.read_only = true;
    to.version = CELLMIRROR_VERSION;
    to.cell = "wall";
    auto server = web::Server::start(to, site_);
    if (!server) return std::unexpected(server.error());
    server_ = std::move(*server);
    site_.set_server(server_.get());
  }
  auto reader = dds::SummaryReader::open(
      {settings.domain, settings.interface_address, settings.topic, settings.security}, clock_, *inbox_);
  if (!reader) return std::unexpected(reader.error());
  summaries_ = std::move(*reader);
  if (auto opened = open_pictures(); !opened) return opened;
  keeper_ = std::thread([this] { keep(); });
  return {};
}

Result<void> WallRun::open_pictures() {
  const WallSettings& settings = options_.settings;
  for (const WallCell& cell : settings.cells) {
    if (cell.thumbnail.empty()) continue;
    auto reader = dds::ImageReader::open(
        {settings.domain, settings.interface_address, cell.thumbnail, cell.partition, settings.security}, clock_,
        [this, name = cell.name](std::span<const std::uint8_t> picture, Timestamp time) {
          site_.thumbnails().receive(name, picture, time);
        });
    if (!reader) return std::unexpected(reader.error());
    pictures_.push_back(std::move(*reader));
  }
  return {};
}

void WallRun::keep() {
  set_thread_name("wall");
  Timestamp written = clock_.now();
  while (!stopping_.load(std::memory_order_relaxed)) {
    site_.drain();
    if (clock_.now() - written >= kMemoryPeriod) {
      write_memory();
      written = clock_.now();
    }
    const timespec period{0, kPeriod_ns};
    nanosleep(&period, nullptr);
  }
}

void WallRun::write_memory() {
  if (options_.state.empty()) return;
  if (const auto written = write_wall_memory(options_.state, site_.remembered()); !written)
    log_warning("wall.memory", "{}", written.error().text());
}

std::string WallRun::url() const {
  if (server_ == nullptr) return {};
  return web::PageAddress{options_.settings.address, server_->port(), {}, true}.url();
}

}  // namespace cellmirror::app
