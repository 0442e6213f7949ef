// The one table of all SCRIPT commands. Checking, help, completion, the reference page and the tests that count come
// from it; handlers are registered by the same ids.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "rt_core/ports/tissue_settings.hpp"
#include "scripts/lang/form.hpp"

namespace cellmirror::script {

// All forms in the order of FormId: the rows of the manual's index, then ours.
[[nodiscard]] std::span<const Form* const> forms();
[[nodiscard]] const Form& form(FormId id);

// The forms of one command ("POS_ROB" has six), found without regard to case; empty for an unknown word.
[[nodiscard]] std::span<const Form* const> forms_of(std::string_view command);

// The commands' names, each once, in the order of the table; without the conventions.
[[nodiscard]] std::span<const std::string> command_names();

// The tables A.1 (attributes of deformable objects), A.4 (flags of the plausibility test) and A.5 (its tokens) are
// not in the manual. These are ours.
struct Attribute {
  std::string_view token;
  std::uint32_t bit;
  std::string_view meaning;
};
struct PlausibilityToken {
  std::string_view token;
  Unit unit;
  std::string_view meaning;
  TissueLimitSetting start;  // SI
};
[[nodiscard]] std::span<const Attribute> object_attributes();            // A.1
[[nodiscard]] std::span<const Attribute> plausibility_flags();           // A.4
[[nodiscard]] std::span<const PlausibilityToken> plausibility_tokens();  // A.5
// "2000 mm/s, COUNT DISCARD", or "off".
[[nodiscard]] std::string start_text(const PlausibilityToken& token);

// "mm/s", "mm or degrees" and so on; empty for Unit::none.
[[nodiscard]] std::string_view unit_text(Unit unit);

}  // namespace cellmirror::script
