#include "scripts/lang/reader.hpp"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "rt_core/base/text.hpp"
#include "rt_core/base/utf8.hpp"
#include "scripts/lang/command_table.hpp"
#include "scripts/lang/matcher.hpp"
#include "scripts/lang/values.hpp"

namespace cellmirror::script {

namespace {

std::string_view without_trailing_nuls(std::string_view text) {
  // C programs like to send the string's end with it.
  while (text.ends_with('\0')) text.remove_suffix(1);
  return text;
}

Position place_of(std::string_view text, std::size_t offset) {
  Position place{offset, 1, 1};
  for (std::size_t i = 0; i < offset; ++i) {
    ++place.column;
    if (text[i] == '\n') {
      ++place.line;
      place.column = 1;
    }
  }
  return place;
}

// The words that distinguish the forms of a command, at the position of the selecting parameter.
std::vector<std::string> selecting_words(std::span<const Form* const> forms, std::size_t position) {
  std::vector<std::string> words;
  for (const Form* form : forms) {
    const Parameter& parameter = form->parameters[position];
    if (parameter.kind == ParameterKind::word) words.emplace_back(parameter.name);
    for (const Choice& choice : parameter.choices) words.emplace_back(choice.word);
  }
  return words;
}

bool selects(const Parameter& parameter, std::string_view word) {
  if (parameter.kind == ParameterKind::word) return equal_ignoring_case(parameter.name, word);
  return choice_of(word, parameter.choices).has_value();
}

bool looks_like_number(std::string_view word) {
  const char c = word.empty() ? '\0' : word.front();
  return (c >= '0' && c <= '9') || c == '+' || c == '-';
}

// eladyn_geo_def has three forms, distinguished as defined in docs/script.md.
FormId geo_def_form(std::span<const Token> words) {
  constexpr std::size_t kWithFourValues = 6;
  if (words.size() >= 2 && !looks_like_number(words[1].text)) return FormId::eladyn_geo_def_token;
  if (words.size() < kWithFourValues) return FormId::eladyn_geo_def_flags;
  const std::string_view name = words[0].text;
  const bool object = equal_ignoring_case(name, "ALL") || name.ends_with(".mpo");
  return object ? FormId::eladyn_geo_def_flags : FormId::eladyn_geo_def_cylinders;
}

std::size_t selecting_position(Selector selector) {
  if (selector == Selector::by_third_word) return 2;
  return selector == Selector::by_second_word ? 1 : 0;
}

const Form* select_form(std::span<const Form* const> forms, std::span<const Token> words, const Position& end,
                        Findings& findings) {
  const Selector selector = forms.front()->selector;
  if (selector == Selector::only_form) return forms.front();
  if (selector == Selector::by_shape) return &form(geo_def_form(words));
  const std::size_t position = selecting_position(selector);
  if (words.size() > position) {
    for (const Form* candidate : forms) {
      if (selects(candidate->parameters[position], words[position].text)) return candidate;
    }
  }
  const std::vector<std::string> accepted = selecting_words(forms, position);
  std::string list;
  for (const std::string& word : accepted) list += (list.empty() ? "" : ", ") + word;
  if (words.size() <= position) {
    findings.error(end, fmt::format("one of {} is missing", list), "expected: " + std::string(forms.front()->syntax));
    return nullptr;
  }
  const std::string_view word = words[position].text;
  findings.error(words[position].begin, fmt::format("{} is not one of {}", printable(word), list),
                 did_you_mean(word, accepted));
  return nullptr;
}

void unknown_command(const Token& head, bool after_text, Findings& findings) {
  std::string remedy = after_text ? "in a file a ';' ends the text of hot_message: leave it out of the text"
                                  : did_you_mean(head.text, command_names());
  if (remedy.empty() && head.text.starts_with('#')) remedy = "a comment line has its # in column 1";
  if (remedy.empty()) remedy = "a comment line has a # in column 1; `cellmirror commands` lists all commands";
  findings.error(head.begin, fmt::format("there is no command {}", printable(head.text)), std::move(remedy));
}

// hot_message: the rest of the command, verbatim.
bool read_text(Lexer& lexer, TextKind kind, const Form& form, ParsedCommand& out, Findings& findings) {
  lexer.skip_blank();
  const Position begin = lexer.position();
  const std::string_view text = kind == TextKind::message ? lexer.rest_of_text() : lexer.rest_of_command();
  if (text.empty()) {
    findings.error(begin, "the text is missing", "expected: " + std::string(form.syntax));
    return false;
  }
  if (text.size() > kMaxCommandBytes) {
    findings.error(begin, fmt::format("the text has {} bytes, more than {}", text.size(), kMaxCommandBytes));
    return false;
  }
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if ((byte >= 0x20 || (byte >= '\t' && byte <= '\r')) && byte != 0x7f) continue;
    const Position at = place_of(lexer.text(), begin.offset + i);
    findings.error(at, fmt::format("the text contains the control byte {}", printable(text.substr(i, 1))));
    return false;
  }
  if (!is_utf8(text)) {
    findings.error(begin, "the text is not UTF-8");
    return false;
  }
  out.push(text, 0);
  out.set_given(0);
  return true;
}

}  // namespace

