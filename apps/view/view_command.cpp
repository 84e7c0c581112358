// delray view: a scene, points or a mesh, live in a browser.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>

#include "apps/commands.h"
#include "apps/interrupt.h"
#include "apps/options/help.h"
#include "apps/options/numbers.h"
#include "apps/options/scheme_option.h"
#include "apps/render/options/render_options.h"
#include "apps/view/loading.h"
#include "apps/view/look.h"
#include "apps/view/open_browser.h"
#include "apps/view/page.h"
#include "apps/view/serve.h"
#include "apps/view/server.h"
#include "apps/view/viewers.h"
#include "comm/agree_on_failure.h"

namespace delray::apps {
namespace {

using namespace view;

struct ViewRequest {
  RenderRequest render;  // as the command line has set it; pages have requests of their own
  ServerOptions server;
  int port = 0;
  bool open = false, once = false;
};

// Options that say how to show a scene, not what.
bool is_of_view(const std::string& name) {
  constexpr const char* kNames[] = {"--bind", "--port",    "--open",    "--once",   "--quiet",
                                    "--help", "--verbose", "--timeout", "--record", "SCENE"};
  return std::ranges::find(kNames, name) != std::end(kNames);
}

std::string joined(const std::vector<std::string>& words, char delimiter) {
  std::string text;
  for (const std::string& word : words)
    text += (text.empty() ? "" : std::string(1, delimiter)) + word;
  return text;
}

// What was given, as words that other command lines take.
struct Given {
  Input input;
  Options options;
};
Given given_by(const CLI::App& command, const ViewRequest& request) {
  Given given;
  given.input = request.render.scene.file.paths;
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = option->get_name();
    if (option->count() == 0 || is_of_view(name)) continue;
    const bool is_flag = option->get_items_expected_max() == 0;
    const char delimiter = option->get_delimiter() != '\0' ? option->get_delimiter() : ' ';
    const std::string value = is_flag ? "true" : joined(option->results(), delimiter);
    if (find_panel_option(name) != nullptr) {
      set_option(given.options, name, value);
    } else if (is_flag) {
      given.input.push_back(name);
    } else if (delimiter != ' ' || option->results().size() == 1) {
      given.input.push_back(name + "=" + value);
    } else {
      given.input.push_back(name);
      for (const std::string& word : option->results()) given.input.push_back(word);
    }
  }
  // At rest edges are smooth unless somebody wants otherwise.
  if (command.count("--samples") == 0) set_option(given.options, "--samples", "2");
  return given;
}

// Who runs view behind something that restarts it wants pages to find it again.
std::string choose_token() {
  constexpr std::size_t kShortest = 16, kLongest = 128;
  const char* const given = std::getenv("DELRAY_VIEW_TOKEN");
  if (given == nullptr || *given == '\0') return random_token();
  const std::string token = given;
  const bool is_plain =
      std::ranges::all_of(token, [](unsigned char c) { return std::isalnum(c) != 0; });
  if (!is_plain || token.size() < kShortest || token.size() > kLongest)
    throw UsageError("DELRAY_VIEW_TOKEN: 16 to 128 letters and digits make a token");
  return token;
}

// The first process: pages, and whoever brings them here.
struct Pages {
  Viewers viewers;
  Server server;
  FrameSender sender{viewers};  // sends through the server
  std::optional<OpenBrowser> browser;

  Pages(const ViewRequest& request, const Given& given)
      : viewers(given.input, given.options,
                request.once ? Until::last_page_closed : Until::stopped),
        server(request.server, page(),
               {[this](PageId id) { viewers.opened(id); },
                [this](PageId id, std::string&& text) { viewers.received(id, text); },
                [this](PageId id) { viewers.closed(id); }}) {
    viewers.set_outlet(server);
  }

  void start(const ViewRequest& request) {
    server.start();
    fmt::print("{}\n", server.url());
    std::fflush(stdout);
    spdlog::info("{}; Ctrl-C ends it",
                 request.open ? "your browser shows it" : "open this address in a browser");
    if (request.open) browser.emplace(server.url());
  }
};

class View {
 public:
  View(Session& session, const ViewRequest& request, const Given& given)
      : session_(session), request_(request), input_(given.input) {
    if (!session.first_process) return;
    pages_.emplace(request, given);
    if (session.under_mpi) pages_->viewers.fix_ranks();
  }

  void run() {
    if (pages_) pages_->start(request_);
    Launch launch = request_.render.launch;
    if (session_.under_mpi) {
      run_ranks(session_, launch, request_.render.scene.file.paths,
                [&](comm::Communicator& communicator) { run_over_mpi(communicator, launch); });
      return;
    }
    for (Job::Kind next = Job::Kind::reload; next != Job::Kind::end;) {
      while (!find_scene(next, launch)) next = Job::Kind::reload;
      launch = wanted(launch);
      run_ranks(session_, launch, {}, [&](comm::Communicator& communicator) {
        const Job::Kind kind = serve(communicator, serving(shown_.prepared, launch));
        if (communicator.rank() == 0) next = kind;
      });
    }
  }

 private:
  Serving serving(const std::shared_ptr<Prepared>& prepared, const Launch& launch) {
    Serving serving;
    serving.prepared = prepared;
    serving.input = input_;
    serving.progress = &session_.progress;
    serving.most_silence = launch.timeout;
    serving.shares_memory = !session_.under_mpi;
    if (pages_) {
      serving.viewers = &pages_->viewers;
      serving.sender = &pages_->sender;
    }
    return serving;
  }

