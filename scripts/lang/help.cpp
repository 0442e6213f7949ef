#include "scripts/lang/help.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <span>

#include "rt_core/base/text.hpp"
#include "scripts/lang/values.hpp"

namespace cellmirror::script {

namespace {

std::string kind_text(const Parameter& parameter) {
  switch (parameter.kind) {
    case ParameterKind::name: {
      constexpr std::array<std::string_view, 7> kKinds = {
          "frame or joint", "robot", "camera", "sensor", "workframe", "frame, a joint or the cell", "voxel volume"};
      return fmt::format("name of a {}", kKinds.at(static_cast<std::size_t>(parameter.name_kind)));
    }
    case ParameterKind::choice: {
      std::string list;
      for (const Choice& choice : parameter.choices) list += (list.empty() ? "" : " | ") + std::string(choice.word);
      return list;
    }
    case ParameterKind::integer:
      return fmt::format("whole number, {}", range_text(parameter.range, parameter.unit));
    case ParameterKind::number:
    case ParameterKind::joint_list:
      return range_text(parameter.range, parameter.unit);
    case ParameterKind::number_list:
      return fmt::format("0 to {} numbers", parameter.width);
    case ParameterKind::file:
      return "name of a file";
    case ParameterKind::identifier:
      return "name";
    case ParameterKind::text:
      return "rest of the command";
    case ParameterKind::slaves:
      return "for each slave its name, the number of its joints that follow, and pairs of joints";
    case ParameterKind::word:
      return {};
  }
  return {};
}

// Candidates for a command's next word.
class Completion {
 public:
  Completion(std::string_view prefix, const NameDirectory* names) : prefix_(prefix), names_(names) {}

  void keyword(std::string_view word) {
    if (word.size() >= prefix_.size() && equal_ignoring_case(word.substr(0, prefix_.size()), prefix_)) add(word);
  }
  void of(const Parameter& parameter) {
    if (parameter.kind == ParameterKind::word) keyword(parameter.name);
    for (const Choice& choice : parameter.choices) keyword(choice.word);
    if (parameter.kind == ParameterKind::name) names(parameter.name_kind);
    if (parameter.kind == ParameterKind::slaves) names(NameKind::robot);
  }
  void of(const Form& form, std::span<const std::string_view> words);

  [[nodiscard]] std::vector<std::string> take() { return std::move(candidates_); }

 private:
  void names(NameKind kind) {
    if (names_ == nullptr) return;
    for (const std::string& name : names_->all(kind)) {
      if (name.starts_with(prefix_)) add(name);
    }
  }
  void labels(const Form& form, std::size_t first, std::span<const std::string_view> words);
  void add(std::string_view candidate) {
    if (std::find(candidates_.begin(), candidates_.end(), candidate) == candidates_.end())
      candidates_.emplace_back(candidate);
  }

  std::string_view prefix_;
  const NameDirectory* names_;
  std::vector<std::string> candidates_;
};

void Completion::of(const Form& form, std::span<const std::string_view> words) {
  std::size_t next = 0;
  for (std::size_t i = 0; i < form.parameters.size(); ++i) {
    const Parameter& parameter = form.parameters[i];
    if (!parameter.label.empty()) {
      labels(form, i, words.subspan(next));
      return;
    }
    if (next == words.size()) {
      of(parameter);
      return;
    }
    const std::string_view word = words[next++];
    if (parameter.kind == ParameterKind::word && !equal_ignoring_case(parameter.name, word)) return;
    if (parameter.kind == ParameterKind::choice && !choice_of(word, parameter.choices)) return;
  }
}

void Completion::labels(const Form& form, std::size_t first, std::span<const std::string_view> words) {
  std::size_t behind = first;
  while (behind < form.parameters.size() && !form.parameters[behind].label.empty()) ++behind;
  const std::span<const Parameter> groups = form.parameters.subspan(first, behind - first);
  std::vector<bool> given(groups.size(), false);
  std::vector<bool> excluded(256, false);
  std::size_t next = 0;
  while (next < words.size()) {
    std::size_t group = 0;
    while (group < groups.size() && !equal_ignoring_case(groups[group].label, words[next])) ++group;
    if (group == groups.size()) return;
    next += 1U + groups[group].width;
    if (next > words.size()) return;  // a value is expected
    given[group] = true;
    if (groups[group].alternatives != 0) excluded[groups[group].alternatives] = true;
  }
  for (std::size_t group = 0; group < groups.size(); ++group) {
    if (!given[group] && !excluded[groups[group].alternatives]) keyword(groups[group].label);
  }
  const bool complete = std::ranges::all_of(given, [](bool each) { return each; });
  if (complete && behind < form.parameters.size()) of(form.parameters[behind]);
}

nlohmann::ordered_json parameter_as_json(const Parameter& parameter) {
  nlohmann::ordered_json json = {{"name", parameter.name}, {"meaning", parameter.meaning}};
  if (!parameter.label.empty()) json["label"] = parameter.label;
  if (parameter.width > 1) json["values"] = parameter.width;
  if (!parameter.choices.empty()) {
    nlohmann::ordered_json choices = nlohmann::ordered_json::array();
    for (const Choice& choice : parameter.choices)
      choices.push_back({{"word", choice.word}, {"meaning", choice.meaning}});
    json["choices"] = std::move(choices);
  }
  if (!unit_text(parameter.unit).empty()) json["unit"] = unit_text(parameter.unit);
  if (parameter.range.bounded()) json["range"] = range_text(parameter.range, Unit::none);
  if (parameter.optional) json["optional"] = true;
  if (!parameter.default_text.empty()) json["default"] = parameter.default_text;
  return json;
}

nlohmann::ordered_json attributes_as_json(std::span<const Attribute> attributes) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const Attribute& row : attributes)
    rows.push_back({{"token", row.token}, {"bit", row.bit}, {"meaning", row.meaning}});
  return rows;
}

