// Attributes of a DICOM file.
#pragma once

#include <optional>
#include <string_view>

#include "config/volume_message/slice_message.hpp"

namespace cellmirror {

struct SliceHeadAnswer {
  SliceAnswerKind kind = SliceAnswerKind::no_dicom;  // head, no_dicom or incomplete
  SliceHead head;
};

// `whole`: the bytes are the whole file.
[[nodiscard]] SliceHeadAnswer read_slice_head(std::string_view bytes, bool whole);

}  // namespace cellmirror
