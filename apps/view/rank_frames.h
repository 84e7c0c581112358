// Frames for pages on one rank, whichever engine they want.
#pragma once

#include <memory>
#include <optional>

#include "apps/render/render_frames.h"
#include "apps/view/viewer.h"
#include "comm/communicator.h"

namespace delray::apps::view {

// What rank 0 has all ranks do.
struct Job {
  enum class Kind { picture, wait, reload, take, restart, end } kind = Kind::wait;
  Options options;  // of the picture, besides the input
  scenes::Camera camera;
  int width = 0, height = 0;
  bool figures = false, is_coarse = false;
};
// Collective: what rank 0 gives goes to all.
Job broadcast(comm::Communicator& communicator, const Job& job);

// The two engines on one rank. Every rank has the whole scene.
class RankFrames {
 public:
  // `owns_scene`: whether it is this rank that changes what ranks of a process share, before the
  // others hear of the job.
  RankFrames(std::shared_ptr<Prepared> prepared, std::vector<std::string> input,
             parallel::Progress* progress, bool owns_scene)
      : prepared_(std::move(prepared)),
        input_(std::move(input)),
        progress_(progress),
        owns_scene_(owns_scene) {}

  // What does not need the other ranks: options are parsed, the scene gets its light. Not
  // collective. Throws what a rank may say that the page should know (UsageError, FileError).
  void begin(const Job& job);
  // Whether begin() has to build first what rays need, which takes a while.
  bool has_to_build(const Job& job) const;
  // Collective: the frame, with its background on rank 0. A picture that was left before it was
  // done has size 0. `growth` may be null.
  Frame render(comm::Communicator& communicator, const Job& job, Growth* growth);
  // Puts what is behind a picture of the last job's camera behind it.
  void finish(const Job& job, Picture& picture) const;
  const RenderRequest& request() const { return request_; }

 private:
  std::shared_ptr<Prepared> prepared_;
  std::vector<std::string> input_;
  parallel::Progress* progress_;
  bool owns_scene_;
  std::optional<Options> options_;  // of the request
  RenderRequest request_;           // which renderers refer to
  std::optional<FrameRenderer> raster_, rays_;
};

}  // namespace delray::apps::view
