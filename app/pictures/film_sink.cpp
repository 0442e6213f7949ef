#include "app/pictures/film_sink.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <sstream>
#include <utility>

#include "app/pictures/picture_file.hpp"
#include "ipc/runtime/system_error.hpp"
#include "rt_core/base/counted.hpp"
#include "rt_core/base/descriptor.hpp"

namespace cellmirror::app {

namespace fs = std::filesystem;

namespace {

Result<void> write_all(int fd, std::span<const std::uint8_t> bytes, const std::string& where) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return fail(fmt::format("{} cannot be written: {}", where, system_error_text(errno)));
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return {};
}

class FrameFiles final : public FilmSink {
 public:
  explicit FrameFiles(fs::path folder) : folder_(std::move(folder)) {}
  Result<void> add(std::span<const std::uint8_t> jpeg) override { return write_picture_file(frame(++frames_), jpeg); }
  // Frames behind the last one are of a longer film that was there before.
  Result<std::string> finish() override {
    std::error_code error;
    for (std::uint64_t behind = frames_ + 1; fs::remove(frame(behind), error); ++behind) {
    }
    return fmt::format("{} in {}", number_of(frames_, "frame"), folder_.string());
  }

 private:
  [[nodiscard]] fs::path frame(std::uint64_t number) const { return folder_ / fmt::format("frame-{:05}.jpg", number); }

  fs::path folder_;
  std::uint64_t frames_ = 0;
};

class JpegsInOneFile final : public FilmSink {
 public:
  JpegsInOneFile(Descriptor file, std::string name) : file_(std::move(file)), name_(std::move(name)) {}
  Result<void> add(std::span<const std::uint8_t> jpeg) override {
    ++frames_;
    return write_all(file_.get(), jpeg, name_);
  }
  Result<std::string> finish() override { return fmt::format("{} in {}", number_of(frames_, "frame"), name_); }

 private:
  Descriptor file_;
  std::string name_;
  std::uint64_t frames_ = 0;
};

// Gets the frames through a pipe.
class Ffmpeg final : public FilmSink {
 public:
  Ffmpeg(pid_t process, Descriptor pipe, std::string name)
      : process_(process), pipe_(std::move(pipe)), name_(std::move(name)) {}
  ~Ffmpeg() override { wait(); }
  Ffmpeg(const Ffmpeg&) = delete;
  Ffmpeg& operator=(const Ffmpeg&) = delete;

  Result<void> add(std::span<const std::uint8_t> jpeg) override {
    ++frames_;
    auto written = write_all(pipe_.get(), jpeg, "the pipe to ffmpeg");
    if (!written && wait() != 0) return refusal();
    return written;
  }
  Result<std::string> finish() override {
    if (wait() != 0) return refusal();
    return fmt::format("{} in {}", number_of(frames_, "frame"), name_);
  }

 private:
  [[nodiscard]] std::unexpected<Error> refusal() const {
    return fail(fmt::format("ffmpeg made no {}: it ended with {}", name_, status_), "it has said why above");
  }

  int wait() {
    pipe_ = Descriptor();
    if (process_ <= 0) return status_;
    int status = 0;
    while (::waitpid(std::exchange(process_, -1), &status, 0) < 0 && errno == EINTR) {
    }
    status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
    return status_;
  }

  pid_t process_;
  int status_ = 0;
  Descriptor pipe_;
  std::string name_;
  std::uint64_t frames_ = 0;
};

std::optional<std::string> program_in_path(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string candidate = folder + "/" + name;
    if (::access(candidate.c_str(), X_OK) == 0) return candidate;
  }
  return std::nullopt;
}

Result<std::unique_ptr<FilmSink>> start_ffmpeg(const std::string& program, const std::string& name, double rate_hz) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return fail(fmt::format("no pipe to ffmpeg: {}", system_error_text(errno)));
  Descriptor reading(ends[0]);
  Descriptor writing(ends[1]);
  // H.264 of this kind plays everywhere; it wants even edges.
  const std::array<std::string, 20> words = {program,
                                             "-nostdin",
                                             "-loglevel",
                                             "error",
                                             "-y",
                                             "-f",
                                             "mjpeg",
                                             "-framerate",
                                             fmt::format("{:g}", rate_hz),
                                             "-i",
                                             "pipe:0",
                                             "-vf",
                                             "scale=trunc(iw/2)*2:trunc(ih/2)*2",
                                             "-c:v",
                                             "libx264",
                                             "-pix_fmt",
                                             "yuv420p",
                                             "-movflags",
                                             "+faststart",
                                             "file:" + name};
  std::array<char*, words.size() + 1> arguments{};
  for (std::size_t i = 0; i < words.size(); ++i) arguments[i] = const_cast<char*>(words[i].c_str());
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, reading.get(), STDIN_FILENO);
  // In a process group of its own: Ctrl-C ends the film, not the program that still has to write it down.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  pid_t process = 0;
  const int failed = ::posix_spawn(&process, program.c_str(), &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) return fail(fmt::format("{} cannot be started: {}", program, system_error_text(failed)));
  return std::make_unique<Ffmpeg>(process, std::move(writing), name);
}

Result<std::unique_ptr<FilmSink>> frames_in(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return fail(fmt::format("the folder {} cannot be made: {}", folder.string(), error.message()));
  return std::make_unique<FrameFiles>(folder);
}

}  // namespace

Result<std::unique_ptr<FilmSink>> make_film_sink(const std::string& name, double rate_hz, std::string& note) {
  if (name.ends_with(".mp4")) {
    if (const auto program = program_in_path("ffmpeg")) return start_ffmpeg(*program, name, rate_hz);
    note = fmt::format("there is no ffmpeg here (apt-get install ffmpeg), so that {} becomes a folder of frames", name);
    return frames_in(name + ".frames");
  }
  if (!name.ends_with(".mjpeg") && !name.ends_with(".mjpg")) return frames_in(name);
  Descriptor file(::open(name.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (!file.valid()) return fail(fmt::format("{} cannot be written: {}", name, system_error_text(errno)));
  return std::make_unique<JpegsInOneFile>(std::move(file), name);
}

}  // namespace cellmirror::app
