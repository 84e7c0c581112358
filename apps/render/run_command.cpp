// posix_spawn, as a process of many threads must not fork by itself; standard error through a pipe.
#include "apps/render/run_command.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <sstream>
#include <system_error>

namespace delray::apps {
namespace {

namespace fs = std::filesystem;

constexpr int kLook = 100;                    // milliseconds: how often to look at `progress`
constexpr std::size_t kLongestErrors = 4096;  // bytes that are kept

[[noreturn]] void fail(int error, const std::string& what) {
  throw std::system_error(error, std::generic_category(), what);
}

struct Pipe {
  std::array<int, 2> ends{-1, -1};
  Pipe() {
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail(errno, "pipe");
  }
  ~Pipe() {
    close(0);
    close(1);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void close(std::size_t end) {
    if (ends[end] >= 0) ::close(ends[end]);
    ends[end] = -1;
  }
};

// Runs in the child before it becomes the program.
struct FileActions {
  posix_spawn_file_actions_t actions{};
  FileActions() { posix_spawn_file_actions_init(&actions); }
  ~FileActions() { posix_spawn_file_actions_destroy(&actions); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;
};

pid_t spawn(const fs::path& program, const std::vector<std::string>& arguments,
            const fs::path& folder, int errors) {
  FileActions files;
  posix_spawn_file_actions_addopen(&files.actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files.actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&files.actions, errors, STDERR_FILENO);
  posix_spawn_file_actions_addchdir_np(&files.actions, folder.c_str());
  std::string name = program.string();
  std::vector<std::string> words = arguments;
  std::vector<char*> pointers = {name.data()};
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  pid_t process = 0;
  const int error =
      ::posix_spawn(&process, program.c_str(), &files.actions, nullptr, pointers.data(), environ);
  if (error != 0) fail(error, name);
  return process;
}

// Until the other end is closed, or `progress` is asked to stop: then false.
bool read_errors(int pipe, const parallel::Progress* progress, std::string& errors) {
  std::array<char, 4096> chunk{};
  while (true) {
    if (progress != nullptr && progress->stop_requested()) return false;
    pollfd wait{pipe, POLLIN, 0};
    if (::poll(&wait, 1, kLook) <= 0) continue;
    const ssize_t got = ::read(pipe, chunk.data(), chunk.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return true;
    errors.append(chunk.data(), static_cast<std::size_t>(got));
    if (errors.size() > kLongestErrors) errors.erase(0, errors.size() - kLongestErrors);
  }
}

int wait_for(pid_t process) {
  int status = 0;
  while (::waitpid(process, &status, 0) < 0) {
    if (errno != EINTR) fail(errno, "waitpid");
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string last_line(const std::string& text) {
  std::istringstream lines(text);
  std::string last;
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty()) last = line;
  }
  return last;
}

}  // namespace

fs::path find_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "/usr/local/bin:/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path program = fs::path(folder) / name;
    if (!program.is_absolute()) continue;
    std::error_code error;
    if (fs::is_regular_file(program, error) && ::access(program.c_str(), X_OK) == 0) return program;
  }
  return {};
}

CommandResult run_command(const fs::path& program, const std::vector<std::string>& arguments,
                          const fs::path& folder, const parallel::Progress* progress) {
  Pipe pipe;
  const pid_t process = spawn(program, arguments, folder, pipe.ends[1]);
  pipe.close(1);
  std::string errors;
  const bool ended = read_errors(pipe.ends[0], progress, errors);
  if (!ended) ::kill(process, SIGTERM);
  const int exit_code = wait_for(process);
  const bool stopped = !ended || (progress != nullptr && progress->stop_requested());
  if (stopped && exit_code != 0) throw parallel::Interrupted{};
  return {exit_code, last_line(errors)};
}

std::string quoted_command(const std::vector<std::string>& words) {
  constexpr const char* kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./:=+,%";
  std::string line;
  for (const std::string& word : words) {
    line += line.empty() ? "" : " ";
    if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) {
      line += word;
      continue;
    }
    line += '\'';
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

}  // namespace delray::apps
