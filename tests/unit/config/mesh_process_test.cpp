// The process that reads meshes: what becomes of one that crashes, hangs or lies, and what is left of it.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "config/mesh_file.hpp"
#include "config/mesh_process.hpp"
#include "ipc/sandbox/child_process.hpp"
#include "tests/unit/config/mesh_text.hpp"
#include "tests/unit/config/temporary_home.hpp"

namespace cellmirror {
namespace {

using std::chrono::milliseconds;

std::size_t open_descriptors() {
  return static_cast<std::size_t>(
      std::distance(std::filesystem::directory_iterator("/proc/self/fd"), std::filesystem::directory_iterator()));
}

// After each test: no child that was not collected, and no descriptor more than before.
struct MeshProcess : testing::Test {
  void TearDown() override {
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
    EXPECT_EQ(errno, ECHILD);
    EXPECT_EQ(open_descriptors(), descriptors);
  }
  // A program in the reader's place.
  [[nodiscard]] MeshReader with(const std::string& commands) const {
    const auto program = home.write("reader", "#!/bin/sh\n" + commands + "\n");
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    return {program, std::chrono::minutes(1)};
  }
  static Result<ScenePolygons> read(const MeshReader& reader, std::string_view bytes = "v 0 0 0") {
    return read_mesh_apart({".obj", bytes, {}, Eigen::Vector3d::Ones(), false}, reader);
  }
  static std::string refusal(const MeshReader& reader, std::string_view bytes = "v 0 0 0") {
    const auto result = read(reader, bytes);
    return result ? "read" : result.error().text();
  }

