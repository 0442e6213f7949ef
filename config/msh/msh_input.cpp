#include "config/msh/msh_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "rt_core/base/text.hpp"

namespace cellmirror::msh {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v'; }

}  // namespace

Place Input::place(std::size_t at) const {
  if (binary_) return {file_, 0, 0};
  const std::string_view before = bytes_.substr(0, std::min(at, bytes_.size()));
  const std::size_t line_begin = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
  return {file_, static_cast<int>(std::ranges::count(before, '\n')) + 1,
          static_cast<int>(before.size() - line_begin) + 1};
}

std::string Input::with_byte(std::size_t at, std::string what) const {
  return binary_ ? fmt::format("at byte {}: {}", at, what) : std::move(what);
}

void Input::error(std::size_t at, std::string what, std::string remedy) {
  diagnostics_.error(place(at), with_byte(at, std::move(what)), std::move(remedy));
}

void Input::refuse(std::size_t at, std::string what, std::string remedy) {
  if (failed_) return;
  failed_ = true;
  error(at, std::move(what), std::move(remedy));
}

std::string Input::ended(const char* what) const { return fmt::format("the file ends where {} is expected", what); }

std::size_t Input::next() {
  while (offset_ < bytes_.size() && is_blank(bytes_[offset_])) ++offset_;
  return offset_;
}

std::string_view Input::word() {
  if (failed_) return {};
  const std::size_t begin = next();
  while (offset_ < bytes_.size() && !is_blank(bytes_[offset_])) ++offset_;
  return bytes_.substr(begin, offset_ - begin);
}

std::string_view Input::line() {
  if (failed_) return {};
  const std::size_t begin = offset_;
  const std::size_t end = std::min(bytes_.find('\n', begin), bytes_.size());
  offset_ = std::min(end + 1, bytes_.size());
  return trimmed(bytes_.substr(begin, end - begin));
}

double Input::number(const char* what) {
  const std::string_view text = word();
  if (failed_) return 0;
  const std::size_t at = offset_ - text.size();
  if (text.empty()) {
    refuse(at, ended(what));
    return 0;
  }
  const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
  double value = 0;
  const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (fault == std::errc::result_out_of_range && end == digits.data() + digits.size()) {
    // Too small is zero; too large is found by the check that it is finite.
    return digits.find("e-") != std::string_view::npos || digits.find("E-") != std::string_view::npos ? 0.0 : HUGE_VAL;
  }
  if (fault != std::errc{} || end != digits.data() + digits.size()) {
    refuse(at, fmt::format("\"{}\" is not a number, but {} is expected", printable(text), what));
    return 0;
  }
  return value;
}

std::int64_t Input::integer(const char* what) {
  const std::string_view text = word();
  if (failed_) return 0;
  const std::size_t at = offset_ - text.size();
  if (text.empty()) {
    refuse(at, ended(what));
    return 0;
  }
  std::int64_t value = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc{} || end != text.data() + text.size())
    refuse(at, fmt::format("\"{}\" is not an integer, but {} is expected", printable(text), what));
  return failed_ ? 0 : value;
}

void Input::skip(std::size_t count, const char* what) {
  if (failed_) return;
  if (left() < count) return refuse(offset_, ended(what));
  offset_ += count;
}

std::size_t Input::checked_count(std::int64_t count, std::size_t at, std::size_t least_bytes, std::size_t most,
                                 const char* what) {
  if (failed_) return 0;
  if (count < 0) {
    refuse(at, fmt::format("the number of {} is {}", what, count), "export the mesh again");
    return 0;
  }
  if (static_cast<std::uint64_t>(count) > most) {
    refuse(at, fmt::format("there are {} {}, more than {}", count, what, most), "make a coarser mesh");
    return 0;
  }
  if (static_cast<std::uint64_t>(count) > left() / least_bytes) {
    refuse(at, fmt::format("there are to be {} {}, more than the rest of the file can hold", count, what),
           "the file is cut off or damaged: export the mesh again");
    return 0;
  }
  return static_cast<std::size_t>(count);
}

bool Input::skip_behind(std::string_view text) {
  if (failed_) return false;
  std::size_t from = offset_;
  while (true) {
    const std::size_t at = bytes_.find(text, from);
    if (at == std::string_view::npos) return false;
    const std::size_t end = at + text.size();
    const bool begins_line = at == 0 || bytes_[at - 1] == '\n';
    if (begins_line && (end == bytes_.size() || is_blank(bytes_[end]))) {
      offset_ = end;
      return true;
    }
    from = end;
  }
}

void Input::expect(std::string_view text) {
  if (failed_) return;
  const std::string_view found = word();
  if (found == text) return;
  const std::size_t at = offset_ - found.size();
  if (found.empty()) return refuse(at, fmt::format("the file ends where {} is expected", text));
  refuse(at, fmt::format("{} is expected, but \"{}\" is found", text, printable(found, 40)),
         "the section has another number of items than it says: export the mesh again");
}

}  // namespace cellmirror::msh
