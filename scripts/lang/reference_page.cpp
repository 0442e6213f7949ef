// docs/script-reference.md, generated from the table; a test compares the committed page with it.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "scripts/lang/help.hpp"
#include "scripts/lang/values.hpp"

namespace cellmirror::script {

namespace {

std::string_view section_title(std::string_view section) {
  if (section == "1.2.1") return "1.2.1 General";
  if (section == "1.2.2") return "1.2.2 Robot parameters";
  if (section == "1.2.3") return "1.2.3 Animation";
  if (section == "1.2.4") return "1.2.4 Multibody dynamics";
  if (section == "1.2.5") return "1.2.5 Elastodynamic objects";
  if (section == "1.2.6") return "1.2.6 Deformable object control and I/O channels";
  if (section == "1.2.7") return "1.2.7 Voxel volumes";
  return "Commands of ours";
}

// Longer lists of words have one line for each.
constexpr std::size_t kChoicesOnALine = 5;
// A row of as many forms is listed once, at the head of the page.
constexpr int kFormsOfACommonRow = 3;

// Words with a meaning of their own; those of plain switches explain themselves.
bool explained(const Choice& choice) {
  return !choice.meaning.empty() && choice.meaning != choice.word && choice.meaning != "on" && choice.meaning != "off";
}

std::string choices_text(const Parameter& parameter) {
  if (parameter.meaning.find("(table ") != std::string_view::npos) return "";  // at the end of the page
  const bool one_a_line =
      parameter.choices.size() > kChoicesOnALine && std::ranges::any_of(parameter.choices, explained);
  std::string out;
  for (const Choice& choice : parameter.choices) {
    out += one_a_line ? "\n  - " : out.empty() ? "" : ", ";
    out += fmt::format("`{}`", choice.word);
    if (!choice.meaning.empty() && choice.meaning != choice.word) out += fmt::format(" {}", choice.meaning);
  }
  return out;
}

// The page says at its head that numbers without a range are any.
std::string number_text(const Parameter& parameter) {
  const std::string_view any = "any number";
  const std::string_view unit = unit_text(parameter.unit);
  std::string range = range_text(parameter.range, Unit::none);
  if (range == any) return std::string(unit.empty() ? any : unit);
  if (unit.empty()) return range;
  return range + (unit.find(' ') == std::string_view::npos ? " " : ", ") + std::string(unit);
}

std::string values_text(const Parameter& parameter) {
  switch (parameter.kind) {
    case ParameterKind::choice:
      return choices_text(parameter);
    case ParameterKind::name:
    case ParameterKind::identifier:
    case ParameterKind::file:
    case ParameterKind::text:
      return "";  // the meaning says what is named
    case ParameterKind::integer:
      return "whole number, " + number_text(parameter);
    case ParameterKind::number_list:
      return fmt::format("0 to {} numbers", parameter.width);
    case ParameterKind::slaves:
      return "for each slave: name, number of joints, pairs of joints";
    default:
      return (parameter.width > 1 ? fmt::format("{} numbers, ", parameter.width) : "") + number_text(parameter);
  }
}

struct Row {
  std::string names;
  std::string text;

