// Where the frames of a film go: a folder of JPEG files, one file of JPEGs behind each other, or ffmpeg, which makes an
// MP4 of them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "rt_core/base/result.hpp"

namespace cellmirror::app {

class FilmSink {
 public:
  virtual ~FilmSink() = default;
  virtual Result<void> add(std::span<const std::uint8_t> jpeg) = 0;
  // After the last frame; tells what became of it, e.g. "31 frames in film/".
  virtual Result<std::string> finish() = 0;
};

// By the name: F.mp4 (where there is no ffmpeg, frames in F.frames/, and `note` says so), F.mjpeg, else a folder, which
// is made. `rate_hz`: of the film.
[[nodiscard]] Result<std::unique_ptr<FilmSink>> make_film_sink(const std::string& name, double rate_hz,
                                                               std::string& note);

}  // namespace cellmirror::app
