// The deformable objects of the cell as SCRIPT names them, and what of their content decides whether a command has a
// visible effect. Never changed: objects do not come or go while a cell is loaded.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/tissue/description/description.hpp"

namespace cellmirror::app {

struct TissueObject {
  std::string name;
  std::uint16_t attributes = kDefaultTissueAttributes;  // at the start
  bool artery = false;
  bool blood_vessel = false;
  bool pool = false;

  static TissueObject of(const tissue::ObjectDescription& description);
};

class TissueObjects {
 public:
  // Their names differ.
  explicit TissueObjects(std::vector<TissueObject> objects) : objects_(std::move(objects)) {}

  [[nodiscard]] std::span<const TissueObject> all() const { return objects_; }
  [[nodiscard]] bool empty() const { return objects_.empty(); }
  // Whether at least one has it.
  [[nodiscard]] bool any(bool TissueObject::* what) const;
  // ALL, in a cell that has at least one.
  [[nodiscard]] bool means_all(std::string_view name) const;
  // The index of the one with this name; the extension .mpo may be left out. Refused: none, with the nearest names, or
  // the cell has no object at all.
  [[nodiscard]] Result<std::size_t> find(std::string_view name) const;

 private:
  [[nodiscard]] Error unknown(std::string_view name) const;

  std::vector<TissueObject> objects_;
};

}  // namespace cellmirror::app
