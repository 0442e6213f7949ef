// Private to this folder.
#pragma once

namespace cellmirror::display {

// Does nothing: a reference to it links the list of this file.
void tolerate_leaks_of_others();

}  // namespace cellmirror::display
