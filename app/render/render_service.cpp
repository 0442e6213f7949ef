#include "app/render/render_service.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/render/picked_object.hpp"
#include "app/render/picture_rate.hpp"
#include "app/render/picture_request.hpp"
#include "app/render/renderer_options.hpp"
#include "app/render/scene_fingerprint.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/rt/scheduling.hpp"

namespace cellmirror::app {

namespace {

constexpr Nanoseconds kRedrawAfter{950'000'000};       // an unchanged picture is drawn again after this time
constexpr Nanoseconds kRendererAgain{10'000'000'000};  // a renderer that could not be had is tried again after so long
constexpr Nanoseconds kFreshEnough{5'000'000};         // a scene serves several drawings of one round for so long
constexpr Nanoseconds kVolumesLook{5'000'000};         // how soon a change of volumes by SCRIPT is noticed

constexpr const char* kEnding = "the gateway is ending";

std::unexpected<Error> too_many() {
  return fail(fmt::format("{} pictures are waited for already", RenderService::kMaxJobs), "ask again in a moment");
}

}  // namespace

RenderService::RenderService(Options options, const SceneSource::Boards& boards, PictureCounter& updates)
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
  report_.rate_hz = options_.settings.rate_hz;
  report_.width = options_.settings.width;
  report_.height = options_.settings.height;
  thread_ = std::jthread([this](const std::stop_token& stop) { loop(stop); });
}

RenderService::~RenderService() {
  thread_.request_stop();
  wake_.wake();
  thread_.join();
}

Result<void> RenderService::refusal(const PictureRequest& request) const {
  if (options_.headless)
    return fail("the gateway takes no pictures: it was started with --headless", "start it without --headless");
  if (!options_.settings.on) {
    return fail("the gateway takes no pictures: the cell file says `on = false` in [display]",
                "remove that line and restart the gateway");
  }
  if (auto checked = check_request(request); !checked) return checked;
  const auto picture = boards_.pictures.latest();
  return picture ? check_camera(request, *picture->cell) : Result<void>();
}

void RenderService::expect_pictures() {
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

Result<std::unique_ptr<PictureStream>> RenderService::open_pictures(const PictureRequest& request) {
  if (const auto refused = refusal(request); !refused) return std::unexpected(refused.error());
  auto stream = streams_.open(request);
  if (!stream) {
    return fail(fmt::format("{} look at pictures already", PictureStreams::kMost), "close a page that is not needed");
  }
  wake_.wake();
  return stream;
}

bool RenderService::add_job(Job job) {
  {
    const std::scoped_lock lock(mutex_);
    if (ended_ || jobs_.size() >= kMaxJobs) return false;
    jobs_.push_back(std::move(job));
  }
  wake_.wake();
  return true;
}

void RenderService::ask_picture(const PictureRequest& request, ImageFormat format, PictureReply reply) {
  if (const auto refused = refusal(request); !refused) return reply(std::unexpected(refused.error()));
  const auto shared = std::make_shared<PictureReply>(std::move(reply));
  const bool added = add_job([this, request, format, shared](bool given_up) {
    (*shared)(given_up ? Result<EncodedImage>(fail(kEnding)) : take(request, format));
  });
  if (!added) (*shared)(too_many());
}

void RenderService::ask_pick(const PictureRequest& request, int x, int y, PickReply reply) {
  using Picked = Result<std::optional<PickedObject>>;
  if (const auto refused = refusal(request); !refused) return reply(std::unexpected(refused.error()));
  if (x < 0 || y < 0 || x >= request.width || y >= request.height)
    return reply(fail(fmt::format("the pixel {}, {} is not in the picture", x, y)));
  const auto shared = std::make_shared<PickReply>(std::move(reply));
  const bool added = add_job([this, request, x, y, shared](bool given_up) {
    (*shared)(given_up ? Picked(fail(kEnding)) : look_at(request, x, y));
  });
  if (!added) (*shared)(too_many());
}

void RenderService::loop(const std::stop_token& stop) {
  set_thread_name("pictures");
  const Nanoseconds period = picture_period(options_.settings.rate_hz);
  Timestamp next = boards_.clock.now();
  while (!stop.stop_requested()) {
    // One at a time: those who look continuously have their turn between.
    const bool more = run_job();
    const Timestamp now = boards_.clock.now();
    const bool early = now < next && volumes_wait(now);
    if (now < next && !early) {
      if (!more) wake_.wait(looks_for_volumes() ? std::min(next - now, kVolumesLook) : next - now);
      continue;
    }
    round(now, early);
    if (early) continue;
    updates_.add();
    next = next + period;
    // Drawing took longer than a period: the phase is given up, so that jobs and stopping have their turn.
    if (const Timestamp after = boards_.clock.now(); next < after) next = after;
  }
  cancel_jobs();
}

bool RenderService::looks_for_volumes() const {
  return streams_.size() > 0 && source_.volumes() != nullptr && !source_.volumes()->empty();
}

bool RenderService::volumes_wait(Timestamp now) const {
  if (!looks_for_volumes() || now - source_.refreshed() < kFreshEnough) return false;
  if (now - last_early_ < picture_period(options_.settings.rate_hz)) return false;
  return boards_.pictures.latest()->volumes.get() != source_.volumes();
}

bool RenderService::run_job() {
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

void RenderService::cancel_jobs() {
  std::deque<Job> left;
  {
    const std::scoped_lock lock(mutex_);
    ended_ = true;
    left.swap(jobs_);
  }
  for (const Job& job : left) job(true);
}

namespace {

// How long casting voxel volumes may take in a picture while they move, where so many are requested a second: half of
// the time, within what is still fluent and what is still to be recognized.
Nanoseconds volume_time_for(double requested_hz) {
  constexpr Nanoseconds kLeast{8'000'000};
  constexpr Nanoseconds kMost{30'000'000};
  const Nanoseconds half{std::llround(0.5e9 / std::max(requested_hz, 1.0))};
  return std::clamp(half, kLeast, kMost);
}

}  // namespace

std::vector<RenderService::Recipient> RenderService::recipients(Timestamp now, bool early) {
  const Nanoseconds round = picture_period(options_.settings.rate_hz);
  const Nanoseconds half = early ? round : round / 2;
  std::vector<Recipient> out;
  for (auto& observer : streams_.all()) {
    if (!observer->looks(now)) continue;
    const PictureRequest request = observer->request();
    if (picture_is_due(observer->due, request.rate_hz, now, half))
      out.push_back({std::move(observer), nullptr, request});
  }
  for (std::size_t i = 0; i < options_.outputs.size(); ++i) {
    Output& output = options_.outputs[i];
    if (output.output->watched() && picture_is_due(output_due_[i], output.request.rate_hz, now, half))
      out.push_back({nullptr, &output, output.request});
  }
  return out;
}

std::vector<PictureRequest> RenderService::requests(Timestamp now) const {
  std::vector<PictureRequest> out;
  for (const auto& observer : streams_.all()) {
    if (observer->looks(now)) out.push_back(observer->request());
  }
  for (const Output& output : options_.outputs) {
    if (output.output->watched()) out.push_back(output.request);
  }
  return out;
}

double RenderService::requested_hz(std::span<const PictureRequest> requests) const {
  double sum = 0;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const auto before = requests.first(i);
    const bool shared =
        std::ranges::any_of(before, [&](const PictureRequest& other) { return same_drawing(other, requests[i]); });
    if (!shared) sum += std::min(requests[i].rate_hz, options_.settings.rate_hz);
  }
  return sum;
}

void RenderService::round(Timestamp now, bool early) {
  if (!report_.on) return;
  if (early) last_early_ = now;
  const std::vector<PictureRequest> all = requests(now);
  cache_.keep(all);
  const std::vector<Recipient> wanted = recipients(now, early);
  if (wanted.empty()) return;
  if (const auto renderer = need_renderer(); !renderer) return report_problem(wanted, renderer.error());
  const double requested = requested_hz(all);
  effort_.begin_cycle(requested);
  volume_time_ = volume_time_for(requested);
  serve(wanted);
}

void RenderService::serve(const std::vector<Recipient>& recipients) {
  std::vector<Recipient> left = recipients;
  while (!left.empty()) {
    RenderedPicture& rendered = cache_.of(left.front().request);
    const auto others = std::ranges::stable_partition(
        left, [&](const Recipient& recipient) { return same_drawing(recipient.request, rendered.request); });
    const std::vector<Recipient> same(left.begin(), others.begin());
    left.erase(left.begin(), others.begin());
    if (const auto drawn = bring_up_to_date(rendered); !drawn) {
      report_problem(same, drawn.error());
      continue;
    }
    for (const Recipient& recipient : same) give(recipient, rendered);
  }
}

void RenderService::report_problem(const std::vector<Recipient>& recipients, const Error& problem) {
  for (const Recipient& recipient : recipients) {
    if (recipient.observer) recipient.observer->report_problem(problem, recipient.request);
  }
}

Result<void> RenderService::bring_up_to_date(RenderedPicture& rendered) {
  const auto panes = prepare(rendered.request);
  if (!panes) {
    note_problem(panes.error());
    return std::unexpected(panes.error());
  }
  const std::uint64_t print = fingerprint(source_.scene(), *panes);
  const Timestamp now = boards_.clock.now();
  const bool same = rendered.drawn.known() && rendered.fingerprint == print && !rendered.hasty;
  if (same && now - rendered.drawn < kRedrawAfter) {
    count(&RenderReport::unchanged);
    effort_.unchanged();
    return {};
  }
  // Volumes that change are shown at once, and as well as can be when they rest.
  const std::uint64_t volumes = volume_fingerprint(source_.scene());
  const bool volumes_changed = rendered.drawn.known() && volumes != rendered.volume_fingerprint;
  const bool smooth = effort_.antialiasing() && !volumes_changed;
  const PictureEffort effort{.smooth = smooth, .volume_time = volume_time_};
  if (const auto drawn = draw(*panes, rendered.request.width, rendered.request.height, rendered.image, effort); !drawn)
    return drawn;
  if (smooth == effort_.antialiasing()) effort_.drew(boards_.clock.now() - now);
  if (!smooth) count(&RenderReport::in_haste);
  rendered.fingerprint = print;
  rendered.volume_fingerprint = volumes;
  rendered.hasty = smooth != effort_.antialiasing() || renderer_->counters().volume_in_haste;
  rendered.drawn = now;
  rendered.posture_time = source_.scene().posture_time;
  rendered.encoded.clear();
  return {};
}

void RenderService::give(const Recipient& recipient, RenderedPicture& rendered) {
  const auto picture = encode(rendered, recipient.request.quality);
  if (!picture) {
    note_problem(picture.error());
    return report_problem({recipient}, picture.error());
  }
  if (recipient.observer) recipient.observer->show(*picture, recipient.request);
  if (recipient.output != nullptr) recipient.output->output->publish_image(**picture);
}

Result<std::shared_ptr<const EncodedImage>> RenderService::encode(RenderedPicture& rendered, int quality) {
  for (const auto& [known, picture] : rendered.encoded) {
    if (known == quality) return picture;
  }
  const Timestamp start = boards_.clock.now();
  std::shared_ptr<EncodedImage> picture = recycled_.take();
  const auto encoded =
      encoder_.encode(rendered.image, {.format = ImageFormat::jpeg, .jpeg_quality = quality}, picture->bytes);
  if (!encoded) return std::unexpected(encoded.error());
  picture->format = ImageFormat::jpeg;
  picture->width = rendered.image.width;
  picture->height = rendered.image.height;
  picture->posture_time = rendered.posture_time;
  picture->sequence = ++sequence_;
  const Timestamp end = boards_.clock.now();
  encode_time_.record(end - start);
  age_.record(boards_.cell_now() - rendered.posture_time);
  rendered.encoded.emplace_back(quality, picture);
  return picture;
}

Result<EncodedImage> RenderService::take(const PictureRequest& request, ImageFormat format) {
  if (const auto renderer = need_renderer(); !renderer) return std::unexpected(renderer.error());
  const auto panes = prepare(request);
  if (!panes) return std::unexpected(panes.error());
  Image image;
  if (const auto drawn = draw(*panes, request.width, request.height, image, PictureEffort()); !drawn)
    return std::unexpected(drawn.error());
  EncodedImage picture;
  const Timestamp start = boards_.clock.now();
  const auto encoded = encoder_.encode(image, {.format = format, .jpeg_quality = request.quality}, picture.bytes);
  if (!encoded) return std::unexpected(encoded.error());
  encode_time_.record(boards_.clock.now() - start);
  picture.format = format;
  picture.width = request.width;
  picture.height = request.height;
  picture.posture_time = source_.scene().posture_time;
  picture.sequence = ++sequence_;
  count(&RenderReport::on_demand);
  return picture;
}

Result<std::optional<PickedObject>> RenderService::look_at(const PictureRequest& request, int x, int y) {
  if (const auto renderer = need_renderer(); !renderer) return std::unexpected(renderer.error());
  const auto panes = prepare(request);
  if (!panes) return std::unexpected(panes.error());
  std::vector<std::uint32_t> objects;
  if (const auto drawn = renderer_->objects(source_.scene(), *panes, request.width, request.height, objects); !drawn) {
    note_problem(drawn.error());
    return std::unexpected(drawn.error());
  }
  count(&RenderReport::on_demand);
  const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(request.width) + static_cast<std::size_t>(x);
  return picked_object(source_.cell(), objects.at(at));
}

Result<std::vector<Pane>> RenderService::prepare(const PictureRequest& request) {
  const Timestamp start = boards_.clock.now();
  const bool fresh = source_.has_scene() && start - source_.refreshed() < kFreshEnough;
  if (!fresh && !source_.refresh() && !source_.has_scene())
    return fail("the cell is not there yet", "ask again in a moment");
  if (!fresh) scene_time_.record(boards_.clock.now() - start);
  return source_.panes(request, updates_.count());
}

Result<void> RenderService::need_renderer() {
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
  clear_problem();
  const std::scoped_lock lock(mutex_);
  report_.renderer = renderer_->name();
  return {};
}

Result<void> RenderService::draw(std::span<const Pane> panes, int width, int height, Image& image,
                                 PictureEffort effort) {
  const Timestamp start = boards_.clock.now();
  auto drawn = renderer_->draw(source_.scene(), panes, width, height, image, effort.smooth, effort.volume_time);
  if (!drawn) {
    note_problem(drawn.error());
    log_error("pictures.draw", "{}", drawn.error().text());
    return drawn;
  }
  draw_time_.record(boards_.clock.now() - start);
  clear_problem();
  const std::scoped_lock lock(mutex_);
  ++report_.drawn;
  const std::uint64_t cast_before = report_.counters.volume_ns;
  report_.counters = renderer_->counters();
  // A picture that shows volumes as the one before takes what was cast then.
  if (report_.counters.volumes > 0 && report_.counters.volume_ns == 0) report_.counters.volume_ns = cast_before;
  return {};
}

void RenderService::note_problem(const Error& error) {
  const std::scoped_lock lock(mutex_);
  ++report_.failed;
  report_.problem = error.text();
}

void RenderService::clear_problem() {
  const std::scoped_lock lock(mutex_);
  report_.problem.clear();
}

void RenderService::count(std::uint64_t RenderReport::* counter) {
  const std::scoped_lock lock(mutex_);
  ++(report_.*counter);
}

namespace {

TraceSummary summary_of(const TcpTrace& trace) {
  TraceSummary summary{.robot = trace.robot, .points = trace.points.size(), .frames = trace.frames.size()};
  for (std::size_t i = 1; i < trace.points.size(); ++i)
    summary.length_m += static_cast<double>((trace.points[i] - trace.points[i - 1]).norm());
  return summary;
}

}  // namespace

RendererCounters RenderService::counters() const {
  const std::scoped_lock lock(mutex_);
  return report_.counters;
}

RenderReport RenderService::report() const {
  RenderReport out;
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
  if (const auto traces = boards_.traces.latest()) {
    for (const TcpTrace& trace : traces->traces) out.traces.push_back(summary_of(trace));
  }
  return out;
}

std::vector<const ImageOutput*> RenderService::outputs() const {
  std::vector<const ImageOutput*> out;
  for (const Output& output : options_.outputs) out.push_back(output.output.get());
  return out;
}

}  // namespace cellmirror::app
