#include "scripts/programs/jet/teach_file.hpp"

#include <algorithm>

#include "rt_core/base/capacity.hpp"

namespace cellmirror::program {

namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

bool is_name_character(char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.'; }

}  // namespace

bool is_teach_name(std::string_view text) {
  return !text.empty() && text.size() <= kMaxNameLength && is_letter(text.front()) &&
         std::all_of(text.begin(), text.end(), is_name_character);
}

}  // namespace cellmirror::program
