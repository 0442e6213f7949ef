#pragma once

#include "drivers/dds/process/event_sender.hpp"

namespace cellmirror::dds {

// Sends the log of the DDS library to cellmirror from now on. `sender` outlives the process's last use of the library.
void send_library_log(EventSender& sender);

}  // namespace cellmirror::dds
