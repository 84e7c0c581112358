// delray view as a process, and what its pages say.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "image/hash.h"
#include "image/io.h"
#include "tests/apps/view/page_client.h"

namespace delray::tests {

// delray view with these arguments, until it is ended.
class Running {
 public:
  explicit Running(std::vector<std::string> arguments, const std::string& before = "") {
    std::array<int, 2> pipe{};
    if (::pipe2(pipe.data(), O_CLOEXEC) != 0) throw std::runtime_error("pipe");
    std::string line = "exec " + before + DELRAY_PROGRAM + " view";
    for (const std::string& argument : arguments) line += " '" + argument + "'";
    std::vector<std::string> words = {"sh", "-c", line};
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, pipe[1], STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    ::setenv("ASAN_OPTIONS", "detect_leaks=0", 1);
    if (::posix_spawn(&process_, "/bin/sh", &actions, nullptr, pointers.data(), environ) != 0)
      throw std::runtime_error("sh");
    posix_spawn_file_actions_destroy(&actions);
    ::close(pipe[1]);
    char c = 0;
    while (::read(pipe[0], &c, 1) == 1 && c != '\n') url_ += c;
    ::close(pipe[0]);
  }
  ~Running() {
    if (process_ <= 0) return;
    ::kill(process_, SIGKILL);
    int status = 0;
    ::waitpid(process_, &status, 0);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  const std::string& url() const { return url_; }
  Address address() const { return parse_address(url_); }
  pid_t process() const { return process_; }
  // Waits for its end.
  int exit_code() {
    int status = 0;
    ::waitpid(process_, &status, 0);
    process_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

 private:
  pid_t process_ = 0;
  std::string url_;
};

inline nlohmann::json hello(int width, int height,
                            const nlohmann::json& options = nlohmann::json::object()) {
  return {{"type", "hello"}, {"width", width}, {"height", height}, {"options", options}};
}

inline nlohmann::json camera(const nlohmann::json& placed, std::uint64_t number, bool moving,
                             double dx) {
  nlohmann::json message = placed;
  message["type"] = "camera";
  message["number"] = number;
  message["moving"] = moving;
  message["eye"][0] = message["eye"][0].get<double>() + dx;
  return message;
}

inline bool is_complete(const nlohmann::json& header) { return header["complete"].get<bool>(); }

inline std::string hash_of(const PageFrame& frame) {
  const image::Texels texels = image::decode_image8(frame.file, "frame");
  image::Image8 picture(texels.width, texels.height);
  std::ranges::copy(texels.texels, picture.colour.data());
  return image::hash(picture);
}

}  // namespace delray::tests
