// What `triangulate` is asked for: its options, and what goes together of them.
#pragma once

#include <optional>
#include <string>

#include "apps/input/point_input.h"
#include "apps/launch.h"
#include "apps/output/triangulation_output.h"
#include "apps/session.h"
#include "apps/triangulate_parts.h"
#include "delaunay/triangulate.h"

namespace CLI {
class App;
}

namespace delray::apps {

// Points that are added: delaunay/refine.h.
struct RefinementChoice {
  std::optional<double> min_angle, max_area;
  std::string method;  // empty: auto
  bool whole = false;  // triangles outside of the domain, too

  bool given() const { return min_angle || max_area || !method.empty() || whole; }
};

// What the command line says.
struct TriangulateOptions {
  PointInput input;
  TriangulationOutput output;
  std::string statistics;
  delaunay::Options how;
  std::optional<double> max_error;
  Launch launch;
  TilesChoice tiles;
  std::string distributed;  // a method of delaunay/distributed.h; empty: tiles
  std::string improve;      // a mesh, in place of points; empty: none
  std::string criterion;    // of delaunay/improve.h; empty: circle
  RefinementChoice refinement;
  bool dim_given = false;
  bool makers = false;  // go to the mesh
  bool list = false;
};

// Whether any of kInsertionChoices was given.
bool chooses_insertion(const delaunay::Options& how);

// Options of which only the methods of delaunay/methods.h leave a choice, for messages.
inline constexpr const char* kInsertionChoices =
    "method, location, split, order, deadlocks, locks, unlock, searching and queue";

void add_triangulate_options(CLI::App& command, TriangulateOptions& options);

// Whether simplices can leave memory as soon as they are final.
bool takes_parts(const TriangulateOptions& options);

// Whether several tiles or ranks are asked for.
bool is_tiled(const Session& session, const TriangulateOptions& options);

// Refuses what does not go together, and resolves every "auto". Throws UsageError, FileError.
void check(const Session& session, TriangulateOptions& options);

}  // namespace delray::apps
