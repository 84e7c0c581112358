// Runs the built program as a user would, in a folder of its own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace delray::tests {

struct Ran {
  int exit_code = -1;  // 128 + signal if one ended it
  std::string out, err;
};

// `command` goes to a shell, in `folder`; "delray" at its start or after "| " is the built program.
Ran run(const std::string& command, const std::filesystem::path& folder);

// What to write before a command so that MPI runs it with so many processes, however few cores
// there are.
std::string mpirun(int processes);

// An empty folder that is removed with it.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  void write(const std::string& name, const std::string& content) const;
  std::string read(const std::string& name) const;
  std::vector<std::string> files() const;  // names, sorted, hidden ones too

 private:
  std::filesystem::path path_;
};

}  // namespace delray::tests
