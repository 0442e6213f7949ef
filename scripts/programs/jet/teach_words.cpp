#include "scripts/programs/jet/teach_words.hpp"

#include <fmt/format.h>

#include <utility>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/text.hpp"
#include "rt_core/base/units.hpp"

namespace cellmirror::program {

void TeachWords::error(const TeachWord& word, std::string message, std::string remedy) {
  diagnostics_.error(place(word.column), std::move(message), std::move(remedy));
}

bool TeachWords::peek_is(std::string_view keyword) const {
  return !at_end() && equal_ignoring_case(peek().text, keyword);
}

void TeachWords::expect_end() {
  if (at_end()) return;
  error(peek(), fmt::format("{} is surplus here", printable(peek().text)),
        "one statement per line; a comment begins with #");
  skip_rest();
}

void TeachWords::missing(std::string_view what, std::string_view example) {
  const TeachWord& last = words_.back();
  diagnostics_.error(place(last.column + static_cast<int>(last.text.size())), fmt::format("{} is missing", what),
                     fmt::format("for example {}", example));
}

std::optional<TeachWord> TeachWords::name(std::string_view what) {
  if (at_end()) {
    missing(fmt::format("the name of the {}", what), "P1");
    return std::nullopt;
  }
  if (peek().text.find('=') != std::string_view::npos) {  // a value: the name was forgotten
    error(peek(), fmt::format("the name of the {} is missing", what), "for example P1");
    return std::nullopt;
  }
  const TeachWord& word = take();
  if (is_teach_name(word.text)) return word;
  error(word, fmt::format("{} is not a valid name of a {}", printable(word.text), what),
        fmt::format("a letter, then letters, digits, '_', '-' and '.', at most {}", kMaxNameLength));
  return std::nullopt;
}

std::optional<double> TeachWords::number(std::string_view what, double least, double most) {
  if (at_end()) {
    missing(fmt::format("the number of {}", what), fmt::format("{} 12.5", what));
    return std::nullopt;
  }
  const TeachWord& word = take();
  const std::optional<double> value = parse_number(word.text);
  if (!value) {
    error(word, fmt::format("{} is not a number", printable(word.text)));
  } else if (*value < least || *value > most) {
    error(word, fmt::format("{} {} is not within {} .. {}", what, word.text, least, most));
  } else {
    return value;
  }
  return std::nullopt;
}

std::optional<long long> TeachWords::integer(std::string_view what, long long least, long long most) {
  if (at_end()) {
    missing(fmt::format("the number of {}", what), fmt::format("{} {}", what, least));
    return std::nullopt;
  }
  const TeachWord& word = take();
  const std::optional<long long> value = parse_integer(word.text);
  if (!value) {
    error(word, fmt::format("{} is not a whole number", printable(word.text)));
  } else if (*value < least || *value > most) {
    error(word, fmt::format("{} {} is not within {} .. {}", what, word.text, least, most));
  } else {
    return value;
  }
  return std::nullopt;
}

std::optional<bool> TeachWords::on_or_off(std::string_view what) {
  if (at_end()) {
    missing("ON or OFF", fmt::format("{} 1 ON", what));
    return std::nullopt;
  }
  const TeachWord& word = take();
  if (equal_ignoring_case(word.text, "ON")) return true;
  if (equal_ignoring_case(word.text, "OFF")) return false;
  error(word, fmt::format("{} is neither ON nor OFF", printable(word.text)));
  return std::nullopt;
}

bool TeachWords::setting(TeachSettings& settings) {
  if (peek_is("SPEED")) {
    take();
    share("SPEED", settings.speed);
  } else if (peek_is("ACCELERATION")) {
    take();
    share("ACCELERATION", settings.acceleration);
  } else if (peek_is("TOLERANCE")) {
    take();
    tolerance(settings.tolerance);
  } else {
    return false;
  }
  return true;
}

void TeachWords::share(std::string_view what, std::optional<double>& share) {
  constexpr double kLeastPercent = 0.01;
  if (peek_is("ROBOT")) {
    take();
    share.reset();
    return;
  }
  if (const auto percent = number(what, kLeastPercent, 100)) share = *percent / 100;
}

void TeachWords::tolerance(std::optional<TeachTolerance>& tolerance) {
  if (peek_is("NONE")) {
    take();
    tolerance.reset();
    return;
  }
  const auto value = number("TOLERANCE", 0, kGreatestTeachDistance);
  if (!value) {
    // Its unit belongs to it, and is no fault of its own.
    if (peek_is("MM") || peek_is("DEG") || peek_is("PERCENT")) take();
    return;
  }
  if (at_end() && *value == 0) {
    tolerance.reset();
    return;
  }
  const std::string example = fmt::format("TOLERANCE {} MM", *value);
  if (at_end()) return missing("MM, DEG or PERCENT", example);
  if (peek_is("SPEED") || peek_is("ACCELERATION") || peek_is("TOLERANCE"))
    return error(peek(), "MM, DEG or PERCENT is missing", "for example " + example);
  const TeachWord& unit = take();
  TeachTolerance read;
  if (equal_ignoring_case(unit.text, "MM")) {
    read = {FlyType::distance, m_from_mm(*value)};
  } else if (equal_ignoring_case(unit.text, "DEG")) {
    if (*value > kGreatestTeachAngle)
      return error(unit, fmt::format("TOLERANCE {} DEG is not within 0 .. {}", *value, kGreatestTeachAngle));
    read = {FlyType::angle, rad_from_deg(*value)};
  } else if (equal_ignoring_case(unit.text, "PERCENT")) {
    if (*value > 100) return error(unit, fmt::format("TOLERANCE {} PERCENT is not within 0 .. 100", *value));
    read = {FlyType::speed_fraction, *value / 100};
  } else {
    return error(unit, fmt::format("{} is not a unit of a tolerance", printable(unit.text)),
                 "MM from the check point, DEG from its orientation, or PERCENT of the speed");
  }
  tolerance = read.parameter > 0 ? std::optional(read) : std::nullopt;
}

}  // namespace cellmirror::program
