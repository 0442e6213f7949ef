// Private to this folder.
#pragma once

namespace cellmirror::display {

// Does nothing when called: whoever refers to it gets the list of this file linked.
void tolerate_leaks_of_others();

}  // namespace cellmirror::display
