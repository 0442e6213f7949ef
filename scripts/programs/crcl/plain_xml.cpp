#include "scripts/programs/crcl/plain_xml.hpp"

#include <array>
#include <cstdint>

namespace cellmirror::crcl {
namespace {

// What a byte may be, as bits.
using Class = std::uint8_t;
constexpr Class kSpace = 1;
constexpr Class kText = 2;   // allowed in text; `]` is not, since `]]>` is an error there
constexpr Class kValue = 4;  // in the value of an attribute: no tabs and ends of lines, which become spaces there
constexpr Class kFirst = 8;  // begins a name
constexpr Class kName = 16;  // continues a name
constexpr Class kComment = 32;

constexpr std::array<Class, 256> classes() {
  std::array<Class, 256> out{};
  for (int c = 0x20; c < 0x7F; ++c) {
    const auto byte = static_cast<char>(c);
    Class& of = out[static_cast<std::size_t>(c)];
    of = kComment;
    if (byte != '<' && byte != '&' && byte != ']') of |= kText;
    if (byte != '<' && byte != '&') of |= kValue;
    const bool letter = (byte >= 'a' && byte <= 'z') || (byte >= 'A' && byte <= 'Z') || byte == '_';
    if (letter) of |= kFirst | kName;
    if ((byte >= '0' && byte <= '9') || byte == '-' || byte == '.' || byte == ':') of |= kName;
  }
  for (const char space : {' ', '\t', '\n', '\r'}) {
    out[static_cast<unsigned char>(space)] |= kSpace | kText | kComment;
  }
  return out;
}

constexpr std::array<Class, 256> kClasses = classes();

bool is(char c, Class which) { return (kClasses[static_cast<unsigned char>(c)] & which) != 0; }

std::string_view without_space(const char* begin, const char* end) {
  while (begin != end && is(*begin, kSpace)) ++begin;
  while (begin != end && is(end[-1], kSpace)) --end;
  return {begin, static_cast<std::size_t>(end - begin)};
}

class PlainReader {
 public:
  PlainReader(std::string_view text, const XmlVisitor& visitor)
      : visitor_(visitor),
        at_(text.data()),
        end_(text.data() + text.size()),
        line_begin_(at_),
        line_end_(end_of_line(at_)) {}

  PlainRead read() {
    skip_declaration();
    bool plain = true;
    while (plain && at_ != end_ && !unwanted_) plain = *at_ == '<' ? markup() : characters();
    visited_.complete = unwanted_ || (plain && closed_);
    return visited_;
  }

 private:
  struct Open {
    std::string_view name;  // with its prefix
    std::string_view text;  // what is not blank
    std::size_t bytes = 0;  // of text, blank or not
  };

  // Once: a second one is an error.
  void skip_declaration() {
    for (const std::string_view known : {R"(<?xml version="1.0"?>)", R"(<?xml version="1.0" encoding="UTF-8"?>)",
                                         R"(<?xml version="1.0" encoding="utf-8"?>)"}) {
      if (!rest().starts_with(known)) continue;
      at_ += known.size();
      return;
    }
  }

  [[nodiscard]] std::string_view rest() const { return {at_, static_cast<std::size_t>(end_ - at_)}; }

  bool characters() {
    const char* const begin = at_;
    while (at_ != end_ && is(*at_, kText)) ++at_;
    if (at_ == begin) return false;
    const std::string_view text = without_space(begin, at_);
    if (depth_ == 0) return text.empty();
    if (depth_ == 1) return true;
    Open& open = open_[depth_ - 1];
    open.bytes += static_cast<std::size_t>(at_ - begin);
    if (open.bytes > kLongestText) return false;
    if (text.empty()) return true;
    // Text in several parts is one text for expat, in which an end of line is \n.
    if (!open.text.empty() || text.find('\r') != std::string_view::npos) return false;
    open.text = text;
    return true;
  }

  bool markup() {
    if (end_ - at_ < 2) return false;
    if (at_[1] == '/') return end_tag();
    if (at_[1] == '!') return comment();
    return start_tag();
  }

  bool comment() {
    if (!rest().starts_with("<!--")) return false;
    const char* place = at_ + 4;
    for (; end_ - place >= 3; ++place) {
      if (!is(*place, kComment)) return false;
      if (place[0] != '-' || place[1] != '-') continue;
      at_ = place + 3;
      return place[2] == '>';
    }
    return false;
  }