  // The ranks and threads that pages want.
  Launch wanted(Launch launch) const {
    const Launch now = pages_->viewers.shared_request().launch;
    launch.ranks = now.ranks;
    launch.threads = now.threads;
    return launch;
  }

  // The scene that is shown next: some of one that is being loaded, all of it, or the same again.
  // What cannot be loaded is told, and what was there stays. Where nothing was, it is thrown, or
  // false where pages have asked for another scene than this one or the first.
  bool find_scene(Job::Kind next, const Launch& launch) {
    try {
      if (next == Job::Kind::reload) {
        const int ranks = std::max(1, launch.ranks);
        loading_.reset();
        loading_.emplace(pages_->viewers, threads_per_rank(launch, ranks) * ranks,
                         session_.progress);
        shown_ = loading_->first();
      } else if (next == Job::Kind::take && loading_) {
        shown_ = loading_->whole();
      }
    } catch (const parallel::Interrupted&) {
      throw;
    } catch (const std::exception& error) {
      const bool is_another_left = pages_->viewers.refuse_scene(error.what());
      if (!whole_.prepared && is_another_left) return false;
      if (!whole_.prepared) throw;
      shown_ = whole_;
    }
    if (shown_.is_whole) {
      loading_.reset();
      whole_ = shown_;
    }
    pages_->viewers.set_scene(*shown_.facts, shown_.is_whole);
    return true;
  }

  // Every process has the scene whole, and loads it anew when rank 0 wants that.
  void run_over_mpi(comm::Communicator& communicator, const Launch& launch) {
    Job::Kind next = Job::Kind::reload;
    std::shared_ptr<Prepared> prepared;
    while (next != Job::Kind::end) {
      if (next == Job::Kind::reload) reload(communicator, prepared);
      next = serve(communicator, serving(prepared, launch));
    }
  }

  void reload(comm::Communicator& communicator, std::shared_ptr<Prepared>& prepared) {
    Job job;
    if (pages_) job.options = pages_->viewers.begin_loading();
    job = broadcast(communicator, job);
    try {
      std::shared_ptr<Prepared> loaded = comm::all_or_none(communicator, comm::Phase::load, [&] {
        Options options = job.options;
        const RenderRequest request = make_request(input_, options);
        parallel::Progress progress(&session_.progress);
        std::optional<ReportLoading> report;
        if (pages_) report.emplace(pages_->viewers, progress);
        PrepareOptions wishes;
        wishes.keep_points = pages_.has_value();
        return prepare(request, &progress, wishes);
      });
      prepared = std::move(loaded);
    } catch (const comm::AgreedFailure&) {
      if (!prepared) throw;
      if (pages_) pages_->viewers.refuse_scene("the scene cannot be shown so");
    }
    if (pages_) pages_->viewers.set_scene(facts_of(request_.render, *prepared), true);
  }

  Session& session_;
  const ViewRequest& request_;
  Input input_;
  std::optional<Pages> pages_;  // of the first process
  // Without mpirun: what is being loaded, what is shown, and the last scene that was whole.
  std::optional<Loading> loading_;
  Loading::Loaded shown_, whole_;
};

int run(Session& session, const CLI::App& command, ViewRequest request) {
  if (request.render.scene.file.path.empty()) throw UsageError("view: SCENE is missing");
  check(session, request.render.launch);
  if (session.under_mpi && request.render.launch.ranks > 0)
    throw UsageError("--ranks: under mpirun the ranks are its processes");
  const Given given = given_by(command, request);
  make_look(given.input, given.options);     // wrong usage ends here
  input_kind_of(request.render.scene.file);  // and what is no scene here
  request.server.port = static_cast<std::uint16_t>(request.port);
  request.server.token = choose_token();
  const StopOnTermination stop;
  View(session, request, given).run();
  return session.progress.stop_requested() ? kInterrupted : kDone;
}

}  // namespace

void add_view(CLI::App& program, Session& session) {
  CLI::App* command = program.add_subcommand(
      "view", "Show a scene, mesh or points in a browser, live: a server for this machine");
  const auto request = std::make_shared<ViewRequest>();
  add_scene_options(*command, request->render.scene);
  add_light_options(*command, request->render.light);
  add_camera_options(*command, request->render.camera);
  add_launch_options(*command, request->render.launch);
  for (const PanelOption& option : panel_options()) {
    if (command->get_option_no_throw(option.name) == nullptr)
      add_options({option.name}, *command, request->render);
  }
  choose_scheme(*command);
  command
      ->add_option("--bind", request->server.address,
                   "IP address of the interface to listen at (default: 127.0.0.1, which other "
                   "machines cannot reach; nothing is encrypted)")
      ->type_name("ADDRESS")
      ->group(group::kOutput);
  command->add_option("--port", request->port, "Port to listen at (default: any that is free)")
      ->group(group::kOutput)
      ->transform(count_between(0, 65535));
  command->add_flag("--open", request->open, "Open the address in the browser")
      ->group(group::kOutput);
  command->add_flag("--once", request->once, "End when the last page is closed")
      ->group(group::kOutput);
  add_common_options(*command, session,
                     "view model.glb --open\n"
                     "view survey.laz --port 8080 --show-as points --shading eye-dome");
  command->callback([&session, request, command] {
    session.run = [&session, request, command] { return run(session, *command, *request); };
  });
}

}  // namespace delray::apps
