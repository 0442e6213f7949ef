#include "ipc/service_manager/notifier.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "ipc/service_manager/service_watchdog.hpp"

namespace cellmirror {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// The service manager's end.
class Manager {
 public:
  explicit Manager(const std::string& name) : name_(name), socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    const auto address = notify_address(name);
    EXPECT_TRUE(address) << address.error().text();
    const auto* where = reinterpret_cast<const sockaddr*>(&address->address);
    EXPECT_EQ(bind(socket_.get(), where, address->length), 0) << name;
    setenv("NOTIFY_SOCKET", name.c_str(), 1);
  }
  ~Manager() {
    unsetenv("NOTIFY_SOCKET");
    unsetenv("WATCHDOG_USEC");
    unsetenv("WATCHDOG_PID");
    if (name_.starts_with('/')) std::filesystem::remove(name_);
  }
  Manager(const Manager&) = delete;
  Manager& operator=(const Manager&) = delete;

  // The next datagram; empty where none comes in time.
  [[nodiscard]] std::string next(milliseconds limit) const {
    pollfd waited{socket_.get(), POLLIN, 0};
    if (poll(&waited, 1, static_cast<int>(limit.count())) <= 0) return {};
    std::array<char, 1024> bytes{};
    const ssize_t length = recv(socket_.get(), bytes.data(), bytes.size(), 0);
    return {bytes.data(), static_cast<std::size_t>(length < 0 ? 0 : length)};
  }

 private:
  std::string name_;
  Descriptor socket_;
};

std::string path_name() { return (std::filesystem::temp_directory_path() / std::to_string(getpid())).string() + ".n"; }
std::string abstract_name() { return "@cellmirror-test-" + std::to_string(getpid()); }

TEST(Notifier, SendsToAPathAndToAnAbstractName) {
  for (const std::string& name : {path_name(), abstract_name()}) {
    const Manager manager(name);
    const auto sut = ServiceNotifier::take_from_environment();
    ASSERT_TRUE(sut) << name;
    ASSERT_TRUE(sut->send("READY=1\nSTATUS=runs"));
    EXPECT_EQ(manager.next(seconds(5)), "READY=1\nSTATUS=runs") << name;
    EXPECT_EQ(std::getenv("NOTIFY_SOCKET"), nullptr) << "a child process would speak for this one";
    EXPECT_FALSE(sut->timeout()) << "nobody watches";
  }
}

TEST(Notifier, IsSilentOnATerminal) {
  unsetenv("NOTIFY_SOCKET");
  setenv("WATCHDOG_USEC", "1000", 1);
  const auto sut = ServiceNotifier::take_from_environment();
  ASSERT_TRUE(sut);
  EXPECT_FALSE(sut->connected());
  EXPECT_TRUE(sut->send("READY=1"));
  EXPECT_FALSE(sut->timeout());
  EXPECT_EQ(std::getenv("WATCHDOG_USEC"), nullptr);
}

TEST(Notifier, TellsThatNobodyListens) {
  setenv("NOTIFY_SOCKET", abstract_name().c_str(), 1);
  const auto sut = ServiceNotifier::take_from_environment();
  ASSERT_TRUE(sut);
  const auto sent = sut->send("READY=1");
  ASSERT_FALSE(sent);
  EXPECT_NE(sent.error().text().find("refused"), std::string::npos) << sent.error().text();
}

TEST(Notifier, RefusesWhatIsNoAddress) {
  constexpr std::size_t kPath = sizeof(sockaddr_un::sun_path);
  const std::string path = "/" + std::string(kPath - 2, 'x');
  EXPECT_TRUE(notify_address(path));
  EXPECT_FALSE(notify_address(path + "x")) << "no room for the NUL byte";
  EXPECT_TRUE(notify_address("@" + std::string(kPath - 1, 'x')));
  EXPECT_FALSE(notify_address("@" + std::string(kPath, 'x')));
  for (const char* text : {"", "@", "/", "run/notify", "vsock:2:1234"}) EXPECT_FALSE(notify_address(text)) << text;
  const auto address = notify_address("@ab");
  ASSERT_TRUE(address);
  EXPECT_EQ(address->address.sun_path[0], '\0');
  EXPECT_EQ(address->length, offsetof(sockaddr_un, sun_path) + 3) << "bytes after the name would belong to it";
}

TEST(Notifier, WatchesOnlyTheProcessThatIsMeant) {
  EXPECT_EQ(watchdog_timeout("2000000", nullptr, 7), seconds(2));
  EXPECT_EQ(watchdog_timeout("2000000", "7", 7), seconds(2));
  EXPECT_FALSE(watchdog_timeout("2000000", "8", 7));
  EXPECT_FALSE(watchdog_timeout(nullptr, "7", 7));
  for (const char* text : {"", "0", "-5", "1e3", "2000000 ", "99999999999999999999"})
    EXPECT_FALSE(watchdog_timeout(text, nullptr, 7)) << text;
}

TEST(Notifier, AStatusIsOneLine) { EXPECT_EQ(status_line("a\nREADY=1"), "STATUS=a READY=1"); }

TEST(ProgressOfACounter, IsAChangeSinceTheLastLook) {
  Progress sut;
  EXPECT_FALSE(sut.look(0));
  EXPECT_TRUE(sut.look(3));
  EXPECT_FALSE(sut.look(3));
  EXPECT_TRUE(sut.look(1)) << "a counter that began anew has moved";
}

TEST(ServiceWatchdogThread, SendsWhileTheCounterMovesAndNoLonger) {
  const Manager manager(abstract_name());
  setenv("WATCHDOG_USEC", "20000", 1);
  const auto notifier = ServiceNotifier::take_from_environment();
  ASSERT_TRUE(notifier);
  ASSERT_EQ(notifier->timeout(), milliseconds(20));
  std::atomic<std::uint64_t> looks{0};
  constexpr std::uint64_t kMoves = 3;  // then the loop stands still
  {
    const ServiceWatchdog sut(*notifier, [&] { return std::min(++looks, kMoves); });
    for (std::uint64_t i = 0; i < kMoves; ++i) EXPECT_EQ(manager.next(seconds(10)), "WATCHDOG=1") << i;
    while (looks < kMoves + 3) usleep(1000);
  }
  EXPECT_EQ(manager.next(milliseconds(0)), "") << "the loop stood still";
}

TEST(ServiceWatchdogThread, RunsOnlyWhereSomebodyWatches) {
  const Manager manager(abstract_name());
  const auto notifier = ServiceNotifier::take_from_environment();
  ASSERT_TRUE(notifier);
  const ServiceWatchdog sut(*notifier, [] {
    ADD_FAILURE() << "nobody asked";
    return std::uint64_t{0};
  });
  EXPECT_EQ(manager.next(milliseconds(20)), "");
}

}  // namespace
}  // namespace cellmirror
