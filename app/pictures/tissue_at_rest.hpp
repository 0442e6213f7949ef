// Deformable objects before anything acts on them.
#pragma once

#include <memory>

#include "config/tissue_setup.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/tissue_state.hpp"

namespace cellmirror::app {

// As their files have them; null: the cell has none. Seconds for large ones.
[[nodiscard]] Result<std::shared_ptr<const TissueView>> tissue_at_rest(const TissueSetup& setup);

}  // namespace cellmirror::app
