// Answers to HTTP requests: status, headers, body. Pure.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ipc/web/http_request.hpp"
#include "ipc/web/outgoing.hpp"
#include "ipc/web/page_files.hpp"
#include "ipc/web/web_site.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/image.hpp"
#include "rt_core/ports/scene_stream.hpp"

namespace cellmirror::web {

struct Answer {
  int status = 200;
  std::string content_type = "text/plain; charset=utf-8";
  Chunk body;
  std::vector<std::pair<std::string_view, std::string>> headers;  // in addition to those of every answer
};

[[nodiscard]] Answer text_answer(int status, std::string text);
[[nodiscard]] Answer json_answer(std::string text);
[[nodiscard]] Answer document_answer(const Document& document);
// 503 with the reason where there is no picture.
[[nodiscard]] Answer picture_answer(Result<EncodedImage> picture);
// The file with its hash as ETag; 304 where that is `known`, the header If-None-Match (may be empty). 503 with the
// reason where there is none.
[[nodiscard]] Answer geometry_answer(const Result<std::shared_ptr<const SceneGeometry>>& geometry,
                                     std::string_view known);
// 304 where the client has this version; compressed where the client accepts it.
[[nodiscard]] Answer file_answer(const PageFile& file, const HttpRequest& request);

// The status line and all headers. Every answer ends its connection.
[[nodiscard]] std::string head_of(const Answer& answer, Timestamp now);

}  // namespace cellmirror::web
