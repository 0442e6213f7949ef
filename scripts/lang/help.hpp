// What people and tools see of the command table: help, completion, the reference page, JSON. Not for hot paths.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scripts/lang/command_table.hpp"
#include "scripts/lang/names.hpp"

namespace cellmirror::script {

// Synopsis, parameters with unit, range and default, example, availability; several lines.
[[nodiscard]] std::string help_text(const Form& form);
// The same for all forms of a command; of an unknown word the nearest commands.
[[nodiscard]] std::string help_text(std::string_view command);

// Candidates for the last, unfinished word of `line` (empty where the line ends with a blank): commands, keywords,
// labels, choices, and names where a directory is given. Sorted as the table and the directory give them.
[[nodiscard]] std::vector<std::string> complete(std::string_view line, const NameDirectory* names);

// The whole of docs/script-reference.md (Markdown).
[[nodiscard]] std::string reference_page();

// `cellmirror commands`: one line a form, and the tables A.1, A.4, A.5 of ours.
[[nodiscard]] std::string commands_as_text();
// `cellmirror commands --json`: {"commands": [{"name", "syntax", "section", "help", "implemented", ...}], "tables":
// ...}
[[nodiscard]] std::string commands_as_json();

}  // namespace cellmirror::script
