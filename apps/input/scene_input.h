// A scene from whatever the user names: a scene file, a generated scene, points or a mesh of them.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>

#include "apps/input/inliers.h"
#include "apps/input/point_input.h"
#include "apps/input/scene_preview.h"
#include "apps/input/show_as.h"
#include "apps/session.h"
#include "scenes/scene.h"

namespace CLI {
class App;
}

namespace delray::apps {

struct SceneInput {
  PointInput file;          // a scene or mesh as well as points
  std::string colour_by;    // empty: what suits the input
  std::string show_as;      // points: a row of show_as.cpp; empty: what suits them
  double point_size = 0;    // diameter of points in pixels; 0: not given
  double radius = -1;       // of points in units of the scene; negative: not given
  double exaggeration = 1;  // of the heights of points
  std::string up;           // "y" or "z"; empty: as the input says
};

// The kind that a file is read as. A PLY, OBJ or OFF without faces is points; a PLY with 64-bit
// coordinates, an OBJ, OFF or STL that delray wrote, a VTU, an .ele or a .node beside one is a mesh
// of points, and so is a folder with an index of pieces. A pack is a scene that need not be in
// memory.
enum class InputKind { scene, mesh, points, picture, pack };
InputKind input_kind(const std::string& path, const files::MemoryBudget& memory = {});

// The same of an input that may be several files, which are points then. Throws UsageError for a
// scene or mesh among several.
InputKind input_kind_of(const PointInput& input);
// The kind with its options: those of points make points of a .node that has an .ele beside it.
InputKind input_kind_of(const SceneInput& input);

// What points are to be shown as, where options say so; null where the points themselves decide.
// Throws UsageError for options of surfaces beside.
const ShowAs* asked_to_show(const SceneInput& input);

// Adds SCENE, --color-by, --exaggeration, --show-as, --point-size, --radius, --up, --allow-outside
// and the options of points.
void add_scene_options(CLI::App& command, SceneInput& input);

// Throws UsageError for options of points, given with a scene or mesh.
void refuse_options_of_points(const SceneInput& input, InputKind kind);

// What colours of points show, by what the option or the points say; `dots`: points without
// triangles.
std::string colouring(const SceneInput& input, const delaunay::PointCloud& points, bool dots);
PointSize size_of(const SceneInput& input);

// Throws FileError for points that 32-bit floats cannot hold around their middle.
void check_reach(const SceneInput& input, std::span<const glm::dvec3> points,
                 const glm::dvec3& middle);

// Says so in the log where so many points have outliers.
void warn_of_outliers(const SceneInput& input, const Inliers& inliers, std::uint64_t points);

// Whether no option changes what the file of a scene holds, but for which way is up.
bool is_plain(const SceneInput& input);

// Throws UsageError for options that change how a scene is made, which a pack has behind it.
void refuse_for_packs(const SceneInput& input);

// Loads or generates the scene; points are triangulated in the plane, with their z as height, or
// shown as points, by default where they lie in space; a pack is unpacked.
// Warnings go to the log. Parallel in the caller's arena. Throws FileError and UsageError.
scenes::Scene load_scene(const SceneInput& input, parallel::Progress* progress);

// A scene, and the points that it was made of, with all that their file says of them: coordinates
// of the file, or metres where it has degrees. No points for a scene, mesh or pack.
struct LoadedScene {
  scenes::Scene scene;
  std::shared_ptr<const delaunay::PointCloud> points;
};
// The same, with the points. Of much that takes long `preview`, where there is one, gets a scene
// before all is done: of points some, as soon as they are read, of other scenes a coarse form.
LoadedScene load_scene_and_points(const SceneInput& input, parallel::Progress* progress,
                                  const ScenePreview& preview);

}  // namespace delray::apps
