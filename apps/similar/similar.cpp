// delray similar: which models are most like another (Kohout 2004, section 8, after V. Hlavaty).
//
// Each model becomes a point whose coordinates are features of its shape; of the Delaunay
// triangulation of these points the nearest are read off.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>

#include "apps/commands.h"
#include "apps/input/scene_input.h"
#include "apps/options/help.h"
#include "apps/options/input_limits.h"
#include "apps/options/list.h"
#include "apps/options/numbers.h"
#include "apps/options/outputs.h"
#include "apps/statistics.h"
#include "apps/terminal/progress_bar.h"
#include "apps/terminal/text_table.h"
#include "delaunay/dimensions.h"
#include "files/error.h"
#include "scenes/shape_features.h"

namespace delray::apps {
namespace {

struct SimilarOptions {
  std::vector<std::string> models;
  std::string to, statistics;
  int dim = scenes::kShapeFeatures;
  std::uint64_t count = 10;
  InputLimits limits;
  bool list = false;
};

std::array<double, scenes::kShapeFeatures> features_of(Session& session,
                                                       const SimilarOptions& options,
                                                       const std::string& model) {
  SceneInput input;
  input.file.path = model;
  input.file.paths = {model};
  input.file.limits = options.limits;
  const auto features = features_of_shape(load_scene(input, &session.progress));
  if (!features) {
    throw files::FileError(files::Cause::input, model, "", "has no triangles with area");
  }
  return *features;
}

// What rounding of corners makes of a feature of one shape.
constexpr double kLeastDeviation = 1e-6;

// The first features of all models, those of `to` last, each over its deviation among the models,
// so that none outweighs the others. A feature in which they differ by rounding alone stays as it
// is.
delaunay::PointTable feature_points(Session& session, const SimilarOptions& options) {
  delaunay::PointTable points{options.dim, {}};
  const auto add = [&](const std::string& model) {
    const auto features = features_of(session, options, model);
    points.coordinates.insert(points.coordinates.end(), features.begin(),
                              features.begin() + options.dim);
  };
  for (const std::string& model : options.models) add(model);
  add(options.to);
  const auto dim = static_cast<std::size_t>(options.dim);
  const auto n = static_cast<double>(options.models.size());
  for (std::size_t k = 0; k < dim; ++k) {
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < options.models.size(); ++i) sum += points.coordinates[i * dim + k];
    for (std::size_t i = 0; i < options.models.size(); ++i) {
      const double off = points.coordinates[i * dim + k] - sum / n;
      squares += off * off;
    }
    const double deviation = std::sqrt(squares / n);
    if (!(deviation > kLeastDeviation)) continue;
    for (std::size_t i = 0; i < points.size(); ++i) points.coordinates[i * dim + k] /= deviation;
  }
  return points;
}

Json similar_json(const SimilarOptions& options, const delaunay::PointTable& points,
                  const std::vector<delaunay::NearRow>& found, std::size_t simplices) {
  const auto features = [&](std::size_t row) {
    Json values = Json::array();
    for (int k = 0; k < options.dim; ++k) values.push_back(points.view()(row, k));
    return values;
  };
  Json names = Json::array();
  for (int k = 0; k < options.dim; ++k) {
    names.push_back(scenes::shape_features()[static_cast<std::size_t>(k)].name);
  }
  Json models = Json::array();
  for (const delaunay::NearRow& near : found) {
    models.push_back({{"model", options.models[near.row]},
                      {"distance", near.distance},
                      {"features", features(near.row)}});
  }
  return {{"schema", "delray.similar/1"},
          {"to", {{"model", options.to}, {"features", features(options.models.size())}}},
          {"dim", options.dim},
          {"features", names},
          {"simplices", simplices},
          {"models", models}};
}

void check(const SimilarOptions& options) {
  if (options.models.empty()) throw UsageError("similar: MODEL is missing");
  if (options.to.empty()) throw UsageError("similar: --to MODEL is missing");
  std::vector<std::string> inputs = options.models;
  inputs.push_back(options.to);
  check_outputs({{"--stats", options.statistics}}, inputs);
}

int run(Session& session, const SimilarOptions& options) {
  if (options.list) {
    print_table("Features of shapes (the first of them: --dim)", scenes::shape_features());
    return kDone;
  }
  check(options);
  delaunay::PointTable points;
  {
    const ProgressBar bar(session, "similar");
    points = feature_points(session, options);
  }
  delaunay::Triangulation triangulation;
  {
    const ProgressBar bar(session, "triangulate");
    session.progress.start(points.size());
    triangulation =
        triangulate_dimensions(points.view(), points.dim, /*seed=*/1, &session.progress);
  }
  const auto found =
      nearest_rows(points.view(), triangulation, static_cast<std::uint32_t>(options.models.size()),
                   static_cast<std::size_t>(options.count));
  write_statistics(options.statistics, similar_json(options, points, found, triangulation.size()));
  if (options.statistics == "-") return kDone;
  TextTable table = {{"distance", "model"}};
  for (const delaunay::NearRow& near : found) {
    table.push_back({fmt::format("{:.4f}", near.distance), options.models[near.row]});
  }
  constexpr std::size_t kWide = 1000;  // names are not cut
  fmt::print("{}", aligned(table, kWide));
  return kDone;
}

}  // namespace

void add_similar(CLI::App& program, Session& session) {
  CLI::App* command =
      program.add_subcommand("similar", "Tell which models are most like another, however turned");
  const auto options = std::make_shared<SimilarOptions>();
  command
      ->add_option("MODEL", options->models,
                   "Models to choose from: scenes, meshes or gen:KIND[:TRIANGLES[:SEED]]")
      ->type_name("FILE")
      ->group(group::kInput);
  command->add_option("--to", options->to, "Model that they are compared with")
      ->type_name("FILE")
      ->group(group::kInput);
  command
      ->add_option("--dim", options->dim,
                   "Number of features that count, 3 to 6 (default: 6; --list describes them)")
      ->check(one_of({"3", "4", "5", "6"}));
  command->add_option("-n", options->count, "Number of models to tell (default: 10)")
      ->transform(count_between(1, 1'000'000));
  command
      ->add_option("--stats", options->statistics,
                   "Models and features as JSON to this file; - for standard output")
      ->type_name("FILE")
      ->group(group::kOutput);
  command->add_flag("--list", options->list, "List the features of shapes")->group(group::kOutput);
  add_memory_option(*command, options->limits);
  add_outside_option(*command, options->limits);
  add_common_options(*command, session,
                     "similar models/*.obj --to scan.ply\n"
                     "similar bunny.obj teapot.obj spot.obj --to turned.obj --dim 4 --stats -");
  command->callback([&session, options] {
    session.run = [&session, options] { return run(session, *options); };
  });
}

}  // namespace delray::apps
