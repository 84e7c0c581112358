// ffmpeg reads the frames by a pattern in their own folder, so that no name of the user's is one.
#include "apps/render/video.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>

#include "apps/render/run_command.h"
#include "files/atomic_file.h"
#include "files/error.h"
#include "files/output_path.h"

namespace delray::apps {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFrames = "frame.png";  // of which frame_path makes frame-0000.png and so on
constexpr const char* kPattern = "frame-%04d.png";

// 4:2:0 has a colour for 2 x 2 pixels. What a video does not tell, players take as BT.709.
constexpr const char* kFilters =
    "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709,format=yuv420p";

[[noreturn]] void fail(const std::string& video, const std::string& what) {
  throw files::FileError(files::Cause::device, video, "", what);
}

// A folder that is not there yet: "a-frames", "a-frames-2" ...
fs::path free_name(const fs::path& video) {
  const fs::path stem = video.parent_path() / (video.stem().string() + "-frames");
  fs::path name = stem;
  for (int i = 2; fs::exists(fs::symlink_status(name)); ++i) {
    name = stem.string() + fmt::format("-{}", i);
  }
  return name;
}

}  // namespace

bool is_video(const std::string& path) {
  std::string suffix = fs::path(path).extension().string();
  for (char& c : suffix) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return suffix == ".mp4";
}

VideoFrames::VideoFrames(std::string video, std::string frames_per_second)
    : video_(std::move(video)),
      frames_per_second_(std::move(frames_per_second)),
      target_(fs::absolute(files::output_path(video_).path)),
      ffmpeg_(find_program("ffmpeg")) {
  std::string name = (target_.parent_path() / ".delray-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    fail(video_, std::string("cannot make a folder for frames beside it: ") + std::strerror(errno));
  }
  folder_ = name;
  if (!ffmpeg_.empty()) return;
  spdlog::warn("{}: ffmpeg is not installed: frames will be kept, but there will be no video",
               video_);
}

VideoFrames::~VideoFrames() {
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

std::string VideoFrames::frames() const { return (folder_ / kFrames).string(); }

std::vector<std::string> VideoFrames::arguments(const Session& session, const fs::path& to) const {
  std::vector<std::string> words = {"-hide_banner",
                                    "-loglevel",
                                    "error",
                                    "-nostdin",
                                    "-y",
                                    "-framerate",
                                    frames_per_second_,
                                    "-start_number",
                                    "0",
                                    "-i",
                                    kPattern,
                                    "-vf",
                                    kFilters,
                                    "-colorspace",
                                    "bt709",
                                    "-color_primaries",
                                    "bt709",
                                    "-color_trc",
                                    "iec61966-2-1",
                                    "-movflags",
                                    "+faststart",
                                    "-bitexact"};
  if (session.metadata) {
    words.insert(words.end(), {"-metadata", "comment=" + session.command_line});
  }
  words.push_back(to.string());
  return words;
}

void VideoFrames::keep_frames(const Session& session, const std::string& why) {
  const fs::path kept = free_name(target_);
  std::error_code error;
  fs::rename(folder_, kept, error);
  const fs::path folder = error ? folder_ : kept;
  folder_.clear();
  std::vector<std::string> command = arguments(session, target_);
  command.insert(command.begin(), "ffmpeg");
  fail(video_,
       fmt::format("{}; the frames are in {}; the video is made by: (cd {} && {})", why,
                   folder.string(), quoted_command({folder.string()}), quoted_command(command)));
}

void VideoFrames::encode(const Session& session) {
  if (ffmpeg_.empty()) keep_frames(session, "ffmpeg is not installed");
  files::AtomicFile file(video_);
  const CommandResult result = [&] {
    try {
      return run_command(ffmpeg_, arguments(session, fs::absolute(file.temporary())), folder_,
                         &session.progress);
    } catch (const std::system_error& error) {
      keep_frames(session, error.what());
    }
  }();
  if (result.exit_code != 0) {
    keep_frames(session, fmt::format("ffmpeg failed with exit code {}{}{}", result.exit_code,
                                     result.errors.empty() ? "" : ": ", result.errors));
  }
  file.commit();
}

}  // namespace delray::apps
