#include "ipc/record/record_finder.hpp"

#include <algorithm>
#include <array>

#include "ipc/record/decode.hpp"

namespace cellmirror::mcap {

namespace {

constexpr std::uint64_t kFinderWindow = std::uint64_t{1} << 16;
constexpr std::uint64_t kLongestCompression = 16;  // letters

// Walks over the fields of a record by their lengths; reads nothing else, so that a wrong candidate costs little.
class Fields {
 public:
  Fields(const Source& source, std::uint64_t at) : source_(source), at_(at) {}

  template <class T>
  std::uint64_t number() {
    std::array<std::byte, sizeof(T)> bytes;
    if (!skip(sizeof(T)) || !source_.read(at_ - sizeof(T), bytes)) {
      ok_ = false;
      return 0;
    }
    return Decoder(bytes).number<T>();
  }
  bool skip(std::uint64_t size) {
    ok_ = ok_ && size <= source_.size() - at_;
    if (ok_) at_ += size;
    return ok_;
  }
  // Its length.
  std::uint64_t text() {
    const std::uint64_t size = number<std::uint32_t>();
    return skip(size) ? size : 0;
  }
  void data() { skip(number<std::uint64_t>()); }
  [[nodiscard]] bool ends_at(std::uint64_t end) const { return ok_ && at_ == end; }
  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] std::uint64_t at() const { return at_; }

 private:
  const Source& source_;
  std::uint64_t at_;
  bool ok_ = true;
};

bool searched_for(std::byte opcode) {
  switch (static_cast<Opcode>(opcode)) {
    case Opcode::schema:
    case Opcode::channel:
    case Opcode::chunk:
    case Opcode::attachment:
    case Opcode::metadata:
      return true;
    default:
      return false;
  }
}

// Names are demanded: zeros and small numbers in a row would agree otherwise.
bool lengths_agree(Opcode opcode, Fields fields, std::uint64_t end) {
  bool named = true;
  switch (opcode) {
    case Opcode::schema:
      fields.skip(2);
      named = fields.text() > 0;
      fields.text();
      fields.text();
      break;
    case Opcode::channel:
      fields.skip(2 + 2);
      named = fields.text() > 0;
      fields.text();
      fields.text();
      break;
    case Opcode::chunk:
      fields.skip(8 + 8 + 8 + 4);
      named = fields.text() <= kLongestCompression;
      fields.data();
      break;
    case Opcode::attachment:
      fields.skip(8 + 8);
      named = fields.text() > 0;
      fields.text();
      fields.data();
      fields.skip(4);
      break;
    case Opcode::metadata:
      named = fields.text() > 0;
      fields.text();
      break;
    default:
      return false;
  }
  return named && fields.ends_at(end);
}

}  // namespace

bool RecordFinder::record_at(std::uint64_t offset) const {
  Fields head(source_, offset);
  const auto opcode = static_cast<Opcode>(head.number<std::uint8_t>());
  const std::uint64_t length = head.number<std::uint64_t>();
  if (!head.ok() || length > limits_.record_bytes || length > source_.size() - head.at()) return false;
  return lengths_agree(opcode, head, head.at() + length);
}

bool RecordFinder::recording_at(std::uint64_t offset) const {
  std::array<std::byte, kMagic.size()> magic;
  if (offset > source_.size() || source_.size() - offset < magic.size() || !source_.read(offset, magic) ||
      !std::ranges::equal(magic, std::as_bytes(std::span(kMagic))))
    return false;
  Fields header(source_, offset + magic.size());
  if (header.number<std::uint8_t>() != static_cast<std::uint8_t>(Opcode::header)) return false;
  const std::uint64_t length = header.number<std::uint64_t>();
  if (!header.ok() || length > source_.size() - header.at()) return false;
  const std::uint64_t end = header.at() + length;
  header.text();
  header.text();
  return header.ends_at(end);
}

// Rejects most candidates without another read of the source.
bool RecordFinder::fits(std::size_t i, std::uint64_t window_at) const {
  constexpr std::size_t kHead = 1 + 8;
  if (window_.size() - i < kHead) return true;
  const auto length = Decoder(View(window_).subspan(i + 1, 8)).number<std::uint64_t>();
  return length <= limits_.record_bytes && length <= source_.size() - (window_at + i);
}

std::optional<FoundRecord> RecordFinder::search(std::uint64_t from, std::uint64_t to, bool only_recordings) {
  to = std::min(to, source_.size());
  while (from < to) {
    window_.resize(std::min(kFinderWindow, to - from));
    if (!source_.read(from, window_)) return std::nullopt;
    for (std::size_t i = 0; i < window_.size(); ++i) {
      if (window_[i] == std::byte{kMagic[0]} && recording_at(from + i)) return FoundRecord{from + i, true};
      if (only_recordings || !searched_for(window_[i]) || !fits(i, from)) continue;
      if (record_at(from + i)) return FoundRecord{from + i, false};
    }
    from += window_.size();
  }
  return std::nullopt;
}

std::optional<FoundRecord> RecordFinder::next(std::uint64_t from, std::uint64_t to) { return search(from, to, false); }

std::optional<FoundRecord> RecordFinder::next_recording(std::uint64_t from, std::uint64_t to) {
  return search(from, to, true);
}

}  // namespace cellmirror::mcap