CommandReader::CommandReader(std::string_view text, std::string_view source, TextKind kind)
    : source_(source), kind_(kind), lexer_(kind == TextKind::message ? without_trailing_nuls(text) : text) {}

bool CommandReader::start(Diagnostics& diagnostics) {
  started_ = true;
  const std::string_view text = lexer_.text();
  if (text.size() > kMaxScriptBytes) {
    diagnostics.error({source_, 0, 0}, fmt::format("the text has {} bytes, more than {}", text.size(), kMaxScriptBytes),
                      "split it and call the parts with EXEC_SCRIPT");
    return false;
  }
  if (!text.empty()) {
    if (const void* nul = std::memchr(text.data(), '\0', text.size()); nul != nullptr) {
      const Position at = place_of(text, static_cast<std::size_t>(static_cast<const char*>(nul) - text.data()));
      diagnostics.error({source_, at.line, at.column}, "there is a NUL byte: this is not SCRIPT text");
      return false;
    }
  }
  if (kind_ == TextKind::file) lexer_.skip_file_header();
  return true;
}

CommandReader::Step CommandReader::next(const NameDirectory* names, ParsedCommand& out, Diagnostics& diagnostics) {
  if (!started_ && !start(diagnostics)) {
    finished_ = true;
    return Step::error;
  }
  if (finished_) return Step::end;
  lexer_.skip_blank();
  while (kind_ == TextKind::file && lexer_.at_terminator()) {  // an empty command
    lexer_.skip_terminator();
    lexer_.skip_blank();
  }
  Token head;
  if (!lexer_.word(head)) {
    finished_ = true;
    if (kind_ == TextKind::file && lexer_.trailing_commas() == 0) return Step::end;
    if (lexer_.at_end() && lexer_.passed_comment()) return Step::comment;
    const Position at = lexer_.position();
    diagnostics.error({source_, at.line, at.column}, "there is no command");
    return Step::error;
  }
  const Step step = read_command(head, names, out, diagnostics);
  return kind_ == TextKind::message ? finish_message(step, diagnostics) : step;
}

CommandReader::Step CommandReader::read_command(const Token& head, const NameDirectory* names, ParsedCommand& out,
                                                Diagnostics& diagnostics) {
  const std::span<const Form* const> forms = forms_of(head.text);
  if (forms.empty() || head.commas_before != 0) {
    Findings findings(diagnostics, source_, {});
    if (forms.empty()) {
      unknown_command(head, head.begin.line == text_end_line_, findings);
    } else {
      findings.error(head.begin, fmt::format("a comma before {} is not allowed here", printable(head.text)));
    }
    lexer_.skip_command();
    return Step::error;
  }
  Findings findings(diagnostics, source_, forms.front()->name);
  if (forms.front()->id == FormId::hot_message) {
    out.start(*forms.front(), head.begin);
    const bool fine = read_text(lexer_, kind_, *forms.front(), out, findings);
    lexer_.skip_command();
    text_end_line_ = lexer_.position().line;
    return fine ? Step::command : Step::error;
  }
  std::size_t count = 0;
  Token* word = words_.data();
  while (lexer_.word(*word)) {
    ++count;
    if (count == kMaxWords || word->begin.offset - head.begin.offset > kMaxCommandBytes) {
      findings.error(head.begin,
                     fmt::format("the command is longer than {} words or {} bytes", kMaxWords - 1, kMaxCommandBytes),
                     "is a ';' missing?");
      lexer_.skip_command();
      return Step::error;
    }
    ++word;
  }
  const Position end = lexer_.position();
  if (lexer_.trailing_commas() != 0) findings.error(end, "there is no value after the last comma");
  if (lexer_.at_terminator()) lexer_.skip_terminator();

  const std::span<const Token> given(words_.data(), count);
  const Form* form = select_form(forms, given, end, findings);
  if (form == nullptr) return Step::error;
  out.start(*form, head.begin);
  return Matcher(*form, given, end, names, name_check_, out, findings).match() ? Step::command : Step::error;
}

CommandReader::Step CommandReader::finish_message(Step step, Diagnostics& diagnostics) {
  finished_ = true;
  lexer_.skip_blank();
  if (lexer_.at_end() || step == Step::error) return step;
  const Position at = lexer_.position();
  diagnostics.error({source_, at.line, at.column}, "there is more text after the command",
                    "send one command per message");
  return Step::error;
}

}  // namespace cellmirror::script
