// Where the worker that simulates tissue leaves what it has found.
#pragma once

#include <functional>
#include <memory>

#include "app/snapshot/board.hpp"
#include "app/snapshot/tissue_report.hpp"
#include "rt_core/ports/tissue_state.hpp"

namespace cellmirror::app {

// In a cell without deformable objects all of it is null.
struct TissueSources {
  const Board<TissueReport>* report = nullptr;
  // The newest shapes, and a request for newer ones; null before the first. Any thread. (TissueWorker::view)
  std::function<std::shared_ptr<const TissueView>()> view = {};

  // Null: there is no tissue, or nothing was reported yet.
  [[nodiscard]] std::shared_ptr<const TissueReport> newest_report() const {
    return report != nullptr ? report->latest() : nullptr;
  }
};

}  // namespace cellmirror::app
