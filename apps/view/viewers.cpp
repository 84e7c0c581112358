// A lock around all pages; whoever waits for a task is woken by whatever a page says. Pages are
// served in turns, those that move first.
#include "apps/view/viewers.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "scenes/camera_path.h"
#include "scenes/framing.h"

namespace delray::apps::view {
namespace {

constexpr double kLookAgain = 0.1;  // seconds: how often to look whether to stop
constexpr double kGrace = 1.5;  // seconds after which a page that was closed is not just reloading
constexpr std::size_t kMostPicks = 8;
constexpr int kMostThreads = 256;  // that a page may start, of all ranks

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Json numbers_of(const glm::vec3& v) { return {v.x, v.y, v.z}; }

bool is_shared(const std::string& name) {
  const PanelOption* const option = find_panel_option(name);
  return option != nullptr && option->scope != PanelOption::Scope::page;
}

// Of options those of what is loaded, in the order of the panel.
Options of_scene(const Options& options) {
  Options scene;
  for (const PanelOption& option : panel_options())
    if (option.scope == PanelOption::Scope::scene)
      set_option(scene, option.name, option_of(options, option.name));
  return scene;
}

// "eye,at,up,fov", from which scenes::parse_camera makes the same floats again.
std::string camera_text(const scenes::Camera& camera, const glm::dvec3& origin) {
  const glm::dvec3 eye = glm::dvec3(camera.eye) + origin, at = glm::dvec3(camera.at) + origin;
  return fmt::format("{},{},{},{},{},{},{},{},{},{}", eye.x, eye.y, eye.z, at.x, at.y, at.z,
                     camera.up.x, camera.up.y, camera.up.z, camera.vertical_fov);
}

}  // namespace

Viewers::Viewers(Input input, Options options, Until until)
    : input_(std::move(input)), until_(until) {
  for (const auto& [name, value] : options)
    set_option(is_shared(name) ? shared_ : first_, name, value);
  make_look(input_, options);
  scene_loading_ = scene_in_force_ = of_scene(shared_);
}

Options Viewers::with_shared(const Options& own) const {
  Options all = own;
  for (const auto& [name, value] : shared_) set_option(all, name, value);
  return all;
}

// For the rasterizer, as which all scenes are loaded.
Options Viewers::options_to_load() const {
  Options options = with_shared(first_);
  set_option(options, "--engine", "");
  return options;
}

RenderRequest Viewers::shared_request() const {
  const std::scoped_lock lock(mutex_);
  return request_of(options_to_load());
}

Options Viewers::begin_loading() {
  const std::scoped_lock lock(mutex_);
  scene_loading_ = of_scene(shared_);
  wants_reload_ = wants_take_ = false;
  return options_to_load();
}

void Viewers::opened(PageId page) {
  const std::scoped_lock lock(mutex_);
  pages_.try_emplace(page);
  had_pages_ = true;
  if (!progress_.is_null()) send(page, progress_);
}

void Viewers::closed(PageId page) {
  const std::scoped_lock lock(mutex_);
  pages_.erase(page);
  last_closed_ = seconds_now();
  changed_.notify_all();
}

bool Viewers::is_there(PageId page) const {
  const std::scoped_lock lock(mutex_);
  return pages_.contains(page);
}

void Viewers::received(PageId id, const std::string& text) {
  const std::scoped_lock lock(mutex_);
  const auto found = pages_.find(id);
  if (found == pages_.end()) return;
  try {
    const Message message = parse_message(text);
    const bool is_hello = std::holds_alternative<HelloMessage>(message);
    if (is_hello == found->second.viewer.has_value())
      throw BadMessage("hello comes first, and once");
    std::visit([&](const auto& one) { receive(id, found->second, one); }, message);
    changed_.notify_all();
  } catch (const BadMessage& error) {
    outlet_->close(id, error.what());
  } catch (const std::exception& error) {
    send(id, {{"type", "error"}, {"text", error.what()}});
  }
}

void Viewers::receive(PageId id, Page& page, const HelloMessage& message) {
  Options own = first_;
  for (const auto& [name, value] : message.options)
    if (find_panel_option(name) != nullptr && !is_shared(name)) set_option(own, name, value);
  std::shared_ptr<const Look> look;
  try {
    look = std::make_shared<const Look>(make_look(input_, with_shared(own)));
  } catch (const std::exception& error) {  // of an earlier version, perhaps
    send(id, {{"type", "error"}, {"text", error.what()}});
    own = first_;
    look = std::make_shared<const Look>(make_look(input_, with_shared(own)));
  }
  page.viewer.emplace(std::move(look), own);
  page.viewer->resize(message.size);
  page.wants_place = true;
  if (!scene_.is_null()) send(id, scene_);
  send_panel(id, *page.viewer);
}

void Viewers::receive(PageId, Page& page, const SizeMessage& message) {
  page.viewer->resize(message);
}

void Viewers::receive(PageId, Page& page, const CameraMessage& message) {
  if (page.viewer->move(message, seconds_now())) page.wants_place = page.is_placed_by_some = false;
}

void Viewers::receive(PageId id, Page& page, const OptionMessage& message) {
  const PanelOption* const option = find_panel_option(message.name);
  if (option == nullptr) throw BadMessage("an option that no page may set");
  Viewer& viewer = *page.viewer;
  try {
    if (option->scope != PanelOption::Scope::page) {
      share(message.name, message.value, viewer);
    } else {
      Options own = viewer.options();
      set_option(own, message.name, message.value);
      viewer.set_look(std::make_shared<const Look>(make_look(input_, with_shared(own))), own);
    }
  } catch (const std::exception& error) {
    send(id, {{"type", "error"}, {"text", error.what()}});
  }
  send_panel(id, viewer);
}

// Asks for what all pages share. Throws UsageError where it cannot be.
void Viewers::share(const std::string& name, const std::string& value, const Viewer& viewer) {
  const bool is_ranks = find_panel_option(name)->scope == PanelOption::Scope::ranks;
  if (is_ranks && ranks_are_fixed_)
    throw UsageError(name + ": ranks are the processes that the launcher started");
  Options shared = shared_;
  set_option(shared, name, value);
  std::swap(shared, shared_);
  try {
    const Look look = make_look(input_, with_shared(viewer.options()));
    const Launch& launch = look.still.launch;
    if (std::max(1, launch.ranks) * std::max(1, launch.threads) > kMostThreads)
      throw UsageError(fmt::format("{}: at most {} threads in all here", name, kMostThreads));
  } catch (...) {
    std::swap(shared, shared_);
    throw;
  }
  (is_ranks ? wants_restart_ : wants_reload_) = true;
}

void Viewers::receive(PageId, Page& page, const ViewMessage& message) {
  const std::vector<std::string> names = scenes::view_names();
  if (std::ranges::find(names, message.name) == names.end())
    throw BadMessage("a view that is not known");
  page.wants_place = true;
  page.view = message.name;
}

void Viewers::receive(PageId, Page& page, const PickMessage& message) {
  if (page.picks.size() < kMostPicks) page.picks.push_back(message);
}

void Viewers::receive(PageId, Page& page, const SeenMessage& message) {
  page.viewer->seen(message);
}

void Viewers::receive(PageId, Page& page, const WatchMessage& message) {
  page.viewer->watch(message);
}

void Viewers::receive(PageId id, Page& page, const CommandMessage&) {
  const Viewer& viewer = *page.viewer;
  if (scene_.is_null() || !viewer.has_camera()) return;
  if (viewer.camera().orthographic())
    throw UsageError("--camera has no words for an orthographic camera");
  const glm::dvec3 origin(scene_["origin"][0].get<double>(), scene_["origin"][1].get<double>(),
                          scene_["origin"][2].get<double>());
  Look look = *viewer.look();
  set_size(viewer.width(), viewer.height(), look.still);
  send(id, {{"type", "command"},
            {"text",
             command_for(input_, look, {camera_text(viewer.camera(), origin), viewer.clip()})}});
}

void Viewers::send_panel(PageId id, const Viewer& viewer) {
  send(id, {{"type", "panel"},
            {"ranks_are_fixed", ranks_are_fixed_},
            {"groups", panel_of(input_, with_shared(viewer.options()))}});
}

void Viewers::send(PageId id, const Json& message) {
  if (outlet_ != nullptr) outlet_->send(id, json_text(message, -1));
}

void Viewers::tell(PageId page, const Json& message) {
  const std::scoped_lock lock(mutex_);
  send(page, message);
}

void Viewers::tell_all(const Json& message) {
  const std::scoped_lock lock(mutex_);
  for (const auto& [id, page] : pages_) send(id, message);
}

void Viewers::renew_looks() {
  for (auto& [id, page] : pages_) {
    if (!page.viewer) continue;
    Options own = page.viewer->options();
    std::shared_ptr<const Look> look;
    try {
      look = std::make_shared<const Look>(make_look(input_, with_shared(own)));
    } catch (const std::exception&) {  // does not go with what is shared now
      own = first_;
      look = std::make_shared<const Look>(make_look(input_, with_shared(own)));
    }
    page.viewer->set_look(std::move(look), own);
    send_panel(id, *page.viewer);
  }
}

bool Viewers::refuse_scene(const std::string& why) {
  const std::scoped_lock lock(mutex_);
  const Options refused = std::exchange(scene_loading_, scene_in_force_);
  if (!wants_reload_) {
    for (const PanelOption& option : panel_options())
      if (option.scope == PanelOption::Scope::scene)
        set_option(shared_, option.name, option_of(scene_in_force_, option.name));
  }
  renew_looks();
  for (const auto& [id, page] : pages_) send(id, {{"type", "error"}, {"text", why}});
  return wants_reload_ || refused != scene_in_force_;
}

void Viewers::set_scene(const Json& facts, bool is_whole) {
  const std::scoped_lock lock(mutex_);
  is_whole_ = is_whole;
  if (is_whole) {
    scene_in_force_ = scene_loading_;
    for (auto& [id, page] : pages_)
      page.wants_place |= std::exchange(page.is_placed_by_some, false);
  }
  scene_ = facts;
  progress_ = nullptr;
  for (const auto& [id, page] : pages_) send(id, scene_);
  renew_looks();
  changed_.notify_all();
}

void Viewers::scene_is_there() {
  const std::scoped_lock lock(mutex_);
  wants_take_ = true;
  changed_.notify_all();
}

void Viewers::set_progress(const std::string& what, std::uint64_t done, std::uint64_t total) {
  const std::scoped_lock lock(mutex_);
  const Json message = {{"type", "progress"}, {"text", what}, {"done", done}, {"total", total}};
  if (message == progress_) return;
  progress_ = message;
  for (const auto& [id, page] : pages_) send(id, progress_);
}

void Viewers::place(PageId page, const scenes::Camera& camera, float clip) {
  const std::scoped_lock lock(mutex_);
  const auto found = pages_.find(page);
  if (found == pages_.end() || !found->second.viewer) return;
  found->second.viewer->place(camera, clip);
  found->second.is_placed_by_some = !is_whole_;
  send(page, {{"type", "camera"},
              {"eye", numbers_of(camera.eye)},
              {"at", numbers_of(camera.at)},
              {"up", numbers_of(camera.up)},
              {"fov", camera.vertical_fov},
              {"height", camera.height},
              {"clip", clip}});
}

// What a page has asked for and is no picture, then pictures in turns, those that move first.
std::optional<Task> Viewers::due(double now) {
  Task task;
  if (std::exchange(wants_reload_, false)) {
    wants_restart_ = wants_take_ = false;
    task.kind = Task::Kind::reload;
    return task;
  }
  if (std::exchange(wants_take_, false)) {
    task.kind = Task::Kind::take;
    return task;
  }
  if (std::exchange(wants_restart_, false)) {
    task.kind = Task::Kind::restart;
    return task;
  }
  for (auto& [id, page] : pages_) {
    if (!page.viewer || !page.viewer->has_size()) continue;
    const bool places = std::exchange(page.wants_place, false);
    if (!places && (page.picks.empty() || !page.viewer->has_camera())) continue;
    task.page = id;
    task.order.camera = page.viewer->camera();
    task.order.width = page.viewer->width();
    task.order.height = page.viewer->height();
    task.order.look = page.viewer->look();
    task.kind = places ? Task::Kind::place : Task::Kind::pick;
    if (places) {
      task.view = page.view;
    } else {
      task.pick = page.picks.front();
      page.picks.pop_front();
    }
    return task;
  }
  const auto consider = [&](PageId id, const Page& page) {
    if (!page.viewer) return;
    const auto order = page.viewer->next(now);
    if (!order || !(is_whole_ || order->stage == Stage::moving || order->stage == Stage::sharp))
      return;
    const bool is_first = task.kind == Task::Kind::nothing;
    if (!is_first && !(order->stage == Stage::moving && task.order.stage != Stage::moving)) return;
    task.kind = Task::Kind::picture;
    task.page = id;
    task.order = *order;
  };
  for (auto page = pages_.upper_bound(last_served_); page != pages_.end(); ++page)
    consider(page->first, page->second);
  for (auto page = pages_.begin(); page != pages_.upper_bound(last_served_); ++page)
    consider(page->first, page->second);
  if (task.kind == Task::Kind::nothing) return std::nullopt;
  last_served_ = task.page;
  return task;
}

double Viewers::wait(double now) const {
  double seconds = kLookAgain;
  for (const auto& [id, page] : pages_)
    if (page.viewer) seconds = std::min(seconds, page.viewer->wait(now));
  return std::max(seconds, 1e-3);
}

Task Viewers::next(const parallel::Progress& progress, double most_seconds) {
  std::unique_lock lock(mutex_);
  const double begin = seconds_now();
  for (;;) {
    const double now = seconds_now();
    const bool is_left = until_ == Until::last_page_closed && had_pages_ && pages_.empty() &&
                         now - last_closed_ > kGrace;
    Task task;
    if (progress.stop_requested() || is_left) {
      task.kind = Task::Kind::end;
      return task;
    }
    if (std::optional<Task> found = due(now)) return *std::move(found);
    if (now - begin >= most_seconds) return task;
    changed_.wait_for(lock, std::chrono::duration<double>(wait(now)));
  }
}

bool Viewers::is_outdone(const Task& task, double seconds) const {
  constexpr double kTurn = 0.5;  // seconds that pages that rest are served in turn
  const std::scoped_lock lock(mutex_);
  if (wants_reload_ || wants_restart_ || wants_take_) return true;
  const double now = seconds_now();
  const auto own = pages_.find(task.page);
  if (own == pages_.end() || !own->second.viewer->is_visible() ||
      own->second.viewer->version() != task.order.version) {
    return true;
  }
  for (const auto& [id, page] : pages_) {
    if (!page.viewer) continue;
    if (page.wants_place || !page.picks.empty()) return true;
    if (id == task.page) continue;
    const auto order = page.viewer->next(now);
    if (order && (order->stage != Stage::still || seconds > kTurn)) return true;
  }
  return false;
}

void Viewers::done(const Task& task, double seconds, bool is_complete) {
  const std::scoped_lock lock(mutex_);
  const auto found = pages_.find(task.page);
  if (found == pages_.end() || !found->second.viewer) return;
  found->second.viewer->done(task.order, seconds, is_complete);
}

std::uint64_t Viewers::number_frame(PageId id) {
  const std::scoped_lock lock(mutex_);
  const auto found = pages_.find(id);
  if (found == pages_.end() || !found->second.viewer) return 0;
  return found->second.viewer->send(seconds_now());
}

void Viewers::send_frame(PageId id, std::uint64_t number, std::vector<std::byte>&& frame) {
  outlet_->send_frame(id, number, std::move(frame));
}

}  // namespace delray::apps::view
