#include "ipc/control/control_server.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "ipc/control/control_connection.hpp"
#include "ipc/control/control_request.hpp"
#include "ipc/control/unix_address.hpp"
#include "ipc/runtime/system_error.hpp"
#include "rt_core/base/log.hpp"

namespace cellmirror {
namespace {

using Progress = ControlConnection::Progress;

Timestamp now() { return SystemClock().now(); }

bool may_ask(int socket) {
  ucred peer{};
  socklen_t length = sizeof peer;
  if (::getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &peer, &length) != 0) return false;
  return peer.uid == ::geteuid() || peer.uid == 0;
}

std::string answer_of(const ControlServer::Handler& handler, std::string_view request) {
  try {
    return handler(request);
  } catch (const std::exception& error) {
    log_error("ipc.control-request", "{}", error.what());
    return control_error({fmt::format("the request failed: {}", error.what()), "this is a bug, please report it"});
  }
}

}  // namespace

// Outlives the server as long as an answer is pending.
class ControlReply::Answers {
 public:
  Answers() : wake_up_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}

  void hand_in(std::uint64_t client, std::string text) {
    {
      const std::scoped_lock lock(mutex_);
      answers_.emplace_back(client, std::move(text));
    }
    wake();
  }
  void wake() {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t woken = ::write(wake_up_.get(), &one, sizeof one);
  }
  std::vector<std::pair<std::uint64_t, std::string>> collect() {
    std::uint64_t count = 0;
    [[maybe_unused]] const ssize_t got = ::read(wake_up_.get(), &count, sizeof count);
    std::vector<std::pair<std::uint64_t, std::string>> out;
    const std::scoped_lock lock(mutex_);
    out.swap(answers_);
    return out;
  }
  [[nodiscard]] const Descriptor& wake_up() const { return wake_up_; }

 private:
  Descriptor wake_up_;
  std::mutex mutex_;
  std::vector<std::pair<std::uint64_t, std::string>> answers_;
};

ControlReply::ControlReply(std::shared_ptr<Answers> answers, std::uint64_t client)
    : answers_(std::move(answers)), client_(client) {}

ControlReply::ControlReply(ControlReply&& other) noexcept
    : answers_(std::move(other.answers_)), client_(other.client_) {}

ControlReply::~ControlReply() {
  if (answers_) (*this)(control_error({"the request was not answered", "ask again"}));
}

void ControlReply::operator()(std::string text) {
  const auto answers = std::exchange(answers_, nullptr);
  if (answers) answers->hand_in(client_, std::move(text));
}

struct ControlServer::Impl {
  struct Client {
    ControlConnection connection;
    std::uint64_t number = 0;
    bool asked = false;  // its request is being answered
    Timestamp deadline;  // of the answer to its request
    [[nodiscard]] Timestamp until() const { return asked ? deadline : connection.deadline(); }
  };

  std::filesystem::path path;
  LaterHandler handler;
  Nanoseconds client_timeout{0};
  Descriptor listener;
  std::shared_ptr<ControlReply::Answers> answers = std::make_shared<ControlReply::Answers>();
  std::vector<Client> connections;
  std::uint64_t clients = 0;  // so far
  std::thread thread;
  std::atomic<bool> stopping{false};
  std::atomic<std::uint64_t> answered{0};
  std::atomic<std::uint64_t> refused{0};
  std::atomic<std::uint64_t> cut{0};

  Result<void> listen();
  void serve();
  void accept_one();
  // False: the connection is over.
  bool go_on(Client& client, short events);
  bool respond(Client& client, std::string text);
  void take_answer(Client& client);
  void hand_out();
  [[nodiscard]] int poll_timeout_ms() const;
  void cut_off_late();
  void make_room();
};

