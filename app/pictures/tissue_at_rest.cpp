#include "app/pictures/tissue_at_rest.hpp"

#include "rt_core/tissue/world.hpp"

namespace cellmirror::app {

Result<std::shared_ptr<const TissueView>> tissue_at_rest(const TissueSetup& setup) {
  if (setup.objects.empty()) return nullptr;
  const Result<tissue::World> world = tissue::World::make(setup.objects, setup.connections);
  if (!world) return std::unexpected(world.error());
  auto view = std::make_shared<TissueView>();
  world->view(*view, false);
  return view;
}

}  // namespace cellmirror::app
