#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "ipc/runtime/lock_file.hpp"
#include "ipc/runtime/runtime_folder.hpp"
#include "tests/unit/ipc/temporary_folder.hpp"

namespace cellmirror {
namespace {

using test::PrivateRuntimeFolder;
using test::TemporaryFolder;

// A child that has the lock at `path` until it is killed.
class Holder {
 public:
  explicit Holder(const std::filesystem::path& path) {
    int ready[2];
    if (::pipe(ready) != 0) std::abort();
    pid_ = ::fork();
    if (pid_ == 0) {
      const auto lock = LockFile::take(path, "child");
      const char ok = lock ? 'y' : 'n';
      if (::write(ready[1], &ok, 1) != 1) _exit(1);
      while (true) ::pause();
    }
    char ok = 'n';
    if (::read(ready[0], &ok, 1) != 1) ok = 'n';
    took_ = ok == 'y';
    ::close(ready[0]);
    ::close(ready[1]);
  }
  ~Holder() { kill(); }
  void kill() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
    pid_ = 0;
  }
  [[nodiscard]] pid_t pid() const { return pid_; }
  [[nodiscard]] bool took() const { return took_; }

 private:
  pid_t pid_ = 0;
  bool took_ = false;
};

TEST(LockFile, IsRefusedWhileAnotherProcessHasItAndNamesThatProcess) {
  const TemporaryFolder folder;
  Holder holder(folder.path() / "lock");
  ASSERT_TRUE(holder.took());
  const auto sut = LockFile::take(folder.path() / "lock", "me");
  ASSERT_FALSE(sut);
  EXPECT_EQ(sut.error().why, LockFile::Refusal::held);
  EXPECT_EQ(sut.error().holder.pid, holder.pid());
  EXPECT_EQ(sut.error().holder.note, "child");
  const auto seen = lock_holder(folder.path() / "lock");
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->pid, holder.pid());
}

TEST(LockFile, EndsWithAKilledProcess) {
  const TemporaryFolder folder;
  Holder holder(folder.path() / "lock");
  ASSERT_TRUE(holder.took());
  holder.kill();
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "lock")) << "the file stays, the lock does not";
  EXPECT_FALSE(lock_holder(folder.path() / "lock"));
  EXPECT_TRUE(LockFile::take(folder.path() / "lock", "me"));
}

TEST(LockFile, IsTakenAwayWhenReleased) {
  const TemporaryFolder folder;
  auto sut = LockFile::take(folder.path() / "lock", "me");
  ASSERT_TRUE(sut);
  EXPECT_TRUE(sut->in_place());
  LockFile moved = std::move(*sut);
  EXPECT_FALSE(sut->held());  // NOLINT(bugprone-use-after-move): that is the question
  EXPECT_TRUE(moved.held());
  moved.release();
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "lock"));
}

TEST(LockFile, KnowsThatItsFileIsGone) {
  const TemporaryFolder folder;
  const auto sut = LockFile::take(folder.path() / "lock", "me");
  ASSERT_TRUE(sut);
  std::filesystem::remove(folder.path() / "lock");
  EXPECT_FALSE(sut->in_place());
  const auto other = LockFile::take(folder.path() / "lock", "other");
  ASSERT_TRUE(other);
  EXPECT_FALSE(sut->in_place()) << "another file of the same name is not ours";
  EXPECT_TRUE(other->in_place());
}

TEST(LockFile, LinksFoldersAndPipesAreRefused) {
  const TemporaryFolder folder;
  folder.write("target", "precious");
  std::filesystem::create_symlink(folder.path() / "target", folder.path() / "link");
  std::filesystem::create_directory(folder.path() / "folder");
  ASSERT_EQ(::mkfifo((folder.path() / "pipe").c_str(), 0600), 0);
  for (const auto* name : {"link", "folder", "pipe", "missing/lock"}) {
    const auto sut = LockFile::take(folder.path() / name, "me");
    ASSERT_FALSE(sut) << name;
    EXPECT_EQ(sut.error().why, LockFile::Refusal::failed);
  }
  std::string text;
  std::ifstream(folder.path() / "target") >> text;
  EXPECT_EQ(text, "precious");
}

TEST(RuntimeFolder, IsMadePrivate) {
  const PrivateRuntimeFolder environment;
  const auto sut = runtime_folder();
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_EQ(*sut, environment.path());
  struct stat made{};
  ASSERT_EQ(::stat(sut->c_str(), &made), 0);
  EXPECT_EQ(made.st_mode & 0777u, 0700u);
  EXPECT_TRUE(runtime_folder()) << "it may be there already";
}

TEST(RuntimeFolder, LinksFilesAndOpenFoldersAreRefused) {
  const PrivateRuntimeFolder environment;
  const TemporaryFolder elsewhere;
  std::filesystem::create_directory_symlink(elsewhere.path(), environment.path());
  EXPECT_FALSE(runtime_folder());
  EXPECT_FALSE(runtime_folder_for_client());
  std::filesystem::remove(environment.path());
  std::ofstream(environment.path()) << "a file";
  EXPECT_FALSE(runtime_folder());
  std::filesystem::remove(environment.path());
  ASSERT_EQ(::mkdir(environment.path().c_str(), 0700), 0);
  ASSERT_EQ(::chmod(environment.path().c_str(), 0770), 0);
  const auto sut = runtime_folder();
  ASSERT_FALSE(sut);
  EXPECT_NE(sut.error().remedy.find("chmod 700"), std::string::npos);
}

TEST(RuntimeFolder, OfAnotherUserIsRefused) {
  if (::geteuid() != 0) GTEST_SKIP() << "skipped: only root can make a folder of another user";
  const PrivateRuntimeFolder environment;
  ASSERT_EQ(::mkdir(environment.path().c_str(), 0700), 0);
  ASSERT_EQ(::chown(environment.path().c_str(), 65534, 65534), 0);
  EXPECT_FALSE(runtime_folder());
  EXPECT_TRUE(runtime_folder_for_client()) << "root may talk to everybody's gateway";
}

TEST(RuntimeFolder, FollowsTheEnvironment) {
  const char* before = std::getenv("XDG_RUNTIME_DIR");
  const std::string saved = before == nullptr ? "" : before;
  ::unsetenv("CELLMIRROR_RUNTIME_DIR");
  ::setenv("XDG_RUNTIME_DIR", "/run/user/12", 1);
  EXPECT_EQ(runtime_folder_path(), "/run/user/12/cellmirror");
  ::unsetenv("XDG_RUNTIME_DIR");
  const std::string expected = ::geteuid() == 0 ? "/run/cellmirror" : "/tmp/cellmirror-" + std::to_string(::geteuid());
  EXPECT_EQ(runtime_folder_path(), expected);
  ::setenv("CELLMIRROR_RUNTIME_DIR", "relative", 1);
  EXPECT_FALSE(runtime_folder_path());
  ::unsetenv("CELLMIRROR_RUNTIME_DIR");
  if (!saved.empty()) ::setenv("XDG_RUNTIME_DIR", saved.c_str(), 1);
}

TEST(RuntimeFolder, NothingThereIsNoFailureForAClient) {
  const PrivateRuntimeFolder environment;
  EXPECT_TRUE(runtime_folder_for_client());
  EXPECT_FALSE(std::filesystem::exists(environment.path()));
}

}  // namespace
}  // namespace cellmirror
