#include "config/volume/nrrd_head.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "config/volume/data_files.hpp"
#include "config/volume/volume_data.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

struct NamedWord {
  std::string_view word;
  VoxelType type;
};
constexpr std::array kTypeWords{NamedWord{"signed char", VoxelType::s8},
                                NamedWord{"int8", VoxelType::s8},
                                NamedWord{"int8_t", VoxelType::s8},
                                NamedWord{"uchar", VoxelType::u8},
                                NamedWord{"unsigned char", VoxelType::u8},
                                NamedWord{"uint8", VoxelType::u8},
                                NamedWord{"uint8_t", VoxelType::u8},
                                NamedWord{"short", VoxelType::s16},
                                NamedWord{"short int", VoxelType::s16},
                                NamedWord{"signed short", VoxelType::s16},
                                NamedWord{"signed short int", VoxelType::s16},
                                NamedWord{"int16", VoxelType::s16},
                                NamedWord{"int16_t", VoxelType::s16},
                                NamedWord{"ushort", VoxelType::u16},
                                NamedWord{"unsigned short", VoxelType::u16},
                                NamedWord{"unsigned short int", VoxelType::u16},
                                NamedWord{"uint16", VoxelType::u16},
                                NamedWord{"uint16_t", VoxelType::u16},
                                NamedWord{"int", VoxelType::s32},
                                NamedWord{"signed int", VoxelType::s32},
                                NamedWord{"int32", VoxelType::s32},
                                NamedWord{"int32_t", VoxelType::s32},
                                NamedWord{"uint", VoxelType::u32},
                                NamedWord{"unsigned int", VoxelType::u32},
                                NamedWord{"uint32", VoxelType::u32},
                                NamedWord{"uint32_t", VoxelType::u32},
                                NamedWord{"longlong", VoxelType::s64},
                                NamedWord{"long long", VoxelType::s64},
                                NamedWord{"long long int", VoxelType::s64},
                                NamedWord{"signed long long", VoxelType::s64},
                                NamedWord{"signed long long int", VoxelType::s64},
                                NamedWord{"int64", VoxelType::s64},
                                NamedWord{"int64_t", VoxelType::s64},
                                NamedWord{"ulonglong", VoxelType::u64},
                                NamedWord{"unsigned long long", VoxelType::u64},
                                NamedWord{"unsigned long long int", VoxelType::u64},
                                NamedWord{"uint64", VoxelType::u64},
                                NamedWord{"uint64_t", VoxelType::u64},
                                NamedWord{"float", VoxelType::f32},
                                NamedWord{"double", VoxelType::f64}};

// What says nothing about where a voxel is or what it is worth.
constexpr std::array<std::string_view, 12> kWithoutEffect{
    "content",     "number",    "block size", "min",     "max",    "sample units",
    "thicknesses", "axis mins", "axis maxs",  "centers", "labels", "measurement frame"};

// The units of length that are understood, in m.
std::optional<double> metres_of(std::string_view unit) {
  if (unit.empty() || equal_ignoring_case(unit, "mm") || equal_ignoring_case(unit, "millimeter")) return 1e-3;
  if (equal_ignoring_case(unit, "cm")) return 1e-2;
  if (equal_ignoring_case(unit, "m")) return 1.0;
  if (equal_ignoring_case(unit, "um") || equal_ignoring_case(unit, "micron") || unit == "\xC2\xB5m") return 1e-6;
  return std::nullopt;
}

// Words between blanks.
std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> out;
  while (true) {
    text = trimmed(text);
    if (text.empty()) return out;
    const std::size_t end = std::min(text.find_first_of(" \t"), text.size());
    out.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
}

// "a" "b": what is between quotes.
std::vector<std::string_view> quoted(std::string_view text) {
  std::vector<std::string_view> out;
  while (true) {
    const std::size_t begin = text.find('"');
    if (begin == std::string_view::npos) return out;
    const std::size_t end = text.find('"', begin + 1);
    if (end == std::string_view::npos) return out;
    out.push_back(text.substr(begin + 1, end - begin - 1));
    text.remove_prefix(end + 1);
  }
}

