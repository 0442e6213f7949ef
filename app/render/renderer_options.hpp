// What a cell file says about the renderer, as the renderer takes it.
#pragma once

#include "config/picture_settings.hpp"
#include "drivers/display/renderer.hpp"

namespace cellmirror::app {

[[nodiscard]] inline display::RendererOptions renderer_options(const PictureSettings& settings) {
  display::RendererOptions options;
  options.threads = settings.threads;
  switch (settings.renderer) {
    case PictureRenderer::automatic:
      options.backend = display::Backend::automatic;
      break;
    case PictureRenderer::osmesa:
      options.backend = display::Backend::osmesa;
      break;
    case PictureRenderer::egl:
      options.backend = display::Backend::egl;
      break;
  }
  return options;
}

}  // namespace cellmirror::app
