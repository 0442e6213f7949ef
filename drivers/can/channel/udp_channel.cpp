#include "drivers/can/channel/udp_channel.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <net/if.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <vector>

#include "drivers/can/channel/error_frame.hpp"
#include "drivers/can/channel/socket_channel.hpp"
#include "drivers/can/channel/udp_datagram.hpp"
#include "drivers/can/channel/udp_sender.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::can {
namespace {

constexpr int kUdpReceiveBuffer = 16'000'000;  // bytes: some 20,000 datagrams with the kernel's book-keeping

// An IPv4 or IPv6 address with port.
struct Address {
  sockaddr_storage storage{};
  socklen_t size = 0;

  [[nodiscard]] const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&storage); }
  [[nodiscard]] sockaddr* get() { return reinterpret_cast<sockaddr*>(&storage); }

  [[nodiscard]] static Address of(const UdpEndpoint& endpoint, unsigned interface_index) {
    Address address;
    if (endpoint.ipv6) {
      sockaddr_in6 v6{};
      v6.sin6_family = AF_INET6;
      v6.sin6_port = htons(endpoint.port);
      v6.sin6_scope_id = interface_index;
      inet_pton(AF_INET6, endpoint.group.c_str(), &v6.sin6_addr);
      std::memcpy(&address.storage, &v6, sizeof v6);
      address.size = sizeof v6;
    } else {
      sockaddr_in v4{};
      v4.sin_family = AF_INET;
      v4.sin_port = htons(endpoint.port);
      inet_pton(AF_INET, endpoint.group.c_str(), &v4.sin_addr);
      std::memcpy(&address.storage, &v4, sizeof v4);
      address.size = sizeof v4;
    }
    return address;
  }
};

bool same_sender(const sockaddr_storage& a, const sockaddr_storage& b) {
  if (a.ss_family != b.ss_family) return false;
  if (a.ss_family == AF_INET) {
    sockaddr_in x{};
    sockaddr_in y{};
    std::memcpy(&x, &a, sizeof x);
    std::memcpy(&y, &b, sizeof y);
    return x.sin_port == y.sin_port && x.sin_addr.s_addr == y.sin_addr.s_addr;
  }
  sockaddr_in6 x{};
  sockaddr_in6 y{};
  std::memcpy(&x, &a, sizeof x);
  std::memcpy(&y, &b, sizeof y);
  return x.sin6_port == y.sin6_port && std::memcmp(&x.sin6_addr, &y.sin6_addr, sizeof x.sin6_addr) == 0;
}

// The address alone: 4 bytes, or 16.
using SourceAddress = std::vector<std::uint8_t>;

std::optional<SourceAddress> parse_source(const std::string& text) {
  SourceAddress v4(sizeof(in_addr));
  if (inet_pton(AF_INET, text.c_str(), v4.data()) == 1) return v4;
  SourceAddress v6(sizeof(in6_addr));
  if (inet_pton(AF_INET6, text.c_str(), v6.data()) == 1) return v6;
  return std::nullopt;
}

bool is_from(const sockaddr_storage& sender, const SourceAddress& source) {
  if (sender.ss_family == AF_INET && source.size() == sizeof(in_addr)) {
    sockaddr_in v4{};
    std::memcpy(&v4, &sender, sizeof v4);
    return std::memcmp(&v4.sin_addr, source.data(), source.size()) == 0;
  }
  if (sender.ss_family != AF_INET6 || source.size() != sizeof(in6_addr)) return false;
  sockaddr_in6 v6{};
  std::memcpy(&v6, &sender, sizeof v6);
  return std::memcmp(&v6.sin6_addr, source.data(), source.size()) == 0;
}

std::string text_of(const sockaddr_storage& sender) {
  std::array<char, NI_MAXHOST> text{};
  const int error = getnameinfo(reinterpret_cast<const sockaddr*>(&sender), sizeof sender, text.data(), text.size(),
                                nullptr, 0, NI_NUMERICHOST);
  return error == 0 ? std::string(text.data()) : std::string("an unknown address");
}

std::unexpected<Error> socket_failure(std::string_view what) {
  if (errno == ENETUNREACH) {
    return fail(
        fmt::format("udp channel: {}: {}", what, std::strerror(errno)),
        "the interface has no route for multicast; on the loopback interface use an IPv4 group such as 239.74.163.2");
  }
  return fail(fmt::format("udp channel: {}: {}", what, std::strerror(errno)),
              "check that the interface is up and has an address ('ip address')");
}

class UdpChannel final : public SocketChannel {
 public:
  UdpChannel(UdpEndpoint endpoint, std::string interface, std::vector<SourceAddress> allowed)
      : endpoint_(std::move(endpoint)), interface_(std::move(interface)), allowed_(std::move(allowed)) {}