// "(1,0,0) (0,1,0)": each in brackets; none where it is no list of vectors.
std::optional<std::vector<Eigen::Vector3d>> vectors_of(std::string_view text) {
  std::vector<Eigen::Vector3d> out;
  for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
    const std::size_t end = text.find(')');
    if (text.front() != '(' || end == std::string_view::npos || out.size() == 3) return std::nullopt;
    std::string_view inner = text.substr(1, end - 1);
    Eigen::Vector3d vector;
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t comma = axis < 2 ? inner.find(',') : inner.size();
      if (comma == std::string_view::npos) return std::nullopt;
      const auto number = parse_number(trimmed(inner.substr(0, comma)));
      if (!number || std::abs(*number) > 1e9) return std::nullopt;
      vector[axis] = *number;
      inner.remove_prefix(std::min(comma + 1, inner.size()));
    }
    out.push_back(vector);
    text.remove_prefix(end + 1);
  }
  return out;
}

class HeadParser {
 public:
  HeadParser(std::string_view text, const std::string& file, Diagnostics& diagnostics)
      : text_(text), file_(file), diagnostics_(diagnostics) {}

  std::optional<NrrdHead> parse() {
    if (!read_magic() || !read_fields()) return std::nullopt;
    read_type();
    read_size();
    read_encoding();
    read_places();
    read_data_files();
    for (const auto& [name, field] : fields_) {
      if (field.used || std::ranges::find(kWithoutEffect, name) != kWithoutEffect.end()) continue;
      diagnostics_.warning({file_, field.line, 0}, fmt::format("\"{}\" is not used", printable(name)));
    }
    if (errors_ > 0) return std::nullopt;
    return std::move(head_);
  }

 private:
  struct Field {
    std::string_view value;
    int line = 0;
    bool used = false;
  };

  void refuse(int line, std::string what, std::string remedy = {}) {
    ++errors_;
    diagnostics_.error({file_, line, 0}, std::move(what), std::move(remedy));
  }

  // None at the end.
  std::optional<std::string_view> next_line() {
    if (at_ >= text_.size()) return std::nullopt;
    const std::size_t end = text_.find('\n', at_);
    std::string_view line = text_.substr(at_, end == std::string_view::npos ? end : end - at_);
    at_ = end == std::string_view::npos ? text_.size() : end + 1;
    if (line.ends_with('\r')) line.remove_suffix(1);
    ++line_;
    return line;
  }

  bool read_magic() {
    const auto magic = next_line();
    constexpr std::string_view kMagic = "NRRD000";
    if (magic && magic->size() == kMagic.size() + 1 && magic->starts_with(kMagic) && magic->back() >= '1' &&
        magic->back() <= '5')
      return true;
    refuse(1, "the file does not begin with NRRD0001 to NRRD0005", "name a NRRD file");
    return false;
  }

  bool read_fields() {
    while (const auto line = next_line()) {
      if (line->empty()) {
        head_.data_offset = at_;
        ended_ = true;
        return true;
      }
      if (line->front() == '#') continue;
      const std::size_t colon = line->find(':');
      if (colon == std::string_view::npos || colon + 1 >= line->size() ||
          ((*line)[colon + 1] != ' ' && (*line)[colon + 1] != '=')) {
        refuse(line_, "the line is neither \"field: value\" nor \"key:=value\"");
        return false;
      }
      if ((*line)[colon + 1] == '=') continue;
      std::string name = lower_case(line->substr(0, colon));
      if (name == "datafile") name = "data file";
      if (name == "lineskip") name = "line skip";
      if (name == "byteskip") name = "byte skip";
      const std::string_view value = trimmed(line->substr(colon + 1));
      if (!fields_.emplace(name, Field{value, line_}).second) {
        refuse(line_, fmt::format("there is another \"{}\"", printable(name)));
        return false;
      }
      if (name == "data file" && words_of(value).size() <= 2 && value.starts_with("LIST")) {
        read_list();
        return true;
      }
    }
    if (text_.size() >= kLargestNrrdHead) {
      refuse(0, fmt::format("the head does not end within {} bytes", kLargestNrrdHead));
      return false;
    }
    return true;
  }

