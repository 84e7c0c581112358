// A scene made ready for rendering: the part of `delray render` that comes before frames.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "apps/render/motion.h"
#include "apps/render/options/render_options.h"
#include "comm/communicator.h"
#include "packs/pack_reader.h"
#include "scenes/scene_part.h"
#include "shading/shader.h"

namespace delray::apps {

// A scene ready to be rendered; shared by the ranks of a process.
struct Prepared {
  scenes::Scene scene;
  scenes::Camera camera;
  std::vector<scenes::Camera> cameras;            // of an animation; empty for a single picture
  Background background;                          // not automatic any more
  std::shared_ptr<shading::Shader> shader;        // rasterizer; ray tracer without a tracer
  std::unique_ptr<raytrace::Tracer> tracer;       // ray tracer, where ranks have the whole scene
  std::unique_ptr<MovingScene> motion;            // of a scene that moves from frame to frame
  std::uint32_t camera_number = scenes::kNone;    // among the scene's; kNone: not one of these
  std::unique_ptr<const packs::PackReader> pack;  // of a scene that is read while it is rendered
  // Ranks make parts of the geometry for themselves, and `scene` has none.
  bool in_parts = false;
  // This rank's part of a scene of which other ranks have read the rest; `scene` has none. Whoever
  // traces rays takes it.
  std::unique_ptr<scenes::ScenePart> part;
  std::string texture_hash;  // before the shader took the texels
  std::string fingerprint;   // likewise, of all; where there are checkpoints
  // The points that it was made of, where somebody asks for them (PrepareOptions::keep_points).
  std::shared_ptr<const delaunay::PointCloud> file_points;
  bool lit_by_default = false;                // the last of the lights is the default one
  bool known_by_name = false;                 // the name of the scene alone tells what is in it
  bool is_preview = false;                    // numbers of triangles are none of the scene's
  std::uint64_t triangles = 0, vertices = 0;  // of the whole scene
  std::uint64_t points = 0;                   // and segments, of the whole scene
  double load_seconds = 0, build_seconds = 0;

  const shading::Shader& shading() const { return tracer ? tracer->shader : *shader; }
};

// For who shows a scene to people.
struct PrepareOptions {
  bool keep_points = false;
  ScenePreview preview;  // gets some of a scene while the rest is loaded
};

// Loads the scene, chooses the camera, builds what the engine needs. Parallel in the caller's
// arena.
std::shared_ptr<Prepared> prepare(const RenderRequest& request, parallel::Progress* progress,
                                  const PrepareOptions& options = {});
// The same of a scene that is in memory; options of what is read change nothing.
std::shared_ptr<Prepared> prepare(const RenderRequest& request, scenes::Scene&& scene);

// Collective: the same on every rank, for ranks that share no memory. Where strategy or
// distribution and the scene allow it they read or make parts of it, and agree on cameras that show
// all of it. Throws what all ranks throw.
std::shared_ptr<const Prepared> prepare(comm::Communicator& communicator,
                                        const RenderRequest& request, parallel::Progress* progress);

// Makes a scene that was prepared for the rasterizer ready for rays, too; it stays ready for the
// rasterizer. Takes memory for Embree's structures and a copy of the textures. REQUIRES: no pack.
void add_tracer(const RenderRequest& request, Prepared& prepared);

// Moves the default light, where there is one, to where it would be had the scene been prepared for
// this camera. Nobody renders meanwhile.
void follow_camera(const RenderRequest& request, const scenes::Camera& camera, Prepared& prepared);

// Whether pictures are of light rather than codes.
bool wants_floats(const RenderRequest& request);

// Bytes that a pixel of the picture takes while it is on its way, at most, in a process with so
// many of the ranks.
std::uint64_t picture_bytes_per_pixel(const RenderRequest& request, int ranks_here);

}  // namespace delray::apps
