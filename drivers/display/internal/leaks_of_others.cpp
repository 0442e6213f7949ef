// What OSMesa, Mesa's drivers and fontconfig keep until the program ends is no leak of ours: some hundred bytes a
// context and a font. Only in builds with AddressSanitizer, for every program that draws.
#include "drivers/display/internal/leaks_of_others.hpp"

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define CELLMIRROR_LEAKS_ARE_LOOKED_FOR
#endif
#elif defined(__SANITIZE_ADDRESS__)
#define CELLMIRROR_LEAKS_ARE_LOOKED_FOR
#endif

#ifdef CELLMIRROR_LEAKS_ARE_LOOKED_FOR
extern "C" const char* __lsan_default_suppressions();  // called by the sanitizer's runtime
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libOSMesa\nleak:swrast_dri\nleak:libEGL\nleak:libfontconfig\n";
}
#endif

namespace cellmirror::display {

void tolerate_leaks_of_others() {}

}  // namespace cellmirror::display