  void read_list() {
    while (const auto line = next_line()) {
      if (trimmed(*line).empty()) continue;
      if (head_.data_files.size() == kMostDataFiles)
        return refuse(line_, fmt::format("there are more than {} data files", kMostDataFiles));
      head_.data_files.emplace_back(*line);
    }
    if (head_.data_files.empty()) refuse(line_, "LIST names no data file");
  }

  Field* field(std::string_view name) {
    const auto at = fields_.find(name);
    if (at == fields_.end()) return nullptr;
    at->second.used = true;
    return &at->second;
  }
  Field* needed(std::string_view name) {
    Field* found = field(name);
    if (found == nullptr) refuse(0, fmt::format("\"{}\" is missing", name));
    return found;
  }

  void read_type() {
    const Field* type = needed("type");
    if (type == nullptr) return;
    const auto* const known = std::ranges::find(kTypeWords, type->value, &NamedWord::word);
    if (known == kTypeWords.end())
      return refuse(type->line, fmt::format("the type {} is not read", printable(type->value)),
                    "types are char, short, int, long long with and without sign, float and double");
    head_.format.type = known->type;
  }

  void read_size() {
    const Field* dimension = needed("dimension");
    if (dimension != nullptr && dimension->value != "3")
      return refuse(dimension->line, fmt::format("the dimension is {}, not 3", printable(dimension->value)),
                    "export one volume of scalar values");
    const Field* sizes = needed("sizes");
    if (sizes == nullptr || dimension == nullptr) return;
    const auto words = words_of(sizes->value);
    std::array<std::uint64_t, 3> size{};
    bool good = words.size() == 3;
    for (std::size_t i = 0; good && i < 3; ++i) {
      const auto number = parse_integer(words[i]);
      good = number && *number > 0 && *number <= 0x7FFFFFFF;
      if (good) size[i] = static_cast<std::uint64_t>(*number);
    }
    if (!good) return refuse(sizes->line, "\"sizes\" is not three positive numbers");
    if (const auto fits = check_voxels(size, head_.format.type == VoxelType::u8 ? 1 : 2); !fits)
      return refuse(sizes->line, fits.error().what, fits.error().remedy);
    for (std::size_t i = 0; i < 3; ++i) head_.format.size[i] = static_cast<std::uint32_t>(size[i]);
    if (const Field* kinds = field("kinds")) check_kinds(*kinds);
  }

  void check_kinds(const Field& kinds) {
    for (const std::string_view kind : words_of(kinds.value)) {
      if (kind == "domain" || kind == "space" || kind == "???" || kind == "none") continue;
      refuse(kinds.line, fmt::format("an axis of kind {} is no axis of space", printable(kind)),
             "export one volume of scalar values");
    }
  }

  void read_encoding() {
    if (const Field* encoding = needed("encoding")) {
      const std::string word = lower_case(encoding->value);
      head_.gzip = word == "gzip" || word == "gz";
      if (!head_.gzip && word != "raw")
        refuse(encoding->line, fmt::format("the encoding {} is not read", printable(encoding->value)),
               "export it as raw or gzip");
    }
    const Field* endian = field("endian");
    if (bytes_of(head_.format.type) > 1 && endian == nullptr) return refuse(0, "\"endian\" is missing");
    if (endian != nullptr) {
      head_.format.big_endian = equal_ignoring_case(endian->value, "big");
      if (!head_.format.big_endian && !equal_ignoring_case(endian->value, "little"))
        refuse(endian->line, fmt::format("\"endian\" is {}, not little or big", printable(endian->value)));
    }
    read_skips();
  }

