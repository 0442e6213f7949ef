// What the gateway does with a reader that does not answer as it should: programs of the test in its place.
#include "config/volume/volume_process.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "ipc/sandbox/child_process.hpp"
#include "tests/unit/config/temporary_home.hpp"

namespace cellmirror {
namespace {

class ReaderOfSlices : public testing::Test {
 protected:
  VolumeProcess with_script(const std::string& script) {
    const auto path = home_.write("reader" + std::to_string(++scripts_), "#!/bin/sh\n" + script);
    chmod(path.c_str(), 0700);
    return VolumeProcess({path, std::chrono::seconds(5)});
  }
  TemporaryHome home_;
  int scripts_ = 0;
};

TEST_F(ReaderOfSlices, ThatIsMissingIsReportedWithItsName) {
  const VolumeReader reader{home_.root() / "none"};
  EXPECT_FALSE(check_program(reader.program));
  const auto sut = VolumeProcess(reader).head("x", true);
  ASSERT_FALSE(sut);
  EXPECT_NE(sut.error().what.find("none cannot be started"), std::string::npos) << sut.error().what;
}

TEST_F(ReaderOfSlices, ThatEndsIsTheFaultOfTheFile) {
  EXPECT_NE(with_script("kill -SEGV $$").head("x", true).error().what.find("signal 11 (SIGSEGV)"), std::string::npos);
  EXPECT_NE(with_script("exit 3").head("x", true).error().what.find("its reader ended"), std::string::npos);
}

TEST_F(ReaderOfSlices, ThatAnswersNonsenseIsNotBelieved) {
  // A frame says: kind, 4 bytes of nothing, length.
  const char* const kKind9 =
      "head -c 17 >/dev/null; printf '\\011\\0\\0\\0\\0\\0\\0\\0\\1\\0\\0\\0\\0\\0\\0\\0x'; sleep 9";
  EXPECT_NE(with_script(kKind9).head("x", true).error().what.find("answer is damaged"), std::string::npos);
  const char* const kHuge =
      "head -c 17 >/dev/null; printf '\\001\\0\\0\\0\\0\\0\\0\\0\\0\\0\\0\\0\\0\\0\\0\\100x'; sleep 9";
  EXPECT_NE(with_script(kHuge).head("x", true).error().what.find("answer is damaged"), std::string::npos);
  const char* const kPixels =
      "head -c 17 >/dev/null; printf '\\004\\0\\0\\0\\0\\0\\0\\0\\024\\0\\0\\0\\0\\0\\0\\0"
      "\\3\\0\\0\\0\\2\\0\\0\\0\\1\\0\\0\\0\\0\\0\\0\\0abcd'; sleep 9";
  std::array<std::byte, 4> to{};
  const auto other_size = with_script(kPixels).pixels("x", 2, 2, SliceValues::u8, to);
  ASSERT_FALSE(other_size);
  EXPECT_NE(other_size.error().what.find("another size or type"), std::string::npos) << other_size.error().what;
}

TEST_F(ReaderOfSlices, ThatDoesNotAnswerIsEnded) {
  const auto path = home_.write("reader", "#!/bin/sh\nsleep 60\n");
  chmod(path.c_str(), 0700);
  const auto sut = VolumeProcess({path, std::chrono::milliseconds(200)}).head("x", true);
  ASSERT_FALSE(sut);
  EXPECT_NE(sut.error().what.find("took more than 0.2 s"), std::string::npos) << sut.error().what;
}

}  // namespace
}  // namespace cellmirror
