#include "drivers/dds/diagnostic_messages.hpp"

namespace cellmirror::dds {

void encode(const DiagnosticArray& message, std::vector<std::byte>& out) {
  CdrWriter writer(out);
  write(message.header, writer);
  writer.write_count(message.status.size());
  for (const DiagnosticStatus& status : message.status) {
    writer.write(static_cast<std::uint8_t>(status.level));
    writer.write_text(status.name);
    writer.write_text(status.message);
    writer.write_text(status.hardware_id);
    writer.write_count(status.values.size());
    for (const KeyValue& value : status.values) {
      writer.write_text(value.key);
      writer.write_text(value.value);
    }
  }
}

}  // namespace cellmirror::dds
