#include "scripts/programs/crcl/xml_reader.hpp"

#include <expat.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "rt_core/base/text.hpp"
#include "scripts/programs/crcl/plain_xml.hpp"

namespace cellmirror::crcl {
namespace {

class ExpatReader {
 public:
  ExpatReader(const std::string& file, const XmlVisitor& visitor, Diagnostics& diagnostics, XmlProgress visited)
      : file_(file), visitor_(visitor), diagnostics_(diagnostics), visited_(visited) {}

  void read(std::string_view text) {
    const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(XML_ParserCreate(nullptr),
                                                                              &XML_ParserFree);
    if (parser == nullptr) {
      diagnostics_.error({.file = file_}, "not enough memory for the XML parser");
      return;
    }
    parser_ = parser.get();
    text_ = text;
    line_end_ = text.find('\n');
    XML_SetUserData(parser_, this);
    XML_SetElementHandler(parser_, &ExpatReader::on_start, &ExpatReader::on_end);
    XML_SetCharacterDataHandler(parser_, &ExpatReader::on_text);
    XML_SetStartDoctypeDeclHandler(parser_, &ExpatReader::on_doctype);
    parse(text);
  }

 private:
  // In pieces: expat counts bytes with an int.
  void parse(std::string_view text) {
    constexpr std::size_t kPiece = std::size_t{1} << 20;
    do {
      const std::size_t size = std::min(text.size(), kPiece);
      const bool last = size == text.size();
      if (XML_Parse(parser_, text.data(), static_cast<int>(size), last ? 1 : 0) == XML_STATUS_ERROR) {
        if (!stopped_) fail(XML_ErrorString(XML_GetErrorCode(parser_)));
        return;
      }
      text.remove_prefix(size);
    } while (!text.empty() && !stopped_);
  }

  // Where the parser is. expat would scan every byte again; counting ends of lines is faster.
  void find_place() {
    const XML_Index index = XML_GetCurrentByteIndex(parser_);
    const std::size_t here = index < 0 ? 0 : std::min(static_cast<std::size_t>(index), text_.size());
    while (line_end_ < here) {
      ++line_;
      line_begin_ = line_end_ + 1;
      line_end_ = text_.find('\n', line_begin_);
    }
    column_ = here < line_begin_ ? 1 : static_cast<std::uint32_t>(here - line_begin_) + 1;
  }

  void fail(std::string_view what) {
    find_place();
    diagnostics_.error({.file = file_, .line = static_cast<int>(line_), .column = static_cast<int>(column_)},
                       fmt::format("the XML cannot be read: {}", what));
    stop();
  }
  void stop() {
    if (!std::exchange(stopped_, true)) XML_StopParser(parser_, XML_FALSE);
  }

  static void on_start(void* self, const XML_Char* name, const XML_Char** attributes) {
    static_cast<ExpatReader*>(self)->start(name, attributes);
  }
  static void on_end(void* self, const XML_Char* /*name*/) { static_cast<ExpatReader*>(self)->end(); }
  static void on_text(void* self, const XML_Char* text, int size) {
    static_cast<ExpatReader*>(self)->text({text, static_cast<std::size_t>(size)});
  }
  static void on_doctype(void* self, const XML_Char* /*name*/, const XML_Char* /*system*/, const XML_Char* /*id*/,
                         int /*internal*/) {
    static_cast<ExpatReader*>(self)->fail("a document type declaration");
  }

  void start(std::string_view name, const XML_Char** attributes) {
    if (stopped_) return;
    if (++depth_ > kMostDepth) return fail(fmt::format("more than {} nested elements", kMostDepth));
    std::string_view type;
    for (; attributes[0] != nullptr; attributes += 2) {
      if (without_prefix(attributes[0]) == "type") type = without_prefix(attributes[1]);
    }
    find_place();
    if (depth_ == 1) {
      const XmlNode root = {.name = without_prefix(name), .type = {}, .text = {}, .line = line_, .column = column_};
      if (!visited_.root && !visitor_.root(root)) stop();
      return;
    }
    if (depth_ == 2) tree_.clear();
    if (tree_.size() >= kMostNodes) return fail(fmt::format("an element with more than {} in it", kMostNodes));
    texts_[depth_ - 1].clear();
    tree_.open(tree_.keep(without_prefix(name)), tree_.keep(type), line_, column_);
  }
  void end() {
    if (stopped_) return;
    --depth_;
    if (depth_ == 0) return;
    tree_.close(tree_.keep(trimmed(texts_[depth_])));
    if (depth_ == 1 && ++elements_ > visited_.elements) visitor_.element(tree_);
  }
  void text(std::string_view text) {
    if (stopped_ || depth_ < 2) return;
    std::string& before = texts_[depth_ - 1];
    if (before.size() + text.size() > kLongestText) {
      return fail(fmt::format("an element with more than {} bytes of text", kLongestText));
    }
    before += text;
  }

  const std::string& file_;
  const XmlVisitor& visitor_;
  Diagnostics& diagnostics_;
  XML_Parser parser_ = nullptr;
  std::string_view text_;
  std::size_t line_begin_ = 0;
  std::size_t line_end_ = 0;  // npos: the last line
  std::uint32_t line_ = 1;
  std::uint32_t column_ = 1;
  XmlTree tree_;
  std::array<std::string, kMostDepth> texts_;  // of the open elements
  std::size_t depth_ = 0;
  XmlProgress visited_;
  std::size_t elements_ = 0;
  bool stopped_ = false;
};

}  // namespace

void read_xml_by_expat(std::string_view text, const std::string& file, const XmlVisitor& visitor,
                       Diagnostics& diagnostics, XmlProgress visited) {
  ExpatReader(file, visitor, diagnostics, visited).read(text);
}

void read_xml(std::string_view text, const std::string& file, const XmlVisitor& visitor, Diagnostics& diagnostics) {
  const PlainRead plain = read_plain_xml(text, visitor);
  if (!plain.complete) read_xml_by_expat(text, file, visitor, diagnostics, plain.visited);
}

}  // namespace cellmirror::crcl