  TemporaryHome home;
  std::size_t descriptors = open_descriptors();
  // More than the buffers of a socket hold.
  std::string large = std::string(8UL << 20U, '#');
};

TEST_F(MeshProcess, tells_how_its_reader_ended) {
  EXPECT_EQ(refusal(with("kill -SEGV $$")),
            "it cannot be read: its reader ended with signal 11 (SIGSEGV): the file is damaged; export it again");
  EXPECT_EQ(refusal(with("kill -XCPU $$")),
            "it cannot be read: its reader took more than 60 s of CPU time; reduce the mesh, or export it again");
  EXPECT_EQ(refusal(with("kill -KILL $$")),
            "it cannot be read: its reader was ended with signal 9 (SIGKILL), as by a system that is out of memory; "
            "reduce the mesh, or free memory of other programs");
  EXPECT_EQ(refusal(with("exit 3")),
            "it cannot be read: its reader ended with status 3: the file is damaged; export it again");
}

TEST_F(MeshProcess, takes_no_answer_that_is_none) {
  const std::string damaged = "it cannot be read: its reader's answer is damaged; export it again";
  EXPECT_EQ(refusal(with("cat >/dev/null; echo nonsense")), damaged);
  EXPECT_EQ(refusal(with("exit 0")), damaged);
  EXPECT_EQ(refusal(with("exit 0"), large), damaged);
  EXPECT_EQ(refusal(with("echo nonsense"), large), damaged);
  // One error text, whatever is in it, and nothing behind it.
  const std::string error = R"(printf '\002\0\0\0\0\0\0\0\003\0\0\0\0\0\0\0a\033b\0\0\0\0\0\0\0\0')";
  EXPECT_EQ(refusal(with(error)), "a\\x1bb");
  EXPECT_EQ(refusal(with(error + "; echo")), damaged);
}

TEST_F(MeshProcess, ends_a_reader_that_hangs_or_answers_for_ever) {
  MeshReader sut = with("exec sleep 1000");
  sut.longest = milliseconds(200);
  const std::string late = "it cannot be read: its reader took more than 0.2 s; reduce the mesh, or export it again";
  EXPECT_EQ(refusal(sut), late);
  EXPECT_EQ(refusal(sut, large), late);
  sut = with("exec cat /dev/zero");
  sut.most_bytes = 1UL << 20U;
  EXPECT_EQ(refusal(sut), "it cannot be read: it contains more than 1 MiB; reduce the mesh");
}

TEST_F(MeshProcess, does_not_wait_for_a_reader_that_hangs_up_and_goes_on) {
  EXPECT_TRUE(refusal(with("exec 0<&- 1<&- 2<&-; exec sleep 1000")).starts_with("it cannot be read: its reader"));
}

TEST_F(MeshProcess, sends_and_receives_at_the_same_time) {
  // Answers before it has read everything, more than a socket holds: neither may wait for the other.
  EXPECT_EQ(refusal(with("exec cat"), large), "it cannot be read: its reader's answer is damaged; export it again");
}

TEST_F(MeshProcess, says_what_to_do_where_the_reader_is_missing) {
  const MeshReader sut{home.root() / "nothing_here"};
  const std::string name = sut.program.string();
  EXPECT_EQ(refusal(sut),
            "it cannot be read: " + name +
                " cannot be started: No such file or directory; install it beside cellmirror; both are built together");
  EXPECT_FALSE(check_program(sut.program));
  EXPECT_TRUE(check_program(installed_mesh_reader().program));
}

TEST_F(MeshProcess, hands_down_neither_signals_nor_descriptors_nor_priority) {
  const int inherited = fcntl(STDERR_FILENO, F_DUPFD, 200);
  ASSERT_GE(inherited, 200);
  sigset_t blocked;
  sigset_t before;
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGTERM);
  ASSERT_EQ(pthread_sigmask(SIG_BLOCK, &blocked, &before), 0);
  const auto handler = std::signal(SIGPIPE, SIG_IGN);
  // As far as this user may; else there is nothing to hand down.
  const sched_param first{1};
  const sched_param ordinary{0};
  pthread_setschedparam(pthread_self(), SCHED_FIFO, &first);
  const std::string told = (home.root() / "told").string();
  (void)read(
      with("{ grep -E 'SigBlk|SigIgn' /proc/self/status; ls /proc/$$/fd; cut -d' ' -f41 /proc/$$/stat; } > " + told));
  pthread_setschedparam(pthread_self(), SCHED_OTHER, &ordinary);
  (void)std::signal(SIGPIPE, handler);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  close(inherited);
  std::ifstream file(told);
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  EXPECT_TRUE(text.starts_with("SigBlk:\t0000000000000000\nSigIgn:\t")) << text;
  // Bit 0 is signal 1. The C library has two signals of its own ignored in every process that it starts.
  const auto ignored = std::stoull(text.substr(text.find("SigIgn:") + 7), nullptr, 16);
  EXPECT_EQ(ignored & ((1ULL << 31U) - 1), 0U) << text;
  EXPECT_TRUE(text.ends_with("\n0\n")) << text;  // its policy: SCHED_OTHER
  EXPECT_EQ(text.find("\n" + std::to_string(inherited) + "\n"), std::string::npos) << text;
}

TEST_F(MeshProcess, reads_from_several_threads_at_once) {
  const std::string stl = tetra_stl();
  std::array<int, 4> read{};
  {
    std::vector<std::jthread> threads;
    for (int& count : read) {
      threads.emplace_back([&] {
        for (int i = 0; i < 4; ++i) {
          geometry::MeshFindings findings;
          if (parse_mesh(stl, ".stl", "m", Eigen::Vector3d::Ones(), {}, findings)) ++count;
        }
      });
    }
  }
  EXPECT_EQ(read, (std::array<int, 4>{4, 4, 4, 4}));
}

// Files that made assimp crash, hang or ask for all memory: the first byte says which format, as for the fuzz target.
TEST_F(MeshProcess, outlives_every_damaged_file_that_is_known) {
  const char* source = std::getenv("CELLMIRROR_SOURCE_DIR");
  const auto folder = std::filesystem::path(source != nullptr ? source : ".") / "tests/fuzz/mesh_check/corpus";
  constexpr std::array<std::string_view, 6> kExtensions{".stl", ".obj", ".dae", ".ply", ".gltf", ".glb"};
  int refused = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    ASSERT_FALSE(bytes.empty()) << entry.path();
    const std::string_view extension = kExtensions[static_cast<unsigned char>(bytes[0]) % kExtensions.size()];
    geometry::MeshFindings findings;
    const auto mesh =
        parse_mesh(std::string_view(bytes).substr(1), extension, "m", Eigen::Vector3d::Ones(), {}, findings);
    if (mesh) continue;
    ++refused;
    EXPECT_TRUE(mesh.error().what.starts_with("the mesh m is refused: ")) << mesh.error().what;
  }
  EXPECT_GE(refused, 10);
  const auto known = [&](const std::string& name) {
    std::ifstream file(folder / name, std::ios::binary);
    return std::string{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()}.substr(1);
  };
  for (const char* name : {"odd_mime_type_glb", "odd_mime_type_no_buffer_glb"}) {
    geometry::MeshFindings findings;
    EXPECT_FALSE(parse_mesh(known(name), ".glb", "m", Eigen::Vector3d::Ones(), {}, findings)) << name;
  }
  geometry::MeshFindings findings;
  EXPECT_FALSE(parse_mesh(known("huge_list_ply"), ".ply", "m", Eigen::Vector3d::Ones(), {}, findings));
}

}  // namespace
}  // namespace cellmirror
