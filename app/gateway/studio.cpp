#include "app/gateway/studio.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/gateway/picked_object.hpp"
#include "app/gateway/picture_rate.hpp"
#include "app/gateway/picture_wish.hpp"
#include "app/gateway/scene_fingerprint.hpp"
#include "app/pictures/renderer_options.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/rt/scheduling.hpp"

namespace cellmirror::app {

namespace {

constexpr Nanoseconds kAnew{950'000'000};              // an unchanged picture is drawn anew after so long
constexpr Nanoseconds kRendererAgain{10'000'000'000};  // a renderer that could not be had is tried again after so long
constexpr Nanoseconds kFreshEnough{5'000'000};         // a scene serves several drawings of one round for so long

constexpr const char* kEnding = "the gateway is ending";

std::unexpected<Error> too_many() {
  return fail(fmt::format("{} pictures are waited for already", Studio::kMostJobs), "ask again in a moment");
}

}  // namespace

Studio::Studio(Options options, const SceneSource::Boards& boards, PictureUpdates& updates)
    : options_(std::move(options)),
      boards_(boards),
      updates_(updates),
      streams_(boards.clock),
      source_(boards),
      output_due_(options_.outputs.size()) {
  if (!options_.make_renderer) {
    options_.make_renderer = [wanted = renderer_options(options_.settings)] {
      return display::Renderer::create(wanted);
    };
  }
  report_.on = options_.settings.on && !options_.headless;
  report_.settings = options_.settings;
  thread_ = std::jthread([this](const std::stop_token& stop) { loop(stop); });
}

Studio::~Studio() {
  thread_.request_stop();
  wake_.wake();
  thread_.join();
}

Result<void> Studio::refusal(const PictureRequest& wish) const {
  if (options_.headless)
    return fail("the gateway takes no pictures: it was started with --headless", "start it without --headless");
  if (!options_.settings.on) {
    return fail("the gateway takes no pictures: the cell file says `on = false` in [display]",
                "take that line away and start the gateway anew");
  }
  if (auto checked = check_wish(wish); !checked) return checked;
  const auto picture = boards_.pictures.look();
  return picture ? check_camera(wish, *picture->cell) : Result<void>();
}

void Studio::expect_pictures() {
  if (options_.headless || !options_.settings.on) return;
  {
    const std::scoped_lock lock(mutex_);
    if (std::exchange(expected_, true)) return;
  }
  add_job([this](bool given_up) {
    PictureRequest small;
    small.width = 160;
    small.height = 120;
    if (!given_up && !renderer_) static_cast<void>(take(small, ImageFormat::jpeg));
  });
}

Result<std::unique_ptr<PictureStream>> Studio::open_pictures(const PictureRequest& wish) {
  if (const auto refused = refusal(wish); !refused) return std::unexpected(refused.error());
  auto stream = streams_.open(wish);
  if (!stream) {
    return fail(fmt::format("{} look at pictures already", PictureStreams::kMost), "close a page that nobody needs");
  }
  wake_.wake();
  return stream;
}

bool Studio::add_job(Job job) {
  {
    const std::scoped_lock lock(mutex_);
    if (ended_ || jobs_.size() >= kMostJobs) return false;
    jobs_.push_back(std::move(job));
  }
  wake_.wake();
  return true;
}

void Studio::ask_picture(const PictureRequest& wish, ImageFormat format, PictureReply reply) {
  if (const auto refused = refusal(wish); !refused) return reply(std::unexpected(refused.error()));
  const auto shared = std::make_shared<PictureReply>(std::move(reply));
  const bool added = add_job([this, wish, format, shared](bool given_up) {
    (*shared)(given_up ? Result<EncodedImage>(fail(kEnding)) : take(wish, format));
  });
  if (!added) (*shared)(too_many());
}

void Studio::ask_pick(const PictureRequest& wish, int x, int y, PickReply reply) {
  using Picked = Result<std::optional<PickedObject>>;
  if (const auto refused = refusal(wish); !refused) return reply(std::unexpected(refused.error()));
  if (x < 0 || y < 0 || x >= wish.width || y >= wish.height)
    return reply(fail(fmt::format("the pixel {}, {} is not in the picture", x, y)));
  const auto shared = std::make_shared<PickReply>(std::move(reply));
  const bool added = add_job(
      [this, wish, x, y, shared](bool given_up) { (*shared)(given_up ? Picked(fail(kEnding)) : look_at(wish, x, y)); });
  if (!added) (*shared)(too_many());
}

void Studio::loop(const std::stop_token& stop) {
  set_thread_name("pictures");
  const Nanoseconds period = picture_period(options_.settings.rate_hz);
  Timestamp next = boards_.clock.now();
  while (!stop.stop_requested()) {
    // One at a time: those who look continuously have their turn between.
    const bool more = run_job();
    const Timestamp now = boards_.clock.now();
    if (now < next) {
      if (!more) wake_.wait(next - now);
      continue;
    }
    round(now);
    updates_.add();
    next = next + period;
    // Drawing took longer than a period: the phase is given up, so that jobs and stopping have their turn.
    if (const Timestamp after = boards_.clock.now(); next < after) next = after;
  }
  give_up_jobs();
}

bool Studio::run_job() {
  Job job;
  {
    const std::scoped_lock lock(mutex_);
    if (jobs_.empty()) return false;
    job = std::move(jobs_.front());
    jobs_.pop_front();
  }
  job(false);
  return true;
}

void Studio::give_up_jobs() {
  std::deque<Job> left;
  {
    const std::scoped_lock lock(mutex_);
    ended_ = true;
    left.swap(jobs_);
  }
  for (const Job& job : left) job(true);
}

std::vector<Studio::Guest> Studio::guests(Timestamp now) {
  const Nanoseconds half = picture_period(options_.settings.rate_hz) / 2;
  std::vector<Guest> out;
  for (auto& looker : streams_.all()) {
    if (!looker->looks(now)) continue;
    const PictureRequest wish = looker->wish();
    if (picture_is_due(looker->due, wish.rate_hz, now, half)) out.push_back({std::move(looker), nullptr, wish});
  }
  for (std::size_t i = 0; i < options_.outputs.size(); ++i) {
    Output& output = options_.outputs[i];
    if (output.output->watched() && picture_is_due(output_due_[i], output.wish.rate_hz, now, half))
      out.push_back({nullptr, &output, output.wish});
  }
  return out;
}

std::vector<PictureRequest> Studio::wishes(Timestamp now) const {
  std::vector<PictureRequest> out;
  for (const auto& looker : streams_.all()) {
    if (looker->looks(now)) out.push_back(looker->wish());
  }
  for (const Output& output : options_.outputs) {
    if (output.output->watched()) out.push_back(output.wish);
  }
  return out;
}

double Studio::wished_hz(std::span<const PictureRequest> wishes) const {
  double sum = 0;
  for (std::size_t i = 0; i < wishes.size(); ++i) {
    const auto before = wishes.first(i);
    const bool shared =
        std::ranges::any_of(before, [&](const PictureRequest& other) { return same_drawing(other, wishes[i]); });
    if (!shared) sum += std::min(wishes[i].rate_hz, options_.settings.rate_hz);
  }
  return sum;
}

void Studio::round(Timestamp now) {
  if (!report_.on) return;
  follow_traces();
  const std::vector<PictureRequest> all = wishes(now);
  shots_.keep(all);
  const std::vector<Guest> wanted = guests(now);
  if (wanted.empty()) return;
  if (const auto renderer = need_renderer(); !renderer) return tell(wanted, renderer.error());
  effort_.begin_round(wished_hz(all));
  serve(wanted);
}

void Studio::follow_traces() {
  const auto picture = boards_.pictures.look();
  if (picture && picture->display && picture->display->on(DisplayMode::smear)) source_.refresh();
}

void Studio::serve(const std::vector<Guest>& guests) {
  std::vector<Guest> left = guests;
  while (!left.empty()) {
    Shot& shot = shots_.of(left.front().wish);
    const auto others =
        std::ranges::stable_partition(left, [&](const Guest& guest) { return same_drawing(guest.wish, shot.wish); });
    const std::vector<Guest> same(left.begin(), others.begin());
    left.erase(left.begin(), others.begin());
    if (const auto drawn = bring_up_to_date(shot); !drawn) {
      tell(same, drawn.error());
      continue;
    }
    for (const Guest& guest : same) give(guest, shot);
  }
}

void Studio::tell(const std::vector<Guest>& guests, const Error& problem) {
  for (const Guest& guest : guests) {
    if (guest.looker) guest.looker->tell(problem, guest.wish);
  }
}

Result<void> Studio::bring_up_to_date(Shot& shot) {
  const auto panes = prepare(shot.wish);
  if (!panes) {
    note_problem(panes.error());
    return std::unexpected(panes.error());
  }
  const std::uint64_t print = fingerprint(source_.scene(), *panes);
  const Timestamp now = boards_.clock.now();
  if (shot.drawn.known() && shot.fingerprint == print && now - shot.drawn < kAnew) {
    count(&PictureReport::unchanged);
    effort_.unchanged();
    return {};
  }
  const bool smooth = effort_.antialiasing();
  if (const auto drawn = draw(*panes, shot.wish.width, shot.wish.height, shot.image, smooth); !drawn) return drawn;
  effort_.drew(boards_.clock.now() - now);
  if (!smooth) count(&PictureReport::in_haste);
  shot.fingerprint = print;
  shot.drawn = now;
  shot.posture_time = source_.scene().posture_time;
  shot.encoded.clear();
  return {};
}

void Studio::give(const Guest& guest, Shot& shot) {
  const auto picture = encode(shot, guest.wish.quality);
  if (!picture) {
    note_problem(picture.error());
    return tell({guest}, picture.error());
  }
  if (guest.looker) guest.looker->show(*picture, guest.wish);
  if (guest.output != nullptr) guest.output->output->publish_image(**picture);
}

Result<std::shared_ptr<const EncodedImage>> Studio::encode(Shot& shot, int quality) {
  for (const auto& [known, picture] : shot.encoded) {
    if (known == quality) return picture;
  }
  const Timestamp start = boards_.clock.now();
  std::shared_ptr<EncodedImage> picture = recycled_.take();
  const auto encoded =
      encoder_.encode(shot.image, {.format = ImageFormat::jpeg, .jpeg_quality = quality}, picture->bytes);
  if (!encoded) return std::unexpected(encoded.error());
  picture->format = ImageFormat::jpeg;
  picture->width = shot.image.width;
  picture->height = shot.image.height;
  picture->posture_time = shot.posture_time;
  picture->sequence = ++sequence_;
  const Timestamp end = boards_.clock.now();
  encode_time_.record(end - start);
  age_.record(end - shot.posture_time);
  shot.encoded.emplace_back(quality, picture);
  return picture;
}

Result<EncodedImage> Studio::take(const PictureRequest& wish, ImageFormat format) {
  if (const auto renderer = need_renderer(); !renderer) return std::unexpected(renderer.error());
  const auto panes = prepare(wish);
  if (!panes) return std::unexpected(panes.error());
  Image image;
  if (const auto drawn = draw(*panes, wish.width, wish.height, image, true); !drawn)
    return std::unexpected(drawn.error());
  EncodedImage picture;
  const Timestamp start = boards_.clock.now();
  const auto encoded = encoder_.encode(image, {.format = format, .jpeg_quality = wish.quality}, picture.bytes);
  if (!encoded) return std::unexpected(encoded.error());
  encode_time_.record(boards_.clock.now() - start);
  picture.format = format;
  picture.width = wish.width;
  picture.height = wish.height;
  picture.posture_time = source_.scene().posture_time;
  picture.sequence = ++sequence_;
  count(&PictureReport::on_demand);
  return picture;
}

Result<std::optional<PickedObject>> Studio::look_at(const PictureRequest& wish, int x, int y) {
  if (const auto renderer = need_renderer(); !renderer) return std::unexpected(renderer.error());
  const auto panes = prepare(wish);
  if (!panes) return std::unexpected(panes.error());
  std::vector<std::uint32_t> objects;
  if (const auto drawn = renderer_->objects(source_.scene(), *panes, wish.width, wish.height, objects); !drawn) {
    note_problem(drawn.error());
    return std::unexpected(drawn.error());
  }
  count(&PictureReport::on_demand);
  const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(wish.width) + static_cast<std::size_t>(x);
  return picked_object(source_.cell(), objects.at(at));
}

Result<std::vector<Pane>> Studio::prepare(const PictureRequest& wish) {
  const Timestamp start = boards_.clock.now();
  const bool fresh = source_.has_scene() && start - source_.refreshed() < kFreshEnough;
  if (!fresh && !source_.refresh() && !source_.has_scene())
    return fail("the cell is not there yet", "ask again in a moment");
  if (!fresh) scene_time_.record(boards_.clock.now() - start);
  return source_.panes(wish, updates_.count());
}

Result<void> Studio::need_renderer() {
  if (renderer_) return {};
  const Timestamp now = boards_.clock.now();
  if (renderer_tried_.known() && now - renderer_tried_ < kRendererAgain) {
    const std::scoped_lock lock(mutex_);
    return fail(report_.problem);
  }
  renderer_tried_ = now;
  auto made = options_.make_renderer();
  if (!made) {
    note_problem(made.error());
    log_error("pictures.renderer", "no pictures: {}", made.error().text());
    return std::unexpected(made.error());
  }
  renderer_ = std::move(*made);
  note_well();
  const std::scoped_lock lock(mutex_);
  report_.renderer = renderer_->name();
  return {};
}

Result<void> Studio::draw(std::span<const Pane> panes, int width, int height, Image& image, bool smooth) {
  const Timestamp start = boards_.clock.now();
  auto drawn = renderer_->draw(source_.scene(), panes, width, height, image, smooth);
  if (!drawn) {
    note_problem(drawn.error());
    log_error("pictures.draw", "{}", drawn.error().text());
    return drawn;
  }
  draw_time_.record(boards_.clock.now() - start);
  note_well();
  const std::scoped_lock lock(mutex_);
  ++report_.drawn;
  report_.counters = renderer_->counters();
  return {};
}

void Studio::note_problem(const Error& error) {
  const std::scoped_lock lock(mutex_);
  ++report_.failed;
  report_.problem = error.text();
}

void Studio::note_well() {
  const std::scoped_lock lock(mutex_);
  report_.problem.clear();
}

void Studio::count(std::uint64_t PictureReport::* counter) {
  const std::scoped_lock lock(mutex_);
  ++(report_.*counter);
}

PictureReport Studio::report() const {
  PictureReport out;
  {
    const std::scoped_lock lock(mutex_);
    out = report_;
  }
  out.streams = streams_.size();
  out.updates = updates_.count();
  out.scene = scene_time_.snapshot();
  out.draw = draw_time_.snapshot();
  out.encode = encode_time_.snapshot();
  out.age = age_.snapshot();
  return out;
}

std::vector<const ImageOutput*> Studio::outputs() const {
  std::vector<const ImageOutput*> out;
  for (const Output& output : options_.outputs) out.push_back(output.output.get());
  return out;
}

}  // namespace cellmirror::app
