// Other programs, run without a shell.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "parallel/progress.h"

namespace delray::apps {

// The program of that name in a folder of PATH; empty if there is none. Folders that are relative
// do not count, as they could be anybody's.
std::filesystem::path find_program(const std::string& name);

struct CommandResult {
  int exit_code = 0;   // 128 + signal if one ended it
  std::string errors;  // the last line on its standard error
};

// Runs `program` with these arguments in `folder`; its standard input is empty, its standard output
// goes nowhere. When `progress` (may be null) is asked to stop the program is ended, and
// parallel::Interrupted thrown. Throws std::system_error if it cannot be started.
CommandResult run_command(const std::filesystem::path& program,
                          const std::vector<std::string>& arguments,
                          const std::filesystem::path& folder, const parallel::Progress* progress);

// The command line as a shell reads it.
std::string quoted_command(const std::vector<std::string>& words);

}  // namespace delray::apps
