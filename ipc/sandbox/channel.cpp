#include "ipc/sandbox/channel.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <fcntl.h>
#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <new>
#include <utility>

#include "rt_core/base/contract.hpp"

namespace cellmirror {

namespace {

constexpr std::uint64_t kMagic = 0x31'6c'6e'6e'68'63'6d'63;  // "cmchnnl1"
constexpr std::size_t kHeaderBytes = 256;
constexpr std::byte kWake{1};

std::unexpected<Error> no_channel(const char* what) {
  return fail(fmt::format("no connection to a confined process: {}: {}", what, std::strerror(errno)));
}

std::size_t total_bytes(const ChannelConfig& config) {
  return kHeaderBytes + shared_ring_bytes(config.to_child_bytes) + shared_ring_bytes(config.to_owner_bytes);
}

SharedMapping map(int memory, std::size_t size) {
  void* start = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, memory, 0);
  return start == MAP_FAILED ? SharedMapping() : SharedMapping(static_cast<std::byte*>(start), size);
}

}  // namespace

// The owner writes the first four before the child starts and does not read them again; the child writes the others.
struct Channel::Header {
  std::uint64_t magic = kMagic;
  std::uint64_t longest = 0;
  std::uint64_t to_child = 0;
  std::uint64_t to_owner = 0;
  alignas(SharedRingHeader::kLine) std::atomic<std::uint64_t> beats{0};
  std::atomic<bool> confined_calls{false};
  std::atomic<bool> confined_files{false};
};

SharedMapping::~SharedMapping() {
  if (start_ != nullptr) munmap(start_, size_);
}

SharedMapping::SharedMapping(SharedMapping&& other) noexcept
    : start_(std::exchange(other.start_, nullptr)), size_(std::exchange(other.size_, 0)) {}

SharedMapping& SharedMapping::operator=(SharedMapping&& other) noexcept {
  std::swap(start_, other.start_);
  std::swap(size_, other.size_);
  return *this;
}

Channel::Channel(Descriptor socket, SharedMapping mapping, std::size_t longest, std::span<std::byte> out,
                 std::span<std::byte> in)
    : socket_(std::move(socket)), mapping_(std::move(mapping)), longest_(longest), out_(out), in_(in) {}

Channel::Header& Channel::header() const { return *reinterpret_cast<Header*>(mapping_.bytes().data()); }

Channel Channel::on(Descriptor socket, SharedMapping mapping, bool owner) {
  static_assert(sizeof(Header) <= kHeaderBytes && kHeaderBytes % SharedRingHeader::kLine == 0);
  const Header& header = *reinterpret_cast<Header*>(mapping.bytes().data());
  const auto longest = static_cast<std::size_t>(header.longest);
  const std::size_t child_ring = shared_ring_bytes(static_cast<std::size_t>(header.to_child));
  const std::size_t owner_ring = shared_ring_bytes(static_cast<std::size_t>(header.to_owner));
  const std::span<std::byte> to_child = mapping.bytes().subspan(kHeaderBytes, child_ring);
  const std::span<std::byte> to_owner = mapping.bytes().subspan(kHeaderBytes + child_ring, owner_ring);
  return {std::move(socket), std::move(mapping), longest, owner ? to_child : to_owner, owner ? to_owner : to_child};
}

