#include "drivers/dds/range_message.hpp"

namespace cellmirror::dds {

void encode(const Range& message, std::vector<std::byte>& out) {
  CdrWriter writer(out);
  write(message.header, writer);
  writer.write(message.radiation_type);
  for (const float value :
       {message.field_of_view, message.min_range, message.max_range, message.range, message.variance}) {
    writer.write(value);
  }
}

}  // namespace cellmirror::dds
