// Options of comparisons on a scene, and the run that all of them share: check, load, compare,
// write. Also the parts of their JSON that are the same.
#include "apps/compare/scene_comparison.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "apps/options/help.h"
#include "apps/options/numbers.h"
#include "apps/terminal/progress_bar.h"
#include "comm/network_file.h"
#include "parallel/arena.h"

namespace delray::apps {
namespace {

void check_scene(const CLI::App& command, const Session& session, SceneComparison& options) {
  if (options.render.scene.file.path.empty())
    throw UsageError(fmt::format("compare {}: SCENE is missing", command.get_name()));
  check(session, options, options.render.scene.file.paths);
  parse_size(options.render);
  complete_layout(options.render);
  options.render.behind = parse_background(options.render.background);
  if (session.under_mpi && command.count("--ranks") > 0)
    throw UsageError("--ranks: under mpirun the ranks are its processes");
  std::sort(options.ranks.begin(), options.ranks.end());
  options.ranks.erase(std::unique(options.ranks.begin(), options.ranks.end()), options.ranks.end());
  options.networks = networks_of(options.network, options.ranks, options.networks);
}

}  // namespace

void add_scene_comparison_options(CLI::App& command, SceneComparison& options,
                                  const std::string& ranks) {
  add_scene_options(command, options.render.scene);
  command
      .add_option("--size", options.render.size,
                  "Width and height in pixels, such as 1920x1080 (default: 1280x720)")
      ->type_name("WxH")
      ->group(group::kPicture);
  add_camera_options(command, options.render.camera);
  command
      .add_option("--ranks", options.ranks,
                  "Numbers of ranks to compare, separated by commas " + ranks)
      ->group(group::kParallel)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->transform(count_between(1, 4096));
  add_network_option(
      command, options.network,
      "(default: gigabit-ethernet, 10-gigabit-ethernet, hdr-infiniband, shared-bus)");
}

int run_scene_comparison(
    Session& session, const CLI::App& command, SceneComparison& options,
    const std::function<Found(const Prepared& prepared, parallel::Progress& progress)>& compare) {
  check_scene(command, session, options);
  ProgressBar bar(session, "compare");
  const parallel::AllowThreads allowed(parallel::arena_threads());
  const auto prepared = parallel::Arena(parallel::arena_threads()).execute([&] {
    return prepare(options.render, &session.progress);
  });
  if (session.first_process) refuse_overwriting(outputs_of(options), prepared->scene.files);
  Found found = compare(*prepared, session.progress);
  bar.end();
  return session.first_process ? report_results(session, options, std::move(found)) : int{kDone};
}

Json scene_json(const SceneComparison& options, const Prepared& prepared) {
  return {{"file", options.render.scene.file.path}, {"triangles", prepared.triangles}};
}

Json networks_json(std::span<const comm::NamedNetwork> networks) {
  Json result = Json::array();
  for (const comm::NamedNetwork& named : networks)
    result.push_back(Json::parse(comm::network_text(named)));
  return result;
}

}  // namespace delray::apps
