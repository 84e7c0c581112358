// Runs a command by the shell, with output and errors redirected into files of the temporary
// folder, which are read and removed.
#include "tests/support/run_program.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace delray::tests {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

// A name in the temporary folder that nobody else uses.
fs::path fresh_path() {
  static std::atomic<int> count{0};
  return fs::temp_directory_path() /
         ("delray-test-" + std::to_string(::getpid()) + "-" + std::to_string(count++));
}

std::string with_program(std::string command) {
  const std::string name = "delray ", program = DELRAY_PROGRAM " ";
  for (std::size_t at = command.find(name); at != std::string::npos; at = command.find(name, at)) {
    const bool word = at == 0 || command[at - 1] == ' ';
    if (word) command.replace(at, name.size(), program);
    at += word ? program.size() : name.size();
  }
  return command;
}

}  // namespace

Ran run(const std::string& command, const fs::path& folder) {
  const fs::path out = fresh_path(), err = fresh_path();
  // Looking for leaks fails with programs that switch stacks, and finds Open MPI's own.
  ::setenv("ASAN_OPTIONS", "detect_leaks=0", 1);
  const std::string line = "cd '" + folder.string() + "' && ( " + with_program(command) + " ) >'" +
                           out.string() + "' 2>'" + err.string() + "' </dev/null";
  const int status = std::system(line.c_str());
  Ran ran;
  ran.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  ran.out = content(out);
  ran.err = content(err);
  fs::remove(out);
  fs::remove(err);
  return ran;
}

std::string mpirun(int processes) {
  return "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
         "OMPI_MCA_btl_vader_single_copy_mechanism=none mpirun --oversubscribe -n " +
         std::to_string(processes) + " ";
}

Folder::Folder() : path_(fresh_path()) { fs::create_directories(path_); }
Folder::~Folder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

void Folder::write(const std::string& name, const std::string& text) const {
  std::ofstream(path_ / name, std::ios::binary) << text;
}

std::string Folder::read(const std::string& name) const { return content(path_ / name); }

std::vector<std::string> Folder::files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(path_)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace delray::tests
