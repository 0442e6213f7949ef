#include "app/proximity/pairs_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "app/console/display_names.hpp"
#include "app/console/put.hpp"
#include "rt_core/base/counted.hpp"
#include "rt_core/base/json_writer.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace {

using collision::Pair;
using collision::PairState;
using collision::PairTable;

struct StateText {
  PairState state;
  std::string_view word;
  std::string_view meaning;
};

// In the order in which they are printed.
constexpr std::array kStates{
    StateText{PairState::tested, "tested", "tested"},
    StateText{PairState::rule_test, "rule-test", "tested because of a rule"},
    StateText{PairState::neighbours, "neighbours", "left out: links of one robot with one joint between them"},
    StateText{PairState::always, "always", "left out: proved to touch in every posture within the joint ranges"},
    StateText{PairState::never, "never", "left out: proved to stay apart in every posture within the joint ranges"},
    StateText{PairState::rule_ignore, "rule-ignore", "left out because of a rule"},
    StateText{PairState::rigid, "rigid", "left out: no joint between them"},
};

std::size_t count(const PairTable& pairs, PairState state) {
  const auto listed =
      std::count_if(pairs.pairs.begin(), pairs.pairs.end(), [state](const Pair& pair) { return pair.state == state; });
  return static_cast<std::size_t>(listed) + (state == PairState::rigid ? pairs.rigid_pairs : 0);
}

}  // namespace

std::string_view word_of(PairState state) {
  const auto found =
      std::find_if(kStates.begin(), kStates.end(), [state](const StateText& text) { return text.state == state; });
  return found == kStates.end() ? "unknown" : found->word;
}

void print_pairs(const std::string& cell, const PairTable& pairs, std::FILE* out) {
  const std::vector<std::string> names = display_names(*pairs.short_names);
  put(out, "{}: {}, {}\n\n", printable(cell), number_of(pairs.bodies.size(), "body", "bodies"),
      number_of(pairs.triangles, "triangle"));
  for (const StateText& text : kStates) {
    if (const std::size_t number = count(pairs, text.state); number > 0)
      put(out, "{:>7}  {:<12} {}\n", number, text.word, text.meaning);
  }
  for (const StateText& text : kStates) {
    bool first = true;
    for (const Pair& pair : pairs.pairs) {
      if (pair.state != text.state) continue;
      if (first) put(out, "\n{}\n", text.word);
      first = false;
      put(out, "  {} - {}{}{}\n", names[pair.a], names[pair.b], pair.reason.empty() ? "" : ": ", pair.reason);
    }
  }
  for (const std::string& doubt : pairs.doubts) put(out, "\nin doubt: {}\n", printable(doubt, 400));
}

void print_pairs_json(const std::string& cell, const PairTable& pairs, std::FILE* out) {
  JsonWriter json(JsonWriter::kExact);
  json.begin_object().member("cell", cell).member("triangles", pairs.triangles).key("bodies").begin_array();
  for (std::size_t i = 0; i < pairs.bodies.size(); ++i) json.value((*pairs.names)[i]);
  json.end_array().key("counts").begin_object();
  for (const StateText& text : kStates) json.member(text.word, count(pairs, text.state));
  json.end_object().key("pairs").begin_array();
  for (const Pair& pair : pairs.pairs) {
    json.line()
        .begin_object()
        .member("a", (*pairs.names)[pair.a])
        .member("b", (*pairs.names)[pair.b])
        .member("tested", collision::is_tested(pair.state))
        .member("state", word_of(pair.state))
        .member("reason", pair.reason)
        .end_object();
    put(out, "{}", json.take());
  }
  json.line().end_array().member("doubts", pairs.doubts).end_object();
  put(out, "{}\n", json.take());
}

}  // namespace cellmirror::app