  std::string_view name() {
    const char* const begin = at_;
    if (at_ == end_ || !is(*at_, kFirst)) return {};
    while (at_ != end_ && is(*at_, kName)) ++at_;
    return {begin, static_cast<std::size_t>(at_ - begin)};
  }

  void skip_space() {
    while (at_ != end_ && is(*at_, kSpace)) ++at_;
  }

  bool end_tag() {
    if (depth_ == 0) return false;
    at_ += 2;
    const Open& open = open_[depth_ - 1];
    if (!rest().starts_with(open.name)) return false;
    at_ += open.name.size();
    skip_space();
    return at_ != end_ && *at_++ == '>' && close();
  }

  bool start_tag() {
    const char* const begin = at_++;
    const std::string_view tag = name();
    std::string_view type;
    if (tag.empty() || !attributes(type)) return false;
    const bool empty = *at_ == '/';
    if (empty && (++at_ == end_ || *at_ != '>')) return false;
    ++at_;
    return open(begin, tag, type) && (!empty || close());
  }

  // Up to the end of the tag, which is there.
  bool attributes(std::string_view& type) {
    if (at_ != end_ && (*at_ == '>' || *at_ == '/')) return true;  // most have none
    constexpr std::size_t kMost = 8;
    std::array<std::string_view, kMost> names;
    for (std::size_t count = 0;; ++count) {
      const char* const before = at_;
      skip_space();
      if (at_ == end_) return false;
      if (*at_ == '>' || *at_ == '/') return true;
      if (count == kMost || at_ == before) return false;
      names[count] = name();
      for (std::size_t other = 0; other < count; ++other) {
        if (names[other] == names[count]) return false;  // an error
      }
      std::string_view value;
      if (names[count].empty() || !attribute_value(value)) return false;
      if (without_prefix(names[count]) == "type") type = without_prefix(value);
    }
  }

  bool attribute_value(std::string_view& value) {
    if (end_ - at_ < 2 || at_[0] != '=' || at_[1] != '"') return false;
    at_ += 2;
    const char* const begin = at_;
    while (at_ != end_ && *at_ != '"' && is(*at_, kValue)) ++at_;
    if (at_ == end_ || *at_ != '"') return false;
    value = {begin, static_cast<std::size_t>(at_++ - begin)};
    return true;
  }

  bool open(const char* begin, std::string_view tag, std::string_view type) {
    if (closed_ || depth_ == open_.size()) return false;
    open_[depth_++] = {.name = tag, .text = {}};
    const auto column = find_line(begin);
    if (depth_ == 1) {
      visited_.visited.root = true;
      unwanted_ =
          !visitor_.root({.name = without_prefix(tag), .type = {}, .text = {}, .line = line_, .column = column});
      return true;
    }
    if (depth_ == 2) tree_.clear();
    if (tree_.size() >= kMostNodes) return false;
    tree_.open(without_prefix(tag), type, line_, column);
    return true;
  }

  bool close() {
    const Open& open = open_[--depth_];
    closed_ = depth_ == 0;
    if (closed_) return true;
    tree_.close(open.text);
    if (depth_ == 1) {
      visitor_.element(tree_);
      ++visited_.visited.elements;
    }
    return true;
  }

  [[nodiscard]] const char* end_of_line(const char* begin) const {
    const std::size_t place = std::string_view(begin, static_cast<std::size_t>(end_ - begin)).find('\n');
    return place == std::string_view::npos ? end_ : begin + place;
  }

  // Counts the lines up to there; returns its column.
  std::uint32_t find_line(const char* place) {
    while (line_end_ < place) {
      ++line_;
      line_begin_ = line_end_ + 1;
      line_end_ = end_of_line(line_begin_);
    }
    return static_cast<std::uint32_t>(place - line_begin_) + 1;
  }

  const XmlVisitor& visitor_;
  const char* at_;
  const char* end_;
  const char* line_begin_;
  const char* line_end_;  // end_: there is no more
  std::uint32_t line_ = 1;
  std::array<Open, kMostDepth> open_;
  std::size_t depth_ = 0;
  bool closed_ = false;    // the root is
  bool unwanted_ = false;  // the rest
  XmlTree tree_;
  PlainRead visited_;
};

}  // namespace

PlainRead read_plain_xml(std::string_view text, const XmlVisitor& visitor) { return PlainReader(text, visitor).read(); }

}  // namespace cellmirror::crcl
