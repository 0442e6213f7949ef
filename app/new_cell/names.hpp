// Names and texts that go into the files of a new cell, whatever the bytes of the sources are. Pure.
#pragma once

#include <string>
#include <string_view>

namespace cellmirror::app {

// 1 to 63 letters, digits, '_' and '-', not beginning with '-': a name of a cell that is also a plain name of a folder.
[[nodiscard]] bool is_plain_name(std::string_view name);
// The name of a file in the cell folder: other characters than letters, digits, '_', '-' and '.' become '_', a leading
// dot or '-' too; at most 100 bytes, of which the end stays.
[[nodiscard]] std::string plain_file_name(std::string_view name);
// A TOML basic string with its quotes; a byte that is part of no UTF-8 character becomes U+FFFD.
[[nodiscard]] std::string toml_text(std::string_view text);
// A number that reads back as itself.
[[nodiscard]] std::string number_text(double value);

}  // namespace cellmirror::app
