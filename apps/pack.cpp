// delray pack: a scene, points or a mesh to a file from which pictures are rendered that need not
// fit into memory.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>

#include "apps/commands.h"
#include "apps/input/point_parts_input.h"
#include "apps/input/scene_input.h"
#include "apps/interrupt.h"
#include "apps/launch.h"
#include "apps/options/help.h"
#include "apps/options/numbers.h"
#include "apps/options/outputs.h"
#include "apps/pack/pack_folder.h"
#include "apps/pack/pack_points.h"
#include "apps/statistics.h"
#include "apps/terminal/progress_bar.h"
#include "files/memory_budget.h"
#include "packs/pack_reader.h"
#include "packs/pack_writer.h"
#include "parallel/arena.h"

namespace delray::apps {
namespace {

struct PackOptions {
  SceneInput scene;
  Launch launch;
  std::string output, statistics;
  bool exact_only = false;
};

void pack_scene(const PackOptions& options, parallel::Progress* progress) {
  const packs::WriteOptions write{!options.exact_only, progress,
                                  options.scene.file.limits.budget()};
  if (is_surface_in_pieces(options.scene)) {
    pack_folder(options.scene, options.output, write, progress);
    return;
  }
  if (is_cloud(options.scene)) {
    std::vector<std::string> files;
    for (const std::filesystem::path& path : find_input_files(options.scene.file).paths)
      files.push_back(path.string());
    refuse_overwriting({{"-o", options.output}, {"--stats", options.statistics}}, files);
    pack_points(options.scene, options.output, write, progress);
    return;
  }
  scenes::Scene scene = load_scene(options.scene, progress);
  refuse_overwriting({{"-o", options.output}, {"--stats", options.statistics}}, scene.files);
  scenes::complete_surfaces(scene);
  packs::write_pack(options.output, scene, write);
}

Json statistics_of(const PackOptions& options) {
  const packs::PackReader pack(options.output, options.scene.file.limits.budget());
  std::size_t levels = 0;
  for (const packs::MeshRow& mesh : pack.meshes()) levels = std::max(levels, mesh.levels.size());
  return {{"schema", "delray.pack/1"},
          {"input", {{"file", options.scene.file.path}}},
          {"result",
           {{"triangles", pack.triangles()},
            {"points", pack.splats()},
            {"meshes", pack.meshes().size()},
            {"levels", levels},
            {"pages", pack.pages().size()},
            {"bytes", pack.file_bytes()}}},
          {"memory", {{"peak_rss", peak_memory()}}}};
}

int run(Session& session, const PackOptions& options) {
  const std::string& output = options.output;
  if (options.scene.file.path.empty()) throw UsageError("pack: SCENE is missing");
  if (output.empty()) throw UsageError("pack: -o FILE is missing");
  if (output == "-" || !output.ends_with(".pack"))
    throw UsageError(fmt::format("-o: '{}' is not a .pack file", output));
  check_outputs({{"-o", output}, {"--stats", options.statistics}}, options.scene.file.paths);
  Stopwatch watch;
  const int threads = threads_per_rank(options.launch, 1);
  const parallel::AllowThreads allowed(threads);
  parallel::Arena arena(threads);
  ProgressBar bar(session, "pack");
  const StopOnTermination stop;
  arena.execute([&] { pack_scene(options, &session.progress); });
  bar.end();
  Json statistics = statistics_of(options);
  statistics["seconds"] = {{"pack", watch.lap()}};
  write_statistics(options.statistics, statistics);
  const Json& result = statistics["result"];
  spdlog::info("{}: {} in {}, {}", output, primitives_text(result["triangles"], result["points"]),
               count_text(result["pages"], "page"),
               files::bytes_text(result["bytes"].get<std::uint64_t>()));
  return kDone;
}

}  // namespace

void add_pack(CLI::App& program, Session& session) {
  CLI::App* command = program.add_subcommand(
      "pack", "Pack a scene, mesh or points into a file that render reads in parts");
  const auto options = std::make_shared<PackOptions>();
  add_scene_options(*command, options->scene);
  command->add_option("-o,--output", options->output, "Pack to write, .pack")
      ->type_name("FILE")
      ->group(group::kOutput);
  command
      ->add_option("--stats", options->statistics,
                   "Statistics as JSON to this file; - for standard output")
      ->type_name("FILE")
      ->group(group::kOutput);
  command->add_flag(
      "--exact-only", options->exact_only,
      "Leave out coarser levels: a smaller pack, which --error of render has no effect on");
  command
      ->add_option("--threads", options->launch.threads,
                   "Number of threads (default: one for each core)")
      ->transform(count_between(1, 1024));
  add_common_options(*command, session,
                     "pack model.glb -o model.pack\n"
                     "pack gen:terrain:1e7 -o terrain.pack");
  command->callback([&session, options] {
    session.run = [&session, options] { return run(session, *options); };
  });
}

}  // namespace delray::apps
