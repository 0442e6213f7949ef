#include "scripts/programs/jet/teach_parser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/text.hpp"
#include "scripts/programs/jet/teach_lines.hpp"
#include "scripts/programs/jet/teach_names.hpp"
#include "scripts/programs/jet/teach_program.hpp"
#include "scripts/programs/jet/teach_words.hpp"
#include "scripts/programs/program/script_comment.hpp"

namespace cellmirror::program {

namespace {

using PointName = std::optional<TeachWord>;  // none: invalid, and reported
using JointsGiven = std::array<bool, kMaxJointsPerRobot>;

class TeachParser {
 public:
  TeachParser(TeachDialect dialect, std::string_view text, const ParseContext& context, Diagnostics& diagnostics)
      : text_(text),
        file_(context.file),
        diagnostics_(diagnostics),
        dialect_(dialect),
        lines_(text),
        program_(dialect, file_),
        read_part_(context.read_part) {}

  std::shared_ptr<const Program> parse();

 private:
  struct Keyword {
    std::string_view word;
    void (TeachParser::*read)(TeachWords& words);
  };
  static const std::array<Keyword, 10> kKeywords;

  void error(int column, std::string message, std::string remedy = {}) {
    diagnostics_.error({file_, lines_.number(), column}, std::move(message), std::move(remedy));
  }
  void expect(const Result<void>& done) {
    if (!done) error(column_, done.error().what, done.error().remedy);
  }
  bool read_line(TeachLines::Line kind);
  void header(TeachWords& words);
  void statement(TeachWords& words);
  void script();
  void finish();

  void point(TeachWords& words);
  void name(TeachWords& words);
  void joints(TeachWords& words);
  void setting(TeachWords& words);
  void dwell(TeachWords& words);
  void hold(TeachWords& words);
  void output(TeachWords& words);
  void end(TeachWords& words);

  bool all_values(TeachWords& words, const PointName& point);
  bool named_values(TeachWords& words, const PointName& point);
  bool named_value(TeachWords& words, JointsGiven& given);
  void new_point_name(const TeachWord& word);

