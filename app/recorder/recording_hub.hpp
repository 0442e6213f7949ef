// The recordings of a gateway: one that a client asked for, and the ring of the cell file. Messages go to each of them,
// and to clients that watch live.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/recorder/recording.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::app {

// Any thread but the tick's.
class RecordingHub {
 public:
  // `clock` outlives the hub.
  explicit RecordingHub(const Clock& clock) : clock_(clock) {}

  // Fails while there is one that goes on.
  Result<void> start_file(RecordingOptions options);
  Result<void> start_ring(RecordingOptions options);
  // The one of a client. False: there is none.
  bool end_file();
  bool renew_file();
  // RECORD ON, OFF, KEEP: of the ring.
  void set_ring_options(RecordingOptions options);  // what RECORD ON begins again
  Result<void> switch_ring(bool on);
  Result<void> keep_ring();

  // Takes messages too, from now on; before any other thread uses the hub.
  void set_live(std::shared_ptr<TopicSink> live) { live_ = std::move(live); }

  void put(const TopicPtr& topic, std::int64_t publish_time_ns, mcap::View data) const;
  void count_missed(const TopicPtr& topic, std::uint64_t messages) const;
  // Whether a recording goes on that wants the topic, or a client watches it live.
  [[nodiscard]] bool wants(const Topic& topic) const;
  // The views of all recordings that go on, each once with its greatest rate.
  [[nodiscard]] std::vector<WantedPicture> pictures() const;
  // The greatest rate of robot states that is wanted; 0: nothing is recorded.
  [[nodiscard]] double rate_hz() const;
  // The greatest rate of deformable objects that is wanted; 0: none are.
  [[nodiscard]] double tissue_rate_hz() const;
  // The newest of each kind, also one that has ended.
  [[nodiscard]] std::vector<RecordingReport> reports() const;
  [[nodiscard]] std::optional<RecordingReport> file_report() const;
  // Another number where a file was begun since: of a recording, or the next one of a ring.
  [[nodiscard]] std::uint64_t files_begun() const;
  // Why a recording that should go on does not, or loses messages; empty: nothing is wrong.
  [[nodiscard]] std::string problem() const;
  // Ends all; waits until they are written.
  void close();

 private:
  using Shared = std::shared_ptr<Recording>;
  [[nodiscard]] std::pair<Shared, Shared> both() const;
  // Ends in another thread's time: nobody waits for the disk with the lock.
  static bool goes_on(const Shared& recording) { return recording && !recording->ended(); }

  const Clock& clock_;
  mutable std::mutex mutex_;  // of the pointers
  Shared file_;
  Shared ring_;
  std::optional<RecordingOptions> ring_options_;
  std::uint64_t starts_ = 0;         // of recordings
  std::shared_ptr<TopicSink> live_;  // null: nobody can watch
};

}  // namespace cellmirror::app