std::string attributes_as_text(std::string_view title, std::span<const Attribute> attributes) {
  std::string out = fmt::format("\n{}\n", title);
  for (const Attribute& row : attributes)
    out += fmt::format("  {:<18} 0x{:04x}  {}\n", row.token, row.bit, row.meaning);
  return out;
}

constexpr std::string_view kA1 = "Table A.1, attributes of deformable objects (ours)";
constexpr std::string_view kA4 = "Table A.4, flags of the plausibility test (ours)";
constexpr std::string_view kA5 = "Table A.5, tokens of the plausibility test (ours)";

}  // namespace

std::string help_text(const Form& form) {
  std::string out = fmt::format("{}\n  {}\n", form.syntax, form.help);
  for (const Parameter& parameter : form.parameters) {
    if (parameter.kind == ParameterKind::word) continue;
    std::string name = parameter.label.empty() ? "" : std::string(parameter.label) + " ";
    name += fmt::format("<{}>", parameter.name);
    out += fmt::format("  {:<22} {}: {}", name, parameter.meaning, kind_text(parameter));
    if (parameter.optional) out += "; optional";
    if (!parameter.default_text.empty()) out += fmt::format(", default {}", parameter.default_text);
    out += '\n';
  }
  if (!form.definition.empty()) out += fmt::format("  our definition: {}\n", form.definition);
  if (!form.example.empty()) out += fmt::format("  example: {}\n", form.example);
  if (!form.conflict.empty()) out += fmt::format("  beside the manual's other examples: {}\n", form.conflict);
  return out;
}

std::string help_text(std::string_view command) {
  std::string out;
  for (const Form* form : forms_of(command)) out += (out.empty() ? "" : "\n") + help_text(*form);
  if (!out.empty()) return out;
  const std::string near = did_you_mean(command, command_names());
  return fmt::format("there is no command {}{}\n", printable(command), near.empty() ? "" : "; " + near);
}

std::vector<std::string> complete(std::string_view line, const NameDirectory* names) {
  constexpr std::string_view kBlank = " \t,";
  std::vector<std::string_view> words;
  std::string_view prefix;
  while (!line.empty()) {
    const std::size_t begin = line.find_first_not_of(kBlank);
    if (begin == std::string_view::npos) break;
    const std::size_t end = line.find_first_of(kBlank, begin);
    if (end == std::string_view::npos) {
      prefix = line.substr(begin);
      break;
    }
    words.push_back(line.substr(begin, end - begin));
    line.remove_prefix(end);
  }
  Completion completion(prefix, names);
  if (words.empty()) {
    for (const std::string& name : command_names()) completion.keyword(name);
  } else {
    for (const Form* form : forms_of(words.front())) completion.of(*form, std::span(words).subspan(1));
  }
  return completion.take();
}

std::string commands_as_text() {
  std::string out;
  std::string_view section;
  for (const Form* form : forms()) {
    if (form->section != section) out += fmt::format("{}{}\n", section.empty() ? "" : "\n", form->section);
    section = form->section;
    out += fmt::format("  {}\n      {}\n", form->syntax, form->help);
  }
  out += fmt::format("\n{} forms, all implemented; those of the sections 1.2.* are the manual's\n", forms().size());
  out += attributes_as_text(kA1, object_attributes()) + attributes_as_text(kA4, plausibility_flags());
  out += fmt::format("\n{}\n", kA5);
  for (const PlausibilityToken& row : plausibility_tokens())
    out += fmt::format("  {:<18} {:<7} {}; at the start {}\n", row.token,
                       row.unit == Unit::none ? "ratio" : unit_text(row.unit), row.meaning, start_text(row));
  return out;
}

std::string commands_as_json() {
  nlohmann::ordered_json commands = nlohmann::ordered_json::array();
  for (const Form* form : forms()) {
    nlohmann::ordered_json row = {{"name", form->name},
                                  {"syntax", form->syntax},
                                  {"section", form->section},
                                  {"help", form->help},
                                  {"implemented", true}};
    row["ours"] = form->origin == Origin::ours;
    row["kind"] = form->kind == FormKind::command ? "command" : "convention";
    if (!form->definition.empty()) row["our_definition"] = form->definition;
    if (!form->example.empty()) row["example"] = form->example;
    if (!form->conflict.empty()) row["example_conflict"] = form->conflict;
    row["needs_active_robot"] = form->needs_active_robot;
    constexpr std::array<std::string_view, 3> kEffects = {"none", "queued", "blocking"};
    row["loop_effect"] = kEffects[static_cast<std::size_t>(form->effect)];
    nlohmann::ordered_json parameters = nlohmann::ordered_json::array();
    for (const Parameter& parameter : form->parameters) parameters.push_back(parameter_as_json(parameter));
    row["parameters"] = std::move(parameters);
    commands.push_back(std::move(row));
  }
  nlohmann::ordered_json tokens = nlohmann::ordered_json::array();
  for (const PlausibilityToken& row : plausibility_tokens())
    tokens.push_back(
        {{"token", row.token}, {"unit", unit_text(row.unit)}, {"meaning", row.meaning}, {"at_start", start_text(row)}});
  const nlohmann::ordered_json document = {{"commands", std::move(commands)},
                                           {"our_tables",
                                            {{"A.1", attributes_as_json(object_attributes())},
                                             {"A.4", attributes_as_json(plausibility_flags())},
                                             {"A.5", std::move(tokens)}}}};
  return document.dump(2) + "\n";
}

}  // namespace cellmirror::script
