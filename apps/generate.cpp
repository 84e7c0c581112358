// delray generate points|outline|scene: inputs that the program makes itself.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/commands.h"
#include "apps/options/help.h"
#include "apps/options/list.h"
#include "apps/options/numbers.h"
#include "apps/options/outputs.h"
#include "delaunay/generate.h"
#include "delaunay/outline.h"
#include "delaunay/write_points.h"
#include "files/memory_budget.h"
#include "scenes/generate.h"
#include "scenes/write_glb.h"

namespace delray::apps {
namespace {

constexpr std::uint64_t kMostPoints = 4'294'967'295;  // rows have 32-bit numbers

struct GenerateOptions {
  std::string kind, output;
  std::uint64_t count = 0;
  int dim = 2;
  std::uint64_t seed = 1;
  bool list = false;
};

void require(const GenerateOptions& options) {
  if (options.kind.empty()) throw UsageError("generate: KIND is missing (--list names them)");
  if (options.output.empty()) throw UsageError("generate: -o FILE is missing");
  check_outputs({{"-o", options.output}}, {});
}

int generate_points(const GenerateOptions& options) {
  if (options.list) {
    print_table("Kinds of points (KIND)", delaunay::point_generators());
    return kDone;
  }
  require(options);
  if (options.output != "-") delaunay::point_writer_for(options.output);
  const std::size_t count = options.count > 0 ? options.count : 1000;
  delaunay::write_points(options.output,
                         delaunay::generate_points(options.kind, count, options.dim, options.seed));
  return kDone;
}

int generate_outline(const GenerateOptions& options) {
  if (options.list) {
    print_table("Kinds of outlines (KIND)", delaunay::outline_generators());
    return kDone;
  }
  require(options);
  find_entry(delaunay::outline_generators(), options.kind, "KIND");
  if (options.output != "-" && !options.output.ends_with(".poly")) {
    throw UsageError(fmt::format("-o: '{}' is not a .poly file", options.output));
  }
  const std::size_t count = options.count > 0 ? options.count : 1000;
  write_outline(options.output, delaunay::generate_outline(options.kind, count, options.seed));
  return kDone;
}

int generate_scene(const GenerateOptions& options) {
  if (options.list) {
    print_table("Kinds of scenes (KIND)", scenes::generators());
    return kDone;
  }
  require(options);
  const scenes::Generator& generator = find_entry(scenes::generators(), options.kind, "KIND");
  if (!options.output.ends_with(".glb")) {
    throw UsageError(fmt::format("-o: '{}' is not a .glb file", options.output));
  }
  const std::uint64_t triangles = options.count > 0 ? options.count : generator.default_triangles;
  files::MemoryBudget().require(
      static_cast<std::uint64_t>(static_cast<double>(triangles) * generator.bytes_per_triangle),
      "gen:" + options.kind);
  scenes::write_glb(options.output, generator.generate(triangles, options.seed));
  return kDone;
}

}  // namespace

void add_generate(CLI::App& program, Session& session) {
  CLI::App* generate = program.add_subcommand("generate", "Generate points, an outline or a scene");
  generate->require_subcommand(1);
  const auto options = std::make_shared<GenerateOptions>();
  const auto add = [&](const char* name, const char* description, const char* kind,
                       const char* count, std::uint64_t most, const std::string& output,
                       int (*run)(const GenerateOptions&), const char* examples) {
    CLI::App* command = generate->add_subcommand(name, description);
    command->add_option("KIND", options->kind, kind);
    command->add_option("-n", options->count, count)->transform(count_between(1, most));
    command->add_option("--seed", options->seed, "Seed of all random numbers (default: 1)")
        ->transform(any_count());
    command->add_option("-o,--output", options->output, "File to write: " + output)
        ->type_name("FILE")
        ->group(group::kOutput);
    command->add_flag("--list", options->list, "List the kinds")->group(group::kOutput);
    add_common_options(*command, session, examples);
    command->callback([&session, options, run] { session.run = [=] { return run(*options); }; });
    return command;
  };
  std::string suffixes;
  for (const delaunay::PointWriter& writer : delaunay::point_writers()) {
    suffixes += fmt::format("{}{}", suffixes.empty() ? "" : " ", writer.suffixes);
  }
  CLI::App* points =
      add("points", "Generate points", "Kind of points (--list describes them)",
          "Number of points, such as 10000, 1e6 or 10k (default: 1000)", kMostPoints,
          suffixes + ", by its suffix; - for XYZ on standard output", generate_points,
          "generate points uniform -n 1000000 --dim 2 -o points.ply\n"
          "generate points --list");
  choose_from(*points, "KIND", names_in(delaunay::point_generators()));
  points->add_option("--dim", options->dim, "Dimension: 2 (default) or 3")
      ->check(one_of({"2", "3"}));
  CLI::App* outline =
      add("outline", "Generate an outline: points and the segments that bound a part of the plane",
          "Kind of outline (--list describes them)",
          "Approximate number of points, such as 10000, 1e6 or 10k (default: 1000)",
          delaunay::kMostOutlinePoints, ".poly; - for standard output", generate_outline,
          "generate outline lake -n 10000 -o lake.poly\n"
          "generate outline country --seed 7 -o country.poly");
  choose_from(*outline, "KIND", names_in(delaunay::outline_generators()));
  CLI::App* scene =
      add("scene", "Generate a scene", "Kind of scene (--list describes them)",
          "Approximate number of triangles, such as 10000, 1e6 or 10k (default: by the kind)",
          scenes::kMostTriangles, "binary glTF, .glb", generate_scene,
          "generate scene terrain -n 1000000 -o terrain.glb\n"
          "generate scene field -o field.glb");
  choose_from(*scene, "KIND", names_in(scenes::generators()));
}

}  // namespace delray::apps