Result<void> ControlServer::Impl::listen() {
  const auto address = unix_address(path);
  if (!address) return std::unexpected(address.error());
  listener = Descriptor(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const auto failed = [&] {
    return fail(fmt::format("cannot listen at {}: {}", path.native(), system_error_text(errno)));
  };
  if (!listener.valid() || !answers->wake_up().valid()) return failed();
  ::unlink(path.c_str());
  if (::bind(listener.get(), reinterpret_cast<const sockaddr*>(&*address), sizeof *address) != 0) return failed();
  // The folder excludes other users; the mode is a second barrier.
  if (::chmod(path.c_str(), 0600) != 0) return failed();
  if (::listen(listener.get(), static_cast<int>(kMaxClients)) != 0) return failed();
  return {};
}

void ControlServer::Impl::serve() {
  ::pthread_setname_np(::pthread_self(), "control-socket");
  std::vector<pollfd> polled;
  while (!stopping.load(std::memory_order_acquire)) {
    polled.clear();
    polled.push_back({answers->wake_up().get(), POLLIN, 0});
    polled.push_back({listener.get(), POLLIN, 0});
    for (const Client& client : connections) {
      const int events = client.asked ? 0 : client.connection.answering() ? POLLOUT : POLLIN;
      polled.push_back({client.connection.fd(), static_cast<short>(events), 0});
    }
    if (::poll(polled.data(), polled.size(), poll_timeout_ms()) < 0 && errno != EINTR) return;
    // From behind, so that the places of the others stay.
    for (std::size_t i = connections.size(); i-- > 0;) {
      if (!go_on(connections[i], polled[i + 2].revents)) {
        std::swap(connections[i], connections.back());
        connections.pop_back();
      }
    }
    hand_out();
    cut_off_late();
    if ((polled[1].revents & POLLIN) != 0) accept_one();
  }
}

void ControlServer::Impl::accept_one() {
  Descriptor socket(::accept4(listener.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (!socket.valid()) {
    if (errno == EMFILE || errno == ENFILE) {
      log_error("ipc.control-descriptors", "no descriptor left for a client of the control socket");
      std::this_thread::sleep_for(std::chrono::milliseconds(100));  // else poll would wake at once again
    }
    return;
  }
  if (connections.size() == kMaxClients) make_room();
  const bool allowed = may_ask(socket.get());
  connections.push_back({ControlConnection(std::move(socket), now() + client_timeout), ++clients, false, {}});
  if (allowed) return;
  refused.fetch_add(1, std::memory_order_relaxed);
  connections.back().connection.answer(
      control_error({"only the gateway's user and root are allowed", "run this as that user"}), now() + client_timeout);
}

bool ControlServer::Impl::go_on(Client& client, short events) {
  if (events == 0) return true;
  ControlConnection& connection = client.connection;
  if (client.asked) {  // it has disconnected
    cut.fetch_add(1, std::memory_order_relaxed);
    return false;
  }
  if (connection.answering()) {
    const Progress progress = connection.write_some();
    if (progress == Progress::finished) return false;
    if (progress == Progress::failed) cut.fetch_add(1, std::memory_order_relaxed);
    return progress == Progress::waiting;
  }
  switch (connection.read_some()) {
    case Progress::waiting:
      return true;
    case Progress::request_complete:
      take_answer(client);
      return true;
    case Progress::too_long:
      refused.fetch_add(1, std::memory_order_relaxed);
      return respond(client,
                     control_error({fmt::format("the request is longer than {} bytes", kMaxControlRequestBytes), ""}));
    default:
      cut.fetch_add(1, std::memory_order_relaxed);
      return false;
  }
}

// Most answers fit the socket's buffer and are gone at once.
bool ControlServer::Impl::respond(Client& client, std::string text) {
  if (text.size() >= kMaxControlReplyBytes)
    text = control_error({fmt::format("the answer is longer than {} bytes", kMaxControlReplyBytes), ""});
  client.asked = false;
  client.connection.answer(std::move(text), now() + client_timeout);
  return client.connection.write_some() == Progress::waiting;
}

void ControlServer::Impl::take_answer(Client& client) {
  client.asked = true;
  client.deadline = now() + kLongestAnswer;
  try {
    handler(client.connection.request(), ControlReply(answers, client.number));
  } catch (const std::exception& error) {  // the released reply has informed the client
    log_error("ipc.control-request", "{}", error.what());
  }
}

// Of a client that was answered twice the first answer counts; one that has gone gets none.
void ControlServer::Impl::hand_out() {
  for (auto& [number, text] : answers->collect()) {
    const auto found = std::ranges::find_if(
        connections, [wanted = number](const Client& client) { return client.number == wanted && client.asked; });
    if (found == connections.end()) continue;
    answered.fetch_add(1, std::memory_order_relaxed);
    if (respond(*found, std::move(text))) continue;
    std::swap(*found, connections.back());
    connections.pop_back();
  }
}

int ControlServer::Impl::poll_timeout_ms() const {
  if (connections.empty()) return -1;
  Timestamp next = connections.front().until();
  for (const Client& client : connections) next = std::min(next, client.until());
  const std::int64_t left_ms = (next - now()).count() / 1'000'000 + 1;
  return static_cast<int>(std::clamp<std::int64_t>(left_ms, 0, 60'000));
}

void ControlServer::Impl::cut_off_late() {
  const Timestamp time = now();
  const auto late = std::remove_if(connections.begin(), connections.end(),
                                   [&](const Client& client) { return client.until() <= time; });
  cut.fetch_add(static_cast<std::uint64_t>(connections.end() - late), std::memory_order_relaxed);
  connections.erase(late, connections.end());
}

// The oldest client is evicted: stalled clients cannot block new ones.
void ControlServer::Impl::make_room() {
  connections.erase(std::min_element(connections.begin(), connections.end(),
                                     [](const auto& a, const auto& b) { return a.until() < b.until(); }));
  cut.fetch_add(1, std::memory_order_relaxed);
}

Result<std::unique_ptr<ControlServer>> ControlServer::start(const std::filesystem::path& path, Handler handler,
                                                            Nanoseconds client_timeout) {
  return start_later(
      path,
      [handler = std::move(handler)](std::string_view request, ControlReply reply) {
        reply(answer_of(handler, request));
      },
      client_timeout);
}

Result<std::unique_ptr<ControlServer>> ControlServer::start_later(const std::filesystem::path& path,
                                                                  LaterHandler handler, Nanoseconds client_timeout) {
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  impl->handler = std::move(handler);
  impl->client_timeout = client_timeout;
  if (const auto listening = impl->listen(); !listening) return std::unexpected(listening.error());
  Impl* server = impl.get();
  try {
    impl->thread = std::thread([server] { server->serve(); });
  } catch (const std::system_error& error) {
    ::unlink(path.c_str());
    return fail(fmt::format("cannot start the thread of the control socket: {}", error.what()),
                "raise the limit of processes");
  }
  return std::unique_ptr<ControlServer>(new ControlServer(std::move(impl)));
}

ControlServer::ControlServer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

ControlServer::~ControlServer() {
  impl_->stopping.store(true, std::memory_order_release);
  impl_->answers->wake();
  impl_->thread.join();
  ::unlink(impl_->path.c_str());
}

ControlServerStatus ControlServer::status() const {
  return {impl_->answered.load(std::memory_order_relaxed), impl_->refused.load(std::memory_order_relaxed),
          impl_->cut.load(std::memory_order_relaxed)};
}

}  // namespace cellmirror
