#pragma once

namespace cellmirror::dds {

// Sends what the DDS library has to say to our log instead of standard output, where it would spoil `--json`.
void redirect_library_log();

}  // namespace cellmirror::dds
