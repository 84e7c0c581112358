// Animations as video files, which ffmpeg makes of their frames.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/session.h"

namespace delray::apps {

// Whether the path ends in .mp4, in any case.
bool is_video(const std::string& path);

// The frames of a video on their way. They lie in a hidden folder beside the video, which goes with
// this object unless keep_frames moved it.
class VideoFrames {
 public:
  // Makes the folder, and warns if there is no ffmpeg. Throws files::FileError.
  VideoFrames(std::string video, std::string frames_per_second);
  ~VideoFrames();
  VideoFrames(const VideoFrames&) = delete;
  VideoFrames& operator=(const VideoFrames&) = delete;

  // The pattern of which frame_path makes names: a PNG in the folder.
  std::string frames() const;

  // Makes the video, whole or not at all, as most players take it (H.264 where ffmpeg has it,
  // 4:2:0), with a black line at the right and below where sides are odd. Without
  // ffmpeg, or when it fails, the frames are kept beside the video, in a folder NAME-frames, and
  // files::FileError (device) tells where and which command makes the video.
  // parallel::Interrupted leaves nothing.
  void encode(const Session& session);

 private:
  // The arguments of ffmpeg, in the folder of the frames.
  std::vector<std::string> arguments(const Session& session, const std::filesystem::path& to) const;
  [[noreturn]] void keep_frames(const Session& session, const std::string& why);

  std::string video_, frames_per_second_;
  std::filesystem::path target_, folder_, ffmpeg_;  // absolute; empty where there is none
};

}  // namespace delray::apps
