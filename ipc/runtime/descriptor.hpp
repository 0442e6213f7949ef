// Descriptor is in rt_core/base; for sources that include it from here.
#pragma once

#include "rt_core/base/descriptor.hpp"
