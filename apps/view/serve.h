// Frames for all pages, by all ranks.
#pragma once

#include <memory>

#include "apps/render/prepare.h"
#include "apps/view/frame_sender.h"
#include "apps/view/rank_frames.h"
#include "apps/view/viewers.h"
#include "comm/communicator.h"

namespace delray::apps::view {

// What ranks need, and rank 0 alone.
struct Serving {
  std::shared_ptr<Prepared> prepared;
  Input input;
  const parallel::Progress* progress = nullptr;  // stops all
  double most_silence = 0;        // seconds without a message between ranks; 0: for ever
  bool shares_memory = true;      // ranks are threads of one process
  Viewers* viewers = nullptr;     // of rank 0
  FrameSender* sender = nullptr;  // likewise
};

// Collective: renders what pages want until something is wanted that needs other ranks or another
// scene; returns what: reload, take, restart or end. Throws what rendering throws that no page is
// to blame for.
Job::Kind serve(comm::Communicator& communicator, const Serving& serving);

// The camera of a page that has none, or wants another view: of the options, or by its name.
scenes::Camera camera_for(const Task& task, const Prepared& prepared);

// What pages are told of a scene.
Json facts_of(const RenderRequest& request, const Prepared& prepared);

}  // namespace delray::apps::view
