// What goes wrong beside the owner of the cell refuses a program; it does not end the gateway.
#include "app/owner/programs/program_reader.hpp"

#include <gtest/gtest.h>
#include <pthread.h>

#include <chrono>
#include <new>
#include <stdexcept>
#include <thread>

#include "scripts/programs/languages/languages.hpp"

namespace cellmirror::app {
namespace {

const program::Language& any_language() { return program::languages()[0]; }

ProgramReader::Read await_read(ProgramReader& reader) {
  constexpr std::chrono::seconds kObserverTimeout{60};
  const auto cancel = std::chrono::steady_clock::now() + kObserverTimeout;
  while (std::chrono::steady_clock::now() < cancel) {
    if (auto read = reader.take()) return *std::move(read);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ADD_FAILURE() << "nothing was read";
  return {};
}

TEST(ProgramReader, RefusesAProgramWhoseReadingThrowsAndReadsTheNext) {
  ProgramReader reader([](const program::Language& /*language*/, const std::filesystem::path& path) -> ProgramText {
    if (path == "programs/huge.ird") throw std::bad_alloc();
    return {.program = nullptr, .findings = {}};
  });
  ASSERT_TRUE(reader.read(1, any_language(), "programs/huge.ird"));
  ASSERT_TRUE(reader.read(2, any_language(), "programs/next.ird"));
  const ProgramReader::Read first = await_read(reader);
  EXPECT_EQ(first.id, 1U);
  ASSERT_FALSE(first.text.program);
  EXPECT_NE(first.text.program.error().text().find("programs/huge.ird cannot be read: "), std::string::npos)
      << first.text.program.error().text();
  const ProgramReader::Read second = await_read(reader);
  EXPECT_EQ(second.id, 2U);
  EXPECT_TRUE(second.text.program);
}

// While it lives no thread can be started: its stack would not fit into the address space.
class NoMoreThreads {
 public:
  NoMoreThreads() {
    EXPECT_EQ(pthread_getattr_default_np(&before_), 0);
    pthread_attr_t huge = {};
    EXPECT_EQ(pthread_attr_init(&huge), 0);
    EXPECT_EQ(pthread_attr_setstacksize(&huge, std::size_t{1} << 60), 0);
    EXPECT_EQ(pthread_setattr_default_np(&huge), 0);
    pthread_attr_destroy(&huge);
  }
  ~NoMoreThreads() {
    pthread_setattr_default_np(&before_);
    pthread_attr_destroy(&before_);
  }
  NoMoreThreads(const NoMoreThreads&) = delete;
  NoMoreThreads& operator=(const NoMoreThreads&) = delete;

 private:
  pthread_attr_t before_ = {};
};

TEST(ProgramReader, RefusesWhereTheSystemGivesNoThreadAndReadsWhenItDoes) {
  ProgramReader reader([](const program::Language& /*language*/, const std::filesystem::path& /*path*/) {
    return ProgramText{.program = nullptr, .findings = {}};
  });
  {
    const NoMoreThreads none;
    const auto refused = reader.read(1, any_language(), "programs/a.ird");
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().text().find("cannot be started"), std::string::npos) << refused.error().text();
  }
  ASSERT_TRUE(reader.read(2, any_language(), "programs/b.ird"));
  EXPECT_EQ(await_read(reader).id, 2U);
}

}  // namespace
}  // namespace cellmirror::app
