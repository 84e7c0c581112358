// From a rendered picture to the bytes of a frame, on threads of their own, so that the next
// picture is rendered meanwhile.
#pragma once

#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>

#include "apps/render/render_frames.h"
#include "apps/view/viewers.h"

namespace delray::apps::view {

// What a frame says of itself.
struct FrameFacts {
  Stage stage = Stage::still;
  std::uint64_t camera_number = 0;
  double render_seconds = 0;
  double samples = 0;       // of rays, per pixel; 0: the rasterizer's
  bool is_complete = true;  // no better picture of this camera will come
};

// A frame as a page gets it: the length of a JSON object as 32 bits, low byte first, the object,
// and a picture file: JPEG while better ones follow, PNG at the end.
std::vector<std::byte> encode_frame(std::uint64_t number, const FrameFacts& facts,
                                    const Picture& picture);

// Encodes pictures and hands them on. Of those that wait for a page the newest is kept.
class FrameSender {
 public:
  explicit FrameSender(Viewers& viewers);
  ~FrameSender();
  FrameSender(const FrameSender&) = delete;
  FrameSender& operator=(const FrameSender&) = delete;

  void send(PageId page, const FrameFacts& facts, Picture&& picture);

 private:
  struct Waiting {
    std::uint64_t number = 0;
    FrameFacts facts;
    Picture picture;
  };
  // PNG takes ten times as long as JPEG, and must not keep a picture that moves waiting.
  struct Lane {
    std::map<PageId, Waiting> waiting;
    std::jthread thread;
  };
  void work(const std::stop_token& stop, Lane& lane);

  Viewers& viewers_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  Lane quick_, exact_;
};

}  // namespace delray::apps::view
