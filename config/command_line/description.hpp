// A command line as data, from which manual pages and shell completion are made. Private to this folder.
#pragma once

#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace cellmirror::cli {

// One JSON object: name, description, footer, options (names, positional, type, default, required, values: none, one or
// many, help) and subcommands, which are of the same form. `name` of the program, where it gives itself none.
[[nodiscard]] std::string description_of(const CLI::App& program, std::string_view name);

}  // namespace cellmirror::cli
