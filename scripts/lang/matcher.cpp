#include "scripts/lang/matcher.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "rt_core/base/text.hpp"
#include "scripts/lang/command_table.hpp"
#include "scripts/lang/values.hpp"

namespace cellmirror::script {

namespace {

Diagnostic finding(Severity severity, const std::string& source, std::string_view command, const Position& at,
                   std::string_view message, std::string remedy) {
  std::string text = command.empty() ? std::string(message) : fmt::format("{}: {}", command, message);
  return {severity, {source, at.line, at.column}, std::move(text), std::move(remedy)};
}

std::vector<std::string> words_of(std::span<const Choice> choices) {
  std::vector<std::string> words;
  for (const Choice& choice : choices) words.emplace_back(choice.word);
  return words;
}

}  // namespace

void Findings::error(const Position& at, std::string_view message, std::string remedy) {
  ok_ = false;
  diagnostics_.add(finding(Severity::error, source_, command_, at, message, std::move(remedy)));
}

void Findings::warning(const Position& at, std::string_view message, std::string remedy) {
  diagnostics_.add(finding(Severity::warning, source_, command_, at, message, std::move(remedy)));
}

bool Matcher::match() {
  check_commas();
  check_active_robot();
  for (std::size_t i = 0; i < form_.parameters.size(); ++i) {
    if (form_.parameters[i].label.empty()) {
      if (!match_parameter(i)) return false;
    } else {
      i = match_labelled(i) - 1;
    }
  }
  if (next_ < words_.size()) surplus(words_[next_]);
  if (findings_.ok()) check_dependencies();
  return findings_.ok();
}

bool Matcher::match_parameter(std::size_t index) {
  const Parameter& parameter = form_.parameters[index];
  switch (parameter.kind) {
    case ParameterKind::word:
      return match_word(parameter);
    case ParameterKind::joint_list:
      match_joint_list(parameter);
      return true;
    case ParameterKind::number_list:
      match_number_list(parameter);
      return true;
    case ParameterKind::slaves:
      match_slaves();
      return true;
    default:
      break;
  }
  if (next_ == words_.size()) {
    if (parameter.optional) return true;
    missing(parameter);
    return false;
  }
  out_.set_given(index);
  match_single(parameter, words_[next_++]);
  return true;
}

bool Matcher::match_word(const Parameter& parameter) {
  if (next_ == words_.size()) {
    missing(parameter);
    return false;
  }
  const Token& word = words_[next_];
  if (!equal_ignoring_case(word.text, parameter.name)) {
    findings_.error(word.begin, fmt::format("{} is given instead of {}", printable(word.text), parameter.name),
                    expected());
    return false;
  }
  ++next_;
  return true;
}

void Matcher::match_single(const Parameter& parameter, const Token& word) {
  double number = 0;
  switch (parameter.kind) {
    case ParameterKind::name:
      check_name(parameter, word);
      break;
    case ParameterKind::identifier:
      check_text(word, parameter.meaning, kMaxFramePath);
      break;
    case ParameterKind::file:
      check_text(word, parameter.meaning, kMaxFramePath);
      break;
    case ParameterKind::choice:
      if (const auto index = choice_of(word.text, parameter.choices)) {
        number = static_cast<double>(*index);
      } else {
        no_choice(parameter.meaning, word, words_of(parameter.choices));
      }
      break;
    default:
      number = value_of(parameter, word,
                        parameter.unit == Unit::by_effector_joint ? effector_joint_kind() : JointKind::revolute);
      break;
  }
  out_.push(word.text, number);
}

std::size_t Matcher::match_labelled(std::size_t first) {
  std::array<std::size_t, kMaxParameters> slots{};
  CELLMIRROR_EXPECTS(form_.parameters.size() <= kMaxParameters);
  std::size_t behind = first;
  while (behind < form_.parameters.size() && !form_.parameters[behind].label.empty()) ++behind;
  const std::span<const Parameter> parameters = form_.parameters.first(behind);
  for (std::size_t i = first; i < parameters.size(); ++i) {
    slots[i] = out_.size();
    for (std::size_t k = 0; k < parameters[i].width; ++k) out_.push({}, 0.0);
  }
  bool any = false;
  while (next_ < words_.size()) {
    const Token& label = words_[next_];
    std::size_t index = first;
    while (index < parameters.size() && !equal_ignoring_case(label.text, parameters[index].label)) ++index;
    if (index == parameters.size()) {
      // As many words as may stand behind the groups; with more of them it is a wrong label.
      if (words_.size() - next_ <= form_.parameters.size() - behind) break;
      surplus(label);
      next_ = words_.size();
      return behind;
    }
    ++next_;
    any = true;
    match_group(index, label, slots[index]);
  }
  for (std::size_t i = first; i < parameters.size(); ++i) {
    if (!parameters[i].optional && !out_.given(i))
      findings_.error(end_, fmt::format("{} <{}> is missing", parameters[i].label, parameters[i].name), expected());
  }
  if (form_.at_least_one && !any) findings_.error(end_, "at least one group must be given", expected());
  return behind;
}

void Matcher::match_group(std::size_t index, const Token& label, std::size_t slot) {
  const Parameter& parameter = form_.parameters[index];
  if (out_.given(index)) findings_.error(label.begin, fmt::format("{} is given twice", parameter.label));
  for (std::size_t i = 0; i < form_.parameters.size(); ++i) {
    const Parameter& other = form_.parameters[i];
    if (i != index && parameter.alternatives != 0 && other.alternatives == parameter.alternatives && out_.given(i))
      findings_.error(label.begin, fmt::format("{} and {} exclude each other", other.label, parameter.label));
  }
  out_.set_given(index);
  for (std::size_t k = 0; k < parameter.width; ++k) {
    if (next_ == words_.size()) {
      findings_.error(end_,
                      fmt::format("{} needs {} value{}, {} given", parameter.label, parameter.width,
                                  parameter.width == 1 ? "" : "s", k),
                      expected());
      return;
    }
    const Token& word = words_[next_++];
    out_.slot(slot + k) = Value{word.text, value_of(parameter, word, JointKind::revolute)};
  }
}

void Matcher::match_joint_list(const Parameter& parameter) {
  const std::size_t given = words_.size() - next_;
  if (given == 0) {
    missing(parameter);
    return;
  }
  const std::span<const JointKind> kinds = joint_kinds();
  const std::size_t most = kinds.empty() ? kMaxJointsPerRobot : kinds.size();
  if (!check_joint_count(parameter, given, kinds.size(), robot_concerned())) {
    next_ = words_.size();
    if (given > most) return;
  }
  if (kinds.empty()) out_.set_unconverted();
  for (std::size_t i = words_.size() - given; i < words_.size(); ++i) {
    const std::size_t joint = i - (words_.size() - given);
    const JointKind kind = kinds.empty() ? JointKind::revolute : kinds[joint];
    Parameter raw = parameter;
    if (kinds.empty()) raw.unit = Unit::none;
    out_.push(words_[i].text, value_of(raw, words_[i], kind));
  }
  next_ = words_.size();
}

bool Matcher::check_joint_count(const Parameter& parameter, std::size_t given, std::size_t joints,
                                std::string_view robot) {
  const std::size_t most = joints == 0 ? kMaxJointsPerRobot : joints;
  const Position first = words_[next_].begin;
  if (given > most) {
    const Token& extra = words_[next_ + most];
    const bool forgotten = extra.first_in_line && !forms_of(extra.text).empty();
    if (forgotten) {
      surplus(extra);
    } else if (joints == 0) {
      findings_.error(extra.begin, fmt::format("{} values given, a robot has at most {} joints", given, most));
    } else {
      findings_.error(extra.begin, fmt::format("{} values given, but {} has {} joints", given, robot, joints),
                      expected());
    }
    return false;
  }
  if (parameter.exact_count && joints != 0 && given < joints) {
    findings_.error(first, fmt::format("{} values given, but {} has {} joints", given, robot, joints),
                    "give one value for each joint");
    return false;
  }
  return true;
}

void Matcher::match_number_list(const Parameter& parameter) {
  for (std::size_t n = 0; next_ < words_.size() && n < parameter.width; ++n) {
    const Token& word = words_[next_++];
    out_.push(word.text, value_of(parameter, word, JointKind::revolute));
  }
}

double Matcher::value_of(const Parameter& parameter, const Token& word, JointKind kind) {
  const bool integer = parameter.kind == ParameterKind::integer;
  const std::optional<double> value = integer ? integer_of(word) : number_of(word);
  if (!value) {
    if (word.first_in_line && !forms_of(word.text).empty()) {
      surplus(word);
    } else {
      findings_.error(word.begin,
                      fmt::format("{} {} {}", parameter.meaning, printable(word.text), why_no_number(word, integer)),
                      expected());
    }
    return 0;
  }
  const Unit unit = unit_of(parameter);
  const Range range = range_of(parameter);
  if (!range.holds(*value)) {
    const std::string allowed = range_text(range, unit);
    const bool from_to = allowed.find("..") != std::string::npos;
    findings_.error(
        word.begin,
        fmt::format("{} {} is not {}{}", parameter.meaning, printable(word.text), from_to ? "in " : "", allowed),
        expected());
    return 0;
  }
  return to_si(*value, unit, kind);
}

void Matcher::missing(const Parameter& parameter) {
  if (parameter.kind == ParameterKind::word) {
    findings_.error(end_, fmt::format("{} is missing", parameter.name), expected());
  } else {
    findings_.error(end_, fmt::format("the {} <{}> is missing", parameter.meaning, parameter.name), expected());
  }
}

void Matcher::surplus(const Token& word) {
  if (word.first_in_line && !forms_of(word.text).empty()) {
    findings_.error(word.begin, fmt::format("{} is within the command", printable(word.text)),
                    "end the command before it with ';'");
  } else {
    findings_.error(word.begin, fmt::format("{} is a surplus word", printable(word.text)), expected());
  }
}

void Matcher::no_choice(std::string_view meaning, const Token& word, std::span<const std::string> accepted) {
  std::string list;
  for (const std::string& choice : accepted) list += (list.empty() ? "" : ", ") + choice;
  std::string remedy = did_you_mean(word.text, accepted);
  if (remedy.empty()) remedy = expected();
  findings_.error(word.begin, fmt::format("{} {} is not one of {}", meaning, printable(word.text), list),
                  std::move(remedy));
}

}  // namespace cellmirror::script