  void read_skips() {
    constexpr long long kMostLines = 1'000'000;
    constexpr long long kMostBytes = 1LL << 40;
    if (const Field* lines = field("line skip")) {
      const auto number = parse_integer(lines->value);
      if (!number || *number < 0 || *number > kMostLines)
        return refuse(lines->line, "\"line skip\" is no number of lines");
      head_.skip_lines = static_cast<std::uint32_t>(*number);
    }
    if (const Field* bytes = field("byte skip")) {
      const auto number = parse_integer(bytes->value);
      if (!number || *number < -1 || *number > kMostBytes)
        return refuse(bytes->line, "\"byte skip\" is no number of bytes");
      head_.at_end = *number == -1;
      head_.skip_bytes = head_.at_end ? 0 : static_cast<std::uint64_t>(*number);
      if (head_.gzip && *number != 0) refuse(bytes->line, "\"byte skip\" before compressed data is not read");
    }
    if (head_.gzip && head_.skip_lines != 0) refuse(0, "\"line skip\" before compressed data is not read");
  }

  void read_places() {
    const double unit = unit_of_length();
    if (const Field* space = field("space")) head_.space = printable(space->value);
    if (const Field* dimension = field("space dimension"); dimension != nullptr && dimension->value != "3")
      return refuse(dimension->line, "the space has another dimension than 3");
    if (const Field* directions = field("space directions")) return read_directions(*directions, unit);
    if (const Field* origin = field("space origin"))
      diagnostics_.warning({file_, origin->line, 0}, "\"space origin\" without \"space directions\" is not used");
    const Field* spacings = field("spacings");
    if (spacings == nullptr) {
      diagnostics_.warning({file_, 0, 0}, "the file has no spacing: voxels of 1 mm are assumed",
                           "write \"spacings: X Y Z\"");
      return;
    }
    const auto words = words_of(spacings->value);
    if (words.size() != 3) return refuse(spacings->line, "\"spacings\" is not three numbers");
    for (std::size_t i = 0; i < 3; ++i) {
      const auto number = parse_number(words[i]);
      if (!number) return refuse(spacings->line, fmt::format("the spacing {} is no number", printable(words[i])));
      head_.spacing_m[static_cast<Eigen::Index>(i)] = std::abs(*number) * unit;
    }
    check_spacings(spacings->line);
  }

  double unit_of_length() {
    constexpr double kMillimetre = 1e-3;
    const Field* of_space = field("space units");
    const Field* of_axes = field("units");
    const Field* units = of_space != nullptr ? of_space : of_axes;
    if (units == nullptr) return kMillimetre;
    const auto words = quoted(units->value);
    for (const std::string_view word : words) {
      if (metres_of(word) && metres_of(word) == metres_of(words.front())) continue;
      refuse(units->line, fmt::format("the unit {} is not read", printable(word)), "write the same of mm, cm, m or um");
      return kMillimetre;
    }
    return words.empty() ? kMillimetre : *metres_of(words.front());
  }

  void check_spacings(int line) {
    if (const auto fits = check_spacing(head_.spacing_m); !fits) refuse(line, fits.error().what, fits.error().remedy);
  }

