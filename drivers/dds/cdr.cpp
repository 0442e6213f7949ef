#include "drivers/dds/cdr.hpp"

namespace cellmirror::dds {

namespace {
constexpr std::size_t kEncapsulationSize = 4;  // kind (big endian in any case) and options, 2 bytes each

std::size_t padding(std::size_t position, std::size_t alignment) {
  return (alignment - position % alignment) % alignment;
}
}  // namespace

std::string_view words(CdrFault fault) {
  switch (fault) {
    case CdrFault::none:
      return "no fault";
    case CdrFault::encapsulation:
      return "the encapsulation is neither CDR_BE nor CDR_LE";
    case CdrFault::truncated:
      return "a length or a value reaches beyond the end of the payload";
    case CdrFault::text:
      return "a string is not terminated by a zero";
    case CdrFault::too_many:
      return "more elements than are accepted in one message";
    case CdrFault::time:
      return "a time has nanoseconds beyond a second, or is before 1970";
  }
  return "unknown fault";
}

CdrReader::CdrReader(std::span<const std::byte> payload) {
  if (payload.size() < kEncapsulationSize) {
    fault_ = CdrFault::truncated;
    return;
  }
  const bool little = payload[1] == std::byte{1};
  if (payload[0] != std::byte{0} || (payload[1] != std::byte{0} && !little)) {
    fault_ = CdrFault::encapsulation;
    return;
  }
  swapped_ = little != (std::endian::native == std::endian::little);
  body_ = payload.subspan(kEncapsulationSize);
}

void CdrReader::fail_with(CdrFault fault) {
  if (fault_ == CdrFault::none) fault_ = fault;
  body_ = {};
  position_ = 0;
}

const std::byte* CdrReader::take(std::size_t size, std::size_t alignment) {
  const std::size_t skipped = padding(position_, alignment);
  // In this order because nothing may overflow: `size` can be anything up to 8 * 2^32.
  if (skipped > remaining() || size > remaining() - skipped) {
    fail_with(CdrFault::truncated);
    return nullptr;
  }
  const std::byte* at = body_.data() + position_ + skipped;
  position_ += skipped + size;
  return at;
}

std::string_view CdrReader::read_text() {
  const auto length = read<std::uint32_t>();  // the terminating zero included
  if (length == 0) return {};
  const std::byte* at = take(length, 1);
  if (at == nullptr) return {};
  if (at[length - 1] != std::byte{0}) {
    fail_with(CdrFault::text);
    return {};
  }
  return {reinterpret_cast<const char*>(at), length - 1};
}

DoubleSequenceView CdrReader::read_doubles() {
  const auto count = read<std::uint32_t>();
  if (count == 0) return {};  // no padding follows an empty sequence
  const std::byte* at = take(std::size_t{count} * sizeof(double), sizeof(double));
  return at == nullptr ? DoubleSequenceView{} : DoubleSequenceView{at, count, swapped_};
}

std::span<const std::uint8_t> CdrReader::read_bytes() {
  const auto count = read<std::uint32_t>();
  const std::byte* at = take(count, 1);
  return at == nullptr ? std::span<const std::uint8_t>()
                       : std::span(reinterpret_cast<const std::uint8_t*>(at), std::size_t{count});
}

void CdrReader::read_octets(std::span<std::uint8_t> out) {
  const std::byte* at = take(out.size(), 1);
  for (std::uint8_t& octet : out) octet = at == nullptr ? std::uint8_t{0} : std::to_integer<std::uint8_t>(*at++);
}

std::uint32_t CdrReader::read_count(std::size_t least_bytes, std::uint32_t most) {
  const auto count = read<std::uint32_t>();
  if (std::size_t{count} * least_bytes > remaining()) {
    fail_with(CdrFault::truncated);
    return 0;
  }
  if (count > most) {
    fail_with(CdrFault::too_many);
    return 0;
  }
  return count;
}

CdrWriter::CdrWriter(std::vector<std::byte>& out) : out_(out) {
  out_.clear();
  for (const int byte : {0, 1, 0, 0}) out_.push_back(static_cast<std::byte>(byte));  // CDR_LE, no options
}

void CdrWriter::align(std::size_t alignment) {
  out_.resize(out_.size() + padding(out_.size() - kEncapsulationSize, alignment));
}

void CdrWriter::fill_to(std::size_t bytes) {
  if (out_.size() < kEncapsulationSize + bytes) out_.resize(kEncapsulationSize + bytes);
}

void CdrWriter::write_text(std::string_view text) {
  text = text.substr(0, text.find('\0'));
  write_count(text.size() + 1);
  append(text.data(), text.size());
  out_.push_back(std::byte{0});
}

void CdrWriter::write_doubles(std::span<const double> values) {
  write_count(values.size());
  for (const double value : values) write(value);
}

}  // namespace cellmirror::dds
