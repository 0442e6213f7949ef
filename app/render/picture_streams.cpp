#include "app/render/picture_streams.hpp"

#include <utility>

#include "app/render/picture_request.hpp"

namespace cellmirror::app {

namespace {

class Stream final : public PictureStream {
 public:
  explicit Stream(std::shared_ptr<PictureObserver> observer) : observer_(std::move(observer)) {}
  void change(const PictureRequest& request) override { observer_->change(request); }
  [[nodiscard]] std::shared_ptr<const EncodedImage> newest(std::uint64_t has) const override {
    return observer_->newest(has);
  }
  [[nodiscard]] std::string problem() const override { return observer_->problem(); }

 private:
  std::shared_ptr<PictureObserver> observer_;
};

}  // namespace

PictureRequest PictureObserver::request() const {
  const std::scoped_lock lock(mutex_);
  return request_;
}

void PictureObserver::change(const PictureRequest& request) {
  if (!check_request(request)) return;  // refused to the client by the caller
  asked_now();
  const std::scoped_lock lock(mutex_);
  if (!same_drawing(request_, request)) {
    newest_.reset();
    problem_.clear();
  }
  request_ = request;
}

std::shared_ptr<const EncodedImage> PictureObserver::newest(std::uint64_t has) {
  asked_now();
  const std::scoped_lock lock(mutex_);
  return newest_ && newest_->sequence != has ? newest_ : nullptr;
}

std::string PictureObserver::problem() const {
  const std::scoped_lock lock(mutex_);
  return problem_;
}

void PictureObserver::show(std::shared_ptr<const EncodedImage> picture, const PictureRequest& request) {
  const std::scoped_lock lock(mutex_);
  if (!same_drawing(request_, request)) return;
  problem_.clear();
  newest_.swap(picture);  // the one before is let go by the argument, without the lock
}

void PictureObserver::report_problem(const Error& problem, const PictureRequest& request) {
  const std::scoped_lock lock(mutex_);
  if (same_drawing(request_, request)) problem_ = problem.text();
}

bool PictureObserver::looks(Timestamp now) const {
  return now - Timestamp{asked_ns_.load(std::memory_order_relaxed)} < kObserverTimeout;
}

std::unique_ptr<PictureStream> PictureStreams::open(const PictureRequest& request) {
  const std::scoped_lock lock(mutex_);
  std::erase_if(observers_, [](const auto& observer) { return observer.expired(); });
  if (observers_.size() >= kMost) return nullptr;
  auto observer = std::make_shared<PictureObserver>(request, clock_);
  observers_.push_back(observer);
  return std::make_unique<Stream>(std::move(observer));
}

std::vector<std::shared_ptr<PictureObserver>> PictureStreams::all() const {
  std::vector<std::shared_ptr<PictureObserver>> out;
  const std::scoped_lock lock(mutex_);
  std::erase_if(observers_, [](const auto& observer) { return observer.expired(); });
  for (const auto& observer : observers_) {
    if (auto there = observer.lock()) out.push_back(std::move(there));
  }
  return out;
}

std::size_t PictureStreams::size() const { return all().size(); }

}  // namespace cellmirror::app
