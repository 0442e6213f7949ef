// Reads [mqtt] of a cell file. Private to this folder.
#pragma once

#include "config/file_finder.hpp"
#include "config/table_reader.hpp"
#include "rt_core/ports/mqtt_config.hpp"

namespace cellmirror {

// Not enabled without the table. Errors: no broker; a broker elsewhere without TLS where nothing says that this is
// meant; files that are missing, outside of the cell folder, or readable for others where they are secret.
[[nodiscard]] MqttConfig read_mqtt(TableReader& top, const FileFinder& files);

}  // namespace cellmirror
