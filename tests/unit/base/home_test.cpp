#include "rt_core/base/home.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace cellmirror {
namespace {

namespace fs = std::filesystem;

class Home : public testing::Test {
 protected:
  Home() : root_(fs::temp_directory_path() / ("cellmirror-home-" + std::to_string(getpid()))) {
    fs::create_directories(root_ / "cell" / "scripts");
    write("cell/scripts/a.spt", "A");
    write("outside.spt", "secret");
  }
  ~Home() override { fs::remove_all(root_); }

  void write(const std::string& name, const std::string& text) const { std::ofstream(root_ / name) << text; }
  [[nodiscard]] KismetHome sut() const { return *KismetHome::open(root_ / "cell"); }
  // What the refusal says; empty where it was none.
  [[nodiscard]] std::string refusal(const std::string& name) const {
    const auto file = sut().file("scripts", name, ".spt");
    return file ? std::string() : file.error().text();
  }

  fs::path root_;
};

TEST_F(Home, FindsAFileWithAndWithoutItsExtension) {
  EXPECT_EQ(sut().file("scripts", "a.spt", ".spt")->filename(), "a.spt");
  EXPECT_EQ(sut().file("scripts", "a", ".spt")->filename(), "a.spt");
}

TEST_F(Home, RefusesEveryWayOut) {
  EXPECT_NE(refusal("../../outside.spt").find("leaves the cell folder"), std::string::npos);
  EXPECT_NE(refusal((root_ / "outside.spt").string()).find("absolute"), std::string::npos);
  fs::create_symlink(root_ / "outside.spt", root_ / "cell/scripts/link.spt");
  EXPECT_NE(refusal("link.spt").find("leaves the cell folder"), std::string::npos);
  fs::create_directory_symlink(root_, root_ / "cell/scripts/up");
  EXPECT_NE(refusal("up/outside.spt").find("leaves the cell folder"), std::string::npos);
}

TEST_F(Home, ALinkThatStaysInsideIsFine) {
  fs::create_symlink(root_ / "cell/scripts/a.spt", root_ / "cell/scripts/b.spt");
  EXPECT_EQ(refusal("b.spt"), "");
}

TEST_F(Home, RefusesWhatIsNoReadableFile) {
  fs::create_directory(root_ / "cell/scripts/folder.spt");
  ASSERT_EQ(mkfifo((root_ / "cell/scripts/pipe.spt").c_str(), 0600), 0);
  EXPECT_NE(refusal("folder.spt").find("is a folder"), std::string::npos);
  EXPECT_NE(refusal("pipe.spt").find("not a regular file"), std::string::npos);
  EXPECT_NE(refusal("missing.spt").find("does not exist"), std::string::npos);
  EXPECT_NE(refusal("").find("empty"), std::string::npos);
  EXPECT_NE(refusal(std::string("a\0b", 3)).find("NUL"), std::string::npos);
  EXPECT_NE(refusal(std::string(5000, 'x')).find("too long"), std::string::npos);
}

TEST_F(Home, TellsTheFileThatItLookedForAndWhichAreNear) {
  for (const char* name : {"trs_demo.spt", "trs_demo.vws", "view1.vws"})
    write("cell/scripts/" + std::string(name), "A");
  fs::create_directories(root_ / "cell/scripts/trs_dame.spt");
  write("cell/scripts/more.spt", "A");
  EXPECT_NE(refusal("trs_dem").find("the file scripts/trs_dem.spt does not exist"), std::string::npos);
  EXPECT_NE(refusal("trs_dem").find("did you mean trs_demo?"), std::string::npos) << refusal("trs_dem");
  EXPECT_NE(refusal("trs_dem.spt").find("did you mean trs_demo.spt?"), std::string::npos) << refusal("trs_dem.spt");
  EXPECT_EQ(refusal("nothing_like_it").find("did you mean"), std::string::npos);
  const auto views = sut().file("scripts", "view1.VWS", ".vws");
  ASSERT_FALSE(views);
  EXPECT_EQ(views.error().remedy, "did you mean view1.vws?");
  fs::create_directories(root_ / "cell/scripts/below");
  write("cell/scripts/below/one.spt", "A");
  EXPECT_NE(refusal("below/ones").find("did you mean below/one?"), std::string::npos) << refusal("below/ones");
  EXPECT_EQ(refusal("../../outsid").find("did you mean"), std::string::npos) << "nothing is told of what is outside";
}

TEST_F(Home, RefusesAFileThatMayNotBeRead) {
  if (geteuid() == 0) GTEST_SKIP() << "skipped: root reads every file";
  write("cell/scripts/closed.spt", "A");
  fs::permissions(root_ / "cell/scripts/closed.spt", fs::perms::none);
  EXPECT_NE(refusal("closed.spt").find("not readable"), std::string::npos);
}

TEST_F(Home, WritesOnlyPlainNamesIntoAFolderOfTheHome) {
  EXPECT_EQ(sut().file_to_write("records", "f.jsonl")->parent_path().filename(), "records");
  EXPECT_TRUE(fs::is_directory(root_ / "cell/records"));
  EXPECT_FALSE(sut().file_to_write("records", "../f"));
  EXPECT_FALSE(sut().file_to_write("records", ".."));
  EXPECT_FALSE(sut().file_to_write("records", "/etc/passwd"));
  fs::create_symlink(root_ / "outside.spt", root_ / "cell/records/link");
  EXPECT_FALSE(sut().file_to_write("records", "link"));
}

TEST_F(Home, WritesIntoItsStateFolderAndReadsThereFirst) {
  const auto made = sut().with_state(root_ / "state/transfer_cell");
  ASSERT_TRUE(made) << made.error().text();
  fs::permissions(root_ / "cell", fs::perms::owner_read | fs::perms::owner_exec);
  const auto target = made->file_to_write("scripts", "a.spt");
  ASSERT_TRUE(target) << target.error().text();
  EXPECT_EQ(*target, fs::canonical(root_) / "state/transfer_cell/scripts/a.spt");
  EXPECT_EQ(*read_text_file(*made->file("scripts", "a", ".spt"), 9), "A") << "of the cell, while nothing was written";
  std::ofstream(*target) << "B";
  EXPECT_EQ(*read_text_file(*made->file("scripts", "a", ".spt"), 9), "B");
  EXPECT_EQ(*read_text_file(*made->file("scripts", "a.spt"), 9), "B");
  EXPECT_EQ(made->shown_name(*target), "scripts/a.spt");
  EXPECT_EQ(made->shown_name(fs::canonical(root_) / "cell/scripts/a.spt"), "scripts/a.spt");
  EXPECT_TRUE(made->has("scripts", "a.spt"));
  EXPECT_FALSE(made->has("scripts", "b.spt"));
  EXPECT_FALSE(made->has("", "scripts")) << "a folder";
  EXPECT_FALSE(fs::exists(root_ / "cell/records"));
  fs::create_symlink(root_ / "outside.spt", root_ / "state/transfer_cell/scripts/link.spt");
  EXPECT_FALSE(made->file("scripts", "link.spt")) << "a link that leaves the state folder";
  fs::permissions(root_ / "cell", fs::perms::owner_all);
}

TEST_F(Home, RefusesAStateFolderThatIsNone) {
  EXPECT_FALSE(sut().with_state(root_ / "outside.spt"));
  EXPECT_FALSE(sut().with_state(root_ / "outside.spt/below"));
}

TEST_F(Home, ReadsAWholeFileUpToTheLimitAndNeverWaitsForAPipe) {
  EXPECT_EQ(*read_text_file(root_ / "outside.spt", 6), "secret");
  EXPECT_FALSE(read_text_file(root_ / "outside.spt", 5));
  ASSERT_EQ(mkfifo((root_ / "pipe").c_str(), 0600), 0);
  EXPECT_FALSE(read_text_file(root_ / "pipe", 100));
  EXPECT_FALSE(read_text_file(root_ / "cell", 100));
}

}  // namespace
}  // namespace cellmirror
