// A few pictures as they should look, compared as a person would: means of blocks of 8 by 8 pixels, with a tolerance.
// CELLMIRROR_UPDATE_GOLDEN=1 writes them anew; look at them before they are committed.
#include <png.h>

#include <cmath>
#include <fstream>

#include "drivers/display/image_codec.hpp"
#include "tests/unit/picture/picture_fixture.hpp"

namespace cellmirror::scene {
namespace {

constexpr int kGoldenWidth = 160;
constexpr int kGoldenHeight = 120;
constexpr int kBlock = 8;
constexpr double kMeanTolerance = 4;    // of 255, over the whole picture
constexpr double kBlockTolerance = 32;  // of one block

std::filesystem::path golden_file(const std::string& name) {
  return source_folder() / "tests/unit/picture/golden" / (name + ".png");
}

std::optional<Image> read_png(const std::filesystem::path& file) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&png, file.c_str()) == 0) return std::nullopt;
  png.format = PNG_FORMAT_RGBA;
  if (png.width != kGoldenWidth || png.height != kGoldenHeight) {
    png_image_free(&png);
    return std::nullopt;
  }
  Image image{.width = kGoldenWidth, .height = kGoldenHeight, .rgba = {}};
  image.rgba.resize(PNG_IMAGE_SIZE(png));
  if (png_image_finish_read(&png, nullptr, image.rgba.data(), 0, nullptr) == 0) return std::nullopt;
  return image;
}

void write_png(const Image& image, const std::filesystem::path& file) {
  display::ImageEncoder encoder;
  std::vector<std::uint8_t> bytes;
  ASSERT_TRUE(encoder.encode(image, {.format = ImageFormat::png, .png_level = 9}, bytes));
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

Eigen::Vector3d block_mean(const Image& image, int left, int top) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int y = top; y < top + kBlock; ++y) {
    for (int x = left; x < left + kBlock; ++x) {
      const std::uint8_t* p = image.pixel(x, y);
      sum += Eigen::Vector3d(p[0], p[1], p[2]);
    }
  }
  return sum / (kBlock * kBlock);
}

class GoldenPictures : public PictureTest {
 protected:
  void all_modes() {
    for (const DisplayMode mode :
         {DisplayMode::floor, DisplayMode::shadows, DisplayMode::textures, DisplayMode::antialiasing})
      set(mode);
    state_.full_screen = true;  // letters are drawn by whatever font a machine has
  }

  void expect_as_golden(const std::string& name) {
    const Image now = picture(kGoldenWidth, kGoldenHeight);
    if (std::getenv("CELLMIRROR_UPDATE_GOLDEN") != nullptr) write_png(now, golden_file(name));
    const auto golden = read_png(golden_file(name));
    ASSERT_TRUE(golden.has_value()) << golden_file(name);
    double sum = 0;
    double worst = 0;
    for (int y = 0; y < kGoldenHeight; y += kBlock) {
      for (int x = 0; x < kGoldenWidth; x += kBlock) {
        const double difference = (block_mean(now, x, y) - block_mean(*golden, x, y)).cwiseAbs().maxCoeff();
        sum += difference;
        worst = std::max(worst, difference);
      }
    }
    const double mean = sum * kBlock * kBlock / (kGoldenWidth * kGoldenHeight);
    EXPECT_LT(mean, kMeanTolerance) << name;
    EXPECT_LT(worst, kBlockTolerance) << name;
    if (HasFailure()) write_png(now, std::filesystem::path(testing::TempDir()) / (name + "_now.png"));
  }
};

TEST_F(GoldenPictures, TheTransferCell) {
  show("transfer_cell");
  all_modes();
  expect_as_golden("transfer_cell");
}

TEST_F(GoldenPictures, TheTransferCellFromAbove) {
  show("transfer_cell");
  all_modes();
  state_.display = 3;
  expect_as_golden("transfer_cell_top");
}

TEST_F(GoldenPictures, TheTrainer) {
  show("phantom_trainer");
  all_modes();
  expect_as_golden("phantom_trainer");
}

TEST_F(GoldenPictures, TheRos2CellWithAGhost) {
  show("ros2_cell");
  all_modes();
  const std::vector<RobotCondition> conditions = {{cell_->robots[0].slot, true, DataState::lost, 60}};
  input_.robots = conditions;
  expect_as_golden("ros2_cell_ghost");
}

}  // namespace
}  // namespace cellmirror::scene
