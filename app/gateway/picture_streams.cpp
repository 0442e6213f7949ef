#include "app/gateway/picture_streams.hpp"

#include <utility>

#include "app/gateway/picture_wish.hpp"

namespace cellmirror::app {

namespace {

class Stream final : public PictureStream {
 public:
  explicit Stream(std::shared_ptr<Looker> looker) : looker_(std::move(looker)) {}
  void change(const PictureRequest& wish) override { looker_->change(wish); }
  [[nodiscard]] std::shared_ptr<const EncodedImage> newest(std::uint64_t has) const override {
    return looker_->newest(has);
  }
  [[nodiscard]] std::string problem() const override { return looker_->problem(); }

 private:
  std::shared_ptr<Looker> looker_;
};

}  // namespace

PictureRequest Looker::wish() const {
  const std::scoped_lock lock(mutex_);
  return wish_;
}

void Looker::change(const PictureRequest& wish) {
  if (!check_wish(wish)) return;  // whoever speaks with the client has told it
  asked_now();
  const std::scoped_lock lock(mutex_);
  if (!same_drawing(wish_, wish)) {
    newest_.reset();
    problem_.clear();
  }
  wish_ = wish;
}

std::shared_ptr<const EncodedImage> Looker::newest(std::uint64_t has) {
  asked_now();
  const std::scoped_lock lock(mutex_);
  return newest_ && newest_->sequence != has ? newest_ : nullptr;
}

std::string Looker::problem() const {
  const std::scoped_lock lock(mutex_);
  return problem_;
}

void Looker::show(std::shared_ptr<const EncodedImage> picture, const PictureRequest& wish) {
  const std::scoped_lock lock(mutex_);
  if (!same_drawing(wish_, wish)) return;
  problem_.clear();
  newest_.swap(picture);  // the one before is let go by the argument, without the lock
}

void Looker::tell(const Error& problem, const PictureRequest& wish) {
  const std::scoped_lock lock(mutex_);
  if (same_drawing(wish_, wish)) problem_ = problem.text();
}

bool Looker::looks(Timestamp now) const {
  return now - Timestamp{asked_ns_.load(std::memory_order_relaxed)} < kPatience;
}

std::unique_ptr<PictureStream> PictureStreams::open(const PictureRequest& wish) {
  const std::scoped_lock lock(mutex_);
  std::erase_if(lookers_, [](const auto& looker) { return looker.expired(); });
  if (lookers_.size() >= kMost) return nullptr;
  auto looker = std::make_shared<Looker>(wish, clock_);
  lookers_.push_back(looker);
  return std::make_unique<Stream>(std::move(looker));
}

std::vector<std::shared_ptr<Looker>> PictureStreams::all() const {
  std::vector<std::shared_ptr<Looker>> out;
  const std::scoped_lock lock(mutex_);
  std::erase_if(lookers_, [](const auto& looker) { return looker.expired(); });
  for (const auto& looker : lookers_) {
    if (auto there = looker.lock()) out.push_back(std::move(there));
  }
  return out;
}

std::size_t PictureStreams::size() const { return all().size(); }

}  // namespace cellmirror::app
