// Foreseeable failures are values: what went wrong and where, and what the user can do about it.
#pragma once

#include <expected>
#include <string>
#include <utility>

namespace cellmirror {

struct Error {
  std::string what;    // one sentence with the thing's name or place, without a full stop
  std::string remedy;  // what the user can do, as a command or an instruction; may be empty

  // "what; remedy", as it is printed on one line.
  [[nodiscard]] std::string text() const { return remedy.empty() ? what : what + "; " + remedy; }
};

template <class T>
using Result = std::expected<T, Error>;

[[nodiscard]] inline std::unexpected<Error> fail(std::string what, std::string remedy = {}) {
  return std::unexpected(Error{std::move(what), std::move(remedy)});
}

}  // namespace cellmirror
