// Any text as the definition of a message, and any bytes as that message; the same bytes as JSON, and as
// the name of a file of the cell. The text ends at the first zero.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "app/recording/recorded_cell.hpp"
#include "app/recording/ros2_schema.hpp"
#include "rt_core/base/contract.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  const std::string_view all(reinterpret_cast<const char*>(data), size);
  const std::string_view text = all.substr(0, all.find('\0'));
  const std::string_view message = text.size() < size ? all.substr(text.size() + 1) : std::string_view();
  const auto schema = app::Ros2Schema::parse("package/msg/Type", text);
  if (schema) {
    const auto values = schema->flatten(std::as_bytes(std::span(message.data(), message.size())));
    CELLMIRROR_EXPECTS(!values || values->size() <= app::kMostValues);
  }
  const auto json = app::flatten_json(message);
  CELLMIRROR_EXPECTS(!json || json->size() <= app::kMostValues);
  if (app::is_below_a_folder(all))
    CELLMIRROR_EXPECTS(!all.empty() && all.front() != '/' && !all.starts_with("../") && !all.contains("/../"));
  return 0;
}
