// The parser's checks stay on in every build: it would take them for granted otherwise.
#undef NDEBUG
#define TOML_IMPLEMENTATION
#include "config/toml.hpp"