  std::string_view text_;
  std::string file_;
  Diagnostics& diagnostics_;
  TeachDialect dialect_;
  TeachLines lines_;
  TeachProgram program_;
  std::shared_ptr<const Program>* read_part_;
  int column_ = 1;  // of the statement
  TeachSettings settings_;
  JointPosition target_;  // of the newest check point
  bool named_ = false;
  bool header_read_ = false;
  bool ended_ = false;
  bool any_point_ = false;
  bool told_of_joints_ = false;
  int joints_line_ = 0;          // 0: JOINTS has not been read
  std::size_t joint_count_ = 0;  // 0: not known, because of a fault
  TeachNames points_;
};

// In the order of how often they occur.
const std::array<TeachParser::Keyword, 10> TeachParser::kKeywords{{
    {"POINT", &TeachParser::point},
    {"SPEED", &TeachParser::setting},
    {"TOLERANCE", &TeachParser::setting},
    {"ACCELERATION", &TeachParser::setting},
    {"DWELL", &TeachParser::dwell},
    {"OUTPUT", &TeachParser::output},
    {"HOLD", &TeachParser::hold},
    {"NAME", &TeachParser::name},
    {"JOINTS", &TeachParser::joints},
    {"END", &TeachParser::end},
}};

std::shared_ptr<const Program> TeachParser::parse() {
  if (text_.size() > kLargestProgramText) {
    diagnostics_.error({file_},
                       fmt::format("the program has {} bytes, more than {}", text_.size(), kLargestProgramText),
                       "divide it into several programs and run them with exec_wait");
    return nullptr;
  }
  program_.reserve(static_cast<std::size_t>(std::count(text_.begin(), text_.end(), '\n')));
  while (read_line(lines_.next())) {
  }
  finish();
  return program_.build(diagnostics_, read_part_);
}

// False where nothing more is to be read.
bool TeachParser::read_line(TeachLines::Line kind) {
  switch (kind) {
    case TeachLines::Line::end:
      return false;
    case TeachLines::Line::too_long:
      error(0, fmt::format("the line has more than {} bytes", kLongestTeachLine));
      return true;
    case TeachLines::Line::too_many:
      error(lines_.column(), fmt::format("the line has more than {} words", TeachLines::kMostWords));
      return true;
    case TeachLines::Line::unwritten:
      error(lines_.column(), "the text contains a control character", "teach files are plain text");
      return true;
    case TeachLines::Line::script:
    case TeachLines::Line::words:
      break;
  }
  const int column = kind == TeachLines::Line::words ? lines_.words().front().column : lines_.column();
  if (ended_) {
    error(column, "there is text after END", "END is the last line of a teach file");
    return false;
  }
  if (program_.full()) {
    error(column, fmt::format("the program has more than {} statements", kMostStatements));
    return false;
  }
  column_ = column;
  program_.at(lines_.number(), column);
  if (kind == TeachLines::Line::script) {
    script();
    return true;
  }
  TeachWords words(lines_.words(), lines_.number(), file_, diagnostics_);
  if (header_read_) {
    statement(words);
  } else {
    header(words);
  }
  return true;
}

void TeachParser::header(TeachWords& words) {
  header_read_ = true;
  const bool boom = words.peek_is(header_of(TeachDialect::boom));
  if (!boom && !words.peek_is(header_of(TeachDialect::tarm))) {
    words.error(words.peek(), fmt::format("the program does not begin with its header"),
                fmt::format("the first line is: {} {}", header_of(dialect_), kTeachVersion));
    return statement(words);
  }
  const TeachDialect found = boom ? TeachDialect::boom : TeachDialect::tarm;
  if (found != dialect_) {
    words.error(words.peek(),
                fmt::format("this is a {} program, but the language is {}", language_of(found), language_of(dialect_)),
                fmt::format("ROBOT_LANGUAGE {}", language_of(found)));
    dialect_ = found;
  }
  const TeachWord& keyword = words.take();
  if (words.at_end() || parse_integer(words.peek().text) != kTeachVersion) {
    words.error(words.at_end() ? keyword : words.peek(),
                fmt::format("the version after {} is not {}", header_of(found), kTeachVersion));
    return words.skip_rest();
  }
  words.take();
  words.expect_end();
}

void TeachParser::statement(TeachWords& words) {
  for (const Keyword& keyword : kKeywords) {
    if (!words.peek_is(keyword.word)) continue;
    (this->*keyword.read)(words);
    return words.expect_end();
  }
  std::vector<std::string> known;
  for (const Keyword& keyword : kKeywords) known.emplace_back(keyword.word);
  words.error(words.peek(), fmt::format("there is no statement {}", printable(words.peek().text)),
              did_you_mean(words.peek().text, known));
}

void TeachParser::script() {
  if (!header_read_) {
    header_read_ = true;
    error(lines_.column(), "the program does not begin with its header",
          fmt::format("the first line is: {} {}", header_of(dialect_), kTeachVersion));
  }
  const std::string_view command = script_command(lines_.script().text);
  if (command.empty()) return error(lines_.column(), "there is no SCRIPT command after %");
  const std::size_t semicolon = command.find(';');
  if (semicolon != std::string_view::npos)
    return error(lines_.script().column + static_cast<int>(semicolon), "there is more than one SCRIPT command after %",
                 "one command per line");
  expect(program_.script(command));
}

void TeachParser::finish() {
  if (!header_read_) {
    diagnostics_.error({file_}, "there is nothing in the program",
                       fmt::format("the first line is: {} {}", header_of(dialect_), kTeachVersion));
    return;
  }
  if (!ended_ && !program_.full())
    diagnostics_.error({file_, lines_.number()}, "END is missing",
                       "the file is truncated, or its last line must be: END");
  if (joints_line_ == 0 && !told_of_joints_)
    diagnostics_.error({file_}, "JOINTS is missing", "the number of values of a check point: JOINTS 6");
  if (!any_point_) diagnostics_.error({file_}, "there is no check point", "for example: POINT P1 0 90 0");
}

void TeachParser::name(TeachWords& words) {
  const TeachWord& keyword = words.take();
  const auto name = words.name("program");
  if (named_) return words.error(keyword, "NAME is given a second time");
  if (any_point_) return words.error(keyword, "NAME comes after a check point", "it belongs to the header");
  named_ = true;
  if (name) program_.rename(name->text);
}

void TeachParser::joints(TeachWords& words) {
  const TeachWord& keyword = words.take();
  const auto count = words.integer("JOINTS", 1, static_cast<long long>(kMaxJointsPerRobot));
  if (joints_line_ != 0)
    return words.error(keyword, fmt::format("JOINTS is given a second time, after line {}", joints_line_));
  joints_line_ = lines_.number();
  if (any_point_ && !told_of_joints_) words.error(keyword, "JOINTS comes after a check point");
  if (count) joint_count_ = static_cast<std::size_t>(*count);
}

void TeachParser::setting(TeachWords& words) { static_cast<void>(words.setting(settings_)); }

void TeachParser::dwell(TeachWords& words) {
  words.take();
  if (const auto seconds = words.number("DWELL", 0, kLongestTeachDwell)) expect(program_.dwell(*seconds));
}

void TeachParser::hold(TeachWords& words) {
  words.take();
  expect(program_.hold());
}

void TeachParser::output(TeachWords& words) {
  words.take();
  const auto number = words.integer("OUTPUT", 1, static_cast<long long>(kMostPorts));
  const auto on = words.on_or_off("OUTPUT");
  if (number && on) expect(program_.output(static_cast<std::uint16_t>(*number), *on));
}

void TeachParser::end(TeachWords& words) {
  words.take();
  ended_ = true;
}

void TeachParser::point(TeachWords& words) {
  const TeachWord keyword = words.take();
  const PointName name = words.name("check point");
  if (name) new_point_name(*name);
  if (joints_line_ == 0 && !told_of_joints_) {
    told_of_joints_ = true;
    words.error(keyword, "JOINTS must come before the first check point",
                "the number of values of a check point: JOINTS 6");
  }
  TeachSettings settings = settings_;
  const bool values = dialect_ == TeachDialect::boom ? all_values(words, name) : named_values(words, name);
  while (words.setting(settings)) {
  }
  any_point_ = true;
  if (name && values) expect(program_.point(name->text, target_, settings));
}

void TeachParser::new_point_name(const TeachWord& word) {
  const int known = points_.note(word.text, lines_.number());
  if (known != 0) error(word.column, fmt::format("check point {} exists already, in line {}", word.text, known));
}

bool is_setting(const TeachWords& words) {
  return words.peek_is("SPEED") || words.peek_is("ACCELERATION") || words.peek_is("TOLERANCE");
}

bool begins_number(std::string_view word) { return word.find_first_of("0123456789+-.") == 0; }

// The rest is ambiguous.
void no_value(TeachWords& words) {
  static const std::array<std::string, 3> settings{"SPEED", "ACCELERATION", "TOLERANCE"};
  const std::string_view word = words.peek().text;
  words.error(words.peek(), fmt::format("{} is neither the value of a joint nor a setting", printable(word)),
              did_you_mean(word, settings));
  words.skip_rest();
}

// One value a joint. False, and a finding, where they are not in order.
bool TeachParser::all_values(TeachWords& words, const PointName& point) {
  bool good = true;
  std::size_t count = 0;
  while (!words.at_end() && !is_setting(words)) {
    if (!begins_number(words.peek().text)) {
      no_value(words);
      return false;
    }
    const auto value = words.number("the joint value", -kGreatestTeachValue, kGreatestTeachValue);
    good = good && value;
    if (value && count < target_.values.size()) target_.values[count] = *value;
    ++count;
  }
  if (point && joint_count_ != 0 && count != joint_count_) {
    words.error(*point,
                fmt::format("check point {} has {} values, but JOINTS is {}", point->text, count, joint_count_));
    return false;
  }
  target_.count = static_cast<std::uint8_t>(joint_count_);
  return good && joint_count_ > 0;
}

// "J3=250", in any order. The first check point has to name every joint.
bool TeachParser::named_values(TeachWords& words, const PointName& point) {
  bool good = true;
  JointsGiven given{};
  while (!words.at_end() && !is_setting(words)) good = named_value(words, given) && good;
  if (point && good && !any_point_) {
    std::string missing;
    for (std::size_t i = 0; i < joint_count_; ++i)
      if (!given[i]) missing += fmt::format("{}J{}", missing.empty() ? "" : ", ", i + 1);
    if (!missing.empty()) {
      words.error(*point, fmt::format("the first check point omits {}", missing), "it must name every joint");
      return false;
    }
  }
  target_.count = static_cast<std::uint8_t>(joint_count_);
  return good && joint_count_ > 0;
}

bool TeachParser::named_value(TeachWords& words, JointsGiven& given) {
  if (words.peek().text.find('=') == std::string_view::npos && !begins_number(words.peek().text)) {
    no_value(words);
    return false;
  }
  const TeachWord& word = words.take();
  const std::size_t sign = word.text.find('=');
  const std::string_view joint = word.text.substr(0, sign);
  const auto number = joint.size() > 1 && (joint[0] == 'J' || joint[0] == 'j') && joint[1] >= '0' && joint[1] <= '9'
                          ? parse_integer(joint.substr(1))
                          : std::nullopt;
  if (sign == std::string_view::npos || !number) {
    words.error(word, fmt::format("{} is not a value of a joint", printable(word.text)),
                "the joint's number and its value without blanks: J3=250");
    return false;
  }
  const std::size_t count = joint_count_ == 0 ? given.size() : joint_count_;
  if (*number < 1 || static_cast<std::size_t>(*number) > count) {
    words.error(word, fmt::format("{} is not one of the {} joints", printable(joint), count));
    return false;
  }
  const auto index = static_cast<std::size_t>(*number - 1);
  if (given[index]) {
    words.error(word, fmt::format("{} has a value already", printable(joint)));
    return false;
  }
  given[index] = true;
  const std::string_view text = word.text.substr(sign + 1);
  const auto value = parse_number(text);
  if (!value || *value < -kGreatestTeachValue || *value > kGreatestTeachValue) {
    words.error({text, word.column + static_cast<int>(sign) + 1},
                value ? fmt::format("{} is not within {} .. {}", text, -kGreatestTeachValue, kGreatestTeachValue)
                : text.empty() ? fmt::format("{} has no value", printable(joint))
                               : fmt::format("{} is not a number", printable(text)));
    return false;
  }
  target_.values[index] = *value;
  return true;
}

}  // namespace

std::shared_ptr<const Program> parse_teach_file(TeachDialect dialect, std::string_view text,
                                                const ParseContext& context, Diagnostics& diagnostics) {
  return TeachParser(dialect, text, context, diagnostics).parse();
}

}  // namespace cellmirror::program