  [[nodiscard]] Result<void> open_socket() override;
  void send_all(std::span<const CanFrame> frames, std::span<bool> sent) override;

 private:
  [[nodiscard]] bool fill() override;
  void refuse(int error) override { note_refused(fmt::format("send: {}", std::strerror(error))); }
  [[nodiscard]] bool is_current() override;
  [[nodiscard]] Result<Descriptor> open_receiver() const;
  [[nodiscard]] Result<Descriptor> open_sender() const;
  [[nodiscard]] int family() const { return endpoint_.ipv6 ? AF_INET6 : AF_INET; }
  void take(std::span<const std::uint8_t> datagram, bool cut, Timestamp receive_time);
  [[nodiscard]] bool refuses(const sockaddr_storage& sender);

  UdpEndpoint endpoint_;
  std::string interface_;
  std::vector<SourceAddress> allowed_;  // empty: all
  unsigned index_ = 0;
  UdpSender sender_;
  sockaddr_storage own_address_{};
  std::array<UdpDatagram, kSendBatch> datagrams_;  // under way
};

Result<Descriptor> UdpChannel::open_receiver() const {
  Descriptor fd(socket(family(), SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!fd.valid()) return socket_failure("no socket");
  const int on = 1;
  setsockopt(fd.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  setsockopt(fd.get(), SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
  setsockopt(fd.get(), SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on);
  set_receive_buffer(fd.get(), kUdpReceiveBuffer);
  // Bound to the group, not to any address: other groups on the same port stay out.
  const Address address = Address::of(endpoint_, index_);
  if (bind(fd.get(), address.get(), address.size) != 0) return socket_failure("cannot bind to the group");
  int joined = -1;
  if (endpoint_.ipv6) {
    ipv6_mreq request{};
    inet_pton(AF_INET6, endpoint_.group.c_str(), &request.ipv6mr_multiaddr);
    request.ipv6mr_interface = index_;
    joined = setsockopt(fd.get(), IPPROTO_IPV6, IPV6_JOIN_GROUP, &request, sizeof request);
  } else {
    ip_mreqn request{};
    inet_pton(AF_INET, endpoint_.group.c_str(), &request.imr_multiaddr);
    request.imr_ifindex = static_cast<int>(index_);
    joined = setsockopt(fd.get(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &request, sizeof request);
  }
  if (joined != 0) return socket_failure("cannot join the group");
  return fd;
}

Result<Descriptor> UdpChannel::open_sender() const {
  Descriptor fd(socket(family(), SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!fd.valid()) return socket_failure("no socket");
  const int one = 1;
  if (endpoint_.ipv6) {
    setsockopt(fd.get(), IPPROTO_IPV6, IPV6_MULTICAST_HOPS, &one, sizeof one);
    setsockopt(fd.get(), IPPROTO_IPV6, IPV6_MULTICAST_LOOP, &one, sizeof one);
    setsockopt(fd.get(), IPPROTO_IPV6, IPV6_MULTICAST_IF, &index_, sizeof index_);
  } else {
    ip_mreqn request{};
    request.imr_ifindex = static_cast<int>(index_);
    setsockopt(fd.get(), IPPROTO_IP, IP_MULTICAST_TTL, &one, sizeof one);
    setsockopt(fd.get(), IPPROTO_IP, IP_MULTICAST_LOOP, &one, sizeof one);
    setsockopt(fd.get(), IPPROTO_IP, IP_MULTICAST_IF, &request, sizeof request);
  }
  const Address group = Address::of(endpoint_, index_);
  if (connect(fd.get(), group.get(), group.size) != 0) return socket_failure("cannot send to the group");
  return fd;
}

Result<void> UdpChannel::open_socket() {
  status_.waits_for = interface_;  // also if it has no route or no address yet
  index_ = if_nametoindex(interface_.c_str());
  if (index_ == 0) return fail("there is no network interface " + interface_, "name one that 'ip link' shows");
  auto sender = open_sender();
  if (!sender) return std::unexpected(sender.error());
  socklen_t size = sizeof own_address_;
  if (getsockname(sender->get(), reinterpret_cast<sockaddr*>(&own_address_), &size) != 0) {
    return socket_failure("no address of its own");
  }
  auto receiver = open_receiver();
  if (!receiver) return std::unexpected(receiver.error());
  sender_ = UdpSender(std::move(*sender));
  socket_ = std::move(*receiver);
  status_.bus = CanBusState::active;
  status_.waits_for.clear();
  return {};
}

bool UdpChannel::is_current() {
  if (if_nametoindex(interface_.c_str()) == index_) return true;
  go_down("the interface " + interface_ + " was removed");
  return false;
}

bool UdpChannel::fill() {
  std::array<std::array<std::uint8_t, kUdpDatagramCapacity>, kReceiveBatch> data;
  std::array<iovec, kReceiveBatch> buffers;
  std::array<sockaddr_storage, kReceiveBatch> senders;
  std::array<std::array<char, kControlCapacity>, kReceiveBatch> control;
  std::array<mmsghdr, kReceiveBatch> messages{};
  for (std::size_t i = 0; i < kReceiveBatch; ++i) {
    buffers[i] = {data[i].data(), data[i].size()};
    messages[i].msg_hdr.msg_name = &senders[i];
    messages[i].msg_hdr.msg_namelen = sizeof senders[i];
    messages[i].msg_hdr.msg_iov = &buffers[i];
    messages[i].msg_hdr.msg_iovlen = 1;
    messages[i].msg_hdr.msg_control = control[i].data();
    messages[i].msg_hdr.msg_controllen = control[i].size();
  }
  const int count = recvmmsg(socket_.get(), messages.data(), kReceiveBatch, MSG_DONTWAIT, nullptr);
  if (count < 0) {
    if (errno == EAGAIN || errno == EINTR) return true;
    go_down(fmt::format("{}: {}", interface_, std::strerror(errno)));
    return false;
  }
  const ClockPair clocks = ClockPair::read();
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Ancillary ancillary = Ancillary::of(messages[k].msg_hdr);
    note_dropped(ancillary);
    if (same_sender(senders[k], own_address_) || refuses(senders[k])) continue;
    const bool cut = (messages[k].msg_hdr.msg_flags & MSG_TRUNC) != 0;
    take(std::span(data[k]).first(messages[k].msg_len), cut, clocks.monotonic(ancillary.stamp_real_ns));
  }
  return true;
}

bool UdpChannel::refuses(const sockaddr_storage& sender) {
  const bool allowed =
      allowed_.empty() || std::ranges::any_of(allowed_, [&](const auto& source) { return is_from(sender, source); });
  if (allowed) return false;
  // The text is formatted at the first of a row only: a stranger may send a lot.
  if (status_.foreign++ % 1000 == 0)
    status_.last_error = fmt::format("datagram from {} refused: allow_from does not name it", text_of(sender));
  return true;
}

void UdpChannel::take(std::span<const std::uint8_t> datagram, bool cut, Timestamp receive_time) {
  const auto frame = decode_udp_datagram(datagram);
  if (cut || !frame) {
    ++status_.malformed;
    status_.last_error = fmt::format("datagram refused: {}", cut ? "too long" : frame.error());
    return;
  }
  if (frame->error) {
    ++status_.error_frames;
    status_.last_error = error_words(*frame);
    if (const auto bus = bus_state_of_error(*frame)) status_.bus = *bus;
  } else {
    ++status_.received;
    // A frame proves that the bus is not off.
    if (status_.bus == CanBusState::bus_off) status_.bus = CanBusState::active;
  }
  put(*frame, receive_time);
}

void UdpChannel::send_all(std::span<const CanFrame> frames, std::span<bool> sent) {
  std::array<iovec, kSendBatch> buffers;
  std::array<int, kSendBatch> errors;
  const double now_s = 1e-9 * static_cast<double>(ClockPair::read().real_ns);
  for (std::size_t done = 0; done < frames.size();) {
    const std::size_t count = std::min(frames.size() - done, kSendBatch);
    for (std::size_t i = 0; i < count; ++i) {
      datagrams_[i] = encode_udp_datagram(frames[done + i], now_s);
      buffers[i] = {datagrams_[i].bytes.data(), datagrams_[i].size};
    }
    sender_.send(std::span(buffers).first(count), std::span(errors).first(count));
    count_sent(std::span(errors).first(count), sent.subspan(done, count));
    done += count;
  }
}

}  // namespace

Result<std::unique_ptr<CanChannel>> open_udp_channel(const UdpEndpoint& endpoint, const std::string& interface,
                                                     const std::vector<std::string>& allow_from, bool waits) {
  std::vector<SourceAddress> allowed;
  for (const std::string& text : allow_from) {
    auto source = parse_source(text);
    if (!source) return fail(fmt::format("allow_from: {} is no numeric address", printable(text)));
    allowed.push_back(std::move(*source));
  }
  auto channel = std::make_unique<UdpChannel>(endpoint, interface, std::move(allowed));
  if (const auto opened = waits ? channel->open_or_wait() : channel->open_socket(); !opened)
    return std::unexpected(opened.error());
  return channel;
}

}  // namespace cellmirror::can