Result<Channel::Ends> Channel::make(const ChannelConfig& config) {
  CELLMIRROR_EXPECTS(std::has_single_bit(config.to_child_bytes) && std::has_single_bit(config.to_owner_bytes));
  CELLMIRROR_EXPECTS(shared_ring::occupied(config.longest_message) <=
                     std::min(config.to_child_bytes, config.to_owner_bytes));
  std::array<int, 2> sockets{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets.data()) != 0) return no_channel("socketpair");
  Descriptor own(sockets[0]);
  Descriptor theirs(sockets[1]);
  Descriptor memory(memfd_create("cellmirror-channel", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!memory.valid()) return no_channel("memfd_create");
  const std::size_t size = total_bytes(config);
  if (ftruncate(memory.get(), static_cast<off_t>(size)) != 0) return no_channel("ftruncate");
  // If the child could shorten the memory, an access of the owner would raise SIGBUS.
  if (fcntl(memory.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0) return no_channel("fcntl");
  SharedMapping mapping = map(memory.get(), size);
  if (mapping.bytes().empty()) return no_channel("mmap");
  auto* header = new (mapping.bytes().data()) Header;
  header->longest = config.longest_message;
  header->to_child = config.to_child_bytes;
  header->to_owner = config.to_owner_bytes;
  return Ends{on(std::move(own), std::move(mapping), true), std::move(theirs), std::move(memory)};
}

Result<Channel> Channel::attach() {
  struct stat state{};
  if (fstat(kChildMemory, &state) != 0) return no_channel("it was not started by cellmirror");
  const auto size = static_cast<std::size_t>(std::max<off_t>(state.st_size, 0));
  if (size < kHeaderBytes) return fail("no connection to cellmirror: the memory is too short");
  SharedMapping mapping = map(kChildMemory, size);
  close(kChildMemory);
  if (mapping.bytes().empty()) return no_channel("mmap");
  const Header& header = *reinterpret_cast<Header*>(mapping.bytes().data());
  const ChannelConfig config{static_cast<std::size_t>(header.to_child), static_cast<std::size_t>(header.to_owner),
                             static_cast<std::size_t>(header.longest)};
  if (header.magic != kMagic || !std::has_single_bit(config.to_child_bytes) ||
      !std::has_single_bit(config.to_owner_bytes) || total_bytes(config) != size)
    return fail("no connection to cellmirror: it is of another version", "install both from one package");
  return on(Descriptor(kChildSocket), std::move(mapping), false);
}

bool Channel::send(std::span<const std::byte> head, std::span<const std::byte> body) {
  if (head.size() + body.size() > longest_) return false;
  const std::scoped_lock lock(shared_->send_mutex);
  const RingResult result = out_.write(head, body);
  if (result == RingResult::damaged) shared_->damaged.store(true, std::memory_order_relaxed);
  if (result != RingResult::done) return false;
  // If the socket is full, the other side has been woken already.
  if (out_.reader_sleeps()) ::send(socket_.get(), &kWake, 1, MSG_DONTWAIT | MSG_NOSIGNAL);
  return true;
}

RingResult Channel::receive(std::vector<std::byte>& out) {
  const RingResult result = in_.read(out, longest_);
  if (result == RingResult::damaged) shared_->damaged.store(true, std::memory_order_relaxed);
  return result;
}

void Channel::drain_wakes() {
  std::array<std::byte, 4096> bytes;
  const ssize_t count = recv(socket_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR)) ended_ = true;
  if (count > 0) wakes_ = static_cast<std::size_t>(count);
}

void Channel::wait(Nanoseconds timeout, std::span<pollfd> also) {
  CELLMIRROR_EXPECTS(also.size() <= kMostAlso);
  wakes_ = 0;
  for (pollfd& other : also) other.revents = 0;
  if (!in_.prepare_to_sleep()) return;
  std::array<pollfd, kMostAlso + 1> waited{pollfd{socket_.get(), POLLIN, 0}};
  std::ranges::copy(also, waited.begin() + 1);
  const std::int64_t ns = std::max<std::int64_t>(0, timeout.count());
  const timespec limit{ns / 1'000'000'000, ns % 1'000'000'000};
  if (ppoll(waited.data(), also.size() + 1, &limit, nullptr) > 0 && waited[0].revents != 0) drain_wakes();
  for (std::size_t i = 0; i < also.size(); ++i) also[i].revents = waited[i + 1].revents;
  in_.awake();
}

void Channel::set_confinement(const ConfinementOutcome& outcome) {
  header().confined_calls.store(outcome.system_calls, std::memory_order_relaxed);
  header().confined_files.store(outcome.files, std::memory_order_relaxed);
}

ConfinementOutcome Channel::confinement() const {
  return {header().confined_calls.load(std::memory_order_relaxed),
          header().confined_files.load(std::memory_order_relaxed)};
}

void Channel::beat() { header().beats.fetch_add(1, std::memory_order_relaxed); }

std::uint64_t Channel::beats() const { return header().beats.load(std::memory_order_relaxed); }

}  // namespace cellmirror
