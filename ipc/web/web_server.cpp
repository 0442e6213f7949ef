#include "ipc/web/web_server.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <exception>
#include <optional>
#include <thread>
#include <utility>

#include "ipc/runtime/system_error.hpp"
#include "ipc/web/connection.hpp"
#include "ipc/web/page_address.hpp"
#include "ipc/web/server_context.hpp"
#include "ipc/web/server_message.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/rt/scheduling.hpp"

namespace cellmirror::web {

namespace {

constexpr Nanoseconds kPicturePeriod{5'000'000};  // how often newer pictures are looked up
constexpr Nanoseconds kLongestWait{1'000'000'000};
constexpr Nanoseconds kNoDescriptorWait{100'000'000};
constexpr std::size_t kWorkers = 2;
constexpr int kBacklog = 128;

struct SocketAddress {
  sockaddr_storage bytes{};
  socklen_t length = 0;
  [[nodiscard]] sockaddr* get() { return reinterpret_cast<sockaddr*>(&bytes); }
};

Result<SocketAddress> socket_address(const std::string& address, int port) {
  SocketAddress out;
  sockaddr_in four{};
  sockaddr_in6 six{};
  const auto port_bytes = htons(static_cast<std::uint16_t>(port));
  if (inet_pton(AF_INET, address.c_str(), &four.sin_addr) == 1) {
    four.sin_family = AF_INET;
    four.sin_port = port_bytes;
    out.length = sizeof four;
    std::memcpy(&out.bytes, &four, sizeof four);
    return out;
  }
  if (inet_pton(AF_INET6, address.c_str(), &six.sin6_addr) == 1) {
    six.sin6_family = AF_INET6;
    six.sin6_port = port_bytes;
    out.length = sizeof six;
    std::memcpy(&out.bytes, &six, sizeof six);
    return out;
  }
  return fail(fmt::format("{} is not a numeric address", address), "e.g. 127.0.0.1");
}

void allow_absent_address(int listener, int family) {
  const int yes = 1;
  if (family == AF_INET) {
    ::setsockopt(listener, IPPROTO_IP, IP_FREEBIND, &yes, sizeof yes);
  } else {
    ::setsockopt(listener, IPPROTO_IPV6, IPV6_FREEBIND, &yes, sizeof yes);
  }
}

Result<Descriptor> listen_at(const std::string& address, int port, bool of_gateway) {
  auto to = socket_address(address, port);
  if (!to) return std::unexpected(to.error());
  Descriptor listener(::socket(to->bytes.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int yes = 1;
  if (listener.valid()) ::setsockopt(listener.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  // At boot, the interface with the address of the cell file may come up later; clients then reach this listener.
  if (listener.valid() && of_gateway) allow_absent_address(listener.get(), to->bytes.ss_family);
  if (listener.valid() && ::bind(listener.get(), to->get(), to->length) == 0 && ::listen(listener.get(), kBacklog) == 0)
    return listener;
  const int why = errno;
  const std::string_view in_use = of_gateway
                                      ? "another program uses that port: choose another one with --port N, or switch "
                                        "the page off with --no-web"
                                      : "another program uses that port: choose another one with --port N";
  const std::string_view other = of_gateway
                                     ? "choose another --port N (1024 to 65535), or [web] address in the cell file"
                                     : "choose another --port N (1024 to 65535), or another address with --bind";
  return fail(fmt::format("no {}page: cannot listen at {} port {}: {}", of_gateway ? "monitor " : "", address, port,
                          system_error_text(why)),
              std::string(why == EADDRINUSE ? in_use : other));
}

int port_of(int listener) {
  SocketAddress own;
  own.length = sizeof own.bytes;
  if (::getsockname(listener, own.get(), &own.length) != 0) return 0;
  // The port has the same offset in both address families.
  sockaddr_in four{};
  std::memcpy(&four, &own.bytes, sizeof four);
  return ntohs(four.sin_port);
}

std::uint64_t read_counter(const std::atomic<std::uint64_t>& counter) {
  return counter.load(std::memory_order_relaxed);
}

}  // namespace

bool port_is_free(const std::string& address, int port) { return listen_at(address, port, true).has_value(); }

struct Server::Impl {
  Descriptor listener;
  Counters counters;
  std::shared_ptr<Inbox> inbox;
  std::optional<JobPool> jobs;
  std::optional<ServerContext> context;
  std::vector<std::unique_ptr<Connection>> connections;
  std::uint64_t next_number = 1;
  Timestamp next_live;
  Timestamp next_picture;
  Timestamp next_look;
  Timestamp accept_again;
  bool live_under_way = false;
  std::atomic<bool> stopping{false};
  std::thread thread;

  ~Impl() { stop(); }

  void stop();
  void serve();
  [[nodiscard]] int poll_timeout_ms(Timestamp now) const;
  [[nodiscard]] bool wants_pictures() const;
  void take_inbox();
  void accept_some(Timestamp now);
  bool make_room();
  void request_live(Timestamp now);
  void send_pictures(Timestamp now);
  void look_for_foxglove(Timestamp now);
  void report_wrong_tokens(Timestamp now);
};

void Server::Impl::stop() {
  if (!thread.joinable()) return;
  stopping.store(true, std::memory_order_release);
  inbox->wake();
  thread.join();
  inbox->close();
  connections.clear();  // with their streams
  jobs.reset();
}

bool Server::Impl::wants_pictures() const {
  return std::ranges::any_of(connections, [](const auto& one) { return one->ready_for_picture(); });
}

int Server::Impl::poll_timeout_ms(Timestamp now) const {
  Timestamp next = now + kLongestWait;
  bool any_live = false;
  bool any_foxglove = false;
  for (const auto& connection : connections) {
    next = std::min(next, connection->deadline());
    any_live = any_live || connection->is_page();
    any_foxglove = any_foxglove || connection->is_foxglove();
  }
  if (any_foxglove) next = std::min(next, next_look);
  if (any_live && !live_under_way) next = std::min(next, next_live);
  if (wants_pictures()) next = std::min(next, next_picture);
  if (now < accept_again) next = std::min(next, accept_again);
  // Rounded up, else poll() returns slightly early and is called again.
  return static_cast<int>(std::max<std::int64_t>(0, ((next - now).count() + 999'999) / 1'000'000));
}

void Server::Impl::serve() {
  set_thread_name("web");
  const Clock& clock = context->site.clock();
  std::vector<pollfd> polled;
  for (;;) {
    polled.clear();
    polled.push_back({inbox->fd(), POLLIN, 0});
    const Timestamp before = clock.now();
    polled.push_back({listener.get(), static_cast<short>(before < accept_again ? 0 : POLLIN), 0});
    for (const auto& connection : connections) polled.push_back({connection->fd(), connection->wanted_events(), 0});
    const int ready = ::poll(polled.data(), polled.size(), poll_timeout_ms(before));
    if (ready < 0 && errno != EINTR) return;
    const Timestamp now = clock.now();
    if (stopping.load(std::memory_order_acquire)) break;
    for (std::size_t i = 0; ready > 0 && i < connections.size(); ++i) {
      if (polled[i + 2].revents != 0) connections[i]->handle_events(polled[i + 2].revents, now);
    }
    take_inbox();
    for (const auto& connection : connections) connection->check_time(now);
    request_live(now);
    send_pictures(now);
    look_for_foxglove(now);
    report_wrong_tokens(now);
    std::erase_if(connections, [](const auto& connection) { return connection->over(); });
    if (ready > 0 && (polled[1].revents & POLLIN) != 0) accept_some(now);
  }
  for (const auto& connection : connections) connection->end(CloseCode::going_away, "the gateway is shutting down");
}

void Server::Impl::take_inbox() {
  for (const Posted& posted : inbox->take()) {
    if (posted.connection == 0) {
      posted.receive(nullptr);
      continue;
    }
    const auto found =
        std::ranges::find(connections, posted.connection, [](const auto& connection) { return connection->number(); });
    if (found != connections.end() && !(*found)->over()) posted.receive(found->get());
  }
}

void Server::Impl::accept_some(Timestamp now) {
  for (int i = 0; i < kBacklog; ++i) {
    Descriptor socket(::accept4(listener.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!socket.valid()) {
      if (errno == EMFILE || errno == ENFILE) {
        log_error("web.descriptors", "no file descriptor left for a client of the monitor page");
        accept_again = now + kNoDescriptorWait;  // else poll() returns at once
      }
      return;
    }
    const int yes = 1;
    ::setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    if (connections.size() >= kMaxConnections && !make_room()) {
      count(counters.refused);
      continue;
    }
    connections.push_back(std::make_unique<Connection>(std::move(socket), next_number++, *context, now));
  }
}

// Closes the oldest connection whose request is not complete.
bool Server::Impl::make_room() {
  const auto found = std::ranges::find_if(connections, [](const auto& connection) {
    using enum Connection::Stage;
    return connection->stage() == head || connection->stage() == body || connection->stage() == draining;
  });
  if (found == connections.end()) return false;
  count(counters.cut);
  connections.erase(found);
  return true;
}

// One document for all of them, made by another thread, ahead of documents that clients requested.
void Server::Impl::request_live(Timestamp now) {
  if (live_under_way || now < next_live) return;
  if (std::ranges::none_of(connections, [](const auto& connection) { return connection->is_page(); })) return;
  next_live = now + context->site.live_period();
  live_under_way = jobs->submit_first([this, &site = context->site, box = inbox] {
    std::string text;
    try {
      text = frame(Opcode::text, live_message(site.live_json()));
    } catch (const std::exception& error) {
      log_error("web.live", "the live document could not be made: {}", error.what());
    }
    box->post(0, [this, chunk = chunk_of(std::move(text))](Connection*) {
      live_under_way = false;
      if (chunk.bytes.empty()) return;
      for (const auto& connection : connections) connection->send_live(chunk);
    });
  });
}

void Server::Impl::send_pictures(Timestamp now) {
  if (now < next_picture) return;
  next_picture = now + kPicturePeriod;
  for (const auto& connection : connections) {
    if (connection->ready_for_picture()) connection->send_picture(now);
  }
}

void Server::Impl::look_for_foxglove(Timestamp now) {
  if (now < next_look) return;
  next_look = now + FoxgloveSession::kLookPeriod;
  for (const auto& connection : connections) connection->look_for_foxglove(now);
}

void Server::Impl::report_wrong_tokens(Timestamp now) {
  for (const std::string& line : context->tries.take_reports(now)) {
    log_warning("web.wrong-token",
                "{}: clients need the token of this run, which cellmirror page prints; block this port for unknown "
                "clients",
                line);
  }
}

Server::Server(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Server::~Server() = default;

Result<std::unique_ptr<Server>> Server::start(const ServerOptions& options, Site& site) {
  ServerOptions settled = options;
  if (settled.token.empty()) {
    auto token = make_token();
    if (!token) return std::unexpected(token.error());
    settled.token = std::move(*token);
  }
  if (settled.run.empty()) settled.run = std::to_string(to_wall_clock_ns(site.clock().now()));
  auto listener = listen_at(options.address, options.port, site.gateway() != nullptr);
  if (!listener) return std::unexpected(listener.error());
  Descriptor wake_up(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC));
  if (!wake_up.valid()) return fail(fmt::format("no monitor page: {}", system_error_text(errno)));
  auto impl = std::make_unique<Impl>();
  impl->listener = std::move(*listener);
  settled.port = port_of(impl->listener.get());
  impl->inbox = std::make_shared<Inbox>(std::move(wake_up));
  impl->jobs.emplace(kWorkers);
  const AccessRules access(settled.address, settled.port, settled.origins);
  impl->context.emplace(ServerContext{settled, access, site, site.gateway(), *impl->jobs, impl->inbox, impl->counters});
  impl->thread = std::thread([server = impl.get()] { server->serve(); });
  return std::unique_ptr<Server>(new Server(std::move(impl)));
}

int Server::port() const { return impl_->context->options.port; }

const std::string& Server::token() const { return impl_->context->options.token; }

ServerStatus Server::status() const {
  const Counters& c = impl_->counters;
  return {read_counter(c.clients),           read_counter(c.requests),     read_counter(c.pictures),
          read_counter(c.pictures_left_out), read_counter(c.refused),      read_counter(c.cut),
          read_counter(c.commands),          read_counter(c.wrong_tokens), read_counter(c.unread_tokens)};
}

}  // namespace cellmirror::web