  void read_directions(const Field& directions, double unit) {
    const auto vectors = vectors_of(directions.value);
    if (!vectors || vectors->size() != 3)
      return refuse(directions.line, "\"space directions\" is not three vectors of three numbers");
    Eigen::Matrix3d axes;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d& step = (*vectors)[static_cast<std::size_t>(i)];
      head_.spacing_m[i] = step.norm() * unit;
      axes.col(i) = step.normalized();
    }
    check_spacings(directions.line);
    if (errors_ > 0) return;
    constexpr double kRightAngle = 1e-3;
    for (int i = 0; i < 3; ++i) {
      if (std::abs(axes.col(i).dot(axes.col((i + 1) % 3))) > kRightAngle)
        return refuse(directions.line, "the axes are not at right angles to each other",
                      "resample it: a sheared volume, as of a tilted gantry, is not read");
    }
    place(axes, unit);
  }

  // Frame V is right-handed, whatever the order of the slices is.
  void place(Eigen::Matrix3d axes, double unit) {
    const bool left_handed_space = equal_ignoring_case(head_.space, "left-anterior-superior") ||
                                   equal_ignoring_case(head_.space, "LAS") ||
                                   head_.space.find("left-handed") != std::string::npos;
    head_.format.last_slice_first = (axes.determinant() < 0) != left_handed_space;
    if (left_handed_space) return;  // no pose in a right-handed frame
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
    if (const Field* field_of_origin = field("space origin")) {
      const auto vector = vectors_of(field_of_origin->value);
      if (!vector || vector->size() != 1)
        return refuse(field_of_origin->line, "\"space origin\" is not a vector of three numbers");
      origin = vector->front() * unit;
    }
    Eigen::Vector3d middle = origin;
    for (int i = 0; i < 3; ++i)
      middle += axes.col(i) * (0.5 * (head_.format.size[static_cast<std::size_t>(i)] - 1.0) * head_.spacing_m[i]);
    if (head_.format.last_slice_first) axes.col(2) *= -1;
    Pose X = Pose::Identity();
    X.linear() = Eigen::Quaterniond(axes).normalized().toRotationMatrix();
    X.translation() = middle;
    head_.X_PV = in_lps(X);
  }

  // The patient's axes of RAS have the other sense of x and y.
  [[nodiscard]] Pose in_lps(const Pose& X) const {
    if (!equal_ignoring_case(head_.space, "right-anterior-superior") && !equal_ignoring_case(head_.space, "RAS"))
      return X;
    Pose turned = Pose::Identity();
    turned.linear() = Eigen::Vector3d(-1, -1, 1).asDiagonal();
    return turned * X;
  }

  void read_data_files() {
    const Field* data = field("data file");
    if (data == nullptr) {
      if (!ended_) refuse(0, "the head has neither an empty line at its end nor a \"data file\"");
      return;
    }
    if (!head_.data_files.empty()) return check_list(*data);
    const auto words = words_of(data->value);
    if (words.size() >= 4 && words[0].find('%') != std::string_view::npos) {
      std::array<long long, 3> numbers{};
      for (std::size_t i = 0; i < 3; ++i) {
        const auto number = parse_integer(words[i + 1]);
        if (!number) return refuse(data->line, "\"data file\" is not \"PATTERN FIRST LAST STEP\"");
        numbers[i] = *number;
      }
      auto names = names_of_pattern(words[0], numbers[0], numbers[1], numbers[2]);
      if (!names) return refuse(data->line, names.error().what, names.error().remedy);
      head_.data_files = std::move(*names);
      return check_list(*data);
    }
    head_.data_files.emplace_back(data->value);
  }

  void check_list(const Field& data) {
    if (head_.gzip) refuse(data.line, "several compressed data files are not read", "put the slices into one file");
    if (head_.skip_lines > 0) refuse(data.line, "\"line skip\" with several data files is not read");
    const std::size_t files = head_.data_files.size();
    if (files > 0 && head_.format.size[2] % files != 0)
      refuse(data.line, fmt::format("{} data files do not hold {} slices in equal parts", files, head_.format.size[2]));
  }

  std::string_view text_;
  const std::string& file_;
  Diagnostics& diagnostics_;
  std::size_t at_ = 0;
  int line_ = 0;
  bool ended_ = false;
  std::size_t errors_ = 0;
  std::map<std::string, Field, std::less<>> fields_;
  NrrdHead head_;
};

}  // namespace

std::optional<NrrdHead> parse_nrrd_head(std::string_view text, const std::string& file, Diagnostics& diagnostics) {
  return HeadParser(text.substr(0, kLargestNrrdHead), file, diagnostics).parse();
}

}  // namespace cellmirror
