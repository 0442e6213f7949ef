// A confined program for tests: the first message says what it does.
#include <arpa/inet.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/sandbox/channel.hpp"
#include "ipc/sandbox/confinement.hpp"

namespace cellmirror {
namespace {

void answer(Channel& channel, const std::string& text) {
  static_cast<void>(channel.send(std::as_bytes(std::span(text))));
}

std::string outcome(bool worked) { return worked ? "worked" : std::strerror(errno); }

int tcp_socket_connects() {
  const int tcp = socket(AF_INET, SOCK_STREAM, 0);
  if (tcp < 0) return -1;
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(1);
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return connect(tcp, reinterpret_cast<sockaddr*>(&to), sizeof to);
}

// Attempts of a process that an attacker controls.
std::string attempt(std::string_view what) {
  if (what == "write a file") return outcome(open("/tmp/cellmirror-sandbox-probe", O_WRONLY | O_CREAT, 0600) >= 0);
  if (what == "read a file") return outcome(open("/etc/hostname", O_RDONLY) >= 0 || open("/etc/group", O_RDONLY) >= 0);
  if (what == "read a system file") return outcome(open("/etc/hosts", O_RDONLY) >= 0);
  if (what == "start a process") {
    const pid_t child = fork();
    if (child == 0) _exit(0);
    return outcome(child > 0);
  }
  if (what == "start a program") return outcome(execl("/bin/true", "true", nullptr) == 0);
  if (what == "signal its parent") return outcome(kill(getppid(), 0) == 0);
  if (what == "connect by TCP") return outcome(tcp_socket_connects() == 0);
  if (what == "trace its parent")
    return outcome(open(("/proc/" + std::to_string(getppid()) + "/mem").c_str(), O_RDWR) >= 0);
  if (what == "send a datagram") return outcome(socket(AF_INET, SOCK_DGRAM, 0) >= 0);
  if (what == "make a raw socket") return outcome(socket(AF_PACKET, SOCK_RAW, 0) >= 0);
  return "unknown";
}

// The rings, found as an attacker would find them: in the mapping.
std::byte* shared_memory(std::size_t& size) {
  struct stat state{};
  if (fstat(kChildMemory, &state) != 0) return nullptr;
  size = static_cast<std::size_t>(state.st_size);
  void* start = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, kChildMemory, 0);
  return start == MAP_FAILED ? nullptr : static_cast<std::byte*>(start);
}

void misbehave(std::string_view how, Channel& channel, std::byte* memory, std::size_t size) {
  if (how == "abort") std::abort();
  if (how == "exit") _exit(3);
  if (how == "hang") {
    constexpr timespec kLong{1, 0};
    while (true) nanosleep(&kLong, nullptr);
  }
  if (how == "stop") raise(SIGSTOP);
  if (how == "damage") std::memset(memory + 256, 0xff, size - 256);
  if (how == "truncate") {
    if (ftruncate(kChildMemory, 0) != 0) answer(channel, std::string("truncate: ") + std::strerror(errno));
  }
  if (how == "eat memory") {
    while (true) {
      constexpr std::size_t kPart = 4U << 20U;
      auto* part = new char[kPart];
      std::memset(part, 1, kPart);
    }
  }
  if (how == "flood") {
    for (; true; channel.beat()) static_cast<void>(channel.send(std::as_bytes(std::span("x"))));
  }
  if (how == "compute") {
    while (true) channel.beat();
  }
  if (how == "wake") {
    const char one = 1;
    for (; true; channel.beat()) static_cast<void>(send(kChildSocket, &one, 1, MSG_DONTWAIT | MSG_NOSIGNAL));
  }
  if (how == "close") {
    close(kChildSocket);
    constexpr timespec kLong{1, 0};
    while (true) nanosleep(&kLong, nullptr);
  }
}

int run() {
  std::size_t size = 0;
  std::byte* const memory = shared_memory(size);
  // Channel::attach() closes the memory's descriptor; "truncate" needs it.
  const int kept = dup(kChildMemory);
  auto channel = Channel::attach();
  if (!channel || memory == nullptr) return 2;
  dup2(kept, kChildMemory);
  close(kept);
  channel->set_confinement(confine_to_network({.address_space_bytes = 256ULL << 20U}));
  std::vector<std::byte> message;
  while (!channel->ended()) {
    while (channel->receive(message) == RingResult::done) {
      const std::string_view text(reinterpret_cast<const char*>(message.data()), message.size());
      if (text.starts_with("try ")) {
        answer(*channel, attempt(text.substr(4)));
      } else if (text == "forbid opening") {
        forbid_opening_files();
        answer(*channel, "done");
      } else if (text == "never read") {
        while (true) {
          channel->beat();
          constexpr timespec kPause{0, 10'000'000};
          nanosleep(&kPause, nullptr);
        }
      } else if (text == "echo") {
        answer(*channel, "echo");
      } else {
        misbehave(text, *channel, memory, size);
      }
    }
    channel->beat();
    channel->wait(Nanoseconds(20'000'000));
  }
  return 0;
}

}  // namespace
}  // namespace cellmirror

int main() { _exit(cellmirror::run()); }
