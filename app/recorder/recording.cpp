#include "app/recorder/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>

#include "app/recording_layout/recording_names.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/base/utc_text.hpp"
#include "rt_core/rt/scheduling.hpp"

namespace cellmirror::app {

namespace {

constexpr std::chrono::milliseconds kGather{50};  // one round of the writer
constexpr std::size_t kWorthAWrite = std::size_t{1} << 20;
constexpr Nanoseconds kLongestChunk{500'000'000};       // what a killed process loses at most, and the round
constexpr Nanoseconds kBetweenChecks{1'000'000'000};    // at the file's name and the bounds of a ring
constexpr Nanoseconds kLongestFailure{10'000'000'000};  // then the recording ends
constexpr std::size_t kMostTopics = 4096;

// "20261123T234501.250Z": without characters that a file system or a shell has another use for.
std::string file_time(std::int64_t wall_ns) {
  std::string out = utc_text_ms(wall_ns);
  std::erase_if(out, [](char c) { return c == '-' || c == ':'; });
  return out;
}

bool fits(const std::vector<std::string>& wanted, const std::string& topic) {
  return wanted.empty() || std::ranges::any_of(wanted, [&](const std::string& pattern) {
           if (!pattern.ends_with('*')) return pattern == topic;
           return topic.starts_with(std::string_view(pattern).substr(0, pattern.size() - 1));
         });
}

std::uint64_t size_of(const std::filesystem::path& file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  return error ? 0 : size;
}

}  // namespace

// The file that is being written.
struct Recording::File {
  File(std::unique_ptr<mcap::FileSink> made, mcap::Compression compression, Timestamp now)
      : sink(std::move(made)),
        writer(*sink, {.profile = "ros2", .library = "cellmirror " CELLMIRROR_VERSION, .compression = compression}),
        opened(now),
        flushed(now),
        looked(now) {}

  std::unique_ptr<mcap::FileSink> sink;
  mcap::Writer writer;
  std::vector<bool> known;                      // channels, by id
  std::map<std::uint16_t, std::uint64_t> lost;  // counted already
  Timestamp opened;
  Timestamp flushed;
  Timestamp looked;
  std::uint64_t bytes_before = 0;  // of the files before
};

Recording::Recording(RecordingOptions options, const Clock& clock)
    : options_(std::move(options)), clock_(clock), started_(clock.now()), renewed_(started_) {
  report_.ring = options_.ring.has_value();
}

Result<std::unique_ptr<Recording>> Recording::start(RecordingOptions options, const Clock& clock) {
  std::unique_ptr<Recording> made(new Recording(std::move(options), clock));
  if (made->options_.ring) made->find_old_files();
  if (auto opened = made->open_file(); !opened) return std::unexpected(opened.error());
  made->thread_ = std::thread([recording = made.get()] { recording->loop(); });
  return made;
}

Recording::~Recording() {
  end();
  if (thread_.joinable()) thread_.join();
}

std::size_t Recording::limit_of(Importance importance) const {
  switch (importance) {
    case Importance::picture:
      return options_.buffer_bytes / 4;
    case Importance::bulk:
      return options_.buffer_bytes / 2;
    case Importance::state:
      return options_.buffer_bytes / 4 * 3;
    case Importance::event:
      return options_.buffer_bytes;
  }
  return options_.buffer_bytes;
}

Recording::ChannelState& Recording::channel_of(const TopicPtr& topic) {
  const auto [entry, is_new] = ids_.try_emplace(topic.get(), static_cast<std::uint16_t>(channels_.size() + 1));
  if (is_new) {
    ChannelState state;
    state.topic = topic;
    state.wanted = wants(*topic) && channels_.size() < kMostTopics;
    channels_.push_back(std::move(state));
  }
  return channels_[entry->second - 1U];
}

void Recording::put(const TopicPtr& topic, std::int64_t log_time_ns, std::int64_t publish_time_ns, mcap::View data) {
  bool wake = false;
  {
    const std::scoped_lock lock(mutex_);
    if (ending_ || gone_) return;
    ChannelState& channel = channel_of(topic);
    if (!channel.wanted) return;
    const std::uint32_t sequence = ++channel.sequence;
    const std::size_t used = waiting_.data.size() + waiting_.entries.size() * sizeof(Entry);
    if (used + data.size() + sizeof(Entry) > limit_of(topic->importance)) {
      ++channel.dropped;
      return;
    }
    ++channel.taken;
    const std::uint16_t id = ids_.find(topic.get())->second;
    waiting_.entries.push_back({id, sequence, static_cast<std::uint64_t>(std::max<std::int64_t>(0, log_time_ns)),
                                static_cast<std::uint64_t>(std::max<std::int64_t>(0, publish_time_ns)),
                                waiting_.data.size(), data.size()});
    waiting_.data.insert(waiting_.data.end(), data.begin(), data.end());
    wake = waiting_.data.size() > kWorthAWrite;
  }
  if (wake) came_.notify_one();
}

void Recording::count_missed(const TopicPtr& topic, std::uint64_t messages) {
  const std::scoped_lock lock(mutex_);
  if (ending_ || gone_) return;
  ChannelState& channel = channel_of(topic);
  if (!channel.wanted) return;
  channel.sequence += static_cast<std::uint32_t>(messages);
  channel.dropped += messages;
}

bool Recording::wants(const Topic& topic) const {
  if (topic.of_tissue && !(options_.tissue_rate_hz > 0)) return false;
  if (topic.importance != Importance::picture) return fits(options_.topics, topic.name);
  return std::ranges::find(options_.pictures, topic.view, &WantedPicture::view) != options_.pictures.end();
}

void Recording::end() {
  {
    const std::scoped_lock lock(mutex_);
    ending_ = true;
  }
  came_.notify_one();
}

bool Recording::ended() const {
  const std::scoped_lock lock(mutex_);
  return ended_;
}

void Recording::renew() {
  const Timestamp now = clock_.now();
  const std::scoped_lock lock(mutex_);
  renewed_ = now;
}

bool Recording::keep() {
  if (!options_.ring) return false;
  const Timestamp at = clock_.now() + options_.ring->keep_after;
  const std::scoped_lock lock(mutex_);
  if (ending_ || gone_) return false;
  // A second request while one waits is for the same files.
  if (!keep_at_.known()) keep_at_ = at;
  return true;
}

RecordingReport Recording::report() const {
  const std::scoped_lock lock(mutex_);
  RecordingReport out = report_;
  out.ended = ended_;
  for (const ChannelState& channel : channels_) {
    if (!channel.wanted) continue;
    out.messages += channel.taken;
    out.dropped += channel.dropped;
    // Two channels of one topic are one to people.
    const auto known = std::ranges::find(out.topics, channel.topic->name, &TopicReport::topic);
    if (known == out.topics.end()) {
      out.topics.push_back({channel.topic->name, channel.taken, channel.dropped});
    } else {
      known->messages += channel.taken;
      known->dropped += channel.dropped;
    }
  }
  if (!out.ended) out.seconds = seconds(clock_.now() - started_);
  return out;
}

void Recording::loop() {
  set_thread_name("recording");
  Batch batch;
  for (;;) {
    bool ending = false;
    {
      std::unique_lock lock(mutex_);
      came_.wait_for(lock, kGather, [this] { return ending_ || waiting_.data.size() > kWorthAWrite; });
      std::swap(batch, waiting_);
      const Timestamp now = clock_.now();
      const bool over = options_.length.count() > 0 && now - started_ >= options_.length;
      const bool left = options_.lease.count() > 0 && now - renewed_ >= options_.lease;
      if (left && !ending_) report_.why = "the program that asked for it is gone";
      ending_ = ending_ || over || left;
      ending = ending_;
    }
    write(batch);
    batch.data.clear();
    batch.entries.clear();
    const Timestamp now = clock_.now();
    look_after_file(now);
    if (ending) break;
  }
  finish_file();
  const std::scoped_lock lock(mutex_);
  report_.seconds = seconds(clock_.now() - started_);
  ended_ = true;
}

std::uint64_t Recording::most_attached() const {
  if (!options_.ring) return options_.most_attached;
  const RecordingRing& ring = *options_.ring;
  const auto files = static_cast<std::uint64_t>(ring.length / std::max(ring.file_length, Nanoseconds(1)) + 1);
  return std::min(options_.most_attached, ring.most_bytes / files / 4);
}

Result<void> Recording::open_file() {
  const Timestamp now = clock_.now();
  std::filesystem::path path = options_.file;
  if (options_.ring)
    path = options_.ring->folder / fmt::format("{}-{}.mcap", options_.ring->name, file_time(to_wall_clock_ns(now)));
  auto sink = mcap::FileSink::create(path);
  if (!sink) return std::unexpected(sink.error());
  auto file = std::make_unique<File>(*std::move(sink), options_.compression, now);
  Result<void> step = file->writer.begin();
  if (step) step = file->writer.put(mcap::Metadata{std::string(kGatewayName), options_.about});
  const auto wall = static_cast<std::uint64_t>(to_wall_clock_ns(now));
  if (!step) return step;
  const auto left_out = attach_cell_files(file->writer, options_.cell, most_attached(), wall);
  if (!left_out) return std::unexpected(left_out.error());
  if (report_.files == 0) {
    for (const std::string& one : *left_out) log_warning("recording", "{} is not attached", one);
  }
  file_ = std::move(file);
  const std::scoped_lock lock(mutex_);
  file_->bytes_before = report_.bytes;
  report_.file = path.string();
  ++report_.files;
  return {};
}

void Recording::write(const Batch& batch) {
  if (!file_) {
    // Between two files of a ring that cannot be made: all of it is lost.
    const std::scoped_lock lock(mutex_);
    for (const Entry& entry : batch.entries) ++channels_[entry.channel - 1U].dropped;
    return;
  }
  mcap::Writer& writer = file_->writer;
  const std::uint64_t bytes_before = writer.bytes();
  Result<void> outcome;
  for (const Entry& entry : batch.entries) {
    if (file_->known.size() <= entry.channel) file_->known.resize(entry.channel + 1U, false);
    if (!file_->known[entry.channel]) {
      TopicPtr topic;
      {
        const std::scoped_lock lock(mutex_);
        topic = channels_[entry.channel - 1U].topic;
      }
      Result<void> described = writer.put({entry.channel, topic->schema_name, topic->schema_encoding, topic->schema});
      if (described)
        described =
            writer.put(mcap::Channel{entry.channel, entry.channel, topic->name, topic->encoding, topic->metadata});
      if (!described) {
        outcome = described;
        const std::scoped_lock lock(mutex_);
        ++channels_[entry.channel - 1U].dropped;
        continue;
      }
      file_->known[entry.channel] = true;
    }
    const mcap::View data = mcap::View(batch.data).subspan(entry.offset, entry.size);
    const auto written = writer.put({entry.channel, entry.sequence, entry.log_time, entry.publish_time, data});
    if (!written) outcome = written;
  }
  const Timestamp now = clock_.now();
  if (outcome && now - file_->flushed >= kLongestChunk) {
    outcome = writer.flush();
    file_->flushed = now;
  }
  count_lost();
  if (!outcome) return note_failure(outcome.error(), now);
  // What is only in the chunk may still find no room.
  if (writer.bytes() == bytes_before) return;
  failing_since_ = {};
  const std::scoped_lock lock(mutex_);
  report_.problem.clear();
}

// Chunks that could not be written.
void Recording::count_lost() {
  const std::scoped_lock lock(mutex_);
  for (const auto& [channel, messages] : file_->writer.lost()) {
    std::uint64_t& counted = file_->lost[channel];
    channels_[channel - 1U].dropped += messages - counted;
    counted = messages;
  }
  report_.bytes = file_->bytes_before + file_->writer.bytes();
}

// A full disk loses messages, which are counted, until there is room again. A ring makes room itself; for a file it is
// the end where that takes too long.
void Recording::note_failure(const Error& error, Timestamp now) {
  if (!failing_since_.known()) {
    failing_since_ = now;
    log_warning("recording", "{}", error.text());
  }
  {
    const std::scoped_lock lock(mutex_);
    report_.problem = error.text();
  }
  if (!options_.ring) {
    if (now - failing_since_ >= kLongestFailure) end_with(error.text());
  } else if (now >= retry_at_) {
    retry_at_ = now + kBetweenChecks;
    remove_oldest();
  }
}

void Recording::end_with(std::string why) {
  log_error("recording", "the recording ends: {}", why);
  const std::scoped_lock lock(mutex_);
  report_.why = std::move(why);
  ending_ = true;
  gone_ = true;
}

void Recording::look_after_file(Timestamp now) {
  if (file_ && now - file_->looked >= kBetweenChecks) {
    file_->looked = now;
    if (!file_->sink->still_there()) {
      const std::string why = file_->sink->file().string() + " was removed";
      if (!options_.ring) return end_with(why);
      log_warning("recording", "{}; another file is begun", why);
      file_.reset();
    }
  }
  if (!options_.ring) return;
  bool keeping = false;
  {
    const std::scoped_lock lock(mutex_);
    keeping = keep_at_.known() && now >= keep_at_;
    if (keeping) keep_at_ = {};
  }
  if (file_ && !keeping && now - file_->opened < options_.ring->file_length) return;
  if (!file_ && !keeping && now < retry_at_) return;
  finish_file();
  if (keeping) keep_files();
  remove_old_files();
  if (auto opened = open_file(); !opened) note_failure(opened.error(), now);
}

void Recording::finish_file() {
  if (!file_) return;
  static_cast<void>(file_->writer.flush());
  count_lost();
  mcap::Texts drops;
  {
    const std::scoped_lock lock(mutex_);
    for (ChannelState& channel : channels_) {
      const std::uint64_t dropped = channel.dropped - channel.noted;
      channel.noted = channel.dropped;
      if (dropped > 0) drops[channel.topic->name] = std::to_string(dropped);
    }
  }
  Result<void> step = file_->writer.put(mcap::Metadata{std::string(kDropsName), std::move(drops)});
  if (step) step = file_->writer.finish();
  if (step) step = file_->sink->sync();
  if (!step) {
    log_error("recording", "the recording has no summary: {}", step.error().text());
    const std::scoped_lock lock(mutex_);
    report_.problem = step.error().text();
  }
  {
    const std::scoped_lock lock(mutex_);
    report_.bytes = file_->bytes_before + file_->writer.bytes();
  }
  if (options_.ring) ring_files_.push_back(file_->sink->file());
  file_.reset();
}

// Those of runs before, one of which may have been killed.
void Recording::find_old_files() {
  const std::string begin = options_.ring->name + "-";
  const std::string kept = begin + "kept-";
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(options_.ring->folder, error)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(begin) || !name.ends_with(".mcap") || !entry.is_regular_file(error)) continue;
    if (name.starts_with(kept)) {
      ++report_.kept;
    } else if (name.size() > begin.size() && name[begin.size()] >= '0' && name[begin.size()] <= '9') {
      ring_files_.push_back(entry.path());
    }
  }
  std::ranges::sort(ring_files_);
}

void Recording::keep_files() {
  for (const std::filesystem::path& file : ring_files_) {
    {
      const std::scoped_lock lock(mutex_);
      if (report_.kept >= options_.ring->most_kept) {
        report_.problem =
            fmt::format("{} files were kept, which is the most; move them away and restart", options_.ring->most_kept);
        return;
      }
    }
    const std::string name = file.filename().string();
    const std::string kept =
        fmt::format("{}-kept-{}", options_.ring->name, name.substr(options_.ring->name.size() + 1));
    std::error_code error;
    std::filesystem::rename(file, file.parent_path() / kept, error);
    if (error) {
      log_error("recording", "{} cannot be kept: {}", file.string(), error.message());
      continue;
    }
    const std::scoped_lock lock(mutex_);
    ++report_.kept;
  }
  ring_files_.clear();
}

void Recording::remove_old_files() {
  const RecordingRing& ring = *options_.ring;
  const auto most_files =
      static_cast<std::size_t>(std::max<std::int64_t>(1, ring.length.count() / ring.file_length.count()));
  std::uint64_t bytes = 0;
  for (const std::filesystem::path& file : ring_files_) bytes += size_of(file);
  while (!ring_files_.empty() && (ring_files_.size() > most_files || bytes > ring.most_bytes)) {
    bytes -= std::min(bytes, size_of(ring_files_.front()));
    remove_oldest();
  }
}

void Recording::remove_oldest() {
  if (ring_files_.empty()) return;
  std::error_code error;
  std::filesystem::remove(ring_files_.front(), error);
  ring_files_.erase(ring_files_.begin());
}

}  // namespace cellmirror::app
