#include "config/volume_reader/slice_head.hpp"

#include <gdcmAttribute.h>
#include <gdcmByteValue.h>
#include <gdcmDataSet.h>
#include <gdcmFile.h>
#include <gdcmReader.h>
#include <gdcmTag.h>

#include <array>
#include <istream>
#include <set>
#include <string>

#include "config/volume_reader/memory_stream.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

// Without the blanks and zeros that make its length even.
std::string text_at(const gdcm::DataSet& data, const gdcm::Tag& tag) {
  if (!data.FindDataElement(tag)) return {};
  const gdcm::ByteValue* value = data.GetDataElement(tag).GetByteValue();
  if (value == nullptr || value->GetPointer() == nullptr) return {};
  std::string_view text(value->GetPointer(), std::min<std::size_t>(value->GetLength(), kLongestSliceText));
  while (!text.empty() && (text.back() == '\0' || text.back() == ' ')) text.remove_suffix(1);
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  return std::string(text);
}

// "1\2\3"
template <std::size_t kCount>
std::optional<std::array<double, kCount>> numbers_at(const gdcm::DataSet& data, const gdcm::Tag& tag) {
  const std::string text = text_at(data, tag);
  std::string_view left = text;
  std::array<double, kCount> out{};
  for (std::size_t i = 0; i < kCount; ++i) {
    const std::size_t end = std::min(left.find('\\'), left.size());
    const auto number = parse_number(trimmed(left.substr(0, end)));
    if (!number) return std::nullopt;
    out[i] = *number;
    left.remove_prefix(std::min(end + 1, left.size()));
  }
  return out;
}

template <std::uint16_t kGroup, std::uint16_t kElement>
std::uint32_t unsigned_at(const gdcm::DataSet& data, std::uint32_t otherwise) {
  const gdcm::Tag tag(kGroup, kElement);
  if (!data.FindDataElement(tag) || data.GetDataElement(tag).IsEmpty()) return otherwise;
  gdcm::Attribute<kGroup, kElement> attribute;
  attribute.SetFromDataElement(data.GetDataElement(tag));
  return static_cast<std::uint32_t>(attribute.GetValue());
}

void read_places(const gdcm::DataSet& data, SliceHead& head) {
  head.position = numbers_at<3>(data, gdcm::Tag(0x0020, 0x0032));
  head.orientation = numbers_at<6>(data, gdcm::Tag(0x0020, 0x0037));
  head.spacing = numbers_at<2>(data, gdcm::Tag(0x0028, 0x0030));
  const auto slope = numbers_at<1>(data, gdcm::Tag(0x0028, 0x1053));
  const auto intercept = numbers_at<1>(data, gdcm::Tag(0x0028, 0x1052));
  head.rescaled = slope.has_value() && intercept.has_value();
  if (slope) head.slope = (*slope)[0];
  if (intercept) head.intercept = (*intercept)[0];
}

SliceHead head_of(const gdcm::File& file) {
  const gdcm::DataSet& data = file.GetDataSet();
  SliceHead head;
  head.patient = text_at(data, gdcm::Tag(0x0010, 0x0020)) + "\n" + text_at(data, gdcm::Tag(0x0010, 0x0010));
  head.series = text_at(data, gdcm::Tag(0x0020, 0x000e));
  head.instance = text_at(data, gdcm::Tag(0x0008, 0x0018));
  head.transfer_syntax = file.GetHeader().GetDataSetTransferSyntax().GetString();
  head.modality = text_at(data, gdcm::Tag(0x0008, 0x0060));
  head.manufacturer = text_at(data, gdcm::Tag(0x0008, 0x0070));
  head.model = text_at(data, gdcm::Tag(0x0008, 0x1090));
  head.description = text_at(data, gdcm::Tag(0x0008, 0x103e));
  head.image_type = text_at(data, gdcm::Tag(0x0008, 0x0008));
  head.photometric = text_at(data, gdcm::Tag(0x0028, 0x0004));
  head.rescale_type = text_at(data, gdcm::Tag(0x0028, 0x1054));
  head.rows = unsigned_at<0x0028, 0x0010>(data, 0);
  head.columns = unsigned_at<0x0028, 0x0011>(data, 0);
  head.bits_allocated = unsigned_at<0x0028, 0x0100>(data, 0);
  head.bits_stored = unsigned_at<0x0028, 0x0101>(data, head.bits_allocated);
  head.high_bit = unsigned_at<0x0028, 0x0102>(data, head.bits_stored > 0 ? head.bits_stored - 1 : 0);
  head.is_signed = unsigned_at<0x0028, 0x0103>(data, 0) == 1;
  head.samples = unsigned_at<0x0028, 0x0002>(data, 1);
  if (const auto frames = numbers_at<1>(data, gdcm::Tag(0x0028, 0x0008));
      frames && (*frames)[0] >= 0 && (*frames)[0] < 1e9)
    head.frames = static_cast<std::uint32_t>((*frames)[0]);
  read_places(data, head);
  return head;
}

bool has_preamble(std::string_view bytes) {
  constexpr std::size_t kPreamble = 128;
  return bytes.size() >= kPreamble + 4 && bytes.substr(kPreamble, 4) == "DICM";
}

}  // namespace

SliceHeadAnswer read_slice_head(std::string_view bytes, bool whole) {
  if (!has_preamble(bytes)) return {SliceAnswerKind::no_dicom, {}};
  MemoryBuffer buffer(bytes);
  std::istream stream(&buffer);
  gdcm::Reader reader;
  reader.SetStream(stream);
  // Everything wanted is before the pixels, which are left out.
  const gdcm::Tag pixels(0x7fe0, 0x0010);
  const bool read = reader.ReadUpToTag(pixels, {pixels});
  if (!whole && (!read || buffer.overran())) return {SliceAnswerKind::incomplete, {}};
  if (!read) return {SliceAnswerKind::no_dicom, {}};
  return {SliceAnswerKind::head, head_of(reader.GetFile())};
}

}  // namespace cellmirror
