// docs/script-reference.md, generated from the table; a test compares the committed page with it.
#include <fmt/format.h>

#include <string>

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

// A '|' would end a cell of a Markdown table.
std::string cell(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '|') out += '\\';
    out += c;
  }
  return out;
}

std::string choices_cell(const Parameter& parameter) {
  std::string out;
  for (const Choice& choice : parameter.choices) {
    out += fmt::format("{}`{}`", out.empty() ? "" : ", ", choice.word);
    if (!choice.meaning.empty() && choice.meaning != choice.word) out += fmt::format(" {}", choice.meaning);
  }
  return out;
}

std::string values_cell(const Parameter& parameter) {
  switch (parameter.kind) {
    case ParameterKind::choice:
      return choices_cell(parameter);
    case ParameterKind::name:
      return parameter.checked_by_host ? "a name, looked up at execution" : "a name that exists";
    case ParameterKind::identifier:
      return "a name";
    case ParameterKind::file:
      return "a file of the cell folder";
    case ParameterKind::text:
      return "the rest of the command";
    case ParameterKind::integer:
      return "whole number, " + range_text(parameter.range, parameter.unit);
    case ParameterKind::number_list:
      return fmt::format("0 to {} numbers", parameter.width);
    case ParameterKind::slaves:
      return "for each slave: name, number of joints, pairs of joints";
    default:
      return (parameter.width > 1 ? fmt::format("{} numbers, ", parameter.width) : "") +
             range_text(parameter.range, parameter.unit);
  }
}

std::string parameters_table(const Form& form) {
  std::string rows;
  for (const Parameter& parameter : form.parameters) {
    if (parameter.kind == ParameterKind::word) continue;
    std::string meaning(parameter.meaning);
    if (parameter.optional) meaning += ", optional";
    if (!parameter.default_text.empty()) meaning += fmt::format(", default {}", parameter.default_text);
    const std::string label = parameter.label.empty() ? "" : std::string(parameter.label) + " ";
    rows +=
        fmt::format("| `{}{}` | {} | {} |\n", label, cell(parameter.name), cell(meaning), cell(values_cell(parameter)));
  }
  return rows.empty() ? "" : "\n| parameter | meaning | values |\n|---|---|---|\n" + rows;
}

std::string form_entry(const Form& form) {
  std::string out = fmt::format(
      "\n```\n{}\n```\n\n{}{}.\n", form.syntax,
      static_cast<char>(form.help[0] >= 'a' && form.help[0] <= 'z' ? form.help[0] - 'a' + 'A' : form.help[0]),
      form.help.substr(1));
  if (form.needs_active_robot) out += "Needs an active robot (`ROBACT`).\n";
  if (!form.definition.empty()) out += fmt::format("Our definition: {}.\n", form.definition);
  out += parameters_table(form);
  if (!form.example.empty()) out += fmt::format("\nExample: `{}`\n", form.example);
  if (!form.conflict.empty()) out += fmt::format("\nBeside the manual's other examples: {}.\n", form.conflict);
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
      "# SCRIPT reference\n\nThis page is generated from the command table (`scripts/lang/table_*.cpp`); a test "
      "compares the two. How SCRIPT\nis read and run, and what the manual leaves open, is described in "
      "[script.md](script.md).\n\nKeywords are case-insensitive, names are case-sensitive. Numbers are in the units "
      "given here and are\nconverted to SI where a command is parsed.\n";
  std::string_view section;
  std::string_view command;
  for (const Form* form : forms()) {
    if (form->section != section) out += fmt::format("\n## {}\n", section_title(form->section));
    if (form->section != section || form->name != command) out += fmt::format("\n### {}\n", form->name);
    section = form->section;
    command = form->name;
    out += form_entry(*form);
  }
  return out + own_tables();
}

}  // namespace cellmirror::script
