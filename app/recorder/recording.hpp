// One recording that goes on: messages are taken from any thread but the tick's, buffered within a bound, and written
// by a thread of its own as one file, or as a ring of files. It never waits for the disk: what finds no room is counted
// by topic, and the counts are written into the file.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

#include "app/recorder/cell_files.hpp"
#include "app/recorder/topic.hpp"
#include "app/recorder/topic_sink.hpp"
#include "app/snapshot/recorder_report.hpp"
#include "ipc/record/writer.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::app {

// A ring: files of a folder, the oldest of which are removed. One that is to be kept is renamed.
struct RecordingRing {
  std::filesystem::path folder;  // is there
  std::string name;              // files are NAME-<UTC>.mcap, and NAME-kept-<UTC>.mcap
  Nanoseconds file_length{60'000'000'000};
  Nanoseconds length{600'000'000'000};                // of all files of the ring together, about
  std::uint64_t most_bytes = std::uint64_t{1} << 30;  // of all files of the ring
  std::size_t most_kept = 50;                         // files; more are not kept
  Nanoseconds keep_after{5'000'000'000};              // how much is kept after a request
};

inline constexpr double kUsualTissueRate_hz = 10;
inline constexpr std::uint64_t kMostAttached = 64'000'000;

// A view that is recorded as pictures: 0 to 6, or a camera. Not more often than that.
struct WantedPicture {
  std::string view;
  double rate_hz = 1;
};

struct RecordingOptions {
  std::filesystem::path file;  // a new one; ignored with a ring
  std::optional<RecordingRing> ring;
  std::vector<std::string> topics;           // none: all; "/tf", or "/cellmirror/*" for all that begin so
  std::vector<WantedPicture> pictures = {};  // beside the topics; none: no pictures
  mcap::Compression compression = mcap::Compression::zstd;
  double rate_hz = 100;                         // of robot states, at most
  double tissue_rate_hz = kUsualTissueRate_hz;  // of deformable objects, at most; 0: they are not recorded
  Nanoseconds length{0};                        // ends after it; 0: no end
  Nanoseconds lease{0};                         // ends where nobody called renew() so long; 0: no lease
  std::size_t buffer_bytes = std::size_t{16} << 20;
  mcap::Texts about = {};  // into the file: version, cell, ...
  CellFiles cell = {};     // attached
  std::uint64_t most_attached =
      kMostAttached;  // bytes of them; of a ring at most a quarter of what a file of it may have
};

class Recording final : public TopicSink {
 public:
  // Fails where the file cannot be made. `clock` outlives the recording.
  [[nodiscard]] static Result<std::unique_ptr<Recording>> start(RecordingOptions options, const Clock& clock);
  // Writes what is left.
  ~Recording() override;
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  // All of these: any thread but the tick's; none waits for the disk.
  void put(const TopicPtr& topic, std::int64_t log_time_ns, std::int64_t publish_time_ns, mcap::View data) override;
  void count_missed(const TopicPtr& topic, std::uint64_t messages) override;
  [[nodiscard]] bool wants(const Topic& topic) const override;
  void end();  // returns at once; ended() is true when the file is whole
  [[nodiscard]] bool ended() const;
  void renew();
  // Keeps the files of the ring, a while from now on. False: it is none, or has ended.
  bool keep();
  [[nodiscard]] RecordingReport report() const;
  [[nodiscard]] double rate_hz() const override { return options_.rate_hz; }
  [[nodiscard]] double tissue_rate_hz() const { return options_.tissue_rate_hz; }
  [[nodiscard]] const std::vector<WantedPicture>& pictures() const { return options_.pictures; }

 private:
  struct ChannelState {
    TopicPtr topic;
    bool wanted = true;
    std::uint32_t sequence = 0;
    std::uint64_t taken = 0;
    std::uint64_t dropped = 0;  // since the start
    std::uint64_t noted = 0;    // of these, in files that are finished
  };
  struct Entry {
    std::uint16_t channel;
    std::uint32_t sequence;
    std::uint64_t log_time;
    std::uint64_t publish_time;
    std::size_t offset;
    std::size_t size;
  };
  struct Batch {
    mcap::Bytes data;
    std::vector<Entry> entries;
  };
  struct File;

  Recording(RecordingOptions options, const Clock& clock);
  ChannelState& channel_of(const TopicPtr& topic);  // with the lock
  std::size_t limit_of(Importance importance) const;

  void loop();
  Result<void> open_file();
  [[nodiscard]] std::uint64_t most_attached() const;
  void write(const Batch& batch);
  void look_after_file(Timestamp now);
  void finish_file();
  void note_failure(const Error& error, Timestamp now);
  void end_with(std::string why);
  void count_lost();
  void find_old_files();
  void keep_files();
  void remove_old_files();
  void remove_oldest();

  RecordingOptions options_;
  const Clock& clock_;
  Timestamp started_;

  // The writer's.
  std::unique_ptr<File> file_;
  Timestamp failing_since_;
  Timestamp retry_at_;                             // of a ring
  std::vector<std::filesystem::path> ring_files_;  // finished ones, oldest first

  mutable std::mutex mutex_;  // of what follows; held for moments
  std::condition_variable came_;
  std::vector<ChannelState> channels_;
  std::unordered_map<const Topic*, std::uint16_t> ids_;
  Batch waiting_;
  bool ending_ = false;
  bool ended_ = false;
  bool gone_ = false;  // nothing more can be written
  Timestamp renewed_;
  Timestamp keep_at_;
  RecordingReport report_;

  std::thread thread_;
};

}  // namespace cellmirror::app
