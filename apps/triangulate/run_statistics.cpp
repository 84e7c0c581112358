// Statistics of `triangulate` as JSON, and what it says at its end.
#include "apps/triangulate/run_statistics.h"

#include <spdlog/spdlog.h>

#include "apps/triangulation_json.h"

namespace delray::apps {

Json statistics_of(const TriangulateOptions& options, std::size_t points,
                   const delaunay::Triangulation& result, std::uint64_t simplices,
                   const delaunay::Hash128& hash, const Seconds& seconds) {
  const delaunay::Options& how = options.how;
  return {
      {"schema", "delray.triangulate/1"},
      {"input",
       {{"file", options.input.path},
        {"points", points},
        {"distinct", result.distinct},
        {"dim", how.dim}}},
      {"options",
       {{"method", how.method},
        {"location", how.location},
        {"split", how.split},
        {"order", how.order},
        {"deadlocks", how.deadlocks},
        {"locks", how.locks},
        {"unlock", how.unlock},
        {"searching", how.searching},
        {"threads", how.threads},
        {"seed", how.seed},
        {"duplicates", options.input.duplicates.empty() ? "first" : options.input.duplicates}}},
      {"result",
       {{"simplices", simplices}, {"hull_facets", result.hull_facets}, {"hash", to_string(hash)}}},
      {"seconds",
       {{"read", seconds.read}, {"triangulate", seconds.triangulate}, {"write", 0.0}}},  // not yet
      {"memory", {{"peak_rss", peak_memory()}}},
  };
}

void add_phases(const delaunay::Statistics& phases, Json& statistics) {
  statistics["seconds"].update(phases_json(phases));
  Json& sync = statistics["sync"] = synchronization_json(phases.synchronization);
  sync.update({{"dag_nodes", phases.dag_nodes},
               {"dag_node_bytes", phases.dag_node_bytes},
               {"searching", searching_json(phases.searching)}});
}

void tell_no_choices(Json& statistics) {
  for (const char* choice : {"location", "split", "order", "deadlocks", "locks", "unlock"}) {
    statistics["options"][choice] = "none";
  }
}

void add_output(const Json& output, Json& statistics) {
  if (!output.is_null()) statistics["raster"] = output;
}

void warn_of_no_simplices(const TriangulateOptions& options, std::uint64_t simplices) {
  if (simplices > 0) return;
  const int dim = options.how.dim;
  spdlog::warn("{}: all points are equal or on one {}: no simplices", options.input.path,
               dim == 2   ? "line"
               : dim == 3 ? "plane"
                          : "hyperplane");
}

void tell_result(int dim, std::size_t rows, std::uint64_t distinct, std::uint64_t simplices,
                 double seconds) {
  spdlog::info("{} points ({} distinct), {} {}, {:.3f} s", rows, distinct, simplices,
               dim == 2   ? "triangles"
               : dim == 3 ? "tetrahedra"
                          : "simplices",
               seconds);
}

}  // namespace delray::apps
