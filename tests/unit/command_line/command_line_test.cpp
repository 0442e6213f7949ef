#include "config/command_line/command_line.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace cellmirror::cli {
namespace {

using testing::HasSubstr;

struct Words : testing::Test {
  Words() {
    program.require_subcommand();
    Command status = program.subcommand("status", "s");
    status.flag("--json", json, "j");
    status.option("--instance", instance, "i");
    Command volume = program.subcommand("volume", "v");
    volume.require_subcommand();
    volume.subcommand("info", "i").option("file", instance, "f");
    program.subcommand("place", "p").option("--xyz", xyz, "x").values(3);
  }
  // What is said of wrong words.
  std::string said(std::vector<const char*> words) {
    words.insert(words.begin(), "cellmirror");
    testing::internal::CaptureStderr();
    const auto status = program.parse(static_cast<int>(words.size()), words.data());
    const std::string text = testing::internal::GetCapturedStderr();
    EXPECT_EQ(status, kExitWrongUsage) << text;
    return text;
  }
  CommandLine program{"A program", "cellmirror"};
  bool json = false;
  std::string instance;
  std::vector<double> xyz;
};

TEST_F(Words, AnUnknownSubcommandIsToldTheNearest) {
  EXPECT_EQ(said({"stauts"}),
            "cellmirror has no subcommand stauts; did you mean status?\nRun with --help for more information.\n");
  EXPECT_THAT(said({"volume", "inf"}), HasSubstr("cellmirror volume has no subcommand inf; did you mean info?"));
  EXPECT_THAT(said({"volume", "inf", "x.nrrd"}), HasSubstr("did you mean info?"));
}

TEST_F(Words, OneThatIsNearNothingIsToldAll) {
  EXPECT_THAT(said({"xyzzy"}), HasSubstr("has no subcommand xyzzy; there are place, status, volume"));
  EXPECT_THAT(said({"\x1b[2J"}), HasSubstr("\\x1b")) << "no escape sequence reaches a terminal";
}

TEST_F(Words, AnUnknownOptionIsToldTheNearest) {
  EXPECT_THAT(said({"status", "--jsno"}), HasSubstr("cellmirror status has no option --jsno; did you mean --json?"));
  EXPECT_THAT(said({"status", "--instanc=a"}), HasSubstr("no option --instanc; did you mean --instance?"));
  EXPECT_THAT(said({"status", "--quux"}), HasSubstr("--quux")) << "as CLI11 says it";
}

TEST_F(Words, WithoutAnyOneIsAskedFor) { EXPECT_THAT(said({}), HasSubstr("subcommand is required")); }

TEST_F(Words, AnOptionWithANumberOfValuesTakesNoneMore) {
  const char* words[] = {"cellmirror", "place", "--xyz", "1", "-2", "0.5"};
  EXPECT_EQ(program.parse(6, words), std::nullopt);
  EXPECT_EQ(xyz, (std::vector<double>{1, -2, 0.5}));
}

}  // namespace
}  // namespace cellmirror::cli
