#include "rt_core/base/journal.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <iterator>
#include <string>

namespace cellmirror {
namespace {

using namespace std::string_literals;

TEST(Journal, AnEntryHasAFieldForEachThing) {
  EXPECT_EQ(journal_text({4, "can.bus-off PUMA_762", "no answer", 0}),
            "SYSLOG_IDENTIFIER=cellmirror\nPRIORITY=4\nCELLMIRROR_KIND=can.bus-off\nCELLMIRROR_SUBJECT=PUMA_762\n"
            "MESSAGE=[can.bus-off PUMA_762] no answer\n");
  EXPECT_EQ(journal_text({3, "web", "x", 7}),
            "SYSLOG_IDENTIFIER=cellmirror\nPRIORITY=3\nCELLMIRROR_KIND=web\nCELLMIRROR_SWALLOWED=7\nMESSAGE=[web] x\n");
}

TEST(Journal, LinesInATextAddNoFields) {
  const std::string text = journal_text({4, "cell", "a\nPRIORITY=0", 0});
  EXPECT_TRUE(text.ends_with("MESSAGE\n\x13\0\0\0\0\0\0\0[cell] a\nPRIORITY=0\n"s)) << text;
}

TEST(Journal, ItIsStandardErrorOnlyIfThatIsTheSameFile) {
  struct stat info{};
  ASSERT_EQ(fstat(STDERR_FILENO, &info), 0);
  const std::string same = std::to_string(info.st_dev) + ":" + std::to_string(info.st_ino);
  EXPECT_TRUE(standard_error_is_journal(same.c_str()));
  EXPECT_FALSE(standard_error_is_journal((same + "0").c_str())) << "redirected since";
  EXPECT_FALSE(standard_error_is_journal(nullptr));
}

TEST(Journal, SendsADatagramAndTellsWhenNobodyTakesIt) {
  const std::string path =
      (std::filesystem::temp_directory_path() / ("cellmirror-journal-" + std::to_string(getpid()))).string();
  const Journal sut(path);
  EXPECT_FALSE(sut.send({4, "web", "x", 0})) << "there is no socket";
  const Descriptor socket(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(std::begin(address.sun_path), sizeof address.sun_path - 1);
  ASSERT_EQ(bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_TRUE(sut.send({4, "web", "x", 0}));
  std::array<char, 256> bytes{};
  const ssize_t length = recv(socket.get(), bytes.data(), bytes.size(), 0);
  EXPECT_EQ(std::string(bytes.data(), static_cast<std::size_t>(length)), journal_text({4, "web", "x", 0}));
  std::filesystem::remove(path);
  EXPECT_FALSE(Journal("").send({4, "web", "x", 0})) << "on a terminal";
}

}  // namespace
}  // namespace cellmirror