  bool operator==(const Row&) const = default;
};

// Words behind a colon, numbers behind a comma.
Row row_of(const Parameter& parameter) {
  std::string text = parameter.meaning == parameter.name ? "" : std::string(parameter.meaning);
  const auto add = [&text](std::string_view separator, std::string_view part) {
    if (part.empty()) return;
    if (!text.empty()) text += separator;
    text += part;
  };
  const std::string values = values_text(parameter);
  const bool words = parameter.kind == ParameterKind::choice;
  if (!words) add(", ", values);
  if (parameter.optional) add(", ", "optional");
  if (!parameter.default_text.empty()) add(", ", fmt::format("default {}", parameter.default_text));
  if (words) add(values.starts_with('\n') ? ":" : ": ", values);
  const std::string label = parameter.label.empty() ? "" : std::string(parameter.label) + " ";
  return {fmt::format("`{}{}`", label, parameter.name), text};
}

// on or off, online or offline: the sentence about the form says of what.
bool is_plain_switch(const Parameter& parameter) {
  const auto in_words = [](const Choice& choice) {
    return !explained(choice) && (choice.word[0] < '0' || choice.word[0] > '9');
  };
  return parameter.kind == ParameterKind::choice && parameter.choices.size() == 2 &&
         std::ranges::all_of(parameter.choices, in_words);
}

std::vector<Row> rows_of(const Form& form) {
  std::vector<Row> rows;
  for (const Parameter& parameter : form.parameters)
    if (parameter.kind != ParameterKind::word && !is_plain_switch(parameter)) rows.push_back(row_of(parameter));
  return rows;
}

// An example of the command and one value shows no more than the syntax, unless the value is a name.
bool shows_more_than_the_syntax(const Form& form) {
  if (form.example.empty() || form.parameters.empty()) return false;
  return std::ranges::count(form.example, ' ') > 1 || form.parameters[0].kind == ParameterKind::name;
}

// Rows of several forms are listed once, at the head of the page.
const std::vector<Row>& common_rows() {
  static const std::vector<Row> common = [] {
    std::vector<std::pair<Row, int>> counted;
    for (const Form* form : forms()) {
      for (const Row& row : rows_of(*form)) {
        const auto found = std::ranges::find(counted, row, &std::pair<Row, int>::first);
        if (found == counted.end()) {
          counted.emplace_back(row, 1);
        } else {
          ++found->second;
        }
      }
    }
    std::vector<Row> often;
    for (auto& [row, count] : counted)
      if (count >= kFormsOfACommonRow) often.push_back(std::move(row));
    return often;
  }();
  return common;
}

bool is_common(const Row& row) { return std::ranges::find(common_rows(), row) != common_rows().end(); }

std::string as_list(const std::vector<Row>& rows) {
  std::string out;
  for (std::size_t i = 0; i < rows.size();) {
    std::string names = rows[i].names;
    std::size_t next = i + 1;
    for (; next < rows.size() && rows[next].text == rows[i].text; ++next) names += ", " + rows[next].names;
    const std::string_view text = rows[i].text;
    out += fmt::format("- {}{}{}\n", names, text.empty() ? "" : text.starts_with('\n') ? ":" : ": ", text);
    i = next;
  }
  return out;
}

std::string parameter_list(const Form& form) {
  std::vector<Row> rows = rows_of(form);
  std::erase_if(rows, is_common);
  return rows.empty() ? "" : "\n" + as_list(rows);
}

bool all_need_an_active_robot(std::string_view section) {
  return std::ranges::all_of(
      forms(), [section](const Form* form) { return form->section != section || form->needs_active_robot; });
}

std::string form_entry(const Form& form, const Form* before) {
  std::string out = fmt::format(
      "\n```\n{}\n```\n\n{}{}.", form.syntax,
      static_cast<char>(form.help[0] >= 'a' && form.help[0] <= 'z' ? form.help[0] - 'a' + 'A' : form.help[0]),
      form.help.substr(1));
  if (form.needs_active_robot && !all_need_an_active_robot(form.section)) out += " Needs an active robot.";
  out += '\n';
  const bool repeated = before != nullptr && before->name == form.name && before->definition == form.definition;
  if (!form.definition.empty()) out += fmt::format("**Ours:** {}.\n", repeated ? "as above" : form.definition);
  out += parameter_list(form);
  if (shows_more_than_the_syntax(form))
    out += fmt::format("\nExample: `{}`{}\n", form.example,
                       form.conflict.empty() ? "" : fmt::format(" ({})", form.conflict));
  return out;
}

std::string attribute_table(std::string_view title, std::span<const Attribute> attributes) {
  std::string out = fmt::format("\n### {}\n\n| token | bit | meaning |\n|---|---|---|\n", title);
  for (const Attribute& row : attributes)
    out += fmt::format("| `{}` | 0x{:04x} | {} |\n", row.token, row.bit, row.meaning);
  return out;
}

std::string own_tables() {
  std::string out =
      "\n## Tables A.1, A.4 and A.5\n\nThe manual refers to these tables and does not contain them. They are ours.\n";
  out += attribute_table("A.1 Attributes of deformable objects", object_attributes());
  out += attribute_table("A.4 Flags of the plausibility test", plausibility_flags());
  out += "\n### A.5 Tokens of the plausibility test\n\n| token | unit | meaning | at the start |\n|---|---|---|---|\n";
  for (const PlausibilityToken& row : plausibility_tokens())
    out += fmt::format("| `{}` | {} | {} | {} |\n", row.token, row.unit == Unit::none ? "ratio" : unit_text(row.unit),
                       row.meaning, start_text(row));
  return out;
}

}  // namespace

std::string reference_page() {
  std::string out =
      "# SCRIPT reference\n\n"
      "Generated from the command table (`scripts/lang/table_*.cpp`). [script.md](script.md) describes how SCRIPT is "
      "read\n"
      "and run. The sections 1.2.1 to 1.2.7 are those of the manual, \"The KISMET SCRIPT-Command Interface\", March "
      "1999.\n"
      "**Ours** marks rules that it leaves open.\n\n"
      "Keywords are case-insensitive, names case-sensitive. Robots, frames, cameras, sensors and workframes are "
      "named;\n"
      "they must exist. Files are in the cell folder. Numbers have the units given here; without a range any number "
      "is\n"
      "permitted.\n\n"
      "## Common parameters\n\nA command lists only parameters that are missing here or differ.\n\n";
  out += as_list(common_rows());
  const Form* before = nullptr;
  for (const Form* form : forms()) {
    const bool new_section = before == nullptr || before->section != form->section;
    if (new_section) out += fmt::format("\n## {}\n", section_title(form->section));
    if (new_section && all_need_an_active_robot(form->section))
      out += "\nAll act on the active robot (`ROBACT`) and need one.\n";
    if (new_section || before->name != form->name) out += fmt::format("\n### {}\n", form->name);
    out += form_entry(*form, before);
    before = form;
  }
  return out + own_tables();
}

}  // namespace cellmirror::script
