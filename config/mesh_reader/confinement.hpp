// What the reader of meshes takes from itself, so that a damaged or hostile file can do no more than end it. Linux.
#pragma once

namespace cellmirror {

// Closes all descriptors but 0, 1 and 2; bounds memory, processor time, files; forbids all system calls but those that
// reading, writing and memory take. The process ends with the thread that started it. What a kernel does not have is
// left out. With sanitizers memory, new descriptors and system calls stay free: they need them.
void confine_this_process();

}  // namespace cellmirror
