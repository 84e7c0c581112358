// All pages that look at the scene: takes what they say, and hands out what is to be done for them,
// one thing after the other.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "apps/view/outlet.h"
#include "apps/view/viewer.h"
#include "parallel/progress.h"

namespace delray::apps::view {

// The next thing to do.
struct Task {
  enum class Kind {
    nothing,  // so long nothing was asked for
    picture,  // an order of a page
    pick,     // what lies under a place in a page's picture?
    place,    // where is the scene seen from, by the view of this name, or at first?
    reload,   // the scene, as other options want it
    take,     // the rest of a scene of which some is shown: scene_is_there
    restart,  // with another number of ranks or threads
    end       // nobody wants anything any more
  } kind = Kind::nothing;
  PageId page = 0;
  Order order;  // of `picture`; where the others are asked for, what the page shows
  PickMessage pick;
  std::string view;
};

// When it ends without being asked to.
enum class Until : std::uint8_t { stopped, last_page_closed };

// Pages, their viewers, and options that they share. Any thread may call anything.
class Viewers {
 public:
  // `options` is what pages begin with. Throws UsageError as make_look.
  Viewers(Input input, Options options, Until until);
  // Where answers go; nobody may be connected before.
  void set_outlet(Outlet& outlet) { outlet_ = &outlet; }
  // Ranks are what the launcher made them: pages may not choose them.
  void fix_ranks() { ranks_are_fixed_ = true; }

  void opened(PageId page);
  void received(PageId page, const std::string& text);
  void closed(PageId page);
  bool is_there(PageId page) const;

  // The scene and the ranks that are asked for now.
  RenderRequest shared_request() const;
  RenderRequest request_of(Options options) const { return make_request(input_, options); }
  // The scene that is asked for now is loaded from here on, with these options. Nothing is left of
  // what was told of an earlier one.
  Options begin_loading();
  // The scene of begin_loading cannot be: says why, and takes back what was asked of it, unless
  // something else was asked for since. Whether that leaves another scene to load.
  bool refuse_scene(const std::string& why);
  // There is a scene, or some of one: pages are told of it, and show it; some of one by sharp and
  // moving pictures alone, since others would take time that the rest needs. Cameras that some of a
  // scene has placed, and nobody has moved, are placed anew by all of it. `facts` go to pages as
  // they are.
  void set_scene(const Json& facts, bool is_whole);
  // A scene of which some is shown has been loaded.
  void scene_is_there();
  // What pages wait for, shown with a share done.
  void set_progress(const std::string& what, std::uint64_t done, std::uint64_t total);
  // Says something to one page, or to all.
  void tell(PageId page, const Json& message);
  void tell_all(const Json& message);

  // Waits for a task for so many seconds at most. Ends once `progress` is asked to stop.
  Task next(const parallel::Progress& progress, double most_seconds);
  // Whether somebody wants something else than this order to go on: it is not due any more,
  // something that moves is, or another page has waited for as long as it took so far.
  bool is_outdone(const Task& task, double seconds) const;
  // A camera for a page, and the distance of its clipping plane; 0: none.
  void place(PageId page, const scenes::Camera& camera, float clip);
  void done(const Task& task, double seconds, bool is_complete);
  // The number of the next frame for a page; 0: it is not there any more.
  std::uint64_t number_frame(PageId page);
  void send_frame(PageId page, std::uint64_t number, std::vector<std::byte>&& frame);

 private:
  struct Page {
    std::optional<Viewer> viewer;  // once it has said hello
    bool wants_place = false;
    std::string view;                // by which it is placed
    bool is_placed_by_some = false;  // of a scene that was not whole, and nobody has moved it since
    std::deque<PickMessage> picks;
  };

  void receive(PageId id, Page& page, const HelloMessage& message);
  void receive(PageId id, Page& page, const SizeMessage& message);
  void receive(PageId id, Page& page, const CameraMessage& message);
  void receive(PageId id, Page& page, const OptionMessage& message);
  void receive(PageId id, Page& page, const ViewMessage& message);
  void receive(PageId id, Page& page, const PickMessage& message);
  void receive(PageId id, Page& page, const SeenMessage& message);
  void receive(PageId id, Page& page, const WatchMessage& message);
  void receive(PageId id, Page& page, const CommandMessage& message);
  Options with_shared(const Options& own) const;
  Options options_to_load() const;
  void share(const std::string& name, const std::string& value, const Viewer& viewer);
  void renew_looks();
  void send_panel(PageId id, const Viewer& viewer);
  void send(PageId id, const Json& message);
  std::optional<Task> due(double now);
  double wait(double now) const;

  Input input_;
  Options first_;  // what a page begins with, but for what is shared
  Options shared_;
  Options scene_loading_, scene_in_force_;  // of `shared_`, of a scene that is loaded, or is whole
  Until until_;
  bool ranks_are_fixed_ = false;
  Outlet* outlet_ = nullptr;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<PageId, Page> pages_;
  PageId last_served_ = 0;
  bool had_pages_ = false, is_whole_ = true, wants_reload_ = false, wants_restart_ = false,
       wants_take_ = false;
  double last_closed_ = 0;
  Json scene_, progress_;
};

}  // namespace delray::apps::view
