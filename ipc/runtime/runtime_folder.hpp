// The folder in which the gateways of one user keep their locks, sockets and descriptions while they run.
#pragma once

#include <filesystem>

#include "rt_core/base/result.hpp"

namespace cellmirror {

// $CELLMIRROR_RUNTIME_DIR, else $XDG_RUNTIME_DIR/cellmirror, else /run/cellmirror for root, else
// /tmp/cellmirror-<uid>. Only the name; nothing is created or accessed. Relative names in the environment are refused.
[[nodiscard]] Result<std::filesystem::path> runtime_folder_path();

// For a gateway: creates the folder (0700) if missing. Refused: a link, no folder, a folder of another user or one with
// access for others; the message has the remedy.
[[nodiscard]] Result<std::filesystem::path> runtime_folder();

// For a client: does not create it. A folder that belongs neither to this user nor to root is refused, except for root,
// which may use any user's gateway. A missing folder is not a failure: nothing runs.
[[nodiscard]] Result<std::filesystem::path> runtime_folder_for_client();

// A folder in the runtime folder, by the same rules.
[[nodiscard]] Result<void> make_private_folder(const std::filesystem::path& folder);

}  // namespace cellmirror
