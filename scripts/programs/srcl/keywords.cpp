#include "scripts/programs/srcl/keywords.hpp"

#include <array>
#include <cstddef>

#include "rt_core/base/text.hpp"

namespace cellmirror::program::srcl {

namespace {

constexpr auto kRows = std::to_array<KeywordRow>({
    {"PROGRAMM", Keyword::program, true},
    {"GANZ", Keyword::integer, true},
    {"REAL", Keyword::real, true},
    {"LOGIK", Keyword::boolean, true},
    {"LAGE", Keyword::pose, true},
    {"STELLUNG", Keyword::joints, true},
    {"FEST", Keyword::constant, true},
    {"LISTE", Keyword::list, true},
    {"SEMAPHOR", Keyword::semaphore, true},
    {"PTP", Keyword::ptp, true},
    {"LIN", Keyword::linear, true},
    {"ZIR", Keyword::circular, true},
    {"REL", Keyword::relative},
    {"WKZ", Keyword::tool_axes},
    {"UEBER", Keyword::fly},
    {"V_ACHSE", Keyword::joint_velocity, true},
    {"B_ACHSE", Keyword::joint_acceleration, true},
    {"V_BAHN", Keyword::path_velocity, true},
    {"B_BAHN", Keyword::path_acceleration, true},
    {"V_DREH", Keyword::turn_velocity, true},
    {"B_DREH", Keyword::turn_acceleration, true},
    {"UEBER_WEG", Keyword::fly_distance, true},
    {"UEBER_WINKEL", Keyword::fly_angle, true},
    {"UEBER_TEMPO", Keyword::fly_speed, true},
    {"WERKZEUG", Keyword::tool, true},
    {"NULLPUNKT", Keyword::zero_point, true},
    {"STANDARD", Keyword::standard},
    {"SPRUNG", Keyword::jump, true},
    {"WENN", Keyword::if_begin, true},
    {"DANN", Keyword::then},
    {"SONSTWENN", Keyword::else_if, true},
    {"SONST", Keyword::otherwise, true},
    {"ENDE_WENN", Keyword::if_end, true},
    {"SOLANGE", Keyword::while_begin, true},
    {"ENDE_SOLANGE", Keyword::while_end, true},
    {"ZAEHLE", Keyword::count_begin, true},
    {"VON", Keyword::from},
    {"BIS", Keyword::until, true},
    {"SCHRITT", Keyword::step},
    {"ENDE_ZAEHLE", Keyword::count_end, true},
    {"WIEDERHOLE", Keyword::repeat_begin, true},
    {"SCHLEIFE", Keyword::loop_begin, true},
    {"ENDE_SCHLEIFE", Keyword::loop_end, true},
    {"VERLASSE", Keyword::leave, true},
    {"WEITER", Keyword::next_round, true},
    {"UPRO", Keyword::subprogram, true},
    {"ENDE_UPRO", Keyword::subprogram_end, true},
    {"RUF", Keyword::call, true},
    {"ZURUECK", Keyword::return_back, true},
    {"HALT", Keyword::halt, true},
    {"ENDE", Keyword::end, true},
    {"WARTE", Keyword::wait, true},
    {"HOECHSTENS", Keyword::at_most},
    {"MELDE", Keyword::notify},
    {"BELEGE", Keyword::acquire, true},
    {"FREI", Keyword::release, true},
    {"EINGANG", Keyword::digital_input},
    {"AUSGANG", Keyword::digital_output, true},
    {"ANALOG_EIN", Keyword::analogue_input},
    {"ANALOG_AUS", Keyword::analogue_output, true},
    {"UND", Keyword::logical_and},
    {"ODER", Keyword::logical_or},
    {"EXOR", Keyword::logical_xor},
    {"NICHT", Keyword::logical_not},
    {"DIV", Keyword::integer_divide},
    {"MOD", Keyword::modulo},
    {"WAHR", Keyword::true_value},
    {"EIN", Keyword::true_value},
    {"FALSCH", Keyword::false_value},
    {"AUS", Keyword::false_value},
    {"ABS", Keyword::absolute},
    {"WURZEL", Keyword::square_root},
    {"SIN", Keyword::sine},
    {"COS", Keyword::cosine},
    {"TAN", Keyword::tangent},
    {"ASIN", Keyword::arc_sine},
    {"ACOS", Keyword::arc_cosine},
    {"ATAN2", Keyword::arc_tangent},
    {"MIN", Keyword::minimum},
    {"MAX", Keyword::maximum},
    {"RUNDE", Keyword::round},
    {"GANZTEIL", Keyword::truncate},
    {"INV", Keyword::inverse},
    {"IST_LAGE", Keyword::current_pose},
    {"IST_STELLUNG", Keyword::current_joints},
    {"PI", Keyword::pi},
});

constexpr std::size_t kSlots = 512;  // a power of two, several times the number of words
constexpr std::size_t kLongestWord = 16;
constexpr std::uint8_t kEmpty = 255;
static_assert(kRows.size() < kEmpty);

constexpr char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

constexpr std::size_t slot_of(std::string_view word) {
  std::uint32_t hash = 2166136261U;  // FNV-1a
  for (const char c : word) hash = (hash ^ static_cast<unsigned char>(upper(c))) * 16777619U;
  return (hash ^ (hash >> 15U)) % kSlots;
}

constexpr std::array<std::uint8_t, kSlots> place_words() {
  std::array<std::uint8_t, kSlots> slots{};
  slots.fill(kEmpty);
  for (std::size_t row = 0; row < kRows.size(); ++row) {
    std::size_t slot = slot_of(kRows[row].word);
    while (slots[slot] != kEmpty) slot = (slot + 1) % kSlots;
    slots[slot] = static_cast<std::uint8_t>(row);
  }
  return slots;
}

constexpr std::array<std::uint8_t, kSlots> kWordSlots = place_words();

bool same_word(std::string_view word, std::string_view upper_case) {
  if (word.size() != upper_case.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i) {
    if (upper(word[i]) != upper_case[i]) return false;
  }
  return true;
}

std::vector<std::string> words_of(bool statements_only) {
  std::vector<std::string> words;
  for (const KeywordRow& row : kRows) {
    if (row.begins_statement || !statements_only) words.emplace_back(row.word);
  }
  return words;
}

}  // namespace

std::span<const KeywordRow> keyword_rows() { return kRows; }

Keyword find_keyword(std::string_view word) {
  if (word.size() > kLongestWord) return Keyword::none;
  for (std::size_t slot = slot_of(word); kWordSlots[slot] != kEmpty; slot = (slot + 1) % kSlots) {
    const KeywordRow& row = kRows[kWordSlots[slot]];
    if (same_word(word, row.word)) return row.keyword;
  }
  return Keyword::none;
}

std::string_view spelling(Keyword keyword) {
  for (const KeywordRow& row : kRows) {
    if (row.keyword == keyword) return row.word;
  }
  return {};
}

const std::vector<std::string>& statement_words() {
  static const std::vector<std::string> words = words_of(true);
  return words;
}

const std::vector<std::string>& all_words() {
  static const std::vector<std::string> words = words_of(false);
  return words;
}

}  // namespace cellmirror::program::srcl
